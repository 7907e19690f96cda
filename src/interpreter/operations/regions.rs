//! Operations that divide faces in their plane (reference 4.5): `setback` and its kin, `shapeL`, `shapeU`, `shapeO`,
//! `innerRectangle`. In: arguments and selectors. Out: one shape per region, fitted, axes and pivot as they were.

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::shape::{CompSplit, Shape};
use super::args::Args;
use super::plan_faces::PlanFaces;
use super::setback_tags::{self, Cuts};
use super::{Pieces, inner_rectangle, setback, setback_to_area, shape_wings};
use crate::cga::builtins::{Operation, Word};
use crate::cga::program::{Arg, ExprKind, Selector, SelectorOperator};
use crate::geometry::{PlaneFrame, Polygon};
use crate::source::Span;

/// Polygons in the plan of the face with this number.
pub type InFace = (usize, Polygon);

/// Polygons by the selector they go to.
pub struct Regions {
    pub by_selector: Vec<Vec<InFace>>,
    /// How far every face edge was set back, where this was done.
    pub distances: Option<Vec<f64>>,
}

/// The number of the selector that names a region by a word, `shape` or `remainder`.
pub fn named(selectors: &[Selector], word: Word) -> Option<usize> {
    selectors.iter().position(|s| s.test.kind == ExprKind::Selector(word))
}

/// Runs an operation as far as the new shapes.
pub fn pieces<'p>(
    run: &mut Derivation<'p>,
    operation: Operation,
    args: &'p [Arg],
    selectors: &'p [Selector],
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let mut parent = env.shape.clone();
    parent.bake();
    if parent.form.mesh.faces.is_empty() {
        run.warn("cga::no-face", span, || format!("there is no face for `{}`: no pieces", operation.name()));
        return Ok(Vec::new());
    }
    let regions = if operation == Operation::SetbackPerEdge {
        setback::per_edge(run, args, &parent, selectors, span, env)?
    } else {
        let evaluated = run.eval_args(args, env)?;
        let args = Args::new(&evaluated, span);
        match operation {
            Operation::SetbackToArea => setback_to_area::regions(run, &args, &parent, selectors, env)?,
            Operation::ShapeL | Operation::ShapeU | Operation::ShapeO => {
                shape_wings::regions(run, operation, &args, &parent, selectors)
            }
            Operation::InnerRectangle => inner_rectangle::regions(run, &args, &parent, selectors),
            _ => setback::by_distance(run, &args, &parent, selectors, env)?,
        }
    };
    let pieces = shapes(run, &parent, selectors, regions);
    run.count_shapes(pieces.len(), span)?;
    Ok(pieces)
}

/// One shape per polygon (`:`, `=:`) or per selector (`=`). The edges of setbacks are tagged where a rule can ask.
fn shapes<'p>(run: &Derivation, parent: &Shape, selectors: &'p [Selector], regions: Regions) -> Pieces<'p> {
    let mut out: Pieces<'p> = Vec::new();
    let rest = named(selectors, Word::Remainder);
    let distances = regions.distances.filter(|_| run.program.observes_tags());
    for (number, (selector, polygons)) in selectors.iter().zip(regions.by_selector).enumerate() {
        let groups: Vec<Vec<InFace>> = match selector.operator {
            SelectorOperator::Each | SelectorOperator::Connected => polygons.into_iter().map(|p| vec![p]).collect(),
            SelectorOperator::All if polygons.is_empty() => Vec::new(),
            SelectorOperator::All => vec![polygons],
        };
        let split = CompSplit::shared(&selector.text, groups.len());
        for (index, group) in groups.into_iter().enumerate() {
            let mut shape = region(parent, &group, distances.as_deref().map(Cuts::Edges), rest == Some(number));
            (shape.comp, shape.comp_index) = (split.clone(), index as i32);
            out.push((Box::new(shape), &selector.body));
        }
    }
    out
}

/// The shape of some polygons; its edges are tagged as those of a setback if told what was cut.
pub fn region(parent: &Shape, group: &[InFace], cuts: Option<Cuts>, is_remainder: bool) -> Shape {
    let mut faces = PlanFaces::new(&parent.form);
    let mesh = &parent.form.mesh;
    for (number, polygon) in group {
        if let Some(frame) = PlaneFrame::of_face(mesh, &mesh.faces[*number]) {
            let source = faces.face(*number, frame);
            faces.push(&source, polygon);
        }
    }
    let mut form = faces.into_form();
    if let Some(cuts) = cuts {
        let sources: Vec<usize> = group.iter().map(|(number, _)| *number).collect();
        setback_tags::mark(&parent.form, &mut form, &sources, cuts, is_remainder);
    }
    let mut shape = parent.clone();
    shape.replace(form);
    shape
}
