//! `innerRectangle` (reference 4.5.6; compatibility notes). In: directions to try. Out: the largest rectangle inside
//! every face, and what remains around it.
//!
//! For a direction and a pair of lines across it, the free stretches between them are exact: an edge of the polygon
//! blocks the heights it passes through between the lines. The lines are searched: first over all corners and evenly
//! between, then by shrinking steps around the best pair.

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::regions::{Regions, named};
use crate::cga::builtins::Word;
use crate::cga::program::Selector;
use crate::geometry::{PlaneFrame, Polygon, boolean};

/// A rectangle in turned coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Rectangle {
    low: DVec2,
    high: DVec2,
}

impl Rectangle {
    fn area(&self) -> f64 {
        let size = self.high - self.low;
        size.x * size.y
    }
}

pub fn regions(run: &mut Derivation, args: &Args, parent: &Shape, selectors: &[Selector]) -> Regions {
    let mut out = Regions { by_selector: vec![Vec::new(); selectors.len()] };
    let mesh = &parent.form.mesh;
    for (number, face) in mesh.faces.iter().enumerate() {
        let Some(frame) = PlaneFrame::of_face(mesh, face) else { continue };
        let polygon = frame.face_to_plan(mesh, face);
        let directions = match args.word(0) {
            Some(Word::Edge) => edge_directions(&polygon),
            _ => vec![scope_direction(parent, &frame)],
        };
        let Some(rectangle) = largest(&polygon, &directions) else { continue };
        if let Some(place) = named(selectors, Word::Shape) {
            out.by_selector[place].push((number, rectangle.clone()));
        }
        if let Some(place) = named(selectors, Word::Remainder) {
            match boolean::difference(std::slice::from_ref(&polygon), std::slice::from_ref(&rectangle)) {
                Ok(rest) => {
                    let least = SLIVER * polygon.area();
                    let rest = rest.into_iter().filter(|p| p.area() > least);
                    out.by_selector[place].extend(rest.map(|p| (number, p)));
                }
                Err(error) => run.warn("cga::inner-rectangle", args.span, || format!("the remainder is lost: {error}")),
            }
        }
    }
    out
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
    let corners: Vec<DVec2> = polygon.outer.clone();
    let middle = corners.iter().sum::<DVec2>() / corners.len().max(1) as f64;
    let mut best: Option<(f64, f64, [DVec2; 4])> = None;
    for &d in directions {
        let across = d.perp();
        let turned = |p: &DVec2| DVec2::new(p.dot(d), p.dot(across));
        let local = Polygon {
            outer: polygon.outer.iter().map(turned).collect(),
            holes: polygon.holes.iter().map(|h| h.iter().map(turned).collect()).collect(),
        };
        let Some(r) = search(&local, turned(&middle)) else { continue };
        let back = |x: f64, y: f64| d * x + across * y;
        let ring = [back(r.low.x, r.low.y), back(r.high.x, r.low.y), back(r.high.x, r.high.y), back(r.low.x, r.high.y)];
        let off = ring.iter().sum::<DVec2>().distance(middle * 4.0);
        let better = best
            .as_ref()
            .is_none_or(|(area, o, _)| r.area() > area * (1.0 + 1e-9) || (r.area() > area * (1.0 - 1e-9) && off < *o));
        if better {
            best = Some((r.area(), off, ring));
        }
    }
    best.map(|(_, _, ring)| Polygon { outer: ring.to_vec(), holes: Vec::new() })
}

/// Lines tried beside the corners, and rounds of refinement.
const EVEN_LINES: usize = 24;
const ROUNDS: usize = 40;

fn search(polygon: &Polygon, middle: DVec2) -> Option<Rectangle> {
    let (low, high) = polygon.bounds()?;
    let mut lines: Vec<f64> = polygon.rings().flatten().map(|p| p.x).collect();
    lines.extend((1..EVEN_LINES).map(|i| low.x + (high.x - low.x) * i as f64 / EVEN_LINES as f64));
    lines.sort_by(f64::total_cmp);
    lines.dedup_by(|a, b| *a - *b < 1e-9 * (high.x - low.x));
    let mut best: Option<Rectangle> = None;
    for (i, &x0) in lines.iter().enumerate() {
        for &x1 in &lines[i + 1..] {
            improve(&mut best, between(polygon, x0, x1), middle);
        }
    }
    let mut best = best?;
    let mut step = (high.x - low.x) / EVEN_LINES as f64;
    for _ in 0..ROUNDS {
        let before = best;
        for (a, b) in
            [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0)]
        {
            let mut candidate = Some(best);
            improve(&mut candidate, between(polygon, best.low.x + a * step, best.high.x + b * step), middle);
            best = candidate.unwrap_or(best);
        }
        if best == before {
            step /= 2.0;
        }
    }
    Some(best)
}

fn improve(best: &mut Option<Rectangle>, found: Option<Rectangle>, middle: DVec2) {
    let Some(found) = found else { return };
    let off = |r: &Rectangle| (r.low + r.high).distance(middle * 2.0);
    let better = best.is_none_or(|b| {
        found.area() > b.area() * (1.0 + 1e-12) || (found.area() >= b.area() * (1.0 - 1e-12) && off(&found) < off(&b))
    });
    if better {
        *best = Some(found);
    }
}

/// The highest free rectangle from line x0 to line x1.
fn between(polygon: &Polygon, x0: f64, x1: f64) -> Option<Rectangle> {
    let width = x1 - x0;
    if width.is_nan() || width <= 0.0 {
        return None;
    }
    let mut blocked: Vec<(f64, f64)> = Vec::new();
    for ring in polygon.rings() {
        for i in 0..ring.len() {
            let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
            let (left, right) = if p.x <= q.x { (p, q) } else { (q, p) };
            if right.x <= x0 || left.x >= x1 {
                continue;
            }
            let at = |x: f64| left.y + (right.y - left.y) * ((x - left.x) / (right.x - left.x)).clamp(0.0, 1.0);
            let (a, b) = if right.x > left.x { (at(x0), at(x1)) } else { (left.y, right.y) };
            blocked.push((a.min(b), a.max(b)));
        }
    }
    blocked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<Rectangle> = None;
    let mut top = blocked.first()?.1;
    for &(low, high) in &blocked[1..] {
        if low > top {
            let free = Rectangle { low: DVec2::new(x0, top), high: DVec2::new(x1, low) };
            let inside = polygon.contains((free.low + free.high) / 2.0);
            if inside && best.is_none_or(|b| free.area() > b.area()) {
                best = Some(free);
            }
        }
        top = top.max(high);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_large_wing_of_an_l() {
        let l = [(0.0, 0.0), (50.0, 0.0), (50.0, 22.0), (24.0, 22.0), (24.0, 46.0), (0.0, 46.0)];
        let polygon = Polygon { outer: l.iter().map(|&(x, y)| DVec2::new(x, y)).collect(), holes: Vec::new() };
        let found = largest(&polygon, &edge_directions(&polygon)).expect("an L holds a rectangle");
        assert!((found.area() - 24.0 * 46.0).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_triangle_holds_half_its_area() {
        let outer = vec![DVec2::ZERO, DVec2::new(8.0, 0.0), DVec2::new(0.0, 6.0)];
        let found = largest(&Polygon { outer, holes: Vec::new() }, &[DVec2::X]).expect("there is room");
        assert!((found.area() - 12.0).abs() < 1e-3, "{found:?}");
    }
}
