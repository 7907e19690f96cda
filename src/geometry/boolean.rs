//! Booleans of plan polygons. In: two sets of polygons. Out: disjoint polygons with holes, on a common integer grid.

use glam::DVec2;

use super::Polygon;

/// The world's errors of the boolean engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BooleanError {
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("the polygons reach over more than 1e9 metres")]
    TooLarge,
    #[error("the polygon engine failed")]
    EngineFailed,
}

/// What lies in a or in b; touching parts are joined.
pub fn union(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    todo!()
}

/// What lies in a and in b.
pub fn intersection(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    todo!()
}

/// What lies in a and not in b.
pub fn difference(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    todo!()
}

/// What lies in exactly one of a and b.
pub fn symmetric_difference(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    todo!()
}

/// A point inside the polygon, not on its border: the middle of the widest stretch of a level line through it.
/// `None` if the polygon has no area.
pub fn point_on_surface(polygon: &Polygon) -> Option<DVec2> {
    todo!()
}
