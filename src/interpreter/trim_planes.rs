//! Trim planes (reference 3.8). In: the mesh a face was split from. Out: the planes through the edges it shares, and
//! whether each is on.
//!
//! A face shape remembers the mesh it came from; the planes are made when something is inserted, so that a component
//! split costs no more than a reference.

use std::sync::Arc;

use glam::DVec3;

use super::form::Form;
use super::shape::Shape;
use super::topology::Topology;
use crate::geometry::{Mesh, Plane};

/// Where the trim planes of a shape come from.
#[derive(Clone, Debug)]
pub struct TrimSource {
    /// The whole shape before the split, in world positions.
    pub form: Arc<Form>,
    pub face: u32,
    /// The y axis of the face shape's pivot.
    pub up: DVec3,
}

/// One plane: what lies in front of it is cut off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimPlane {
    pub plane: Plane,
    /// The edge it goes through.
    pub edge: [DVec3; 2],
    /// It cuts only between the ends of its edge: the edge is concave, or the face itself goes on behind the plane.
    pub is_limited: bool,
    pub is_horizontal: bool,
}

/// An edge that rises less than this against the pivot's xz-plane makes a horizontal trim plane.
const HORIZONTAL_BELOW_DEGREES: f64 = 40.0;
/// Faces this far beyond their own trim plane, as a share of the edge length, go on behind it.
const BEYOND: f64 = 1e-6;

impl TrimSource {
    /// The planes in the order of the face's edges, outer loop first. Edges of one face, or of more than two, and edges
    /// whose faces lie on each other, have none.
    pub fn planes(&self) -> Vec<TrimPlane> {
        let mesh = &self.form.mesh;
        let Some(face) = mesh.faces.get(self.face as usize) else { return Vec::new() };
        let topology = Topology::of(mesh);
        let edges = face.edges().zip(topology.face_edges(self.face as usize));
        let plane = |((from, to), &e): ((u32, u32), &u32)| {
            let edge = &topology.edges[e as usize];
            let other = if edge.first == self.face { edge.second? } else { edge.first };
            (edge.uses == 2 && other != self.face).then_some(())?;
            self.plane(mesh, [from, to].map(|v| mesh.positions[v as usize]), other)
        };
        edges.filter_map(plane).collect()
    }

    fn plane(&self, mesh: &Mesh, [from, to]: [DVec3; 2], other: u32) -> Option<TrimPlane> {
        let own = &mesh.faces[self.face as usize];
        let (normal, neighbour) = (mesh.normal(own), mesh.normal(&mesh.faces[other as usize]));
        let along = (to - from).try_normalize()?;
        let bisecting = (normal + neighbour).try_normalize()?;
        let plane = Plane::through(from, along.cross(bisecting))?;
        let is_concave = neighbour.dot(along.cross(normal)) < -BEYOND;
        let limit = BEYOND * from.distance(to);
        let goes_on = own.outer.iter().any(|&v| plane.signed_distance(mesh.positions[v as usize]) > limit);
        let rise = libm::asin(along.dot(self.up).abs().min(1.0)).to_degrees();
        let is_horizontal = rise < HORIZONTAL_BELOW_DEGREES;
        Some(TrimPlane { plane, edge: [from, to], is_limited: is_concave || goes_on, is_horizontal })
    }
}

impl Shape {
    /// The trim planes that `trim.horizontal` and `trim.vertical` leave on.
    pub fn active_trim_planes(&self) -> Vec<TrimPlane> {
        if !self.trim_horizontal && !self.trim_vertical {
            return Vec::new();
        }
        let Some(source) = &self.trim_source else { return Vec::new() };
        let mut planes = source.planes();
        planes.retain(|p| if p.is_horizontal { self.trim_horizontal } else { self.trim_vertical });
        planes
    }
}
