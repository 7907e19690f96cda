//! `center` (reference 4.6). In: axes. Out: the scope moved so that its centre is that of the reference scope.

use glam::DVec3;

use super::super::shape::{Scope, Shape};
use super::args::Args;
use crate::cga::builtins::Word;

pub fn apply(args: &Args, shape: &mut Shape, reference: &Scope) {
    let mask = match args.word(0) {
        Some(Word::X) => DVec3::X,
        Some(Word::Y) => DVec3::Y,
        Some(Word::Z) => DVec3::Z,
        Some(Word::Xy) => DVec3::new(1.0, 1.0, 0.0),
        Some(Word::Xz) => DVec3::new(1.0, 0.0, 1.0),
        Some(Word::Yz) => DVec3::new(0.0, 1.0, 1.0),
        _ => DVec3::ONE,
    };
    let delta = shape.scope.frame.local_direction(reference.center() - shape.scope.center());
    shape.scope.frame.origin += shape.scope.frame.axes * (delta * mask);
}
