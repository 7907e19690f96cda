//! Defects and measures of meshes. In: a mesh. Out: every case of one defect, by the function of its name.

use super::Mesh;

/// A directed edge of a face: (from, to) vertex indices.
pub type Edge = (u32, u32);

/// Edges with a face on one side only, as that face runs them.
pub fn open_edges(mesh: &Mesh) -> Vec<Edge> {
    todo!()
}

/// Edges (lesser index first) in more than two faces, with how many.
pub fn edges_used_more_than_twice(mesh: &Mesh) -> Vec<(Edge, usize)> {
    todo!()
}

/// Edges (lesser index first) that two faces run in the same direction: one of the two is flipped.
pub fn edges_run_twice_the_same_way(mesh: &Mesh) -> Vec<Edge> {
    todo!()
}

/// Faces whose outer loop encloses no area, or has fewer than three corners.
pub fn faces_without_area(mesh: &Mesh) -> Vec<usize> {
    todo!()
}

/// (face, corner) where a loop has the same vertex, or the same position, twice in a row.
pub fn doubled_corners(mesh: &Mesh) -> Vec<(usize, usize)> {
    todo!()
}

/// Faces with a corner farther than `tolerance` metres from the face's mean plane, with that distance.
pub fn non_planar_faces(mesh: &Mesh, tolerance: f64) -> Vec<(usize, f64)> {
    todo!()
}

/// (face, corner) whose index has no vertex.
pub fn missing_vertices(mesh: &Mesh) -> Vec<(usize, usize)> {
    todo!()
}

/// Vertices with a coordinate that is not finite.
pub fn non_finite_vertices(mesh: &Mesh) -> Vec<usize> {
    todo!()
}

/// Triangles of no area that the triangulation of a face gives: (face, number of them).
pub fn degenerate_triangles(mesh: &Mesh) -> Vec<(usize, usize)> {
    todo!()
}

/// Whether every edge is run once in each direction; positions are compared by index, see [`super::mesh::Mesh::welded`].
pub fn is_closed(mesh: &Mesh) -> bool {
    todo!()
}

/// Volume by the divergence theorem, cubic metres: right for closed meshes, positive if faces point outwards.
pub fn volume(mesh: &Mesh) -> f64 {
    todo!()
}

/// Sum of the face areas, holes taken off, square metres.
pub fn surface_area(mesh: &Mesh) -> f64 {
    todo!()
}
