//! `i` (reference 4.11). In: a path and how to fit. Out: the asset's geometry stretched to the scope, zero sizes taken
//! from its proportions.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::super::assets::Asset;
use super::super::derivation::Derivation;
use super::super::files;
use super::super::form::Form;
use super::super::limits::Outcome;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use super::insert_cleanup;
use super::primitive::unit_cube;
use crate::cga::builtins::Word;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) -> Outcome<()> {
    let asset = load(run, args, 0);
    run.allow_vertices(asset.form.mesh.positions.len(), args.span)?;
    let words: Vec<Word> = (1..args.len()).filter_map(|i| args.word(i)).collect();
    let asset = if words.contains(&Word::NoCleanup) { asset } else { insert_cleanup::once(asset) };
    let upright = if words.contains(&Word::ZUp) { Arc::new(z_up(&asset)) } else { asset };
    let mode = words.iter().find(|w| matches!(w, Word::KeepSizeAndPosition | Word::KeepSizeAlignPosition));
    match mode {
        Some(Word::KeepSizeAndPosition) => shape.scope.size = DVec3::ZERO,
        Some(Word::KeepSizeAlignPosition) => keep_size(shape, &upright),
        _ => {}
    }
    fit(shape, &upright);
    Ok(())
}

/// The asset whose path is argument `i`; a box, with a warning, if it cannot be had.
pub fn load(run: &mut Derivation, args: &Args, i: usize) -> Arc<Asset> {
    let path: Arc<str> = args.value(i).map_or_else(|| "".into(), Value::to_text);
    let loaded = files::geometry(run, &path, args.span);
    loaded.unwrap_or_else(|error| {
        run.warn("cga::missing-asset", args.span, || format!("{error}, a box stands in"));
        Arc::new(Asset::new(unit_cube()))
    })
}

/// The asset turned -90 degrees about x.
fn z_up(asset: &Asset) -> Asset {
    let mut form = asset.form.clone();
    form.mesh.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x, p.z, -p.y));
    form.mesh.faces.iter_mut().flat_map(|f| &mut f.normals).for_each(|n| *n = DVec3::new(n.x, n.z, -n.y));
    Asset::new(form)
}

/// A scope of the asset's size, centred in x and z, on the floor of the old one.
fn keep_size(shape: &mut Shape, asset: &Asset) {
    let spare = (shape.scope.size - asset.size) / 2.0;
    shape.scope.frame.origin += shape.scope.frame.axes * DVec3::new(spare.x, 0.0, spare.z);
    shape.scope.size = asset.size;
}

/// Puts the asset into the scope, by the zero rules of reference 4.11.
pub fn fit(shape: &mut Shape, asset: &Asset) {
    let (a, c) = (asset.size, asset.low);
    let ratio = |i: usize, size: DVec3| if a[i] == 0.0 { 1.0 } else { size[i] / a[i] };
    let old = shape.scope.size;
    let zero: Vec<usize> = (0..3).filter(|&i| old[i] == 0.0).collect();
    let mut moved = DVec3::ZERO;
    match zero.as_slice() {
        [] => {}
        [flat] => {
            let (i, j) = ((flat + 1) % 3, (flat + 2) % 3);
            shape.scope.size[*flat] = a[*flat] * (ratio(i, old.abs()) + ratio(j, old.abs())) / 2.0;
        }
        [first, second] => {
            let k = ratio(3 - first - second, old);
            for i in [*first, *second] {
                shape.scope.size[i] = k * a[i];
                moved[i] = k * c[i];
            }
        }
        _ => {
            shape.scope.size = a;
            moved = c;
        }
    }
    shape.scope.frame.origin += shape.scope.frame.axes * moved;
    let size = shape.scope.size;
    let factor = DVec3::new(ratio(0, size), ratio(1, size), ratio(2, size));
    let frame = shape.scope.frame;
    let mut form: Form = asset.form.clone();
    form.mesh.positions.iter_mut().for_each(|p| *p = frame.world_from_local((*p - c) * factor));
    form.turn_corner_normals(frame.axes * DMat3::from_diagonal(factor));
    shape.replace_in_scope(form);
}
