//! `setNormals` and `softenNormals` (reference 4.12). In: how edges are to look. Out: normals at the corners of faces.

use std::sync::Arc;

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Word;
use crate::geometry::normals::{conform, soften};

/// What `auto` smooths below, degrees.
const AUTO: f64 = 30.0;

/// `setNormals(hard | soft | auto | conform)`.
pub fn set(args: &Args, shape: &mut Shape) {
    shape.bake();
    let mesh = &mut Arc::make_mut(&mut shape.form).mesh;
    match args.word(0) {
        Some(Word::Soft) => soften(mesh, 180.0),
        Some(Word::Auto) => soften(mesh, AUTO),
        Some(Word::Conform) => conform(mesh),
        _ => soften(mesh, 0.0),
    }
}

/// `softenNormals(angle)`.
pub fn soften_below(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let angle = args.float_or(run, 0, 0.0);
    if !(0.0..=180.0).contains(&angle) {
        run.warn("cga::normal-angle", args.span, || format!("{angle} is outside 0 to 180 degrees; the nearer is used"));
    }
    shape.bake();
    soften(&mut Arc::make_mut(&mut shape.form).mesh, angle);
}
