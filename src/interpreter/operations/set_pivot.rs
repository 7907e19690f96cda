//! `setPivot` (reference 4.7). In: an order of axes and a corner of the scope. Out: pivot and scope there.

use glam::{DMat3, DVec3};

use super::super::derivation::Derivation;
use super::super::placement::Frame;
use super::super::shape::{Scope, Shape};
use super::args::Args;
use crate::cga::builtins::Word;

/// New x, y, z for `xyz` by corner: (old axis, sign). Read off the figures the reference cites.
const AXES: [[(usize, f64); 3]; 8] = [
    [(0, 1.0), (1, 1.0), (2, 1.0)],
    [(2, 1.0), (1, 1.0), (0, -1.0)],
    [(0, -1.0), (1, 1.0), (2, -1.0)],
    [(2, -1.0), (1, 1.0), (0, 1.0)],
    [(2, 1.0), (1, -1.0), (0, 1.0)],
    [(0, -1.0), (1, -1.0), (2, 1.0)],
    [(2, -1.0), (1, -1.0), (0, -1.0)],
    [(0, 1.0), (1, -1.0), (2, -1.0)],
];

/// Corners: the four of the base going round, then the four above.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 0.0, 1.0],
    [0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.bake();
    let corner = args.float_or(run, 1, 0.0).rem_euclid(8.0).floor() as usize % 8;
    let xyz = AXES[corner];
    let order = match args.word(0) {
        Some(Word::Yzx | Word::ZUp) => [xyz[2], xyz[0], xyz[1]],
        Some(Word::Zxy) => [xyz[1], xyz[2], xyz[0]],
        _ => xyz,
    };
    let old = shape.scope;
    let direction = |(axis, sign): (usize, f64)| old.frame.axes.col(axis) * sign;
    let origin = old.frame.world_from_local(old.size * DVec3::from_array(CORNERS[corner]));
    let axes = DMat3::from_cols(direction(order[0]), direction(order[1]), direction(order[2]));
    let size = DVec3::new(old.size[order[0].0], old.size[order[1].0], old.size[order[2].0]);
    shape.scope = Scope { frame: Frame { origin, axes }, size };
    shape.binding = shape.scope;
    shape.pivot_to_scope();
}
