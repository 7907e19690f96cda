//! Defects of plan polygons. In: a polygon. Out: every case of one defect, by the function of its name.
//!
//! Every check decides with exact predicates; a polygon that passes all is ready for every algorithm here.

use super::Polygon;

/// A corner: ring (0 = outer, then the holes) and index in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Corner {
    pub ring: usize,
    pub index: usize,
}

/// Corners with a coordinate that is not finite.
pub fn non_finite_points(polygon: &Polygon) -> Vec<Corner> {
    todo!()
}

/// Rings with fewer than three points.
pub fn rings_too_short(polygon: &Polygon) -> Vec<usize> {
    todo!()
}

/// Corners equal to the corner before them.
pub fn doubled_points(polygon: &Polygon) -> Vec<Corner> {
    todo!()
}

/// Pairs of edges (each named by its first corner) that cross, touch or overlap where polygons may not: anywhere but
/// at the shared end of neighbouring edges and, between different rings, at single points.
pub fn crossing_edges(polygon: &Polygon) -> Vec<(Corner, Corner)> {
    todo!()
}

/// Rings that run the wrong way: a clockwise outline, a counter-clockwise hole.
pub fn reversed_rings(polygon: &Polygon) -> Vec<usize> {
    todo!()
}

/// Holes that do not lie inside the outline.
pub fn holes_outside(polygon: &Polygon) -> Vec<usize> {
    todo!()
}

/// Pairs of holes one of which lies inside the other.
pub fn nested_holes(polygon: &Polygon) -> Vec<(usize, usize)> {
    todo!()
}
