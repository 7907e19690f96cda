//! In: the bytes of an .hgt tile (big-endian 16-bit heights, north row first, posts on whole degrees) and its name.
//! Out: a [`Raster`]. Source: SRTM Topography, version 2.1 documentation, sections 2.1 and 3.1.

use glam::{DAffine2, DMat2, DVec2};

use super::crs::Crs;
use super::error::ElevationProblem;
use super::placement::{LonLatBox, Placement};
use super::raster::Raster;

const VOID: i16 = -32768;

/// Decodes one tile; `tile` is the name that carries the south-west corner.
pub(super) fn read(name: &str, tile: &str, bytes: &[u8], area: Option<LonLatBox>) -> Result<Raster, ElevationProblem> {
    let (west, south) = corner(tile).ok_or_else(|| ElevationProblem::HgtName(tile.to_owned()))?;
    let (width, height) = posts(bytes.len()).ok_or(ElevationProblem::HgtSize(bytes.len()))?;
    let step = DVec2::new(1.0 / (width - 1) as f64, -1.0 / (height - 1) as f64);
    let crs_from_cell =
        DAffine2::from_mat2_translation(DMat2::from_diagonal(step), DVec2::new(west, south + 1.0) - step / 2.0);
    let crs = Crs::parse("EPSG:4326").expect("WGS84 is known");
    let placement = Placement::new(crs, crs_from_cell, width, height).expect("steps are not zero");
    let window = placement.window(area);
    let mut heights = Vec::with_capacity(window.width * window.height);
    for row in window.row..window.row + window.height {
        let start = 2 * (row * width + window.column);
        for pair in bytes[start..start + 2 * window.width].chunks_exact(2) {
            let h = i16::from_be_bytes([pair[0], pair[1]]);
            heights.push(if h == VOID { f32::NAN } else { f32::from(h) });
        }
    }
    Ok(Raster::new(name, placement.cropped(window), heights))
}

/// Whether a file of this name and length can be an .hgt tile.
pub(super) fn looks_like(tile: &str, length: usize) -> bool {
    tile.to_ascii_lowercase().ends_with(".hgt") || corner(tile).is_some() && posts(length).is_some()
}

/// Columns and rows: 3" or 1" tiles; 1" tiles beyond 50 degrees of latitude may have every other column only.
fn posts(length: usize) -> Option<(usize, usize)> {
    [(1201, 1201), (3601, 3601), (1801, 3601)].into_iter().find(|(w, h)| 2 * w * h == length)
}

/// West and south from a name such as `.../N43E007.SRTMGL1.hgt`.
fn corner(tile: &str) -> Option<(f64, f64)> {
    let base = tile.rsplit(['/', '\\']).next()?.to_ascii_uppercase();
    let b = base.as_bytes();
    let number = |s: &[u8]| std::str::from_utf8(s).ok().filter(|t| t.bytes().all(|c| c.is_ascii_digit()))?.parse().ok();
    let (lat, lon): (f64, f64) = (number(b.get(1..3)?)?, number(b.get(4..7)?)?);
    let south = match b[0] {
        b'N' => lat,
        b'S' => -lat,
        _ => return None,
    };
    let west = match b[3] {
        b'E' => lon,
        b'W' => -lon,
        _ => return None,
    };
    ((-90.0..90.0).contains(&south) && (-180.0..180.0).contains(&west)).then_some((west, south))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tile whose height is 10 at its south-west post, one more per column, 0.. and a void in the north-west.
    fn tile() -> Vec<u8> {
        let mut bytes = Vec::new();
        for row in 0..1201_i16 {
            for column in 0..1201_i16 {
                let h = if row == 0 && column == 0 { VOID } else { column + 2 * (1200 - row) };
                bytes.extend(h.to_be_bytes());
            }
        }
        bytes
    }

    #[test]
    fn posts_lie_on_whole_degrees() {
        let r = read("t", "dir/S17W180.hgt", &tile(), None).unwrap();
        let close = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-6;
        assert!(close(r.sample(-180.0, -17.0), 0.0) && close(r.sample(180.0, -17.0), 0.0));
        assert!(close(r.sample(-179.0, -17.0), 1200.0) && close(r.sample(-179.0, -16.0), 3600.0));
        assert!(close(r.sample(-179.5, -16.5), 600.0 + 1200.0));
        assert_eq!((r.sample(-180.0, -16.0), r.voids()), (None, 1));
        assert_eq!(r.sample(-178.9, -16.5), None);
    }

    #[test]
    fn a_window_gives_the_same_heights() {
        let whole = read("t", "N42E001.hgt", &tile(), None).unwrap();
        let area = LonLatBox { west: 1.4, south: 42.2, east: 1.5, north: 42.3 };
        let part = read("t", "N42E001.hgt", &tile(), Some(area)).unwrap();
        assert!(part.size().0 < 140 && part.size().1 < 140);
        for (lon, lat) in [(1.4, 42.2), (1.5, 42.3), (1.4567, 42.2345)] {
            assert!((part.sample(lon, lat).unwrap() - whole.sample(lon, lat).unwrap()).abs() < 1e-6);
        }
        let beside = LonLatBox { west: 3.0, south: 42.2, east: 3.1, north: 42.3 };
        assert_eq!(read("t", "N42E001.hgt", &tile(), Some(beside)).unwrap().size(), (0, 0));
    }

    #[test]
    fn names_and_sizes_are_checked() {
        assert!(matches!(read("t", "hill.hgt", &tile(), None), Err(ElevationProblem::HgtName(_))));
        assert!(matches!(read("t", "N42E001.hgt", &tile()[2..], None), Err(ElevationProblem::HgtSize(_))));
        assert_eq!(corner("a/b/n05w008.hgt"), Some((-8.0, 5.0)));
        assert_eq!(
            (corner("N91E000.hgt"), corner("N+1E000.hgt"), corner("N4"), corner("é42E001")),
            (None, None, None, None)
        );
    }
}
