//! Cutting a polygon into convex parts. In: a polygon with holes. Out: rings over its corners.
//!
//! A triangulation without the diagonals it can do without (Hertel, Mehlhorn 1983): at most four times as many parts as
//! needed. Long diagonals are taken out first. No corners are added.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use glam::DVec2;

use super::orientation::orientation;
use super::polygon::{Polygon, Ring};
use super::triangulate::triangulate_polygon;

/// Whether a polygon has no hole and turns right nowhere; straight corners do not count.
pub fn is_convex(polygon: &Polygon) -> bool {
    let ring = &polygon.outer;
    let n = ring.len();
    let bend = |i: usize| orientation(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]);
    polygon.holes.is_empty() && (0..n).all(|i| bend(i) != Ordering::Less)
}

/// Groups of convex rings, counter-clockwise. Without `longest` every group is one ring; with it, rings are in one group
/// where a cut between them would be at least that long (metres). Empty if the polygon cannot be triangulated.
pub fn convex_parts(polygon: &Polygon, longest: Option<f64>) -> Vec<Vec<Ring>> {
    let points: Vec<DVec2> = polygon.rings().flatten().copied().collect();
    let mut parts = Parts::of(&points, triangulate_polygon(polygon));
    let mut cuts: Vec<(u32, u32)> = parts.owner.keys().copied().filter(|&(a, b)| a < b).collect();
    cuts.retain(|&(a, b)| parts.owner.contains_key(&(b, a)));
    let length = |&(a, b): &(u32, u32)| points[a as usize].distance(points[b as usize]);
    cuts.sort_by(|a, b| length(b).total_cmp(&length(a)));
    cuts.retain(|&(a, b)| !parts.join(a, b));
    let mut group: Vec<usize> = (0..parts.rings.len()).collect();
    fn leader(group: &[usize], mut i: usize) -> usize {
        while group[i] != i {
            i = group[i];
        }
        i
    }
    for &(a, b) in cuts.iter().filter(|cut| longest.is_some_and(|most| length(cut) >= most)) {
        let (p, q) = (leader(&group, parts.owner[&(a, b)]), leader(&group, parts.owner[&(b, a)]));
        group[p.max(q)] = p.min(q);
    }
    let mut out: BTreeMap<usize, Vec<Ring>> = BTreeMap::new();
    for (i, ring) in parts.rings.iter().enumerate().filter(|(_, ring)| !ring.is_empty()) {
        let ring = ring.iter().map(|&c| points[c as usize]).collect();
        out.entry(leader(&group, i)).or_default().push(ring);
    }
    out.into_values().collect()
}

struct Parts<'a> {
    points: &'a [DVec2],
    /// Corner numbers; empty where a part was joined to another.
    rings: Vec<Vec<u32>>,
    /// The part on the left of a directed edge.
    owner: BTreeMap<(u32, u32), usize>,
}

impl<'a> Parts<'a> {
    fn of(points: &'a [DVec2], triangles: Vec<[u32; 3]>) -> Parts<'a> {
        let mut owner = BTreeMap::new();
        for (i, &[a, b, c]) in triangles.iter().enumerate() {
            owner.extend([((a, b), i), ((b, c), i), ((c, a), i)]);
        }
        Parts { points, rings: triangles.into_iter().map(Vec::from).collect(), owner }
    }

    /// Takes the cut between two corners out if the parts on its sides make a convex one.
    fn join(&mut self, a: u32, b: u32) -> bool {
        let (p, q) = (self.owner[&(a, b)], self.owner[&(b, a)]);
        if p == q {
            return false;
        }
        // From b round to a, and from a round to b.
        let (left, right) = (starting_at(&self.rings[p], b), starting_at(&self.rings[q], a));
        let turns_left = |before: u32, at: u32, after: u32| {
            let [x, y, z] = [before, at, after].map(|c| self.points[c as usize]);
            before != after && orientation(x, y, z) != Ordering::Less
        };
        let convex = turns_left(left[left.len() - 2], a, right[1]) && turns_left(right[right.len() - 2], b, left[1]);
        if convex {
            let joined: Vec<u32> = left.iter().chain(&right[1..right.len() - 1]).copied().collect();
            for i in 0..joined.len() {
                self.owner.insert((joined[i], joined[(i + 1) % joined.len()]), p);
            }
            self.rings[q].clear();
            self.rings[p] = joined;
        }
        convex
    }
}

fn starting_at(ring: &[u32], corner: u32) -> Vec<u32> {
    let mut ring = ring.to_vec();
    if let Some(place) = ring.iter().position(|&c| c == corner) {
        ring.rotate_left(place);
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::signed_area;
    use proptest::prelude::*;

    fn ring(points: &[(f64, f64)]) -> Ring {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn an_l_falls_in_two() {
        let l = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)]);
        let polygon = Polygon { outer: l, holes: Vec::new() };
        assert!(!is_convex(&polygon));
        let parts = convex_parts(&polygon, None);
        assert_eq!(parts.len(), 2, "{parts:?}");
        // The only cuts from the inner corner are at least 4 long.
        assert_eq!(convex_parts(&polygon, Some(3.9)).iter().map(Vec::len).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn a_frame_falls_in_convex_parts() {
        let frame = Polygon {
            outer: ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)]),
            holes: vec![ring(&[(2.0, 2.0), (2.0, 4.0), (4.0, 4.0), (4.0, 2.0)])],
        };
        let parts = convex_parts(&frame, None);
        assert!(parts.len() <= 6, "{parts:?}");
        let sum: f64 = parts.iter().flatten().map(|r| signed_area(r)).sum();
        assert_eq!(sum, 32.0);
    }

    proptest! {
        #[test]
        fn parts_are_convex_and_fill_the_polygon(radii in prop::collection::vec(1.0..9.0f64, 3..30)) {
            let n = radii.len() as f64;
            let corner = |(i, r): (usize, &f64)| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
                DVec2::new(r * cos, r * sin)
            };
            let star = Polygon { outer: radii.iter().enumerate().map(corner).collect(), holes: Vec::new() };
            let parts = convex_parts(&star, None);
            let convex = |r: &Ring| is_convex(&Polygon { outer: r.clone(), holes: Vec::new() });
            prop_assert!(parts.iter().flatten().all(convex));
            let sum: f64 = parts.iter().flatten().map(|r| signed_area(r)).sum();
            prop_assert!((sum - star.area()).abs() < 1e-9 * sum);
        }
    }
}
