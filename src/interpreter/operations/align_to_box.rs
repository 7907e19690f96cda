//! `alignScopeToGeometryBBox` (reference 4.7). In: the two axes to turn. Out: pivot and scope along the least rectangle
//! around the geometry seen along the third axis, which stays; the first axis named runs along the longer side.

use glam::{DMat3, DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Word;
use crate::geometry::rectangle::least_around;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (first, second) = match args.word(0) {
        Some(Word::Yx) => (1, 0),
        Some(Word::Xz) => (0, 2),
        Some(Word::Zx) => (2, 0),
        Some(Word::Yz) => (1, 2),
        Some(Word::Zy) => (2, 1),
        _ => (0, 1),
    };
    shape.bake();
    let axes = shape.scope.frame.axes;
    let (u, v) = (axes.col(first), axes.col(second));
    let origin = shape.scope.frame.origin;
    let plan = |p: &DVec3| DVec2::new((p - origin).dot(u), (p - origin).dot(v));
    let points: Vec<DVec2> = shape.form.mesh.positions.iter().map(plan).collect();
    let Some(along) = least_around(&points) else {
        run.warn("cga::no-extent", args.span, || "there is no geometry with an extent to align to".into());
        return;
    };
    // Of the two senses the one nearer to the old axis.
    let along = if along.x < 0.0 || (along.x == 0.0 && along.y < 0.0) { -along } else { along };
    let across = along.perp();
    let mut columns = [axes.x_axis, axes.y_axis, axes.z_axis];
    columns[first] = u * along.x + v * along.y;
    columns[second] = u * across.x + v * across.y;
    shape.turn_scope(DMat3::from_cols(columns[0], columns[1], columns[2]));
    shape.pivot_to_scope();
}
