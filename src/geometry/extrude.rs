//! Extrusion. In: a mesh of faces, a direction and a distance. Out: prisms, with the role and source of every face.
//!
//! Words: *bottom* is the source face turned over, *top* its moved copy, *sides* stand on the source's border edges.

use glam::DVec3;

use super::{Face, Mesh};

/// Where the vertices go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Every face along its own normal; coplanar neighbours together, others as prisms of their own.
    FaceNormal,
    /// Every vertex along the mean normal of its faces, `distance` metres.
    VertexNormal,
    /// All along one vector (world up); it is normalised.
    Along(DVec3),
    /// Along one vector to a flat top: `distance` above the lowest vertex, at least the shape's own extent;
    /// a negative distance is taken down from the highest vertex.
    AlongToFlatTop(DVec3),
}

/// What a result face is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    Bottom,
    Top,
    SideOuter,
    SideInner,
}

/// Origin of one result face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    pub role: Role,
    /// Index of the source face.
    pub face: u32,
    /// Edge of the source face (outer loop first, then holes, no edge skipped) a side stands on.
    pub edge: Option<u32>,
}

/// `origins` runs parallel to `mesh.faces`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extruded {
    pub mesh: Mesh,
    pub origins: Vec<Origin>,
}

/// Distances up to this leave a shape as it is (compatibility notes).
pub const LEAST_DISTANCE: f64 = 0.001;

/// Extrudes every face. For one n-gon: vertices are the n source ones, then the n moved ones; faces are bottom
/// [1, 0, n-1, .. 2], top [n, .. 2n-1], then side [i, i+1, i+1+n, i+n] per edge (compatibility notes, "Shape and
/// faces"); several faces: the same per face. Holes get walls, edges shared by two faces that move together none.
/// If the body lies behind the source face (negative distance) every face is turned so that it points outwards.
/// Top and bottom keep the uvs, sides carry the uv of their edge at both ends.
///
/// `None`: nothing to do, because `distance` is at most [`LEAST_DISTANCE`], is not finite, or no face has area.
pub fn extrude(mesh: &Mesh, direction: Direction, distance: f64) -> Option<Extruded> {
    todo!()
}
