//! Texture coordinates (reference 4.14). In: set numbers, frames and factors. Out: projections kept with the shape, and
//! coordinates written to its faces.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::placement::{Frame, sin_cos_degrees};
use super::super::projection::{Projection, fitting_tile};
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Word;
use crate::cga::program::Prefix;
use crate::geometry::mesh::{CornerUvs, UvSets};

/// First and second axis, and whether they are the world's.
fn axes(word: Option<Word>) -> (usize, usize, bool) {
    match word {
        Some(Word::ScopeXz) => (0, 2, false),
        Some(Word::ScopeYx) => (1, 0, false),
        Some(Word::ScopeYz) => (1, 2, false),
        Some(Word::ScopeZx) => (2, 0, false),
        Some(Word::ScopeZy) => (2, 1, false),
        Some(Word::WorldXy) => (0, 1, true),
        Some(Word::WorldXz) => (0, 2, true),
        Some(Word::WorldYx) => (1, 0, true),
        Some(Word::WorldYz) => (1, 2, true),
        Some(Word::WorldZx) => (2, 0, true),
        Some(Word::WorldZy) => (2, 1, true),
        _ => (0, 1, false),
    }
}

/// `setupProjection(set, axes, width, height [, offsetU, offsetV [, uwFactor]])`; five arguments: the last is the
/// uwFactor (deprecated form). The frame is frozen here.
pub fn setup_projection(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = args.uv_set(run, 0) else { return };
    let (first, second, world) = axes(args.word(1));
    let frame = if world { Frame::WORLD } else { shape.scope.frame };
    let extent = DVec2::new(shape.scope.size[first], shape.scope.size[second]);
    let tile = DVec2::new(tile_size(run, args, 2, extent.x), tile_size(run, args, 3, extent.y));
    if tile.x == 0.0 || tile.y == 0.0 {
        run.warn("cga::tile-size", args.span, || "a tile of size 0 cannot be projected".into());
        return;
    }
    let (offset, uw) = match args.len() {
        5 => (DVec2::ZERO, args.float_or(run, 4, 0.0)),
        _ => {
            let offset = DVec2::new(args.length(run, 4, extent.x), args.length(run, 5, extent.y));
            (offset, args.float_or(run, 6, 0.0))
        }
    };
    let (u, v): (DVec3, DVec3) = (frame.axes.col(first), frame.axes.col(second));
    let projection = Projection { origin: frame.origin, axes: [u, v, u.cross(v)], tile, offset, uw_factor: uw };
    let list = &mut shape.state_mut().projections;
    match list.binary_search_by_key(&set, |(s, _)| *s) {
        Ok(place) => list[place].1 = projection,
        Err(place) => list.insert(place, (set, projection)),
    }
}

/// The size of a tile: metres, a share of the extent, or the nearest size of which a whole number fits.
pub fn tile_size(run: &mut Derivation, args: &Args, i: usize, extent: f64) -> f64 {
    let x = args.float_or(run, i, 0.0);
    match args.prefix(i) {
        Prefix::Absolute => x,
        Prefix::Relative => x * extent,
        Prefix::Floating => fitting_tile(extent, x),
    }
}

/// `projectUV(set)`: writes the projected coordinates of every corner.
pub fn project(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = args.uv_set(run, 0) else { return };
    let Some(projection) = shape.state.projections.iter().find(|(s, _)| *s == set).map(|(_, p)| *p) else {
        run.warn("cga::no-projection", args.span, || {
            format!("set {set} has no projection: setupProjection comes first")
        });
        return;
    };
    shape.bake();
    let form = Arc::make_mut(&mut shape.form);
    form.instanced = false;
    let Form { mesh, .. } = form;
    for face in &mut mesh.faces {
        let at = |v: u32| projection.uv(mesh.positions[v as usize]);
        let uv = match face.outer[..] {
            [a, b, c, d] if face.holes.is_empty() => CornerUvs::from([a, b, c, d].map(at)),
            _ => face.corners().map(at).collect(),
        };
        put(&mut face.uvs, set, uv);
    }
}

fn put(uvs: &mut UvSets, set: u8, uv: CornerUvs) {
    match uvs.binary_search_by_key(&set, |(s, _)| *s) {
        Ok(place) => uvs[place].1 = uv,
        Err(place) => uvs.insert(place, (set, uv)),
    }
}

/// The set an operation changes: argument `i`, with a warning if it is no set or no face has it.
pub fn existing(run: &mut Derivation, args: &Args, i: usize, shape: &Shape) -> Option<u8> {
    let set = args.uv_set(run, i)?;
    if shape.form.mesh.faces.iter().any(|face| face.uv(set).is_some()) {
        return Some(set);
    }
    run.warn("cga::no-uv", args.span, || format!("no face has texture set {set}: nothing changes"));
    None
}

/// Changes every coordinate of a set; faces without it stay.
pub fn edit(shape: &mut Shape, set: u8, change: impl Fn(DVec2) -> DVec2) {
    let form = Arc::make_mut(&mut shape.form);
    form.instanced = false;
    for face in &mut form.mesh.faces {
        if let Some((_, uv)) = face.uvs.iter_mut().find(|(s, _)| *s == set) {
            uv.iter_mut().for_each(|p| *p = change(*p));
        }
    }
}

pub fn translate(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = existing(run, args, 0, shape) else { return };
    let by = DVec2::new(args.float_or(run, 1, 0.0), args.float_or(run, 2, 0.0));
    edit(shape, set, |p| p + by);
}

pub fn scale(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = existing(run, args, 0, shape) else { return };
    let by = DVec2::new(args.float_or(run, 1, 0.0), args.float_or(run, 2, 0.0));
    edit(shape, set, |p| p * by);
}

/// `rotateUV(set, angle)`: about (0, 0), counter-clockwise.
pub fn rotate(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = existing(run, args, 0, shape) else { return };
    let (sin, cos) = sin_cos_degrees(args.float_or(run, 1, 0.0));
    edit(shape, set, |p| DVec2::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos));
}

/// `copyUV(from, to)`.
pub fn copy(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (Some(from), Some(to)) = (existing(run, args, 0, shape), args.uv_set(run, 1)) else { return };
    let form = Arc::make_mut(&mut shape.form);
    form.instanced = false;
    for face in &mut form.mesh.faces {
        if let Some(uv) = face.uv(from).map(CornerUvs::from) {
            put(&mut face.uvs, to, uv);
        }
    }
}

/// `deleteUV(set)`: shapes without the set stay as they are.
pub fn delete(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(set) = args.uv_set(run, 0) else { return };
    let form = Arc::make_mut(&mut shape.form);
    form.instanced = false;
    form.mesh.faces.iter_mut().for_each(|face| face.uvs.retain(|(s, _)| *s != set));
}
