//! The town's ground as a GeoTIFF: float32, EPSG:4326, deflate, cells of about 15 m (larger for very large towns).

use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use glam::DVec2;
use tiff::encoder::colortype::Gray32Float;
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder};
use tiff::tags::Tag;

use super::TownError;
use super::layout::{BLOCK, Town};
use super::write::{METRES_PER_DEGREE, lon_lat};
use crate::output;

const CELL: f64 = 15.0;
const MOST_CELLS: f64 = 4096.0;

/// Writes the elevation; the file appears under its name only when it is complete.
pub fn geotiff(town: &Town, path: &Path) -> Result<(), TownError> {
    let whole = || -> tiff::TiffResult<()> {
        let mut file = BufWriter::new(output::aside(path)?);
        encode(town, &mut file)?;
        Ok(output::keep(file, path)?)
    };
    whole().map_err(|source| TownError::Tiff { path: path.to_owned(), source })
}

fn encode<W: Write + Seek>(town: &Town, out: &mut W) -> tiff::TiffResult<()> {
    let reach = town.half_size() + BLOCK;
    let cell = CELL.max(2.0 * reach.max_element() / MOST_CELLS);
    let size = (reach * 2.0 / cell).ceil();
    let (columns, rows) = (size.x as u32, size.y as u32);
    let west_north = DVec2::new(-0.5 * size.x * cell, 0.5 * size.y * cell);
    let cells: Vec<f32> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| {
            let centre = west_north + DVec2::new(f64::from(column) + 0.5, -(f64::from(row) + 0.5)) * cell;
            (town.level(town.unwarp(centre)) * 100.0).round() as f32 / 100.0
        })
        .collect();
    let corner = lon_lat(west_north);
    let step = DVec2::splat(cell) / METRES_PER_DEGREE;
    let mut encoder = TiffEncoder::new(out)?.with_compression(Compression::Deflate(DeflateLevel::Best));
    let mut image = encoder.new_image::<Gray32Float>(columns, rows)?;
    let directory = image.encoder();
    directory.write_tag(Tag::ModelPixelScaleTag, [step.x, step.y, 0.0].as_slice())?;
    directory.write_tag(Tag::ModelTiepointTag, [0.0, 0.0, 0.0, corner.x, corner.y, 0.0].as_slice())?;
    // Version 1.1.0, 3 keys: geographic model, pixel is area, WGS 84.
    let keys: [u16; 16] = [1, 1, 0, 3, 1024, 0, 1, 2, 1025, 0, 1, 1, 2048, 0, 1, 4326];
    directory.write_tag(Tag::GeoKeyDirectoryTag, keys.as_slice())?;
    image.write_data(&cells)
}
