//! Tags of what is left of a mesh after an operation. In: the old mesh with its tags, the new one, and the old face of
//! every new one. Out: the new one's tags.
//!
//! A new face has the tags of its source. Its edges have the tags of the source's edges they lie on, its vertices those
//! of the source's vertices they stand on (reference 4.15.4, "cut components keep tags").

use glam::DVec3;

use super::Tags;
use crate::geometry::{Face, Mesh};

/// Distances below this share of the source face's extent are none.
const NEAR: f64 = 1e-7;

pub fn carried(tags: &Tags, old: &Mesh, new: &Mesh, sources: &[Option<u32>]) -> Tags {
    let mut out = Tags::default();
    if tags.is_empty() {
        return out;
    }
    for (number, (face, source)) in new.faces.iter().zip(sources).enumerate() {
        let Some(source) = source else { continue };
        out.extend_face(number, tags.face(*source as usize));
        if tags.any_edges() || tags.any_vertices() {
            let source = Tagged::of(tags, old, &old.faces[*source as usize]);
            source.give(new, face, &mut out);
        }
    }
    out
}

/// The tagged edges and vertices of one face.
struct Tagged<'a> {
    tags: &'a Tags,
    edges: Vec<([u32; 2], [DVec3; 2])>,
    vertices: Vec<(u32, DVec3)>,
    near: f64,
}

impl<'a> Tagged<'a> {
    fn of(tags: &'a Tags, mesh: &Mesh, face: &Face) -> Self {
        let at = |v: u32| mesh.positions[v as usize];
        let tagged = |(a, b): &(u32, u32)| !tags.edge([*a, *b]).is_empty();
        let edges = face.edges().filter(tagged).map(|(a, b)| ([a, b], [at(a), at(b)])).collect();
        let vertices = face.corners().filter(|v| !tags.vertex(*v).is_empty()).map(|v| (v, at(v))).collect();
        let first = face.corners().next().map_or(DVec3::ZERO, at);
        let extent = face.corners().map(|v| at(v).distance(first)).fold(0.0, f64::max);
        Tagged { tags, edges, vertices, near: NEAR * extent }
    }

    fn give(&self, mesh: &Mesh, face: &Face, out: &mut Tags) {
        let at = |v: u32| mesh.positions[v as usize];
        if !self.edges.is_empty() {
            for (a, b) in face.edges() {
                for (edge, ends) in &self.edges {
                    if self.on(at(a), ends) && self.on(at(b), ends) {
                        out.extend_edge([a, b], self.tags.edge(*edge));
                    }
                }
            }
        }
        if !self.vertices.is_empty() {
            for v in face.corners() {
                for (vertex, _) in self.vertices.iter().filter(|(_, p)| p.distance(at(v)) <= self.near) {
                    out.extend_vertex(v, self.tags.vertex(*vertex));
                }
            }
        }
    }

    /// Whether a point lies on the straight line between two others.
    fn on(&self, p: DVec3, [a, b]: &[DVec3; 2]) -> bool {
        let along = *b - *a;
        let share =
            if along == DVec3::ZERO { 0.0 } else { ((p - *a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
        (*a + along * share).distance(p) <= self.near
    }
}
