//! Ears of an outline that crosses itself by a rounding. In: such a ring. Out: triangles whose areas add up to its area.
//!
//! Roof faces around an apex have chains of corners a few grid steps apart; rounding their positions can fold such a chain
//! by as much. Cutting n - 3 corners one by one covers the ring whatever their order; this order does the least harm.

use std::cmp::Ordering;

use glam::DVec2;

use crate::geometry::orientation::orientation;
use crate::geometry::polygon::signed_area;

/// Greatest depth of a fold, as a share of the ring's extent: what rounding to the grid and welding can do, magnified.
const FOLD: f64 = 1e-6;

/// n - 2 triangles; `None` if the ring repeats a point or has hardly any area, or if one triangle would have to be folded
/// deeper than [`FOLD`].
pub(super) fn cut(ring: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let (low, high) = ring.iter().fold((ring[0], ring[0]), |(low, high), &p| (low.min(p), high.max(p)));
    let limit = FOLD * (high - low).max_element();
    let repeats = (0..ring.len()).any(|i| ring[..i].contains(&ring[i]));
    if repeats || signed_area(ring) <= limit * (high - low).max_element() {
        return None;
    }
    let mut left: Vec<u32> = (0..ring.len() as u32).collect();
    let mut triangles = Vec::with_capacity(ring.len() - 2);
    while left.len() > 3 {
        let n = left.len();
        let harms = (0..n).map(|k| (k, harm(ring, &left, k)));
        let (tip, least) = harms.min_by(|p, q| p.1.total_cmp(&q.1)).expect("four corners or more are left");
        if least > limit {
            return None;
        }
        triangles.push([left[(tip + n - 1) % n], left[tip], left[(tip + 1) % n]]);
        left.remove(tip);
    }
    let last = [left[0], left[1], left[2]];
    triangles.push(last);
    let [a, b, c] = last.map(|i| ring[i as usize]);
    (orientation(a, b, c) == Ordering::Greater || height(a, b, c) <= limit).then_some(triangles)
}

/// Least height of a triangle.
fn height(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest == 0.0 { 0.0 } else { (b - a).perp_dot(c - a).abs() / longest }
}

/// What cutting off a corner does wrong: the height of a triangle that turns the wrong way, or how deep another corner lies
/// in it, or an edge; below 0, how far the nearest corner stays away. A strict ear is not enough: the fold may lie just beside it.
fn harm(ring: &[DVec2], left: &[u32], tip: usize) -> f64 {
    let n = left.len();
    let corners = [(tip + n - 1) % n, tip, (tip + 1) % n];
    let [a, b, c] = corners.map(|k| ring[left[k] as usize]);
    if orientation(a, b, c) != Ordering::Greater {
        return height(a, b, c);
    }
    let inside = |p: DVec2, q: DVec2, o: DVec2| (q - p).normalize_or_zero().perp_dot(o - p);
    let depth = |k: usize| {
        let p = ring[left[k] as usize];
        inside(a, b, p).min(inside(b, c, p)).min(inside(c, a, p))
    };
    let deepest = (0..n).filter(|k| !corners.contains(k)).map(depth).fold(f64::NEG_INFINITY, f64::max);
    // An edge may pass through the ear between the corners.
    let ends = |k: usize| (ring[left[k] as usize], ring[left[(k + 1) % n] as usize]);
    (0..n).map(|k| crossing(ends(k), (c, a))).fold(deepest, f64::max)
}

/// How far one of two segments that cross would have to give way; no bound if they do not cross.
fn crossing((p, q): (DVec2, DVec2), (a, b): (DVec2, DVec2)) -> f64 {
    let side = |from: DVec2, to: DVec2, o: DVec2| (to - from).normalize_or_zero().perp_dot(o - from);
    let (sp, sq, sa, sb) = (side(a, b, p), side(a, b, q), side(p, q, a), side(p, q, b));
    if sp * sq < 0.0 && sa * sb < 0.0 {
        [sp, sq, sa, sb].into_iter().map(f64::abs).fold(f64::INFINITY, f64::min)
    } else {
        f64::NEG_INFINITY
    }
}
