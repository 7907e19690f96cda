//! `offset` (reference 4.5.7). In: a distance, negative inwards, and what to keep. Out: the inside faces first, then
//! the border faces in edge order; vertices are shared.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::auto_tags;
use super::plan_faces::PlanFaces;
use crate::cga::builtins::Word;
use crate::geometry::offset::offset;
use crate::geometry::{PlaneFrame, Polygon};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let distance = args.float_or(run, 0, 0.0);
    let keep = args.word(1).unwrap_or(Word::All);
    if distance == 0.0 {
        return;
    }
    shape.bake();
    let source = shape.form.clone();
    if source.mesh.faces.iter().all(|face| PlaneFrame::of_face(&source.mesh, face).is_none()) {
        run.warn("cga::no-face", args.span, || "there is no face with an area to offset".into());
        return;
    }
    let mut out = PlanFaces::new(&source);
    // Per result face: whether it is the border of an edge, and of which.
    let mut borders: Vec<Option<(usize, usize)>> = Vec::new();
    for (number, face) in source.mesh.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(&source.mesh, face) else { continue };
        match offset(&frame.face_to_plan(&source.mesh, face), distance) {
            Ok(result) => {
                if keep == Word::Inside && result.inside.is_empty() {
                    return;
                }
                let face = out.face(number, frame);
                if keep != Word::Border {
                    result.inside.iter().for_each(|polygon| out.push(&face, polygon));
                    borders.resize(borders.len() + result.inside.len(), None);
                }
                if keep != Word::Inside {
                    for border in result.borders {
                        borders.push(Some((number, border.edge)));
                        let polygon = Polygon { outer: border.ring, holes: Vec::new() };
                        // Outside the face, borders look the other way, so that areas add up.
                        if distance > 0.0 { out.push_flipped(&face, &polygon) } else { out.push(&face, &polygon) }
                    }
                }
            }
            Err(error) => {
                run.warn("cga::offset", args.span, || format!("this face was not offset: {error}"));
                return;
            }
        }
    }
    let mut form = out.into_form();
    auto_tags::borders(&source, &mut form, &borders);
    shape.replace(form);
}
