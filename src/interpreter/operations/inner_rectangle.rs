//! `innerRectangle` and the old `innerRect` (reference 4.5.6; compatibility notes). In: directions to try. Out: the
//! largest rectangle inside every face, and what remains around it.

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::plan_faces::PlanFaces;
use super::regions::{Regions, named};
use super::strips;
use crate::cga::builtins::Word;
use crate::cga::program::Selector;
use crate::geometry::largest_rectangle::{Rectangle, largest_upright};
use crate::geometry::polygon::centroid;
use crate::geometry::{PlaneFrame, Polygon, boolean, polygon};

pub fn regions(run: &mut Derivation, args: &Args, parent: &Shape, selectors: &[Selector]) -> Regions {
    let mut out = Regions { by_selector: vec![Vec::new(); selectors.len()], distances: None };
    let mesh = &parent.form.mesh;
    for (number, face) in mesh.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(mesh, face) else {
            run.warn("cga::no-face", args.span, || "a face without area has no pieces".into());
            continue;
        };
        let polygon = frame.face_to_plan(mesh, face);
        let directions = match args.word(0) {
            Some(Word::Edge) => edge_directions(&polygon),
            _ => vec![scope_direction(parent, &frame)],
        };
        let Some(rectangle) = largest(&polygon, &directions) else {
            run.warn("cga::inner-rectangle", args.span, || "there is no rectangle inside this face".into());
            continue;
        };
        if let Some(place) = named(selectors, Word::Shape) {
            out.by_selector[place].push((number, rectangle.clone()));
        }
        if let Some(place) = named(selectors, Word::Remainder) {
            match boolean::difference(std::slice::from_ref(&polygon), std::slice::from_ref(&rectangle)) {
                Ok(rest) => {
                    let least = SLIVER * polygon.area();
                    let rest = rest.into_iter().filter(|p| p.area() > least);
                    let rest = rest.map(|p| strips::starting_on(p, strips::edges(&polygon.outer)));
                    out.by_selector[place].extend(rest.map(|p| (number, p)));
                }
                Err(error) => run.warn("cga::inner-rectangle", args.span, || format!("the remainder is lost: {error}")),
            }
        }
    }
    out
}

/// `innerRect`: the largest rectangle along the scope's axes in place of every face.
pub fn replace(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.bake();
    let source = shape.form.clone();
    let mut faces = PlanFaces::new(&source);
    for (number, face) in source.mesh.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(&source.mesh, face) else { continue };
        let polygon = frame.face_to_plan(&source.mesh, face);
        if let Some(rectangle) = largest(&polygon, &[scope_direction(shape, &frame)]) {
            faces.push(&faces.face(number, frame), &rectangle);
        }
    }
    let form = faces.into_form();
    if form.mesh.faces.is_empty() {
        run.warn("cga::inner-rectangle", args.span, || "there is no face that holds a rectangle".into());
        return;
    }
    shape.replace(form);
}

/// Remainders below this share of the face are not made.
const SLIVER: f64 = 1e-6;

/// The scope axis that lies nearest to the face, in the plan of the face.
fn scope_direction(parent: &Shape, frame: &PlaneFrame) -> DVec2 {
    let in_plan = |i: usize| {
        let axis = parent.scope.frame.axes.col(i);
        DVec2::new(axis.dot(frame.u), axis.dot(frame.v))
    };
    let flattest = if in_plan(0).length() >= in_plan(2).length() - 1e-9 { in_plan(0) } else { in_plan(2) };
    flattest.try_normalize().unwrap_or(DVec2::X)
}

/// Directions of the edges longer than a quarter of the longest of their loop, one of each.
fn edge_directions(polygon: &Polygon) -> Vec<DVec2> {
    let mut out: Vec<DVec2> = Vec::new();
    for ring in polygon.rings() {
        let edge = |i: usize| ring[(i + 1) % ring.len()] - ring[i];
        let longest = (0..ring.len()).map(|i| edge(i).length()).fold(0.0, f64::max);
        for i in 0..ring.len() {
            let Some(d) = edge(i).try_normalize().filter(|_| edge(i).length() > longest / 4.0) else { continue };
            let known = |o: &DVec2| o.perp_dot(d).abs() < 1e-9 || o.dot(d).abs() < 1e-9;
            if !out.iter().any(known) {
                out.push(d);
            }
        }
    }
    out
}

/// The largest rectangle with a side along one of the directions; of equals, the one nearest to the middle.
fn largest(polygon: &Polygon, directions: &[DVec2]) -> Option<Polygon> {
    let middle = middle(polygon);
    let mut best: Option<(f64, f64, [DVec2; 4])> = None;
    for &d in directions {
        let across = d.perp();
        let turned = |p: &DVec2| DVec2::new(p.dot(d), p.dot(across));
        let local = Polygon {
            outer: polygon.outer.iter().map(turned).collect(),
            holes: polygon.holes.iter().map(|h| h.iter().map(turned).collect()).collect(),
        };
        let Some(found) = largest_upright(&local, turned(&middle)) else { continue };
        let Rectangle { low, high } = found;
        let back = |x: f64, y: f64| d * x + across * y;
        let ring = [back(low.x, low.y), back(high.x, low.y), back(high.x, high.y), back(low.x, high.y)];
        let off = ring.iter().sum::<DVec2>().distance(middle * 4.0);
        let better = best.as_ref().is_none_or(|(area, o, _)| {
            found.area() > area * (1.0 + 1e-9) || (found.area() > area * (1.0 - 1e-9) && off < *o)
        });
        if better {
            best = Some((found.area(), off, ring));
        }
    }
    best.map(|(_, _, ring)| Polygon { outer: ring.to_vec(), holes: Vec::new() })
}

/// The centre of mass, holes left out.
fn middle(polygon: &Polygon) -> DVec2 {
    let (mut sum, mut area) = (DVec2::ZERO, 0.0);
    for (i, ring) in polygon.rings().enumerate() {
        let share = polygon::signed_area(ring).abs() * if i == 0 { 1.0 } else { -1.0 };
        sum += centroid(ring) * share;
        area += share;
    }
    if area > 0.0 { sum / area } else { centroid(&polygon.outer) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_large_wing_of_a_turned_l() {
        let l = [(0.0, 0.0), (50.0, 0.0), (50.0, 22.0), (24.0, 22.0), (24.0, 46.0), (0.0, 46.0)];
        let (sin, cos) = libm::sincos(0.3);
        let outer = l.iter().map(|&(x, y)| DVec2::new(x * cos - y * sin, x * sin + y * cos)).collect();
        let polygon = Polygon { outer, holes: Vec::new() };
        let found = largest(&polygon, &edge_directions(&polygon)).expect("an L holds a rectangle");
        assert!((found.area() - 24.0 * 46.0).abs() < 1e-6, "{found:?}");
    }
}
