//! Takes out vertices that the combination put on edges but that nothing turns at. In: outlines. Out: the same areas,
//! the same joints, fewer vertices. Corners that faces had before stay.

use std::collections::{BTreeMap, BTreeSet};

use super::assemble::Outline;
use super::facets::Facets;
use super::meet::distance_to_segment;

pub fn straighten(facets: &Facets, outlines: &mut [Outline]) {
    let mut corners: BTreeSet<(u8, u32)> = BTreeSet::new();
    for facet in &facets.list {
        corners.extend(facet.loops.iter().flatten().map(|&v| (facet.operand, v)));
    }
    let mut neighbours: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    let mut needed: BTreeSet<u32> = BTreeSet::new();
    for outline in outlines.iter() {
        let operand = facets.list[outline.facet].operand;
        for ring in &outline.loops {
            for (i, &v) in ring.iter().enumerate() {
                let n = ring.len();
                neighbours.entry(v).or_default().extend([ring[(i + n - 1) % n], ring[(i + 1) % n]]);
                if corners.contains(&(operand, v)) {
                    needed.insert(v);
                }
            }
        }
    }
    let mut gone: BTreeSet<u32> = BTreeSet::new();
    let candidates: Vec<u32> = neighbours.keys().copied().filter(|v| !needed.contains(v)).collect();
    for v in candidates {
        let Some((x, y)) = ends(&neighbours[&v]) else { continue };
        let [p, a, b] = [v, x, y].map(|v| facets.position(v));
        let between = (p - a).dot(b - p) > 0.0;
        if between && distance_to_segment(p, a, b) <= 2.0 * facets.pool.tolerance {
            gone.insert(v);
            for (end, other) in [(x, y), (y, x)] {
                let near = neighbours.get_mut(&end).expect("neighbours know each other");
                near.remove(&v);
                near.insert(other);
            }
        }
    }
    for ring in outlines.iter_mut().flat_map(|o| &mut o.loops) {
        ring.retain(|v| !gone.contains(v));
    }
}

fn ends(neighbours: &BTreeSet<u32>) -> Option<(u32, u32)> {
    let mut list = neighbours.iter();
    match (list.next(), list.next(), list.next()) {
        (Some(&a), Some(&b), None) => Some((a, b)),
        _ => None,
    }
}
