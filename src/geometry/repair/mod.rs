//! The door for footprints. In: any list of rings. Out: clean polygons, a verdict, and what was done.
//!
//! The rings are rounded to the kernel's grid (exact integer coordinates) and every decision is taken there
//! (numerics section 4). A footprint that is already valid keeps its first vertex, its order, its collinear vertices
//! and its coordinates bit for bit.

use super::{Polygon, Ring};

/// Tolerances with one owner each (numerics section 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Consecutive points closer than this are joined, metres; 0 joins only points that are equal on the grid.
    pub weld: f64,
    /// Parts and holes smaller than this are dropped, square metres.
    pub min_area: f64,
}

impl Default for Options {
    fn default() -> Self {
        Options { weld: 1e-3, min_area: 0.01 }
    }
}

/// Whether a footprint can be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Used as it came.
    Ok,
    /// Used after the changes listed in the notes.
    Repaired,
    /// Not usable.
    Rejected(Rejection),
}

/// Why a footprint is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Rejection {
    #[error("the outline has fewer than three different points")]
    TooFewPoints,
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("the outline is larger than 1e9 metres")]
    TooLarge,
    #[error("the outline encloses no area")]
    NoArea,
    #[error("all parts are smaller than the least area")]
    BelowLeastArea,
    #[error("the holes leave nothing of the outline")]
    HolesCoverOutline,
    #[error("the polygon engine failed on this outline")]
    EngineFailed,
}

/// One thing that was done; counts are of points or rings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Note {
    DoubledPointsRemoved(usize),
    OutlineReversed,
    HolesReversed(usize),
    CrossingsResolved,
    SplitIntoParts(usize),
    SmallPartsDropped(usize),
    SmallHolesDropped(usize),
}

/// The result: polygons are ready for the skeleton, booleans and CGA.
#[derive(Clone, Debug, PartialEq)]
pub struct Repaired {
    pub verdict: Verdict,
    pub polygons: Vec<Polygon>,
    pub notes: Vec<Note>,
    /// Outline less holes as they came, by signed areas, square metres (NaN if a coordinate is not finite).
    pub area_before: f64,
    pub area_after: f64,
}

/// Cleans a footprint: `rings[0]` is the outline, the others are holes; directions and repeated last points
/// do not matter. Each ring is filled by the non-zero rule on its own, the filled holes are united and taken from
/// the filled outline (numerics 4.5).
pub fn repair(rings: &[Ring], options: &Options) -> Repaired {
    todo!()
}
