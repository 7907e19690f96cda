//! `convexify` (reference 4.12). In: the length that cuts must stay below, if any. Out: concave faces and faces with
//! holes cut into convex ones that share their vertices; convex faces stay.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::plan_faces::PlanFaces;
use super::strips::{self, Loops};
use crate::geometry::PlaneFrame;
use crate::geometry::convex_parts::{convex_parts, is_convex};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let longest = args.float(run, 0);
    shape.bake();
    let source = shape.form.clone();
    let plan = |face| PlaneFrame::of_face(&source.mesh, face).map(|f| (f, f.face_to_plan(&source.mesh, face)));
    if source.mesh.faces.iter().all(|face| plan(face).is_none_or(|(_, polygon)| is_convex(&polygon))) {
        return;
    }
    let mut out = PlanFaces::new(&source);
    for (number, face) in source.mesh.faces.iter().enumerate() {
        let Some((frame, polygon)) = plan(face) else { continue };
        let parts = if is_convex(&polygon) { Vec::new() } else { convex_parts(&polygon, longest) };
        let target = out.face(number, frame);
        if parts.is_empty() {
            if !is_convex(&polygon) {
                run.warn("cga::convexify", args.span, || {
                    "a face that crosses itself or is all hole was left as it is".into()
                });
            }
            out.push(&target, &polygon);
            continue;
        }
        for group in &parts {
            let loops: Vec<Loops> = group.iter().map(|ring| vec![ring.as_slice()]).collect();
            for part in strips::joined(&loops) {
                out.push(&target, &strips::starting_on(part, strips::edges(&polygon.outer)));
            }
        }
    }
    let form = out.into_form();
    shape.replace(form);
}
