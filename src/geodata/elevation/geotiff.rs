//! In: the bytes of a GeoTIFF (also BigTIFF, either byte order). Out: a [`Raster`] of its first band.
//!
//! Of the file's images only the first is read: the others are overviews and masks. Source: OGC GeoTIFF 1.1
//! (19-008r4); nodata, scale and offset as GDAL writes them (tags 42113 and 42112).

use std::io::Cursor;

use glam::{DAffine2, DMat2, DVec2};
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::band::{Band, gdal_item};
use super::crs::Crs;
use super::error::ElevationProblem;
use super::geokeys::GeoKeys;
use super::placement::{LonLatBox, Placement, Window};
use super::raster::Raster;

type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

/// Most cells that are held at once (1 GiB).
const MAX_CELLS: u64 = 1 << 28;

const GDAL_METADATA: Tag = Tag::Unknown(42112);

/// Whether bytes begin like a TIFF or BigTIFF.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| bytes.starts_with(*magic))
}

/// Decodes the cells that `area` needs, or all; `crs` replaces what the file says.
pub(super) fn read(
    name: &str,
    bytes: &[u8],
    area: Option<LonLatBox>,
    crs: Option<&str>,
) -> Result<Raster, ElevationProblem> {
    let mut limits = Limits::default();
    limits.ifd_value_size = 64 << 20;
    let mut tiff = Decoder::new(Cursor::new(bytes))?.with_limits(limits);
    check_compression(&mut tiff)?;
    let keys = GeoKeys::parse(
        &numbers(&mut tiff, Tag::GeoKeyDirectoryTag)?.iter().map(|&v| v as u16).collect::<Vec<_>>(),
        &doubles(&mut tiff, Tag::GeoDoubleParamsTag)?,
    );
    let crs = match crs {
        Some(given) => Crs::parse(given)?,
        None => Crs::parse(&keys.crs()?)?,
    };
    let (width, height) = tiff.dimensions()?;
    let crs_from_cell = transform(&mut tiff, keys.pixel_is_point())?;
    let placement = Placement::new(crs, crs_from_cell, width as usize, height as usize)
        .ok_or(ElevationProblem::NoPlace("its transform has no inverse"))?;
    let window = placement.window(area);
    if window.width as u64 * window.height as u64 > MAX_CELLS {
        let (width, height) = (window.width as u64, window.height as u64);
        return Err(ElevationProblem::TooLarge { width, height, limit: MAX_CELLS });
    }
    let band = band(&mut tiff, keys.metres_per_height())?;
    let heights = cells(&mut tiff, bytes.len() as u64, window, &band)?;
    Ok(Raster::new(name, placement.cropped(window), heights))
}

/// Methods that other software writes for elevation and that we cannot undo.
fn check_compression(tiff: &mut Tiff) -> Result<(), ElevationProblem> {
    let name = match tiff.find_tag_unsigned::<u16>(Tag::Compression)?.unwrap_or(1) {
        1 | 5 | 7 | 8 | 32773 | 32946 | 50000 => return Ok(()),
        34887 => "LERC".to_owned(),
        34925 => "LZMA".to_owned(),
        34712 => "JPEG 2000".to_owned(),
        50001 => "WebP".to_owned(),
        50002 => "JPEG XL".to_owned(),
        other => format!("TIFF method {other}"),
    };
    Err(ElevationProblem::Compression(name))
}

/// An unsigned tag's values; none if it is absent.
fn numbers(tiff: &mut Tiff, tag: Tag) -> Result<Vec<u64>, ElevationProblem> {
    Ok(tiff.find_tag_unsigned_vec(tag)?.unwrap_or_default())
}

fn doubles(tiff: &mut Tiff, tag: Tag) -> Result<Vec<f64>, ElevationProblem> {
    match tiff.find_tag(tag)? {
        Some(value) => Ok(value.into_f64_vec()?),
        None => Ok(Vec::new()),
    }
}

/// The affine transform from cell coordinates to the file's coordinates (GeoTIFF 1.1, section 7.2 and annex B.6).
fn transform(tiff: &mut Tiff, pixel_is_point: bool) -> Result<DAffine2, ElevationProblem> {
    let matrix = doubles(tiff, Tag::ModelTransformationTag)?;
    let scale = doubles(tiff, Tag::ModelPixelScaleTag)?;
    let tie = doubles(tiff, Tag::ModelTiepointTag)?;
    let crs_from_raster = if let [a, b, _, d, e, f, _, h, ..] = matrix[..] {
        DAffine2::from_mat2_translation(DMat2::from_cols(DVec2::new(a, e), DVec2::new(b, f)), DVec2::new(d, h))
    } else if let ([sx, sy, ..], [i, j, _, x, y, _, ..]) = (&scale[..], &tie[..]) {
        let step = DVec2::new(*sx, -sy);
        DAffine2::from_mat2_translation(DMat2::from_diagonal(step), DVec2::new(*x, *y) - step * DVec2::new(*i, *j))
    } else if tie.len() > 6 {
        return Err(ElevationProblem::NoPlace("ground control points are not supported; warp the file first"));
    } else {
        return Err(ElevationProblem::NoPlace("it has neither a transformation nor a tie point with a pixel scale"));
    };
    let half = if pixel_is_point { 0.5 } else { 0.0 };
    Ok(crs_from_raster * DAffine2::from_translation(DVec2::splat(-half)))
}

