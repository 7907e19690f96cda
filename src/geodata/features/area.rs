//! The area of a scene. In: a box or polygon in degrees. Out: its ring in the local frame, and lines cut to it.

use glam::DVec2;

use crate::geodata::osm::LonLatBox;
use crate::geometry::Ring;

/// What belongs to the scene, degrees (longitude, latitude).
#[derive(Clone, Debug, PartialEq)]
pub enum Area {
    Box(LonLatBox),
    /// A closed ring without a repeated last point; any direction.
    Polygon(Vec<(f64, f64)>),
}

impl Area {
    /// The least box around the area; an empty polygon gives `None`.
    pub fn bounds(&self) -> Option<LonLatBox> {
        match self {
            Area::Box(b) => Some(*b),
            Area::Polygon(ring) => LonLatBox::around(ring.iter().copied()),
        }
    }

    /// Corners in the local frame, counter-clockwise.
    pub fn ring(&self, project: &dyn Fn(f64, f64) -> DVec2) -> Ring {
        let mut ring: Ring = match self {
            Area::Box(b) => [(b.west, b.south), (b.east, b.south), (b.east, b.north), (b.west, b.north)]
                .iter()
                .map(|&(lon, lat)| project(lon, lat))
                .collect(),
            Area::Polygon(ring) => ring.iter().map(|&(lon, lat)| project(lon, lat)).collect(),
        };
        if crate::geometry::polygon::signed_area(&ring) < 0.0 {
            ring.reverse();
        }
        ring
    }
}
