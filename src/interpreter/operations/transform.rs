//! `t`, `s`, `r`, `translate`, `rotate`, `rotateScope` (reference 4.6). In: lengths and angles. Out: a moved scope;
//! geometry follows, the pivot stays.

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::placement::{Frame, rotation};
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Word;

/// Three arguments from `first`, each relative to the scope size where prefixed.
fn lengths(run: &mut Derivation, args: &Args, first: usize, size: DVec3) -> DVec3 {
    DVec3::new(
        args.length(run, first, size.x),
        args.length(run, first + 1, size.y),
        args.length(run, first + 2, size.z),
    )
}

/// `t(x, y, z)`: along the scope axes.
pub fn t(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let by = lengths(run, args, 0, shape.scope.size);
    shape.scope.frame.origin += shape.scope.frame.axes * by;
}

/// `s(x, y, z)`: sets the size; the origin stays.
pub fn s(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.scope.size = lengths(run, args, 0, shape.scope.size);
}

/// `r([center,] ax, ay, az)`: about the pivot axes.
pub fn r(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let first = usize::from(args.word(0).is_some());
    let turn = rotation(lengths(run, args, first, DVec3::ONE));
    let center = shape.scope.center();
    let pivot = shape.pivot.axes;
    shape.scope.frame.axes = pivot * turn * pivot.transpose() * shape.scope.frame.axes;
    if args.word(0) == Some(Word::ScopeCenter) {
        shape.scope.frame.origin += center - shape.scope.center();
    }
}

fn system(run: &Derivation, word: Option<Word>, shape: &Shape) -> Frame {
    match word {
        Some(Word::Scope) => shape.scope.frame,
        Some(Word::Pivot) => shape.pivot,
        Some(Word::Object) => run.object,
        _ => Frame::WORLD,
    }
}

/// `translate(mode, system, x, y, z)`.
pub fn translate(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let frame = system(run, args.word(1), shape);
    let v = lengths(run, args, 2, DVec3::ONE);
    match args.word(0) {
        Some(Word::Abs) => shape.scope.frame.origin = frame.world_from_local(v),
        _ => shape.scope.frame.origin += frame.axes * v,
    }
}

/// `rotate(mode, system, ax, ay, az)`: about the scope origin. `abs` in the scope's own system equals `rel`.
pub fn rotate(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let frame = system(run, args.word(1), shape);
    let turn = rotation(lengths(run, args, 2, DVec3::ONE));
    let absolute = args.word(0) == Some(Word::Abs) && args.word(1) != Some(Word::Scope);
    shape.scope.frame.axes =
        if absolute { frame.axes * turn } else { frame.axes * turn * frame.axes.transpose() * shape.scope.frame.axes };
}

/// `rotateScope(ax, ay, az)`: the scope turns about the pivot axes around geometry that stays.
pub fn rotate_scope(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let turn = rotation(lengths(run, args, 0, DVec3::ONE));
    let pivot = shape.pivot.axes;
    let axes = pivot * turn * pivot.transpose() * shape.scope.frame.axes;
    shape.turn_scope(axes);
}
