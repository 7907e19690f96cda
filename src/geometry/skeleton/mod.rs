//! Weighted straight skeleton, exact in every decision (`../shared/numerics.md` §5).
//!
//! In: a repaired [`Polygon`] and, if wanted, one speed per edge. Out: nodes with the time at which the shrinking
//! outline reaches them, and one face per edge. Time is distance from the eaves where the weight is 1.

use glam::DVec2;

use crate::geometry::polygon::Polygon;

/// A corner of a face: a vertex of the polygon (`time` 0) or a place where the shrinking outline changes its shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Plan position, metres, in the coordinates of the input.
    pub position: DVec2,
    /// Distance from the eaves, metres (for weight 1).
    pub time: f64,
}

/// What one edge of the polygon sweeps.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonFace {
    /// Index over the edges of the outer ring, then those of the holes; edge `i` of a ring runs from vertex `i` to `i + 1`.
    pub edge: usize,
    /// Node indices, counter-clockwise seen from above; the first two are the ends of the edge.
    pub boundary: Vec<u32>,
}

/// The faces swept by the edges of a polygon, sorted by edge. Faces of no extent are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// The vertices of the polygon in the order of its rings (node `i` starts edge `i`), then the inner nodes.
    pub nodes: Vec<Node>,
    pub faces: Vec<SkeletonFace>,
    /// Loops of the outline where it stopped: at the wanted time, or because no edge of it moves. Counter-clockwise
    /// around what is left, holes clockwise. Empty if the outline vanished.
    pub tops: Vec<Vec<u32>>,
}

/// Why there is no skeleton.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SkeletonError {
    #[error("the outline has fewer than three different points")]
    TooFewPoints,
    #[error("a coordinate is not a finite number, or the outline is wider than 1e9 m")]
    NotFinite,
    #[error("the outline crosses or overlaps itself")]
    NotSimple,
    #[error("{given} weights for {edges} edges")]
    WeightCount { given: usize, edges: usize },
    #[error("weight {weight} of edge {edge} is not a finite number of at least 0")]
    Weight { edge: usize, weight: f64 },
    #[error("the distance {0} is not a finite number of at least 0")]
    Distance(f64),
}

/// The straight skeleton of `polygon`. `weights` are the speeds of the edges (outer ring, then holes), 1 if `None`.
///
/// # Errors
/// See [`SkeletonError`]; none for a polygon that passed the repair door, with valid weights.
pub fn skeleton(polygon: &Polygon, weights: Option<&[f64]>) -> Result<Skeleton, SkeletonError> {
    todo!()
}

/// The skeleton as far as the outline has come at `time`; [`Skeleton::tops`] is the outline then.
///
/// # Errors
/// As [`skeleton`], and [`SkeletonError::Distance`].
pub fn wavefront(polygon: &Polygon, weights: Option<&[f64]>, time: f64) -> Result<Skeleton, SkeletonError> {
    todo!()
}
