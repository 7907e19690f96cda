//! Faces that pass through each other or cover each other. In: a mesh, a depth. Out: pairs of faces.
//!
//! Coordinates are rounded, so faces that only touch may pass through each other by a rounding. What counts is a measure,
//! not a sign: both faces reach more than the given depth to both sides of the other's plane, and what they have in
//! common is longer than that (Moller 1997, "A Fast Triangle-Triangle Intersection Test").

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::geometry::Mesh;
use crate::geometry::box_tree::{Bounds, BoxTree};
use crate::geometry::triangulate::{dropped_axis, triangles};

type Triangle = [DVec3; 3];

/// Pairs of faces (lesser index first) that intersect deeper than `depth` metres, or lie on each other facing the same
/// way. Faces back to back, as where one body stands on another, are none.
pub fn self_intersections(mesh: &Mesh, depth: f64) -> Vec<(usize, usize)> {
    let all: Vec<(usize, Triangle, DVec3)> = (triangles(mesh))
        .filter_map(|(face, t)| Some((face, t, (t[1] - t[0]).cross(t[2] - t[0]).try_normalize()?)))
        .collect();
    let bounds = |t: &Triangle| Bounds { lo: t[0].min(t[1]).min(t[2]), hi: t[0].max(t[1]).max(t[2]) };
    let boxes: Vec<Bounds> = all.iter().map(|(_, t, _)| bounds(t)).collect();
    let mut found = BTreeSet::new();
    let mut look = |i: usize, j: usize| {
        let ((f, a, na), (g, b, nb)) = (&all[i], &all[j]);
        if i < j && f != g && boxes[i].touches(&boxes[j]) && intersect((a, *na), (b, *nb), depth) {
            found.insert((*f.min(g), *f.max(g)));
        }
    };
    if all.len() <= FEW {
        (0..all.len()).for_each(|i| (i + 1..all.len()).for_each(|j| look(i, j)));
    } else {
        let tree = BoxTree::new(boxes.clone());
        boxes.iter().enumerate().for_each(|(i, b)| tree.visit(|other| other.touches(b), |j| look(i, j)));
    }
    found.into_iter().collect()
}

/// So many triangles are compared pair by pair.
const FEW: usize = 24;

fn intersect((a, na): (&Triangle, DVec3), (b, nb): (&Triangle, DVec3), depth: f64) -> bool {
    let heights = |t: &Triangle, on: &Triangle, n: DVec3| t.map(|p| (p - on[0]).dot(n));
    let (above_a, above_b) = (heights(b, a, na), heights(a, b, nb));
    if flat(above_a, depth) && flat(above_b, depth) {
        return na.dot(nb) > 0.0 && covers(a, na, b, depth);
    }
    if !(on_both_sides(above_a, depth) && on_both_sides(above_b, depth)) {
        return false;
    }
    let Some(line) = na.cross(nb).try_normalize() else { return false };
    let ((a0, a1), (b0, b1)) = (interval(a, above_b, line), interval(b, above_a, line));
    a1.min(b1) - a0.max(b0) > depth
}

fn flat(heights: [f64; 3], depth: f64) -> bool {
    heights.iter().all(|h| h.abs() <= depth)
}

fn on_both_sides(heights: [f64; 3], depth: f64) -> bool {
    heights.iter().any(|&h| h > depth) && heights.iter().any(|&h| h < -depth)
}

/// The part of a line that a triangle has, given the heights of its corners over the plane that the line lies in.
fn interval(t: &Triangle, heights: [f64; 3], line: DVec3) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let (p, q) = (heights[i], heights[j]);
        if (p <= 0.0) != (q <= 0.0) {
            let x = t[i].lerp(t[j], p / (p - q)).dot(line);
            (low, high) = (low.min(x), high.max(x));
        }
    }
    (low, high)
}

/// Whether two triangles of one plane share an area that is wider than `depth`.
fn covers(a: &Triangle, na: DVec3, b: &Triangle, depth: f64) -> bool {
    let Some(drop) = dropped_axis(na) else { return false };
    // About a corner, so that far origins cost no digits.
    let (a, mut piece) = (a.map(|p| drop(p - a[0])), b.map(|p| drop(p - a[0])).to_vec());
    for (p, q) in [(a[0], a[1]), (a[1], a[2]), (a[2], a[0])] {
        piece = left_of(&piece, p, q);
    }
    let twice: f64 = (1..piece.len().max(2) - 1).map(|i| (piece[i] - piece[0]).perp_dot(piece[i + 1] - piece[0])).sum();
    let longest = piece.iter().map(|p| p.distance(piece[0])).fold(0.0, f64::max);
    twice / 2.0 > depth * longest
}

/// A convex polygon cut to the left side of a line (Sutherland, Hodgman 1974).
fn left_of(piece: &[DVec2], p: DVec2, q: DVec2) -> Vec<DVec2> {
    let side = |x: DVec2| (q - p).perp_dot(x - p);
    let mut out = Vec::with_capacity(piece.len() + 1);
    for (i, &x) in piece.iter().enumerate() {
        let y = piece[(i + 1) % piece.len()];
        let (sx, sy) = (side(x), side(y));
        if sx >= 0.0 {
            out.push(x);
        }
        if (sx >= 0.0) != (sy >= 0.0) {
            out.push(x.lerp(y, sx / (sx - sy)));
        }
    }
    out
}
