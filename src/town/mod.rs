//! A fictional town of any size, as map data: input for the example, for tests and for benchmarks.
//!
//! In: a seed and a number of buildings. Out: `NAME.osm` (OSM XML) and `NAME.tif` (GeoTIFF elevation). The same
//! seed and number give the same bytes. The town lies at 45° N 30° W, in the open Atlantic, so that nobody takes
//! it for a real place. It is not a phase: nothing else in the library uses it.

mod elevation;
mod layout;
mod lots;
mod write;

use std::path::{Path, PathBuf};

use crate::output::{OutputError, prepare_folder};

pub use layout::Town;

/// Why a town could not be made.
#[derive(Debug, thiserror::Error)]
pub enum TownError {
    #[error("a town has 1 to 1,000,000 buildings, not {0}")]
    Size(u32),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("{}: {source}", path.display())]
    Tiff { path: PathBuf, source: tiff::TiffError },
}

/// Writes `folder/name.osm` and `folder/name.tif`; the folder is made if it is missing. Files appear whole or not at all.
/// `heard` is told of every building.
pub fn write_town(
    seed: u64,
    buildings: u32,
    folder: &Path,
    name: &str,
    heard: &dyn Fn(u64),
) -> Result<[PathBuf; 2], TownError> {
    if !(1..=1_000_000).contains(&buildings) {
        return Err(TownError::Size(buildings));
    }
    prepare_folder(folder)?;
    let town = Town::new(seed, buildings);
    let (osm, tif) = (folder.join(format!("{name}.osm")), folder.join(format!("{name}.tif")));
    write::osm(&town, &osm, heard)?;
    elevation::geotiff(&town, &tif)?;
    Ok([osm, tif])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_town_has_as_many_buildings_as_asked_and_the_same_bytes_every_time() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for n in [1, 37, 400] {
            let [osm, tif] = write_town(7, n, &folder.path().join("a"), "t", &|_| {}).expect("the town can be written");
            let [osm2, tif2] =
                write_town(7, n, &folder.path().join("b"), "t", &|_| {}).expect("the town can be written");
            let text = std::fs::read_to_string(&osm).expect("the file was written");
            assert_eq!(text.matches("k=\"building\"").count(), n as usize);
            assert_eq!(text, std::fs::read_to_string(osm2).expect("the file was written"));
            assert_eq!(std::fs::read(tif).expect("written"), std::fs::read(tif2).expect("written"));
        }
    }

    #[test]
    fn sizes_outside_the_range_are_refused() {
        assert!(matches!(write_town(0, 0, Path::new("/nowhere"), "t", &|_| {}), Err(TownError::Size(0))));
        assert!(matches!(write_town(0, 1_000_001, Path::new("/nowhere"), "t", &|_| {}), Err(TownError::Size(_))));
    }
}
