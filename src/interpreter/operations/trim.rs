//! `trim` (reference 3.8, 4.12) and the trimming of what is inserted. In: the shape's trim planes. Out: geometry without
//! what lies beyond the active ones; closed bodies stay closed.

use std::sync::Arc;

use super::super::form::Form;
use super::super::shape::Shape;
use super::super::trim_planes::TrimPlane;
use crate::geometry::cut::{self, Origin};

/// `trim()`: cuts and fits the scope.
pub fn apply(shape: &mut Shape) {
    if let Some(form) = trimmed(shape) {
        shape.replace(form);
    }
}

/// After `i` and primitives: cuts inside the scope they gave.
pub fn inserted(shape: &mut Shape) {
    if let Some(form) = trimmed(shape) {
        shape.replace_in_scope(form);
    }
}

/// What the active planes leave; `None` if they cut nothing.
fn trimmed(shape: &mut Shape) -> Option<Form> {
    let planes = shape.active_trim_planes();
    if planes.is_empty() || shape.form.mesh.faces.is_empty() {
        return None;
    }
    let mut form: Arc<Form> = shape.bake().clone();
    for plane in &planes {
        if let Some(cut) = cut_by(&form, plane) {
            form = Arc::new(cut);
        }
    }
    (!Arc::ptr_eq(&form, &shape.form)).then(|| Arc::unwrap_or_clone(form))
}

fn cut_by(form: &Form, trim: &TrimPlane) -> Option<Form> {
    let cut = cut::cut(&form.mesh, &trim.plane);
    if cut.front.is_empty() {
        return None;
    }
    let source = |o: &Origin| match o {
        Origin::Face(face) => Some(*face),
        Origin::Cap => None,
    };
    Some(form.derived(cut.behind.mesh, cut.behind.origins.iter().map(source)))
}
