//! `setback` and `setbackPerEdge` (reference 4.5.1, 4.5.2; compatibility notes). In: distances and selectors of face
//! edges. Out: the strips along the selected edges, joined where those of one selector touch, and what remains.

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::shape::{CompSplit, Shape};
use super::super::value::Value;
use super::args::Args;
use super::comp::Wanted;
use super::comp::{COMPONENT, Test, assign};
use super::components::Components;
use super::regions::{Regions, named};
use super::{setback_uv, strips};
use crate::cga::builtins::Word;
use crate::cga::program::{Arg, Component, ExprKind, Selector};
use crate::geometry::offset::{self, Border};
use crate::geometry::{PlaneFrame, Polygon};
use crate::source::Span;

/// `setback(distance | distances [, uvSet])`. Edges beyond the end of a list stay.
pub fn by_distance<'p>(
    run: &mut Derivation<'p>,
    args: &Args,
    parent: &Shape,
    selectors: &'p [Selector],
    env: &Env,
) -> Outcome<Regions> {
    let components = face_edges(run, args, 1, parent, selectors);
    let owners = owners(run, &components, parent, selectors, env)?;
    let one = args.value(0).cloned().unwrap_or(Value::Float(0.0));
    let mut distances = Vec::with_capacity(owners.len());
    for (edge, owner) in owners.iter().enumerate() {
        let wanted = match &one {
            Value::Floats(list) => list.items.get(edge).copied().unwrap_or(0.0),
            scalar => scalar.to_float(),
        };
        distances.push(if owner.is_some() { run.finite(wanted, args.span).max(0.0) } else { 0.0 });
    }
    Ok(cut(run, parent, selectors, &owners, distances, args.span))
}

/// `setbackPerEdge(distance [, uvSet])`: the distance is evaluated on every face edge, selected or not.
pub fn per_edge<'p>(
    run: &mut Derivation<'p>,
    args: &'p [Arg],
    parent: &Shape,
    selectors: &'p [Selector],
    span: Span,
    env: &Env,
) -> Outcome<Regions> {
    let others = run.eval_args(args.get(1..).unwrap_or_default(), env)?;
    let components = face_edges(run, &Args::new(&others, span), 0, parent, selectors);
    let owners = owners(run, &components, parent, selectors, env)?;
    let mut distances = Vec::with_capacity(owners.len());
    let split = CompSplit::shared(&"all".into(), components.len());
    for (i, owner) in owners.iter().enumerate() {
        let mut shape = components.shape(parent, &[i]);
        (shape.comp, shape.comp_index) = (split.clone(), i as i32);
        shape.seed = parent.seed.part(COMPONENT + i as u64);
        let distance = match args.first() {
            Some(Arg::Value(_, expr)) => {
                run.eval_finite(expr, &env.on_component(&shape, parent, components.facets(i)))?
            }
            _ => 0.0,
        };
        distances.push(if owner.is_some() { distance.max(0.0) } else { 0.0 });
    }
    Ok(cut(run, parent, selectors, &owners, distances, span))
}

/// The face edges as selectors see them; `uv_set` is the position of the set's number, 0 if absent.
pub fn face_edges(
    run: &mut Derivation,
    args: &Args,
    uv_set: usize,
    parent: &Shape,
    selectors: &[Selector],
) -> Components {
    let mut components = Components::of(parent, Component::FaceEdges, false, Wanted::BORDERS);
    if selectors.iter().any(|s| setback_uv::mentioned(&s.test)) {
        let set = if args.value(uv_set).is_some() { args.uv_set(run, uv_set) } else { Some(0) };
        if let Some(set) = set
            && !setback_uv::mark(&mut components, &parent.form.mesh, set)
        {
            run.warn("cga::no-uv", args.span, || format!("faces without coordinates in set {set} have no uv sides"));
        }
    }
    components
}

/// The number of the selector that takes each face edge.
pub fn owners<'p>(
    run: &mut Derivation<'p>,
    components: &Components,
    parent: &Shape,
    selectors: &'p [Selector],
    env: &Env,
) -> Outcome<Vec<Option<usize>>> {
    let tests: Vec<Test> = selectors.iter().map(|s| Test { test: &s.test, text: &s.text }).collect();
    let mut owners = assign(run, components, parent, &tests, env)?;
    for (number, selector) in selectors.iter().enumerate() {
        // An index counts round the edges, also backwards.
        if let ExprKind::Number(index) = selector.test.kind {
            let place = index.rem_euclid(owners.len().max(1) as f64) as usize;
            if let Some(owner) = owners.get_mut(place) {
                *owner = owner.or(Some(number));
            }
        }
    }
    Ok(owners)
}

/// Cuts the strips off every face. A face that cannot be set back goes to the remainder with a warning.
pub fn cut(
    run: &mut Derivation,
    parent: &Shape,
    selectors: &[Selector],
    owners: &[Option<usize>],
    distances: Vec<f64>,
    span: Span,
) -> Regions {
    let mesh = &parent.form.mesh;
    let remainder = named(selectors, Word::Remainder);
    let mut by_selector = vec![Vec::new(); selectors.len()];
    let mut first_edge = 0;
    for (number, face) in mesh.faces.iter().enumerate() {
        let count = face.edges().count();
        let edges = first_edge..first_edge + count;
        first_edge += count;
        let Some(frame) = PlaneFrame::of_face(mesh, face) else {
            run.warn("cga::no-face", span, || "a face without area has no pieces".into());
            continue;
        };
        let polygon = frame.face_to_plan(mesh, face);
        let result = match offset::setback(&polygon, &distances[edges.clone()]) {
            Ok(result) => result,
            Err(error) => {
                run.warn("cga::setback", span, || format!("this face was not set back: {error}"));
                if let Some(place) = remainder {
                    by_selector[place].push((number, polygon));
                }
                continue;
            }
        };
        if let Some(place) = remainder {
            let inside = result.inside.into_iter().map(|p| strips::starting_near(p, &polygon));
            by_selector[place].extend(inside.map(|p| (number, p)));
        }
        for (selector, list) in by_selector.iter_mut().enumerate() {
            let own = |border: &&Border| owners[edges.start + border.edge] == Some(selector);
            let borders: Vec<Vec<&[glam::DVec2]>> = result.borders.iter().filter(own).map(loops).collect();
            list.extend(strips::joined(&borders).into_iter().map(|p| (number, p)));
        }
    }
    Regions { by_selector, distances: Some(distances) }
}

/// All loops of a strip, the outer one first.
pub fn loops(border: &Border) -> Vec<&[glam::DVec2]> {
    std::iter::once(&border.ring).chain(&border.holes).map(Vec::as_slice).collect()
}

/// Area of what would remain, square metres; faces that cannot be set back remain whole.
pub fn remaining_area(polygons: &[Polygon], distances: &[f64]) -> f64 {
    let mut first = 0;
    let mut sum = 0.0;
    for polygon in polygons {
        let count = polygon.rings().map(Vec::len).sum::<usize>();
        let own = &distances[first..first + count];
        first += count;
        sum += match offset::setback(polygon, own) {
            Ok(result) => result.inside.iter().map(Polygon::area).sum(),
            Err(_) => polygon.area(),
        };
    }
    sum
}
