//! Mitred offsets of a polygon. In: a repaired [`Polygon`] and distances. Out: what is left inside, and one border
//! face per edge, which share their vertices bit for bit.

use crate::geometry::polygon::{Polygon, Ring};
use crate::geometry::skeleton::SkeletonError;

/// The strip between an edge and its new place, counter-clockwise, first point to second point is the edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Border {
    /// Index over the edges of the outer ring, then those of the holes.
    pub edge: usize,
    pub ring: Ring,
}

/// Result of [`offset`] and [`setback`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Offset {
    /// The offset polygons; empty once the distance has eaten the polygon. Each starts with the edge that lies on the
    /// lowest edge of the input.
    pub inside: Vec<Polygon>,
    /// In edge order; edges that did not move have none.
    pub borders: Vec<Border>,
}

/// Offset by `distance` metres along the straight skeleton: negative inwards, positive outwards (CGA `offset`).
/// Outwards, a corner reaches at most [`MITRE_LIMIT`] times the distance.
///
/// # Errors
/// Those of the skeleton.
pub fn offset(polygon: &Polygon, distance: f64) -> Result<Offset, SkeletonError> {
    todo!()
}

/// Longest mitre of an outward offset, in distances; sharper corners are cut off square there.
pub const MITRE_LIMIT: f64 = 4.0;

/// Move every edge inwards by its own distance (>= 0, missing = 0): CGA `setback`. Edges of distance 0 stay; a strip
/// attaches to an unmoved neighbour at a convex corner and ends square at a concave one.
///
/// # Errors
/// Those of the skeleton.
pub fn setback(polygon: &Polygon, distances: &[f64]) -> Result<Offset, SkeletonError> {
    todo!()
}
