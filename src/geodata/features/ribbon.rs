//! Roads and brooks as surfaces. In: centre lines and widths. Out: polygons with mitred or bevelled corners.
//!
//! A ribbon is the union of one rectangle per segment, one wedge per corner and a half disc per round cap, so that no
//! bend is too sharp for it. Ribbons that meet at a junction get round caps there and so overlap without a notch.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geometry::Polygon;
use crate::geometry::boolean::{BooleanError, union};
use crate::geometry::repair::{Options, repair};

/// How a ribbon ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cap {
    Flat,
    Round,
}

/// A corner whose mitre would reach further than this many half widths is bevelled (SVG's default is 4).
const MITRE_LIMIT: f64 = 2.0;

/// Corners of a half disc: chord error 2 % of the radius.
const CAP_SEGMENTS: usize = 8;

/// The ribbon of one line; a closed line has no ends and its caps do not matter. Empty for a line without length.
/// Corners of pieces fall together but for rounding: repair makes one of each.
pub fn ribbon(line: &[DVec2], width: f64, caps: [Cap; 2]) -> Result<Vec<Polygon>, BooleanError> {
    let united = union(&pieces(line, width, caps), &[])?;
    let clean = |p: Polygon| repair(&[vec![p.outer], p.holes].concat(), &Options::default()).polygons;
    Ok(united.into_iter().flat_map(clean).collect())
}

/// The ribbon as overlapping convex polygons, counter-clockwise: for a caller that unites many ribbons at once.
pub fn pieces(line: &[DVec2], width: f64, caps: [Cap; 2]) -> Vec<Polygon> {
    let half = width / 2.0;
    let mut points = line.to_vec();
    points.dedup();
    if points.len() < 2 || half.is_nan() || half <= 0.0 {
        return Vec::new();
    }
    let closed = points.len() > 3 && points.first() == points.last();
    let normals: Vec<DVec2> = points.windows(2).map(|w| (w[1] - w[0]).normalize().perp() * half).collect();
    let mut out = Vec::new();
    for (w, n) in points.windows(2).zip(&normals) {
        push(&mut out, vec![w[0] - *n, w[1] - *n, w[1] + *n, w[0] + *n]);
    }
    for (i, n) in normals.windows(2).enumerate() {
        push(&mut out, corner(points[i + 1], n[0], n[1]));
    }
    let (first, last) = (normals[0], normals[normals.len() - 1]);
    if closed {
        push(&mut out, corner(points[0], last, first));
    } else {
        if caps[0] == Cap::Round {
            push(&mut out, half_disc(points[0], first));
        }
        if caps[1] == Cap::Round {
            push(&mut out, half_disc(points[points.len() - 1], -last));
        }
    }
    out
}

fn push(out: &mut Vec<Polygon>, outer: Vec<DVec2>) {
    if outer.len() > 2 {
        out.push(Polygon { outer, holes: Vec::new() });
    }
}

/// The wedge between two segments at their common point; `a` and `b` are their left normals of half a width.
fn corner(at: DVec2, a: DVec2, b: DVec2) -> Vec<DVec2> {
    let turn = a.perp_dot(b);
    // The wedge lies on the outer side of the bend; (from, to) goes counter-clockwise round it.
    let (from, to) = if turn > 0.0 { (-a, -b) } else { (b, a) };
    let radius = a.length();
    let middle = a + b;
    let sum = middle.length_squared();
    if turn == 0.0 && a.dot(b) > 0.0 {
        return Vec::new();
    }
    // The tip lies on the bisector at distance r / cos(half the turn) = 2 r^2 / |a + b|.
    let reach = 2.0 * radius * radius / sum.sqrt();
    if reach <= MITRE_LIMIT * radius {
        let tip = (from + to) * (2.0 * radius * radius / sum);
        vec![at, at + from, at + tip, at + to]
    } else {
        vec![at, at + from, at + to]
    }
}

/// The half disc behind a start point whose left normal is `normal`.
fn half_disc(at: DVec2, normal: DVec2) -> Vec<DVec2> {
    (0..=CAP_SEGMENTS)
        .map(|i| {
            let angle = std::f64::consts::PI * i as f64 / CAP_SEGMENTS as f64;
            let (sin, cos) = libm::sincos(angle);
            at + DVec2::new(cos, sin).rotate(normal)
        })
        .collect()
}

/// The caps of each line: round where an end lies on another line's point, or on a point that its own line passes again.
pub fn caps(lines: &[&[DVec2]]) -> Vec<[Cap; 2]> {
    let key = |p: DVec2| (p.x.to_bits(), p.y.to_bits());
    let mut visits: BTreeMap<(u64, u64), usize> = BTreeMap::new();
    for point in lines.iter().flat_map(|line| line.iter()) {
        *visits.entry(key(*point)).or_default() += 1;
    }
    let cap = |point: Option<&DVec2>| match point {
        Some(&p) if visits[&key(p)] > 1 => Cap::Round,
        _ => Cap::Flat,
    };
    lines.iter().map(|line| [cap(line.first()), cap(line.last())]).collect()
}
