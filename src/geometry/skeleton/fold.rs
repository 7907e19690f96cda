//! Faces that welding has folded: a node moved by a few grid steps has passed another or an arc. In: faces over nodes.
//! Out: whether any of them crosses itself.

use std::cmp::Ordering;

use glam::DVec2;

use super::faces::FaceLoops;
use super::wavefront::Wavefront;
use crate::geometry::orientation::orientation;
use crate::geometry::polygon::Polygon;
use crate::geometry::polygon_checks::crossing_edges;

/// Faces with more corners go through the sweep of [`crossing_edges`].
const PAIRS: usize = 24;

/// Grid steps between a corner and an edge below which rounding to metres may fold the face.
const CLOSE: f64 = 1e-2;

/// Whether a face of an edge that moves is no simple counter-clockwise outline in plan.
pub(super) fn any(wf: &Wavefront, faces: &[FaceLoops]) -> bool {
    let mut ring = Vec::new();
    let moving = faces.iter().filter(|face| face.outer.len() >= 3 && wf.line(face.root).w != 0);
    moving.into_iter().any(|face| {
        ring.clear();
        ring.extend(face.outer.iter().map(|&n| DVec2::new(wf.nodes[n as usize].x, wf.nodes[n as usize].y)));
        is_folded(&ring)
    })
}

fn is_folded(ring: &[DVec2]) -> bool {
    let n = ring.len();
    if n == 3 {
        return orientation(ring[0], ring[1], ring[2]) != Ordering::Greater;
    }
    if n > PAIRS {
        return !crossing_edges(&Polygon { outer: ring.to_vec(), holes: Vec::new() }).is_empty();
    }
    let corner = |k: usize| ring[k % n];
    let neighbours = |i: usize, j: usize| j == i + 1 || (i == 0 && j + 1 == n);
    (0..n).any(|i| {
        let pairs = i + 1..n;
        pairs.into_iter().any(|j| !neighbours(i, j) && meet(corner(i), corner(i + 1), corner(j), corner(j + 1)))
    })
}

/// Whether two segments have a point in common, or come as near as [`CLOSE`].
fn meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    if (a.max(b) + CLOSE).cmplt(c.min(d)).any() || (c.max(d) + CLOSE).cmplt(a.min(b)).any() {
        return false;
    }
    let apart = |p: Ordering, q: Ordering| p == q && p != Ordering::Equal;
    let cross =
        !apart(orientation(a, b, c), orientation(a, b, d)) && !apart(orientation(c, d, a), orientation(c, d, b));
    cross || [(c, a, b), (d, a, b), (a, c, d), (b, c, d)].into_iter().any(|(p, from, to)| is_close(p, from, to))
}

fn is_close(p: DVec2, from: DVec2, to: DVec2) -> bool {
    let along = to - from;
    let share = (p - from).dot(along) / along.length_squared();
    p.distance_squared(from + along * share.clamp(0.0, 1.0)) < CLOSE * CLOSE
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn a_needle_on_the_wrong_side_is_a_fold() {
        let face = |x: f64| ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 2.0), (x, 3.0), (0.0, 5.0)]);
        assert!(!is_folded(&face(0.1)));
        assert!(is_folded(&face(-1e-9)));
        assert!(is_folded(&ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])));
        let long: Vec<DVec2> = (0..40).map(|k| DVec2::new(f64::from(k), f64::from(k * k))).rev().collect();
        assert!(!is_folded(&long.iter().rev().copied().collect::<Vec<_>>()));
    }
}
