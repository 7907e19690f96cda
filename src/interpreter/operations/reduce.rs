//! `reduceGeometry` (reference 4.12). In: the share of the vertices to take out. Out: triangles over those that stay,
//! without tags.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::super::topology::used_vertices;
use super::args::Args;
use crate::geometry::simplify::simplify;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let given = args.float_or(run, 0, 0.0);
    let amount = given.clamp(0.0, 1.0);
    if amount != given {
        run.warn("cga::reduce", args.span, || format!("the amount {given} is not between 0 and 1: {amount} is used"));
    }
    shape.bake();
    let vertices = used_vertices(&shape.form.mesh).len();
    let wanted = libm::rint(vertices as f64 * amount) as usize;
    if wanted == 0 {
        return;
    }
    let found = simplify(&shape.form.mesh, wanted);
    if found.removed < wanted {
        run.warn("cga::reduce", args.span, || {
            format!("{} of {vertices} vertices could go without breaking the surface, not {wanted}", found.removed)
        });
    }
    if found.removed == 0 {
        return;
    }
    let mut form = shape.form.derived(found.mesh, found.sources.into_iter().map(Some));
    if form.labels.is_some() {
        *form.tags_mut() = Default::default();
    }
    shape.replace(form);
}
