//! `alignScopeToAxes` (reference 4.7). In: an axis of the world or the object. Out: pivot and scope parallel to it,
//! fitted around geometry that stays.

use glam::{DMat3, DVec3};

use super::super::derivation::Derivation;
use super::super::placement::{Frame, perpendicular};
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Word;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (frame, axis) = match args.word(0) {
        Some(Word::X | Word::WorldX) => (Frame::WORLD, Some(0)),
        Some(Word::Y | Word::WorldY) => (Frame::WORLD, Some(1)),
        Some(Word::Z | Word::WorldZ) => (Frame::WORLD, Some(2)),
        Some(Word::ObjectX) => (run.object, Some(0)),
        Some(Word::ObjectY) => (run.object, Some(1)),
        Some(Word::ObjectZ) => (run.object, Some(2)),
        Some(Word::ObjectXyz) => (run.object, None),
        _ => (Frame::WORLD, None),
    };
    let axes = match axis {
        None => frame.axes,
        Some(axis) => completed(frame.axes, axis, shape.scope.frame.axes),
    };
    shape.turn_scope(axes);
    shape.pivot_to_scope();
}

/// The named axis as in `target`, the others as near to the old ones as can be.
fn completed(target: DMat3, axis: usize, old: DMat3) -> DMat3 {
    let fixed: DVec3 = target.col(axis);
    match axis {
        0 => {
            let z = perpendicular(fixed, old.z_axis, old.y_axis);
            DMat3::from_cols(fixed, z.cross(fixed), z)
        }
        1 => {
            let x = perpendicular(fixed, old.x_axis, old.z_axis);
            DMat3::from_cols(x, fixed, x.cross(fixed))
        }
        _ => {
            let x = perpendicular(fixed, old.x_axis, old.y_axis);
            DMat3::from_cols(x, fixed.cross(x), fixed)
        }
    }
}
