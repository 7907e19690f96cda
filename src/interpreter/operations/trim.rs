//! `trim` (reference 3.8, 4.12) and the trimming of what is inserted. In: the shape's trim planes. Out: geometry without
//! what lies beyond the active ones; closed bodies stay closed.

use std::sync::Arc;

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::shape::Shape;
use super::super::trim_planes::TrimPlane;
use crate::geometry::cut::{self, Origin};
use crate::geometry::solid::{OpenMeshes, Operator, combine};
use crate::geometry::{Face, Mesh};
use crate::source::Span;

/// `trim()`: cuts and fits the scope.
pub fn apply(run: &mut Derivation, shape: &mut Shape, span: Span) {
    if let Some(form) = trimmed(run, shape, span) {
        shape.replace(form);
    }
}

/// After `i` and primitives: cuts inside the scope they gave.
pub fn inserted(run: &mut Derivation, shape: &mut Shape, span: Span) {
    if let Some(form) = trimmed(run, shape, span) {
        shape.replace_in_scope(form);
    }
}

/// What the active planes leave; `None` if they cut nothing.
fn trimmed(run: &mut Derivation, shape: &mut Shape, span: Span) -> Option<Form> {
    if shape.trim_source.is_none() || shape.form.mesh.faces.is_empty() {
        return None;
    }
    shape.bake();
    let planes = shape.trim_planes_that_cut();
    let mut form: Arc<Form> = shape.form.clone();
    for plane in &planes {
        if let Some(cut) = cut_by(run, &form, plane, span) {
            form = Arc::new(cut);
        }
    }
    (!Arc::ptr_eq(&form, &shape.form)).then(|| Arc::unwrap_or_clone(form))
}

fn cut_by(run: &mut Derivation, form: &Form, trim: &TrimPlane, span: Span) -> Option<Form> {
    let cut = cut::cut(&form.mesh, &trim.plane);
    if cut.front.is_empty() {
        return None;
    }
    if !trim.is_limited {
        let source = |o: &Origin| match o {
            Origin::Face(face) => Some(*face),
            Origin::Cap => None,
        };
        return Some(form.derived(cut.behind.mesh, cut.behind.origins.iter().map(source)));
    }
    match combine(&form.mesh, &beyond(trim, &form.mesh), Operator::Subtract, OpenMeshes::Surfaces) {
        Ok(left) if left.mesh == form.mesh => None,
        Ok(left) => {
            let source = |o: &crate::geometry::solid::Origin| (o.operand == 0).then_some(o.face);
            Some(form.derived(left.mesh, left.origins.iter().map(source)))
        }
        Err(error) => {
            run.warn("cga::boolean", span, || format!("a trim plane cannot cut this: {error}"));
            None
        }
    }
}

/// The room in front of a plane between the ends of its edge, as far as the mesh reaches.
fn beyond(trim: &TrimPlane, mesh: &Mesh) -> Mesh {
    let [from, to] = trim.edge;
    let reach = mesh.positions.iter().map(|p| p.distance(from)).fold(to.distance(from), f64::max) * 2.0;
    let out = trim.plane.normal * reach;
    let side = (to - from).normalize_or_zero().cross(trim.plane.normal) * reach;
    let corner = |i: usize| -> DVec3 {
        let pick = |bit: usize| (i >> bit & 1) as f64;
        from + (to - from) * pick(0) + out * pick(1) + side * (2.0 * pick(2) - 1.0)
    };
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh { positions: (0..8).map(corner).collect(), faces: quads.iter().map(|q| Face::new(q.to_vec())).collect() }
}
