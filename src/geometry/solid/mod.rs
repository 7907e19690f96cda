//! Booleans of polygon meshes in space. In: two meshes, closed or open. Out: one mesh whose faces know where they come
//! from, with the edges where the two meet.
//!
//! Faces stay polygons: every face is cut along its intersections with the other mesh, the pieces are sorted by where
//! they lie, and what is kept of one face is joined again. Vertices of the input keep their coordinates bit for bit.
//! Closed operands give a closed result: if rounding prevents that, the work is done again with a coarser tolerance,
//! and refused in the end.
//!
//! Faces that lie on each other: for closed bodies the surface appears once where both point the same way, and where
//! they point against each other it is inside a union and part of no intersection. Meshes that lie in one plane
//! altogether are combined in that plane and keep their old edges (cga-reference 4.16.2).

mod arrange;
mod assemble;
mod cells;
mod classify;
mod facets;
mod meet;
mod pool;
mod straighten;

use super::Mesh;
use super::mesh_checks::is_closed;
use facets::Facets;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    Union,
    Subtract,
    Intersect,
}

/// How components with open edges are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OpenMeshes {
    /// As the half space behind them, where no open edge lies inside the other mesh.
    HalfSpaces,
    /// As surfaces that enclose nothing.
    Surfaces,
}

/// Where a face of the result comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// 0 for the first operand, 1 for the second.
    pub operand: u8,
    /// Index of the face there.
    pub face: u32,
    /// A face of the other operand lies on it.
    pub is_shared: bool,
}

/// `origins` runs parallel to the faces, those of the first operand first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Combined {
    pub mesh: Mesh,
    pub origins: Vec<Origin>,
    /// Edges (vertex indices, the lesser first) between faces of different operands.
    pub cuts: Vec<[u32; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SolidError {
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("the surfaces meet in too many places")]
    TooComplex,
    #[error("the surfaces meet so closely that no clean result was found")]
    NoCleanResult,
}

/// Tolerance as a share of the extent; each new try is this much coarser.
const TOLERANCE: f64 = 1e-9;
const COARSER: f64 = 30.0;
const TRIES: usize = 4;
/// What f64 resolves at a distance from the origin, with room for a few operations.
const RESOLUTION: f64 = 1e-14;

/// Combines two meshes.
///
/// # Errors
/// See [`SolidError`].
pub fn combine(a: &Mesh, b: &Mesh, operator: Operator, open: OpenMeshes) -> Result<Combined, SolidError> {
    let points = || a.positions.iter().chain(&b.positions);
    if points().any(|p| !p.is_finite()) {
        return Err(SolidError::NotFinite);
    }
    let bounds = super::box_tree::Bounds::around(points().copied());
    let Some(bounds) = bounds else { return Ok(Combined::default()) };
    let extent = (bounds.hi - bounds.lo).max_element();
    let reach = bounds.lo.abs().max(bounds.hi.abs()).max_element();
    let mut tolerance = (extent * TOLERANCE).max(reach * RESOLUTION);
    let mut failure = SolidError::NoCleanResult;
    for _ in 0..TRIES {
        let facets = Facets::new(a, b, tolerance);
        match attempt(facets, [a, b], operator, open) {
            Ok(combined) => return Ok(combined),
            Err(SolidError::TooComplex) => return Err(SolidError::TooComplex),
            Err(error) => failure = error,
        }
        tolerance *= COARSER;
    }
    Err(failure)
}

fn attempt(
    mut facets: Facets,
    meshes: [&Mesh; 2],
    operator: Operator,
    open: OpenMeshes,
) -> Result<Combined, SolidError> {
    let meetings = meet::all(&mut facets);
    let arrangement = arrange::settle(&mut facets, &meetings)?;
    let pieces = classify::kept(&facets, &meetings, &arrangement, operator, open)?;
    let must_close = facets.components.iter().all(|c| c.is_closed);
    let combined = assemble::assemble(&facets, &arrangement, pieces, meshes);
    let closes = combined.mesh.faces.is_empty() || is_closed(&combined.mesh);
    if must_close && !closes { Err(SolidError::NoCleanResult) } else { Ok(combined) }
}

#[cfg(test)]
mod tests;
