//! What can be wrong with an elevation file. Every error names the file.

/// An elevation file that could not be used.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {problem}")]
pub struct ElevationError {
    pub file: String,
    pub problem: ElevationProblem,
}

/// The kinds of problem.
#[derive(Debug, thiserror::Error)]
pub enum ElevationProblem {
    #[error("not an elevation file: neither GeoTIFF nor .hgt (also .zip or .gz of it)")]
    UnknownFormat,
    #[error("damaged or unsupported TIFF: {0}")]
    Tiff(#[from] tiff::TiffError),
    #[error("damaged TIFF: {0}")]
    Damaged(String),
    #[error("{0} compression is not supported; `gdal_translate -co COMPRESS=DEFLATE` converts the file")]
    Compression(String),
    #[error("pixels of type {0} hold no heights")]
    SampleType(&'static str),
    #[error(
        "the file does not say which coordinate reference system it uses; name one in the recipe (crs \"EPSG:4326\", \
         or a PROJ string)"
    )]
    NoCrs,
    #[error("unknown coordinate reference system {0}; give \"EPSG:<code>\" or a PROJ string")]
    UnknownCrs(String),
    #[error("the file's own projection is not supported: {0}; name an equivalent PROJ string in the recipe (crs)")]
    UserDefinedCrs(String),
    #[error("coordinate reference system {definition}: {reason}")]
    Crs { definition: String, reason: String },
    #[error("the file is not placed on Earth: {0}")]
    NoPlace(&'static str),
    #[error("{width} x {height} cells are too many at once (limit {limit}); cut the file to the scene")]
    TooLarge { width: u64, height: u64, limit: u64 },
    #[error("an .hgt file is named by its south-west corner, such as N43E007.hgt; this one is named {0}")]
    HgtName(String),
    #[error("{0} bytes are no .hgt tile: 1201 x 1201 or 3601 x 3601 heights of two bytes are expected")]
    HgtSize(usize),
    #[error("damaged .gz file: {0}")]
    Gzip(std::io::Error),
    #[error("damaged .zip file: {0}")]
    Zip(#[from] zip::result::ZipError),
    #[error("the .zip file holds no .hgt or .tif file")]
    EmptyZip,
}

impl ElevationProblem {
    pub(super) fn in_file(self, file: &str) -> ElevationError {
        ElevationError { file: file.to_owned(), problem: self }
    }
}
