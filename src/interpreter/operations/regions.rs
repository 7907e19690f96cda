//! `setback`, `shapeL`, `shapeU`, `shapeO`, `innerRectangle` (reference 4.5; compatibility notes). In: distances and
//! selectors. Out: the strips along the selected edges, joined where they touch, and what remains.

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::orientation;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use super::comp::{Test, assign};
use super::components::Components;
use super::plan_faces::PlanFaces;
use super::setback_tags;
use super::strips;
use super::{Pieces, inner_rectangle};
use crate::cga::builtins::{Operation, Word};
use crate::cga::program::{Component, ExprKind, Selector, SelectorOperator};
use crate::geometry::offset::setback;
use crate::geometry::{PlaneFrame, Polygon};

/// Polygons by the selector they go to, with the number of the face they lie in.
pub struct Regions {
    pub by_selector: Vec<Vec<(usize, Polygon)>>,
}

/// The number of the selector that names a region by a word, `shape` or `remainder`.
pub fn named(selectors: &[Selector], word: Word) -> Option<usize> {
    selectors.iter().position(|s| s.test.kind == ExprKind::Selector(word))
}

/// Runs an operation as far as the new shapes.
pub fn pieces<'p>(
    run: &mut Derivation<'p>,
    operation: Operation,
    args: &Args,
    selectors: &'p [Selector],
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let mut parent = env.shape.clone();
    parent.bake();
    let mut cuts: Option<Vec<f64>> = None;
    let regions = match operation {
        Operation::Setback => {
            let (owners, distances) = selected_edges(run, args, &parent, selectors, env)?;
            let regions = cut(run, args, &parent, selectors, &owners, &distances, Word::Remainder);
            cuts = Some(distances);
            regions
        }
        Operation::ShapeL | Operation::ShapeU | Operation::ShapeO => {
            let (owners, distances) = wings(run, operation, args, &parent, selectors);
            let regions = cut(run, args, &parent, selectors, &owners, &distances, Word::Remainder);
            cuts = Some(distances);
            regions
        }
        Operation::InnerRectangle => inner_rectangle::regions(run, args, &parent, selectors),
        other => {
            run.error(
                "cga::not-supported-yet",
                args.span,
                format!("`{}` is a known CGA operation, not supported yet", other.name()),
            );
            return Ok(Vec::new());
        }
    };
    let cuts = cuts.filter(|_| run.program.observes_tags());
    let pieces = shapes(&parent, selectors, regions, cuts.as_deref());
    run.count_shapes(pieces.len(), args.span)?;
    Ok(pieces)
}

/// One shape per polygon (`:`) or per selector (`=`), fitted, axes and pivot as they were. With the distances of a
/// setback its edges are tagged.
fn shapes<'p>(parent: &Shape, selectors: &'p [Selector], regions: Regions, cuts: Option<&[f64]>) -> Pieces<'p> {
    let mut out: Pieces<'p> = Vec::new();
    let rest = named(selectors, Word::Remainder);
    for (number, (selector, polygons)) in selectors.iter().zip(regions.by_selector).enumerate() {
        let groups: Vec<Vec<(usize, Polygon)>> = match selector.operator {
            SelectorOperator::Each | SelectorOperator::Connected => polygons.into_iter().map(|p| vec![p]).collect(),
            SelectorOperator::All if polygons.is_empty() => Vec::new(),
            SelectorOperator::All => vec![polygons],
        };
        let total = groups.len() as f64;
        for (index, group) in groups.into_iter().enumerate() {
            let mut faces = PlanFaces::new(&parent.form);
            for (number, polygon) in &group {
                let mesh = &parent.form.mesh;
                if let Some(frame) = PlaneFrame::of_face(mesh, &mesh.faces[*number]) {
                    let source = faces.face(*number, frame);
                    faces.push(&source, polygon);
                }
            }
            let mut form = faces.into_form();
            if let Some(distances) = cuts {
                let sources: Vec<usize> = group.iter().map(|(number, _)| *number).collect();
                setback_tags::mark(&parent.form, &mut form, &sources, distances, rest == Some(number));
            }
            let mut shape = parent.clone();
            shape.replace(form);
            shape.lineage.comp_selector = selector.text.clone();
            shape.lineage.comp_index = index as f64;
            shape.lineage.comp_total = total;
            out.push((shape, &selector.body));
        }
    }
    out
}

