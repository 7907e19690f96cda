//! Makes segments meet only in vertices. In: facets and the segments that cut them. Out: for every edge or segment the
//! vertices on it; the same for all facets that have it, so cut meshes stay joined.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::SolidError;
use super::facets::{Edge, Facet, Facets, edge};
use super::meet::{Meetings, distance_to_segment};
use super::pool::Pool;
use crate::geometry::orientation::orientation;

#[derive(Default)]
pub struct Arrangement {
    /// Vertices strictly inside an edge, rising from its lesser end.
    inner: BTreeMap<Edge, Vec<u32>>,
    /// The cut facets with all their segments, borders included, before they are cut up.
    pub roots: BTreeMap<usize, BTreeSet<Edge>>,
}

/// Rounds of cutting after which the input is given up.
const ROUNDS: usize = 12;
/// Cuts of a round that may be more than those of the round before.
const FEW_CUTS: usize = 100;
/// Segments in one facet.
const MOST_SEGMENTS: usize = 40_000;

pub fn settle(facets: &mut Facets, meetings: &Meetings) -> Result<Arrangement, SolidError> {
    let mut arrangement = Arrangement::default();
    for (&number, segments) in &meetings.segments {
        let borders = facets.list[number].edges().map(|(a, b)| edge(a, b));
        let roots = segments.iter().copied().chain(borders).filter(|e| e[0] != e[1]).collect();
        arrangement.roots.insert(number, roots);
    }
    let mut unsettled: BTreeSet<usize> = arrangement.roots.keys().copied().collect();
    let mut last_cuts: Option<usize> = None;
    for _ in 0..ROUNDS {
        let mut cuts: BTreeSet<(Edge, u32)> = BTreeSet::new();
        for &number in &unsettled {
            let pieces = arrangement.pieces(number);
            if pieces.len() > MOST_SEGMENTS {
                return Err(SolidError::TooComplex);
            }
            find_cuts(&facets.list[number], &pieces, &mut facets.pool, &mut cuts);
        }
        // Segments that nearly lie on each other may be cut ever finer: each round then finds more than the one before.
        if last_cuts.is_some_and(|last| cuts.len() > FEW_CUTS.max(last)) {
            return Err(SolidError::NoCleanResult);
        }
        last_cuts = Some(cuts.len());
        let Some(changed) = arrangement.insert(&cuts, &facets.pool) else { return Ok(arrangement) };
        let shares = |roots: &BTreeSet<Edge>| changed.iter().any(|e| roots.contains(e));
        unsettled = arrangement.roots.iter().filter(|(_, roots)| shares(roots)).map(|(n, _)| *n).collect();
    }
    Err(SolidError::NoCleanResult)
}

impl Arrangement {
    /// Adds vertices to edges; the edges that changed, or `None` if none did.
    fn insert(&mut self, cuts: &BTreeSet<(Edge, u32)>, pool: &Pool) -> Option<BTreeSet<Edge>> {
        let mut changed = BTreeSet::new();
        for &(root, v) in cuts {
            if root.contains(&v) {
                continue;
            }
            let inner = self.inner.entry(root).or_default();
            if !inner.contains(&v) {
                inner.push(v);
                changed.insert(root);
            }
        }
        for root in &changed {
            let [a, b] = root.map(|v| pool.positions[v as usize]);
            let place = |v: u32| (b - a).dot(pool.positions[v as usize] - a);
            let inner = self.inner.get_mut(root).expect("it was changed");
            inner.sort_by(|&u, &v| place(u).total_cmp(&place(v)).then(u.cmp(&v)));
        }
        (!changed.is_empty()).then_some(changed)
    }

    /// The vertices along an edge from `a` to `b`, without `b`.
    pub fn along(&self, a: u32, b: u32) -> Vec<u32> {
        let inner = self.inner.get(&edge(a, b)).map(Vec::as_slice).unwrap_or_default();
        let mut out = vec![a];
        if a < b {
            out.extend(inner)
        } else {
            out.extend(inner.iter().rev())
        }
        out
    }

