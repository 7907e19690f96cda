//! Trim planes (reference 3.8). In: the mesh a face was split from. Out: the planes through the edges it shares, and
//! whether each is on.
//!
//! Face shapes remember the mesh they came from; its planes are made once, when something is inserted first.

use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::form::Form;
use super::shape::Shape;
use super::topology::Topology;
use crate::geometry::{Mesh, Plane};

/// A shape that was split into its faces.
#[derive(Debug)]
pub struct TrimParent {
    /// In world positions.
    form: Arc<Form>,
    /// By face.
    planes: OnceLock<Vec<Vec<TrimPlane>>>,
}

/// Where the trim planes of a face shape come from.
#[derive(Clone, Debug)]
pub struct TrimSource {
    pub parent: Arc<TrimParent>,
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
}

/// An edge that rises less than this against the pivot's xz-plane makes a horizontal trim plane.
const HORIZONTAL_BELOW_DEGREES: f64 = 40.0;
/// Faces this far beyond their own trim plane, as a share of the edge length, go on behind it.
const BEYOND: f64 = 1e-6;

impl TrimParent {
    /// `form` in world positions.
    pub fn new(form: Arc<Form>) -> Self {
        TrimParent { form, planes: OnceLock::new() }
    }

    /// The planes of one face in the order of its edges, outer loop first. Edges of one face, or of more than two, and
    /// edges whose faces lie on each other, have none.
    fn planes(&self, face: u32) -> &[TrimPlane] {
        let planes = self.planes.get_or_init(|| {
            let topology = Topology::of(&self.form.mesh);
            (0..self.form.mesh.faces.len()).map(|f| planes_of(&self.form.mesh, &topology, f)).collect()
        });
        planes.get(face as usize).map(Vec::as_slice).unwrap_or_default()
    }
}

fn planes_of(mesh: &Mesh, topology: &Topology, face: usize) -> Vec<TrimPlane> {
    let edges = mesh.faces[face].edges().zip(topology.face_edges(face));
    let plane = |((from, to), &e): ((u32, u32), &u32)| {
        let edge = &topology.edges[e as usize];
        let other = if edge.first as usize == face { edge.second? } else { edge.first } as usize;
        (edge.uses == 2 && other != face).then_some(())?;
        plane_between(mesh, [from, to].map(|v| mesh.positions[v as usize]), face, other)
    };
    edges.filter_map(plane).collect()
}

fn plane_between(mesh: &Mesh, [from, to]: [DVec3; 2], face: usize, other: usize) -> Option<TrimPlane> {
    let own = &mesh.faces[face];
    let (normal, neighbour) = (mesh.normal(own), mesh.normal(&mesh.faces[other]));
    let along = (to - from).try_normalize()?;
    let bisecting = (normal + neighbour).try_normalize()?;
    let plane = Plane::through(from, along.cross(bisecting))?;
    let is_concave = neighbour.dot(along.cross(normal)) < -BEYOND;
    let limit = BEYOND * from.distance(to);
    let goes_on = own.outer.iter().any(|&v| plane.signed_distance(mesh.positions[v as usize]) > limit);
    Some(TrimPlane { plane, edge: [from, to], is_limited: is_concave || goes_on })
}

impl TrimSource {
    fn is_horizontal(&self, plane: &TrimPlane) -> bool {
        let along = (plane.edge[1] - plane.edge[0]).normalize_or_zero();
        libm::asin(along.dot(self.up).abs().min(1.0)).to_degrees() < HORIZONTAL_BELOW_DEGREES
    }
}

impl Shape {
    /// The trim planes that `trim.horizontal` and `trim.vertical` leave on and that have a vertex of the form, which is
    /// in world positions, in front of them.
    pub fn trim_planes_that_cut(&self) -> Vec<TrimPlane> {
        let Some(source) = self.trim_source.as_ref().filter(|_| self.state.trim_horizontal || self.state.trim_vertical)
        else {
            return Vec::new();
        };
        let is_on = |p: &&TrimPlane| {
            if source.is_horizontal(p) { self.state.trim_horizontal } else { self.state.trim_vertical }
        };
        let cuts = |p: &&TrimPlane| self.form.mesh.positions.iter().any(|&v| p.plane.signed_distance(v) > 0.0);
        source.parent.planes(source.face).iter().filter(cuts).filter(is_on).copied().collect()
    }
}