fn band(tiff: &mut Tiff, metres_per_height: f64) -> Result<Band, ElevationProblem> {
    let text = |tiff: &mut Tiff, tag| -> Result<String, ElevationProblem> {
        match tiff.find_tag(tag)? {
            Some(value) => Ok(value.into_string()?),
            None => Ok(String::new()),
        }
    };
    let metadata = text(tiff, GDAL_METADATA)?;
    let number = |role: &str| gdal_item(&metadata, role).and_then(|v| v.parse().ok());
    let metres = match gdal_item(&metadata, "unittype").unwrap_or_default() {
        "ft" | "foot" | "feet" => 0.3048,
        "US survey foot" | "us-ft" | "ftUS" => 1200.0 / 3937.0,
        _ => metres_per_height,
    };
    Ok(Band {
        nodata: text(tiff, Tag::GdalNodata)?.trim_matches(['\0', ' ']).parse().ok(),
        scale: number("scale").unwrap_or(1.0) * metres,
        offset: number("offset").unwrap_or(0.0) * metres,
    })
}

/// Where the file keeps its blocks of cells.
struct Blocks {
    width: usize,
    height: usize,
    across: usize,
    offsets: Vec<u64>,
    lengths: Vec<u64>,
}

fn blocks(tiff: &mut Tiff, width: usize) -> Result<Blocks, ElevationProblem> {
    let (offsets, lengths) = match tiff.get_chunk_type() {
        ChunkType::Strip => (Tag::StripOffsets, Tag::StripByteCounts),
        ChunkType::Tile => (Tag::TileOffsets, Tag::TileByteCounts),
    };
    let (w, h) = tiff.chunk_dimensions();
    let (w, h) = (w as usize, h as usize);
    if w == 0 || h == 0 {
        return Err(ElevationProblem::Damaged("blocks of no cells".to_owned()));
    }
    let (offsets, lengths) = (numbers(tiff, offsets)?, numbers(tiff, lengths)?);
    Ok(Blocks { width: w, height: h, across: width.div_ceil(w), offsets, lengths })
}

/// Decodes the blocks that touch the window. Blocks that the file leaves out are void.
fn cells(tiff: &mut Tiff, file_length: u64, window: Window, band: &Band) -> Result<Vec<f32>, ElevationProblem> {
    let mut heights = vec![f32::NAN; window.width * window.height];
    if heights.is_empty() {
        return Ok(heights);
    }
    let width = tiff.dimensions()?.0 as usize;
    let blocks = blocks(tiff, width)?;
    for by in window.row / blocks.height..=(window.row + window.height - 1) / blocks.height {
        for bx in window.column / blocks.width..=(window.column + window.width - 1) / blocks.width {
            let index = by * blocks.across + bx;
            let (Some(&offset), Some(&length)) = (blocks.offsets.get(index), blocks.lengths.get(index)) else {
                return Err(ElevationProblem::Damaged(format!("block {index} is missing from the directory")));
            };
            if offset == 0 || length == 0 {
                continue;
            }
            if offset.checked_add(length).is_none_or(|end| end > file_length) {
                return Err(ElevationProblem::Damaged(format!("block {index} lies beyond the end of the file")));
            }
            let index = u32::try_from(index).map_err(|_| tiff::TiffError::IntSizeError)?;
            let (data_width, data_height) = tiff.chunk_data_dimensions(index);
            let values = tiff.read_chunk(index)?;
            let block = Window {
                column: bx * blocks.width,
                row: by * blocks.height,
                width: data_width as usize,
                height: data_height as usize,
            };
            place(&values, block, window, band, &mut heights)?;
        }
    }
    Ok(heights)
}

/// Copies a block's part of the window.
fn place(
    values: &DecodingResult,
    block: Window,
    window: Window,
    band: &Band,
    heights: &mut [f32],
) -> Result<(), ElevationProblem> {
    let columns = block.column.max(window.column)..(block.column + block.width).min(window.column + window.width);
    for row in block.row.max(window.row)..(block.row + block.height).min(window.row + window.height) {
        let to = (row - window.row) * window.width;
        for column in columns.clone() {
            let cell = (row - block.row) * block.width + column - block.column;
            heights[to + column - window.column] = band.metres(values, cell, block.width * block.height)?;
        }
    }
    Ok(())
}