    /// The pieces of a facet's segments, with the segment each is cut from; a piece of several segments once.
    fn pieces(&self, number: usize) -> Vec<(Edge, Edge)> {
        let mut pieces: BTreeMap<Edge, Edge> = BTreeMap::new();
        for &root in &self.roots[&number] {
            let mut chain = self.along(root[0], root[1]);
            chain.push(root[1]);
            for w in chain.windows(2).filter(|w| w[0] != w[1]) {
                pieces.entry(edge(w[0], w[1])).or_insert(root);
            }
        }
        pieces.into_iter().collect()
    }

    /// The pieces of a facet's own edges, as often as they are run.
    pub fn border(&self, facet: &Facet) -> Vec<Edge> {
        let mut border = Vec::new();
        for (a, b) in facet.edges() {
            let mut chain = self.along(a, b);
            chain.push(b);
            border.extend(chain.windows(2).map(|w| edge(w[0], w[1])));
        }
        border
    }

    /// The edges of the finished arrangement in a facet.
    pub fn edges(&self, number: usize) -> Vec<Edge> {
        self.pieces(number).into_iter().map(|(piece, _)| piece).collect()
    }
}

/// Finds vertices that lie on pieces, and pieces that cross.
fn find_cuts(facet: &Facet, pieces: &[(Edge, Edge)], pool: &mut Pool, cuts: &mut BTreeSet<(Edge, u32)>) {
    let tolerance = pool.tolerance;
    let flat = |pool: &Pool, v: u32| (facet.flat)(pool.positions[v as usize]);
    let mut order: Vec<(DVec2, DVec2, usize)> = Vec::with_capacity(pieces.len());
    for (i, (piece, _)) in pieces.iter().enumerate() {
        let (a, b) = (flat(pool, piece[0]), flat(pool, piece[1]));
        order.push((a.min(b) - DVec2::splat(tolerance), a.max(b) + DVec2::splat(tolerance), i));
    }
    order.sort_by(|x, y| x.0.x.total_cmp(&y.0.x).then(x.2.cmp(&y.2)));
    for (rank, &(lo, hi, i)) in order.iter().enumerate() {
        for &(other_lo, other_hi, j) in &order[rank + 1..] {
            if other_lo.x > hi.x {
                break;
            }
            if other_lo.y <= hi.y && lo.y <= other_hi.y {
                cut_pair(facet, pieces[i], pieces[j], pool, cuts);
            }
        }
    }
}

fn cut_pair(facet: &Facet, a: (Edge, Edge), b: (Edge, Edge), pool: &mut Pool, cuts: &mut BTreeSet<(Edge, u32)>) {
    let mut touched = false;
    for (piece, root, other) in [(a.0, a.1, b.0), (b.0, b.1, a.0)] {
        let [from, to] = piece.map(|v| pool.positions[v as usize]);
        for v in other.into_iter().filter(|v| !piece.contains(v)) {
            if distance_to_segment(pool.positions[v as usize], from, to) <= pool.tolerance {
                cuts.insert((root, v));
                touched = true;
            }
        }
    }
    if touched || a.0.iter().any(|v| b.0.contains(v)) {
        return;
    }
    let [p, q] = a.0.map(|v| (facet.flat)(pool.positions[v as usize]));
    let [r, s] = b.0.map(|v| (facet.flat)(pool.positions[v as usize]));
    let apart = |a: DVec2, b: DVec2, c: DVec2, d: DVec2| orientation(a, b, c).is_gt() == orientation(a, b, d).is_gt();
    if apart(p, q, r, s) || apart(r, s, p, q) {
        return;
    }
    let (heights, along): (f64, f64) = ((q - p).perp_dot(r - p), (q - p).perp_dot(r - s));
    let [from, to]: [DVec3; 2] = b.0.map(|v| pool.positions[v as usize]);
    let crossing = pool.place(from + (to - from) * (heights / along).clamp(0.0, 1.0));
    cuts.insert((a.1, crossing));
    cuts.insert((b.1, crossing));
}
