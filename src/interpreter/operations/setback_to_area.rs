//! `setbackToArea` (reference 4.5.3). In: the area that shall remain, least and greatest distances. Out: the regions
//! of the setback that leaves it, to 1e-9 of the whole; the nearest one where none does.
//!
//! One offset is common to all selected edges of all faces: the remainder of the whole shape has the area.

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use super::regions::Regions;
use super::setback::{cut, face_edges, owners, remaining_area};
use crate::cga::program::Selector;
use crate::geometry::{PlaneFrame, Polygon};

pub fn regions<'p>(
    run: &mut Derivation<'p>,
    args: &Args,
    parent: &Shape,
    selectors: &'p [Selector],
    env: &Env,
) -> Outcome<Regions> {
    let area = args.float_or(run, 0, 0.0);
    let arrays = (1..args.len()).take_while(|&i| matches!(args.value(i), Some(Value::Floats(_)))).count();
    let components = face_edges(run, args, 1 + arrays, parent, selectors);
    let owners = owners(run, &components, parent, selectors, env)?;
    if owners.iter().all(Option::is_none) {
        run.warn("cga::setback-area", args.span, || "no edge is selected, so nothing can be set back".into());
    }
    let mut limit = |i: usize, edge: usize| match args.value(i) {
        Some(Value::Floats(list)) => list.items.get(edge).map(|&x| run.finite(x, args.span).max(0.0)),
        _ => None,
    };
    let mut bounds = Vec::with_capacity(owners.len());
    for (edge, owner) in owners.iter().enumerate() {
        let (least, most) = (limit(1, edge).unwrap_or(0.0), limit(2, edge).unwrap_or(f64::INFINITY));
        bounds.push(if owner.is_some() { (least.min(most), most) } else { (0.0, 0.0) });
    }
    let mesh = &parent.form.mesh;
    let plan = |face| PlaneFrame::of_face(mesh, face).map(|frame| frame.face_to_plan(mesh, face)).unwrap_or_default();
    let polygons: Vec<Polygon> = mesh.faces.iter().map(plan).collect();
    let distances = solve(&polygons, &bounds, area);
    let reached = remaining_area(&polygons, &distances);
    let whole: f64 = polygons.iter().map(Polygon::area).sum();
    if area <= 0.0 || (reached - area).abs() > 1e-6 * whole {
        run.warn("cga::setback-area", args.span, || {
            format!("the remainder cannot have an area of {area}: it has {reached:.6}")
        });
    }
    Ok(cut(run, parent, selectors, &owners, distances, args.span))
}

/// The distances `max(least + k, most)` that leave the area: it falls with k, so a bracket is narrowed by the secant
/// (Illinois variant of regula falsi: Dowell, Jarratt 1971) and by halving in turn.
fn solve(polygons: &[Polygon], bounds: &[(f64, f64)], area: f64) -> Vec<f64> {
    let at = |k: f64| -> Vec<f64> { bounds.iter().map(|&(least, most)| (least + k).min(most)).collect() };
    let over = |k: f64| remaining_area(polygons, &at(k)) - area;
    let extent =
        polygons.iter().filter_map(Polygon::bounds).map(|(low, high)| (high - low).length()).fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, extent);
    let (mut above, mut below) = (over(low), over(high));
    if above <= 0.0 {
        return at(low);
    }
    if below >= 0.0 {
        return at(high);
    }
    let enough = ENOUGH * (above + area).max(area);
    for round in 0..ROUNDS {
        let secant = high - below * (high - low) / (below - above);
        let k = if round % 3 == 2 { (low + high) / 2.0 } else { secant };
        let found = over(k);
        if found.abs() <= enough || k <= low || k >= high {
            return at(k);
        }
        if found > 0.0 {
            (low, above) = (k, found);
            below /= 2.0;
        } else {
            (high, below) = (k, found);
            above /= 2.0;
        }
    }
    at((low + high) / 2.0)
}

/// Share of the area that is near enough.
const ENOUGH: f64 = 1e-12;
/// Halvings alone would need 3 x 40 for the resolution of the skeleton.
const ROUNDS: usize = 120;
