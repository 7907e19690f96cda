//! Triangulation. In: a polygon with holes or a mesh face. Out: counter-clockwise triangles over its corners.
//!
//! Corners are numbered over the loops in order: the outer loop first, then the holes.

use glam::{DVec2, DVec3};

use super::{Face, Mesh, Polygon};

/// Triangles of a plan polygon: n + 2 h - 2 of them, counter-clockwise, covering it exactly.
/// Degenerate input (fewer than three points, no area) gives fewer or none.
pub fn triangulate_polygon(polygon: &Polygon) -> Vec<[u32; 3]> {
    todo!()
}

/// Triangles of a face over its corners, seen counter-clockwise from the side its normal points to.
/// The face is projected once, along the greatest component of its Newell normal. A face without area gives none.
pub fn triangulate_face(mesh: &Mesh, face: &Face) -> Vec<[u32; 3]> {
    todo!()
}

/// All triangles of a mesh as (face index, corner positions), faces in order.
pub fn triangles(mesh: &Mesh) -> impl Iterator<Item = (usize, [DVec3; 3])> + '_ {
    mesh.faces.iter().enumerate().flat_map(move |(index, face)| {
        let corners: Vec<u32> = face.corners().collect();
        triangulate_face(mesh, face)
            .into_iter()
            .map(move |t| (index, t.map(|c| mesh.positions[corners[c as usize] as usize])))
    })
}
