//! `shapeL`, `shapeU`, `shapeO` (reference 4.5.4; compatibility notes). In: depths by side of the scope. Out: the wings
//! along those sides as one region, and what remains.

use super::super::derivation::Derivation;
use super::super::orientation;
use super::super::shape::Shape;
use super::args::Args;
use super::comp::Wanted;
use super::components::Components;
use super::regions::{Regions, named};
use super::setback::cut;
use crate::cga::builtins::{Operation, Word};
use crate::cga::program::{Component, Selector};

/// The sides in the order of the arguments.
pub fn regions(
    run: &mut Derivation,
    operation: Operation,
    args: &Args,
    parent: &Shape,
    selectors: &[Selector],
) -> Regions {
    let sides: &[Word] = match operation {
        Operation::ShapeL => &[Word::Front, Word::Left],
        Operation::ShapeU => &[Word::Front, Word::Right, Word::Left],
        _ => &[Word::Front, Word::Right, Word::Back, Word::Left],
    };
    let depths: Vec<f64> = (0..sides.len()).map(|i| args.float_or(run, i, 0.0).max(0.0)).collect();
    let shape = named(selectors, Word::Shape);
    let components = Components::of(parent, Component::FaceEdges, false, Wanted::BORDERS);
    let mut owners = Vec::with_capacity(components.len());
    let mut distances = Vec::with_capacity(components.len());
    for i in 0..components.len() {
        let direction = components.facets(i)[0].direction;
        let side = |word: &Word| orientation::agrees(*word, direction, &parent.scope, &run.object) == Some(true);
        let depth = sides.iter().position(side).map_or(0.0, |k| depths[k]);
        // Strips are cut even if nobody takes them.
        owners.push(Some(shape.unwrap_or(selectors.len())));
        distances.push(depth);
    }
    cut(run, parent, selectors, &owners, distances, args.span)
}
