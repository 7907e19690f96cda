//! In: bytes of an elevation file (GeoTIFF, .hgt, either of them in .zip or .gz) and its name. Out: a [`Raster`].

mod band;
mod crs;
mod error;
mod geokeys;
mod geotiff;
mod hgt;
mod placement;
mod raster;
#[cfg(test)]
mod tests;

use std::io::{Cursor, Read};

pub use error::{ElevationError, ElevationProblem};
pub use placement::{LonLatBox, Placement};
pub use raster::{IMPLAUSIBLE_M, Raster};

/// Largest unpacked size of a packed file, bytes.
const MAX_UNPACKED: u64 = 4 << 30;

/// Reads an elevation file; the format is told by its content, and only .hgt needs its name (for the place).
/// With `area` only the cells around it are decoded. `crs` (`EPSG:<code>` or a PROJ string) replaces what a GeoTIFF
/// says about its coordinates; .hgt is always WGS84.
pub fn read(name: &str, bytes: &[u8], area: Option<LonLatBox>, crs: Option<&str>) -> Result<Raster, ElevationError> {
    unpack(name, name, bytes, area, crs, 0).map_err(|problem| problem.in_file(name))
}

/// `tile` is the name inside the archive.
fn unpack(
    name: &str,
    tile: &str,
    bytes: &[u8],
    area: Option<LonLatBox>,
    crs: Option<&str>,
    depth: usize,
) -> Result<Raster, ElevationProblem> {
    if geotiff::looks_like(bytes) {
        geotiff::read(name, bytes, area, crs)
    } else if bytes.starts_with(&[0x1f, 0x8b]) && depth < 2 {
        let inner = tile.strip_suffix(".gz").unwrap_or(tile);
        unpack(name, inner, &gunzip(bytes)?, area, crs, depth + 1)
    } else if bytes.starts_with(b"PK") && depth < 2 {
        let (inner, content) = unzip(bytes)?;
        unpack(name, &inner, &content, area, crs, depth + 1)
    } else if hgt::looks_like(tile, bytes.len()) {
        hgt::read(name, tile, bytes, area)
    } else {
        Err(ElevationProblem::UnknownFormat)
    }
}

fn gunzip(bytes: &[u8]) -> Result<Vec<u8>, ElevationProblem> {
    let mut out = Vec::new();
    let stream = flate2::read::MultiGzDecoder::new(bytes);
    stream.take(MAX_UNPACKED).read_to_end(&mut out).map_err(ElevationProblem::Gzip)?;
    Ok(out)
}

/// The first .hgt or .tif of an archive.
fn unzip(bytes: &[u8]) -> Result<(String, Vec<u8>), ElevationProblem> {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes))?;
    for index in 0..archive.len() {
        let entry = archive.by_index(index)?;
        let inner = entry.name()?.into_owned();
        let lower = inner.to_ascii_lowercase();
        if entry.is_file() && [".hgt", ".tif", ".tiff"].iter().any(|end| lower.ends_with(end)) {
            let mut out = Vec::new();
            entry.take(MAX_UNPACKED).read_to_end(&mut out).map_err(|e| ElevationProblem::Zip(e.into()))?;
            return Ok((inner, out));
        }
    }
    Err(ElevationProblem::EmptyZip)
}