/// Per face edge: the selector that takes it, and its distance (0 where none takes it).
fn selected_edges<'p>(
    run: &mut Derivation<'p>,
    args: &Args,
    parent: &Shape,
    selectors: &'p [Selector],
    env: &Env,
) -> Outcome<(Vec<Option<usize>>, Vec<f64>)> {
    let components = Components::of(parent, Component::FaceEdges, false, false);
    let tests: Vec<Test> = selectors.iter().map(|s| Test { test: &s.test, text: &s.text }).collect();
    let mut owners = assign(run, &components, parent, &tests, env)?;
    for (number, selector) in selectors.iter().enumerate() {
        // An index counts round the edges, also backwards.
        if let ExprKind::Number(index) = selector.test.kind {
            let place = index.rem_euclid(owners.len().max(1) as f64) as usize;
            if let Some(owner) = owners.get_mut(place) {
                *owner = owner.or(Some(number));
            }
        }
    }
    let one = args.value(0).cloned().unwrap_or(Value::Float(0.0));
    let mut distances = Vec::with_capacity(owners.len());
    for (edge, owner) in owners.iter().enumerate() {
        let wanted = match &one {
            Value::Floats(list) => list.items.get(edge).copied().unwrap_or(0.0),
            scalar => scalar.to_float(),
        };
        distances.push(if owner.is_some() { run.finite(wanted, args.span).max(0.0) } else { 0.0 });
    }
    Ok((owners, distances))
}

/// The edges `shapeL/U/O` cut from: by the scope's sides, in the order of their arguments.
fn wings(
    run: &mut Derivation,
    operation: Operation,
    args: &Args,
    parent: &Shape,
    selectors: &[Selector],
) -> (Vec<Option<usize>>, Vec<f64>) {
    let sides: &[Word] = match operation {
        Operation::ShapeL => &[Word::Front, Word::Left],
        Operation::ShapeU => &[Word::Front, Word::Right, Word::Left],
        _ => &[Word::Front, Word::Right, Word::Back, Word::Left],
    };
    let depths: Vec<f64> = (0..sides.len()).map(|i| args.float_or(run, i, 0.0).max(0.0)).collect();
    let shape = named(selectors, Word::Shape);
    let components = Components::of(parent, Component::FaceEdges, false, false);
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
    (owners, distances)
}

/// Cuts the strips off every face. Strips of neighbouring edges of one selector are joined.
fn cut(
    run: &mut Derivation,
    args: &Args,
    parent: &Shape,
    selectors: &[Selector],
    owners: &[Option<usize>],
    distances: &[f64],
    rest: Word,
) -> Regions {
    let mesh = &parent.form.mesh;
    let remainder = named(selectors, rest);
    let mut out = Regions { by_selector: vec![Vec::new(); selectors.len()] };
    let mut first_edge = 0;
    for (number, face) in mesh.faces.iter().enumerate() {
        let count = face.edges().count();
        let edges = first_edge..first_edge + count;
        first_edge += count;
        let Some(frame) = PlaneFrame::of_face(mesh, face) else { continue };
        let polygon = frame.face_to_plan(mesh, face);
        let result = match setback(&polygon, &distances[edges.clone()]) {
            Ok(result) => result,
            Err(error) => {
                run.warn("cga::setback", args.span, || format!("this face was not set back: {error}"));
                if let Some(place) = remainder {
                    out.by_selector[place].push((number, polygon));
                }
                continue;
            }
        };
        if let Some(place) = remainder {
            out.by_selector[place].extend(result.inside.into_iter().map(|p| (number, p)));
        }
        for (selector, list) in out.by_selector.iter_mut().enumerate() {
            let own = |edge: usize| owners[edges.start + edge] == Some(selector);
            let borders = result.borders.iter().filter(|b| own(b.edge));
            let rings: Vec<&[glam::DVec2]> = borders.map(|b| b.ring.as_slice()).collect();
            list.extend(strips::joined(&rings).into_iter().map(|p| (number, p)));
        }
    }
    out
}
