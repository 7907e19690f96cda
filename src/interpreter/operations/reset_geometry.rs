//! `resetGeometry` (reference 4.12). In: the initial shape. Out: its geometry, scope and pivot; trim planes are gone,
//! attributes, materials and uv projections stay.

use super::super::derivation::Derivation;
use super::super::shape::Shape;

pub fn apply(run: &Derivation, shape: &mut Shape) {
    let Some(initial) = &run.initial else { return };
    shape.form = initial.form.clone();
    shape.binding = initial.binding;
    shape.scope = initial.scope;
    shape.pivot = initial.pivot;
    shape.trim_source = None;
}
