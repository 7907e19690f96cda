//! `footprint` (reference 4.8). In: any faces. Out: the outline of their projection on the scope's plane y = 0, facing
//! up, without texture coordinates and materials of faces.

use std::sync::Arc;

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::shape::Shape;
use super::args::Args;
use crate::geometry::triangulate::triangles;
use crate::geometry::{Mesh, PlaneFrame, Polygon, boolean};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.bake();
    let source = Arc::clone(&shape.form);
    let axes = shape.scope.frame.axes;
    let frame = PlaneFrame { origin: shape.scope.frame.origin, u: axes.x_axis, v: -axes.z_axis, normal: axes.y_axis };
    let shadows = shadows(&source.mesh, &frame);
    if shadows.is_empty() {
        run.warn("cga::footprint", args.span, || "there is no surface that covers any ground".into());
        return;
    }
    match boolean::union(&shadows, &[]) {
        Ok(outlines) => {
            let mut mesh = Mesh::default();
            outlines.iter().for_each(|polygon| frame.push_face(&mut mesh, polygon, 0.0));
            shape.replace(Form::from_mesh(mesh));
        }
        Err(error) => run.warn("cga::footprint", args.span, || format!("there is no footprint: {error}")),
    }
}

/// Faces and triangles whose projection is below this share of the whole are seen edge on.
const EDGE_ON: f64 = 1e-9;

/// The projections that have an area: of whole faces where they are flat, else of their triangles.
fn shadows(mesh: &Mesh, frame: &PlaneFrame) -> Vec<Polygon> {
    let extent = mesh.bounds().map_or(0.0, |(low, high)| (high - low).length());
    let mut out = Vec::new();
    let mut keep = |polygon: Polygon| {
        if polygon.area() > EDGE_ON * extent * extent {
            out.push(polygon);
        }
    };
    let mut bent = Mesh { positions: mesh.positions.clone(), ..Mesh::default() };
    for face in &mesh.faces {
        let normal = mesh.normal(face);
        let origin = mesh.positions[face.outer[0] as usize];
        let off = |v: u32| (mesh.positions[v as usize] - origin).dot(normal).abs();
        if face.corners().all(|v| off(v) <= 1e-9 * extent) {
            let mut polygon = frame.face_to_plan(mesh, face);
            if normal.dot(frame.normal) < 0.0 {
                polygon.outer.reverse();
                polygon.outer.rotate_right(1);
            }
            keep(polygon);
        } else {
            bent.faces.push(face.clone());
        }
    }
    for (_, corners) in triangles(&bent) {
        let ring: Vec<DVec2> = corners.iter().map(|&p| frame.to_plan(p)).collect();
        keep(Polygon { outer: ring, holes: Vec::new() });
    }
    out
}
