//! Joining strips that share edges. In: counter-clockwise rings that meet bit for bit. Out: one polygon per connected
//! part, with holes, each starting with the first edge of its first ring that stayed on the outside.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geometry::polygon::signed_area;
use crate::geometry::{Polygon, Ring};

type Key = [u64; 2];

fn key(p: DVec2) -> Key {
    (p + DVec2::ZERO).to_array().map(f64::to_bits)
}

/// The loops of one strip: around it, and around parts it does not cover.
pub type Loops<'a> = Vec<&'a [DVec2]>;

/// The union of the strips.
pub fn joined(strips: &[Loops]) -> Vec<Polygon> {
    let mut parts: Vec<Vec<&[DVec2]>> = Vec::new();
    for strip in strips {
        // The loops of all earlier parts this one touches along an edge.
        let (mut touching, apart): (Vec<_>, Vec<_>) = parts.into_iter().partition(|part| shares_edge(part, strip));
        parts = apart;
        let mut merged: Vec<&[DVec2]> = touching.drain(..).flatten().collect();
        merged.extend(strip);
        parts.push(merged);
    }
    parts.iter().flat_map(|part| outline(part)).collect()
}

/// The polygon with its outline started at the edge nearest to the first edge of `first`.
pub fn starting_near(mut polygon: Polygon, first: &Polygon) -> Polygon {
    let [a, b, ..] = first.outer[..] else { return polygon };
    let along = b - a;
    let distance = |p: DVec2| {
        let length = along.length_squared();
        let share = if length > 0.0 { ((p - a).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(a + along * share)
    };
    let mut best = (0, f64::INFINITY);
    for (i, (p, q)) in edges(&polygon.outer).enumerate() {
        let d = distance((p + q) / 2.0);
        if d < best.1 - 1e-9 * along.length() {
            best = (i, d);
        }
    }
    polygon.outer.rotate_left(best.0);
    polygon
}

/// The polygon with its outline started at its first edge on one of these segments, tried in order and run the same way.
pub fn starting_on(mut polygon: Polygon, segments: impl Iterator<Item = (DVec2, DVec2)>) -> Polygon {
    for (a, b) in segments {
        let along = b - a;
        let near = 1e-7 * along.length();
        let off = |p: DVec2| (p - a).perp_dot(along).abs() > near * along.length();
        let within =
            |p: DVec2| (p - a).dot(along) >= -near * along.length() && (p - b).dot(along) <= near * along.length();
        let on = |&(p, q): &(DVec2, DVec2)| {
            !off(p) && !off(q) && within(p) && within(q) && (q - p).dot(along) > near * along.length()
        };
        let place = edges(&polygon.outer).position(|edge| on(&edge));
        if let Some(place) = place {
            polygon.outer.rotate_left(place);
            return polygon;
        }
    }
    polygon
}

pub fn edges<'a>(ring: &'a [DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + 'a {
    (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()]))
}

fn shares_edge(part: &[&[DVec2]], strip: &[&[DVec2]]) -> bool {
    let own = || strip.iter().flat_map(|ring| edges(ring));
    part.iter().any(|other| own().any(|(a, b)| edges(other).any(|(c, d)| a == d && b == c)))
}

/// The edges that are not run both ways, chained into loops.
fn outline(rings: &[&[DVec2]]) -> Vec<Polygon> {
    if let [ring] = rings {
        return vec![Polygon { outer: ring.to_vec(), holes: Vec::new() }];
    }
    let mut left: Vec<(DVec2, DVec2)> = Vec::new();
    let mut count: BTreeMap<(Key, Key), usize> = BTreeMap::new();
    for (a, b) in rings.iter().flat_map(|ring| edges(ring)) {
        *count.entry((key(a), key(b))).or_default() += 1;
        left.push((a, b));
    }
    left.retain(|(a, b)| a != b && !count.contains_key(&(key(*b), key(*a))));
    let mut from: BTreeMap<Key, Vec<usize>> = BTreeMap::new();
    for (i, (a, _)) in left.iter().enumerate() {
        from.entry(key(*a)).or_default().push(i);
    }
    let mut used = vec![false; left.len()];
    let mut loops: Vec<Ring> = Vec::new();
    for start in 0..left.len() {
        if let Some(ring) = trace(start, &left, &from, &mut used) {
            loops.push(ring);
        }
    }
    with_holes(loops)
}

/// Follows edges from one until it closes; where several go on, the sharpest right turn keeps loops apart.
fn trace(start: usize, edges: &[(DVec2, DVec2)], from: &BTreeMap<Key, Vec<usize>>, used: &mut [bool]) -> Option<Ring> {
    let mut ring = Ring::new();
    let mut at = start;
    while !used[at] {
        used[at] = true;
        let (a, b) = edges[at];
        ring.push(a);
        let along = b - a;
        let turn = |i: &usize| {
            let next = edges[*i].1 - edges[*i].0;
            libm::atan2(along.perp_dot(next), along.dot(next))
        };
        let open = from.get(&key(b))?.iter().filter(|i| !used[**i] || **i == start);
        at = *open.min_by(|i, j| turn(i).total_cmp(&turn(j)))?;
    }
    (at == start && ring.len() >= 3).then_some(ring)
}

/// Counter-clockwise loops are outlines; the others are holes of the outline around them.
fn with_holes(loops: Vec<Ring>) -> Vec<Polygon> {
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = loops.into_iter().partition(|ring| signed_area(ring) > 0.0);
    let mut out: Vec<Polygon> = outer.into_iter().map(|outer| Polygon { outer, holes: Vec::new() }).collect();
    for hole in holes {
        let inside = |p: &&mut Polygon| hole.iter().any(|q| crate::geometry::polygon::ring_contains(&p.outer, *q));
        let smallest =
            out.iter_mut().filter(inside).min_by(|a, b| signed_area(&a.outer).total_cmp(&signed_area(&b.outer)));
        if let Some(polygon) = smallest {
            polygon.holes.push(hole);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn four_strips_make_a_ring_with_a_hole() {
        let (o, i) =
            ([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)], [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)]);
        let strips: Vec<Ring> = (0..4).map(|k| ring(&[o[k], o[(k + 1) % 4], i[(k + 1) % 4], i[k]])).collect();
        let all: Vec<Loops> = strips.iter().map(|s| vec![s.as_slice()]).collect();
        let whole = joined(&all);
        assert_eq!(whole.len(), 1);
        assert_eq!((whole[0].area(), whole[0].holes.len()), (12.0, 1));
        assert_eq!(whole[0].outer[..2], strips[0][..2]);
        let opposite = joined(&[all[0].clone(), all[2].clone()]);
        assert_eq!(opposite.iter().map(Polygon::area).collect::<Vec<_>>(), [3.0, 3.0]);
        assert_eq!(joined(&all[..3]).iter().map(Polygon::area).collect::<Vec<_>>(), [9.0]);
    }
}
