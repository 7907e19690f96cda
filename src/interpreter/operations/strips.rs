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

/// The union of the rings.
pub fn joined(rings: &[&[DVec2]]) -> Vec<Polygon> {
    let mut parts: Vec<Vec<&[DVec2]>> = Vec::new();
    for ring in rings {
        // The rings of all earlier parts this one touches along an edge.
        let (mut touching, apart): (Vec<_>, Vec<_>) = parts.into_iter().partition(|part| shares_edge(part, ring));
        parts = apart;
        let mut merged: Vec<&[DVec2]> = touching.drain(..).flatten().collect();
        merged.push(ring);
        parts.push(merged);
    }
    parts.iter().flat_map(|part| outline(part)).collect()
}

fn edges<'a>(ring: &'a [DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + 'a {
    (0..ring.len()).map(move |i| (ring[i], ring[(i + 1) % ring.len()]))
}

fn shares_edge(part: &[&[DVec2]], ring: &[DVec2]) -> bool {
    part.iter().any(|other| edges(ring).any(|(a, b)| edges(other).any(|(c, d)| a == d && b == c)))
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
        let all: Vec<&[DVec2]> = strips.iter().map(Vec::as_slice).collect();
        let whole = joined(&all);
        assert_eq!(whole.len(), 1);
        assert_eq!((whole[0].area(), whole[0].holes.len()), (12.0, 1));
        assert_eq!(whole[0].outer[..2], strips[0][..2]);
        let opposite = joined(&[all[0], all[2]]);
        assert_eq!(opposite.iter().map(Polygon::area).collect::<Vec<_>>(), [3.0, 3.0]);
        assert_eq!(joined(&all[..3]).iter().map(Polygon::area).collect::<Vec<_>>(), [9.0]);
    }
}
