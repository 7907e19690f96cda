//! `normalizeUV` and `tileUV` (reference 4.14). In: texture coordinates a shape has. Out: the same, stretched to 0..1
//! or to tiles of metres.

use std::sync::Arc;

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::measure;
use super::super::shape::Shape;
use super::args::Args;
use super::uv::{edit, existing, tile_size};
use crate::cga::builtins::Word;

/// Least and greatest of the coordinates.
fn range<'a>(points: impl Iterator<Item = &'a DVec2>) -> Option<(DVec2, DVec2)> {
    points.fold(None, |range: Option<(DVec2, DVec2)>, p| {
        Some(range.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))))
    })
}

/// `normalizeUV(set, mode, type)`.
pub fn normalize(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = existing(run, args, 0, shape) else { return };
    let mode = args.word(1).unwrap_or(Word::Uv);
    if args.word(2) == Some(Word::SeparatePerFace) {
        let form = Arc::make_mut(&mut shape.form);
        form.instanced = false;
        for face in &mut form.mesh.faces {
            let Some((_, uv)) = face.uvs.iter_mut().find(|(s, _)| *s == set) else { continue };
            if let Some(range) = range(uv.iter()) {
                uv.iter_mut().for_each(|p| *p = normalized(*p, range, mode));
            }
        }
        return;
    }
    if let Some(range) = range(shape.form.mesh.faces.iter().filter_map(|f| f.uv(set)).flatten()) {
        edit(shape, set, |p| normalized(p, range, mode));
    }
}

fn normalized(p: DVec2, (low, high): (DVec2, DVec2), mode: Word) -> DVec2 {
    let extent = high - low;
    let factor = |e: f64| if e > 0.0 { 1.0 / e } else { 1.0 };
    let q = p - low;
    match mode {
        Word::UvUniform => q * factor(extent.max_element()),
        Word::U => DVec2::new(q.x * factor(extent.x), p.y),
        Word::V => DVec2::new(p.x, q.y * factor(extent.y)),
        _ => q * DVec2::new(factor(extent.x), factor(extent.y)),
    }
}

/// `tileUV(set, width, height)`: one unit becomes that many metres on the surface; 0 leaves an axis as it is.
pub fn tile(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = existing(run, args, 0, shape) else { return };
    let Some(range) = range(shape.form.mesh.faces.iter().filter_map(|f| f.uv(set)).flatten()) else { return };
    let metres = measure::uv_extent_in_metres(shape, set);
    let tile = DVec2::new(tile_size(run, args, 1, metres.x), tile_size(run, args, 2, metres.y));
    let (low, extent) = (range.0, range.1 - range.0);
    let axis = |p: f64, low: f64, extent: f64, metres: f64, tile: f64| {
        if tile == 0.0 || extent == 0.0 { p } else { (p - low) / extent * (metres / tile) }
    };
    edit(shape, set, |p| {
        DVec2::new(axis(p.x, low.x, extent.x, metres.x, tile.x), axis(p.y, low.y, extent.y, metres.y, tile.y))
    });
}
