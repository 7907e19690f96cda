//! Cutting meshes by planes. In: a mesh and one or many parallel planes. Out: the pieces, closed again by caps.
//!
//! Closed meshes give closed pieces, a cap face per separate outline of the cut, with its holes. Open meshes are just
//! cut. Concave faces may fall into several. A face in the plane goes to the side it bounds. A face keeps its first
//! edge if that survives, otherwise it starts with the first surviving one (cga-reference C.3). Cut points are computed
//! once per edge, so the pieces meet bitwise. Texture coordinates are interpolated; caps have none.

use glam::DVec3;

use super::{Mesh, Plane};

/// Where a face of a piece comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// All or part of this face of the input.
    Face(u32),
    /// Closes the cut.
    Cap,
}

/// One piece; `origins` runs parallel to `mesh.faces`. A cap comes first if the input's face 0 is in other pieces
/// only (cga-reference 4.3.1), last otherwise. Empty if nothing of the input lies here.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    pub mesh: Mesh,
    pub origins: Vec<Origin>,
}

/// The two sides of a cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    pub behind: Piece,
    pub front: Piece,
}

/// Cuts a mesh by a plane.
pub fn cut(mesh: &Mesh, plane: &Plane) -> Cut {
    todo!()
}

/// Cuts a mesh by the parallel planes `normal . p = boundary` (`normal` of length 1, `boundaries` rising) into
/// `boundaries.len() + 1` pieces: before the first, between each pair, after the last. Pieces may be empty.
pub fn slice(mesh: &Mesh, normal: DVec3, boundaries: &[f64]) -> Vec<Piece> {
    todo!()
}
