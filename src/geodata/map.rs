//! The map's entry. In: map files. Out: [`OsmData`] (`read_map`), and from it the scene's features (`extract`).

use std::path::PathBuf;

use glam::DVec2;

use super::feature::Feature;
use super::ledger::Ledger;

pub use super::features::area::Area;
pub use super::osm::{LonLatBox, MapError, MapPlace, OsmData};

/// Reads all files into one map; of objects with the same id the one read first stays.
/// `heard` is told of every run of bytes that was read.
pub fn read_map(paths: &[PathBuf], heard: &(dyn Fn(u64) + Sync)) -> Result<OsmData, MapError> {
    super::osm::read_files(paths, heard)
}

/// Makes the scene's features, sorted by id. See [`super::features`] for what becomes of each object.
pub fn extract(
    data: &OsmData,
    area: Option<&Area>,
    project: &(dyn Fn(f64, f64) -> DVec2 + Sync),
    ledger: &mut Ledger,
) -> Vec<Feature> {
    super::features::extract(data, area, project, ledger)
}

/// The part of the earth that the map is about: the declared bounds, or else the box of its buildings, or else of its
/// roads, or else of all its ways. Single far-away nodes do not count. `None` for a map without ways.
pub fn extent(data: &OsmData) -> Option<LonLatBox> {
    super::features::extent(data)
}
