//! Eaves, hips, valleys and ridges (reference 3.6). In: a roof without its bottom. Out: what each edge is.

use glam::DVec3;

use super::super::environment::RoofEdge;
use super::super::shape::Shape;
use super::super::topology::{Edge, Topology};
use crate::geometry::Mesh;

/// Heights within this share of the roof's extent are the same.
const LEVEL: f64 = 1e-6;

/// One kind per edge of the topology; `None` for border edges that are no eaves.
pub fn classify(shape: &Shape, topology: &Topology) -> Vec<Option<RoofEdge>> {
    let mesh = &shape.form.mesh;
    let up = up(shape);
    let height = |v: u32| up.dot(mesh.positions[v as usize]);
    let lowest = (0..mesh.positions.len() as u32).map(height).fold(f64::INFINITY, f64::min);
    let tolerance = LEVEL * shape.scope.size.abs().max_element().max(LEVEL);
    let low = |v: u32| (height(v) - lowest).abs() <= tolerance;
    let is_eave = |e: &Edge| e.is_border() && low(e.from) && low(e.to);
    let mut at_eave = vec![false; mesh.positions.len()];
    for edge in topology.edges.iter().filter(|e| is_eave(e)) {
        at_eave[edge.from as usize] = true;
        at_eave[edge.to as usize] = true;
    }
    let kind = |edge: &Edge| {
        if is_eave(edge) {
            Some(RoofEdge::Eave)
        } else if edge.is_border() {
            None
        } else if is_concave(mesh, edge) {
            Some(RoofEdge::Valley)
        } else if at_eave[edge.from as usize] || at_eave[edge.to as usize] {
            Some(RoofEdge::Hip)
        } else {
            Some(RoofEdge::Ridge)
        }
    };
    topology.edges.iter().map(kind).collect()
}

/// The direction the roof rises to: the mean of its faces, which is the normal of the face it stands on; the scope's y
/// axis if they cancel because the roof is closed.
pub fn up(shape: &Shape) -> DVec3 {
    let mesh = &shape.form.mesh;
    let sum: DVec3 = mesh.faces.iter().map(|face| mesh.area_vector(face)).sum();
    let whole: f64 = mesh.faces.iter().map(|face| mesh.area_vector(face).length()).sum();
    if sum.length() > LEVEL * whole { sum.normalize() } else { shape.scope.frame.axes.y_axis }
}

/// Whether the two faces fold inwards along the edge.
fn is_concave(mesh: &Mesh, edge: &Edge) -> bool {
    let Some(second) = edge.second else { return false };
    let along = mesh.positions[edge.to as usize] - mesh.positions[edge.from as usize];
    let normal = |f: u32| mesh.normal(&mesh.faces[f as usize]);
    let (a, b): (DVec3, DVec3) = (normal(edge.first), normal(second));
    // The first face runs the edge forwards: a convex fold turns its normal about the edge towards the second's.
    a.cross(b).dot(along) < -LEVEL * along.length()
}
