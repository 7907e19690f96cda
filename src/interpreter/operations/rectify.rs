//! `rectify` (reference 4.12). In: an angle of 0 to 45 degrees. Out: a flat shape whose edges within that angle of a
//! scope axis run along it.
//!
//! Neighbouring edges along one axis come to lie on one line, at the mean of their places weighted by length. Holes that
//! lose their area go; a result that crosses itself is not taken.

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::shape::Shape;
use super::args::Args;
use super::cleanup::remove_corners;
use crate::geometry::polygon::signed_area;
use crate::geometry::polygon_checks::crossing_edges;
use crate::geometry::{Mesh, PlaneFrame};

/// Heights up to this share of the extent are flat.
const FLAT: f64 = 1e-6;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let given = args.float_or(run, 0, 0.0);
    let angle = given.clamp(0.0, 45.0);
    if angle != given {
        run.warn("cga::rectify", args.span, || format!("the angle {given} is not between 0 and 45: {angle} is used"));
    }
    shape.bake();
    let mut form = (*shape.form).clone();
    let Some(plane) = flat_plane(shape) else {
        run.warn("cga::rectify", args.span, || "only flat shapes with an area can be made rectangular".into());
        return;
    };
    straighten(&mut form.mesh, &plane, angle);
    if tidy(&mut form.mesh, &plane) {
        let all: Vec<usize> = (0..form.mesh.faces.len()).collect();
        let tidied: Form = form.part(&all);
        shape.replace(tidied);
    } else {
        run.warn("cga::rectify", args.span, || "the outline would cross itself, so the shape stays as it is".into());
    }
}

/// The scope plane closest to the shape: two axes of the scope. `None` for shapes that are not flat.
fn flat_plane(shape: &Shape) -> Option<PlaneFrame> {
    let mesh = &shape.form.mesh;
    let normal = mesh.faces.iter().map(|face| mesh.normal(face)).find(|n| *n != DVec3::ZERO)?;
    let first = mesh.positions[mesh.faces[0].outer[0] as usize];
    let extent = mesh.positions.iter().map(|p| p.distance(first)).fold(0.0, f64::max);
    let used = mesh.faces.iter().flat_map(|face| face.corners()).map(|v| mesh.positions[v as usize]);
    if used.into_iter().any(|p| (p - first).dot(normal).abs() > FLAT * extent) {
        return None;
    }
    let axes = shape.scope.frame.axes;
    let across = |i: &usize| axes.col(*i).dot(normal).abs();
    let up = (0..3).max_by(|a, b| across(a).total_cmp(&across(b)))?;
    let (u, v) = (axes.col((up + 1) % 3), axes.col((up + 2) % 3));
    let (up, v) = if axes.col(up).dot(normal) < 0.0 { (-axes.col(up), -v) } else { (axes.col(up), v) };
    Some(PlaneFrame { origin: shape.scope.frame.origin, u, v, normal: up })
}

/// Moves vertices so that edges near an axis run along it.
fn straighten(mesh: &mut Mesh, plane: &PlaneFrame, angle: f64) {
    let plan: Vec<DVec2> = mesh.positions.iter().map(|&p| plane.to_plan(p)).collect();
    let tangent = libm::tan(angle.to_radians()) + 1e-12;
    // Vertices that get one v, and those that get one u.
    let (mut level, mut upright) = (Lines::new(plan.len()), Lines::new(plan.len()));
    for (a, b) in mesh.faces.iter().flat_map(|face| face.edges()) {
        let (p, q) = (plan[a as usize], plan[b as usize]);
        let d = (q - p).abs();
        if d.y <= tangent * d.x {
            level.join(a, b, (p.y + q.y) / 2.0, d.length());
        } else if d.x <= tangent * d.y {
            upright.join(a, b, (p.x + q.x) / 2.0, d.length());
        }
    }
    for (i, position) in mesh.positions.iter_mut().enumerate() {
        let old = plan[i];
        let new = DVec2::new(upright.place(i).unwrap_or(old.x), level.place(i).unwrap_or(old.y));
        *position += plane.u * (new.x - old.x) + plane.v * (new.y - old.y);
    }
}

/// Vertices that come to lie on common lines.
struct Lines {
    leader: Vec<usize>,
    /// Weighted places of the edges of each line, and their weights.
    sums: Vec<(f64, f64)>,
}

impl Lines {
    fn new(vertices: usize) -> Lines {
        Lines { leader: (0..vertices).collect(), sums: vec![(0.0, 0.0); vertices] }
    }

    fn find(&self, mut i: usize) -> usize {
        while self.leader[i] != i {
            i = self.leader[i];
        }
        i
    }

    fn join(&mut self, a: u32, b: u32, place: f64, weight: f64) {
        let (a, b) = (self.find(a as usize), self.find(b as usize));
        let (low, high) = (a.min(b), a.max(b));
        if low != high {
            self.leader[high] = low;
            let (sum, weight) = std::mem::take(&mut self.sums[high]);
            self.sums[low].0 += sum;
            self.sums[low].1 += weight;
        }
        self.sums[low].0 += place * weight;
        self.sums[low].1 += weight;
    }

    fn place(&self, i: usize) -> Option<f64> {
        let (sum, weight) = self.sums[self.find(i)];
        (weight > 0.0).then(|| sum / weight)
    }
}

/// Takes out doubled corners, and holes and faces without area; false if an outline crosses itself.
fn tidy(mesh: &mut Mesh, plane: &PlaneFrame) -> bool {
    let at: Vec<DVec2> = mesh.positions.iter().map(|&p| plane.to_plan(p)).collect();
    let same = |a: u32, b: u32| at[a as usize].distance(at[b as usize]) <= 1e-9;
    for face in &mut mesh.faces {
        remove_corners(face, |ring, i| same(ring[i], ring[(i + ring.len() - 1) % ring.len()]));
    }
    let area = |ring: &[u32]| signed_area(&ring.iter().map(|&v| at[v as usize]).collect::<Vec<DVec2>>());
    for face in &mut mesh.faces {
        let turn = area(&face.outer).signum();
        while let Some(gone) = face.holes.iter().position(|hole| hole.len() < 3 || area(hole) * turn >= 0.0) {
            let before: usize = face.loops().take(gone + 1).map(|ring| ring.len()).sum();
            let after = before + face.holes[gone].len();
            face.holes.remove(gone);
            face.uvs.iter_mut().for_each(|(_, uv)| {
                let mut corner = 0;
                uv.retain(|_| {
                    corner += 1;
                    !(before < corner && corner <= after)
                });
            });
            face.normals.clear();
        }
    }
    mesh.faces.retain(|face| face.outer.len() >= 3);
    !mesh.faces.is_empty() && mesh.faces.iter().all(|face| crossing_edges(&plane.face_to_plan(mesh, face)).is_empty())
}
