//! `split(u | v, uvSpace | unitSpace, set)` (reference 4.3.5). In: a block of sizes in texture units or metres. Out:
//! pieces of the surface between lines of constant u or v, uncapped, their scopes fitted.
//!
//! Sizes in metres are mapped to texture units in proportion (reference A45): the whole range is as long as
//! `geometry.du` or `geometry.dv` says.

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::form::Form;
use super::super::limits::Outcome;
use super::super::measure;
use super::{Pieces, split_pattern};
use crate::cga::program::{Expr, SplitBlock};
use crate::geometry::cut::{self, Origin};
use crate::source::Span;

/// The direction, unit and texture set of the split.
pub struct Along<'p> {
    /// v instead of u.
    pub v: bool,
    /// unitSpace instead of uvSpace.
    pub metres: bool,
    pub set: &'p Expr,
}

pub fn along_texture<'p>(
    run: &mut Derivation<'p>,
    along: &Along<'p>,
    block: &'p SplitBlock,
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let set = run.eval_finite(along.set, env)?;
    if set.fract() != 0.0 || !(0.0..10.0).contains(&set) {
        run.warn("cga::uv-set", span, || "texture coordinate sets are numbered 0 to 9".into());
        return Ok(Vec::new());
    }
    let (set, i) = (set as u8, usize::from(along.v));
    let mut parent = env.shape.clone();
    parent.bake();
    let faces = &parent.form.mesh.faces;
    let Some((low, high)) = measure::uv_range(&parent.form, set) else {
        run.warn("cga::no-uv", span, || format!("this geometry has no texture coordinates in set {set}: no pieces"));
        return Ok(Vec::new());
    };
    if faces.iter().any(|face| face.uv(set).is_none()) {
        run.warn("cga::no-uv", span, || format!("faces without texture coordinates in set {set} are left out"));
    }
    let range = high[i] - low[i];
    let total = if along.metres { measure::uv_extent_in_metres(&parent, set)[i] } else { range };
    let layout = split_pattern::lay_out(run, block, total, span, env)?;
    let Some(last) = layout.slabs.last() else { return Ok(Vec::new()) };
    let inner = layout.slabs.len() - usize::from(last.end >= total);
    let boundaries: Vec<f64> = layout.slabs[..inner].iter().map(|s| low[i] + s.end / total * range).collect();
    let values: Vec<Option<Vec<f64>>> =
        faces.iter().map(|face| face.uv(set).map(|uv| uv.iter().map(|p| p[i]).collect())).collect();
    let pieces = cut::slice_by_value(&parent.form.mesh, &values, &boundaries).into_iter().take(layout.slabs.len());
    let forms = pieces.map(|piece| {
        let sources = piece.origins.into_iter().map(|origin| match origin {
            Origin::Face(face) => Some(face),
            Origin::Cap => None,
        });
        let form = parent.form.derived(piece.mesh, sources);
        if form.mesh.faces.is_empty() { Form::default() } else { form }
    });
    Ok(layout.pieces(forms.collect(), &parent, |_, form| {
        let mut shape = Box::new(parent.clone());
        shape.replace(form);
        shape
    }))
}
