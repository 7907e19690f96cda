//! Where facets of the two operands meet. In: facets. Out: segments on both, and pairs that lie in one plane.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::facets::{Edge, Facet, Facets, edge};
use super::pool::Pool;
use crate::geometry::box_tree::BoxTree;

/// What was found; by facet number.
#[derive(Default)]
pub struct Meetings {
    /// Segments that cut the facet.
    pub segments: BTreeMap<usize, BTreeSet<Edge>>,
    /// Facets of the other operand in the same plane whose boxes touch.
    pub coplanar: BTreeMap<usize, Vec<usize>>,
    /// Components that meet, lesser number first.
    pub components: BTreeSet<(u32, u32)>,
}

pub fn all(facets: &mut Facets) -> Meetings {
    let mut meetings = Meetings::default();
    let second = facets.second;
    let tree = BoxTree::new(facets.list[second..].iter().map(|f| f.bounds).collect());
    for f in 0..second {
        for g in tree.touching(&facets.list[f].bounds) {
            let g = second + g;
            pair(facets, f, g, &mut meetings);
        }
    }
    meetings
}

fn pair(facets: &mut Facets, f: usize, g: usize, meetings: &mut Meetings) {
    let Facets { list, pool, .. } = facets;
    let (first, other) = (&list[f], &list[g]);
    let segments: Vec<Edge> = match (Stand::of(other, first, pool), Stand::of(first, other, pool)) {
        (Stand::Aside, _) | (_, Stand::Aside) => return,
        (Stand::Inside, _) | (_, Stand::Inside) => {
            meetings.coplanar.entry(f).or_default().push(g);
            meetings.coplanar.entry(g).or_default().push(f);
            first.edges().chain(other.edges()).map(|(a, b)| edge(a, b)).collect()
        }
        _ => common_segments(first, other, pool),
    };
    if segments.is_empty() {
        return;
    }
    let pair = (first.component.min(other.component), first.component.max(other.component));
    meetings.components.insert(pair);
    for number in [f, g] {
        meetings.segments.entry(number).or_default().extend(segments.iter().copied());
    }
}

/// How a facet stands to a plane.
enum Stand {
    Aside,
    Across,
    Inside,
}

impl Stand {
    fn of(facet: &Facet, plane: &Facet, pool: &Pool) -> Stand {
        let (mut below, mut above, mut on) = (false, false, false);
        for &v in facet.loops.iter().flatten() {
            let height = plane.height(pool.positions[v as usize]);
            if height.abs() <= pool.tolerance {
                on = true;
            } else if height > 0.0 {
                above = true;
            } else {
                below = true;
            }
        }
        match (below, above, on) {
            (false, false, _) => Stand::Inside,
            (true, false, false) | (false, true, false) => Stand::Aside,
            _ => Stand::Across,
        }
    }
}

/// The stretches of the planes' common line that lie in both facets, borders included.
fn common_segments(f: &Facet, g: &Facet, pool: &mut Pool) -> Vec<Edge> {
    let Some(along) = f.normal.cross(g.normal).try_normalize() else { return Vec::new() };
    let mut points = crossings(f, g, pool);
    points.extend(crossings(g, f, pool));
    let place = |v: u32| along.dot(pool.positions[v as usize]);
    points.sort_by(|&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
    points.dedup();
    let in_both = |w: &&[u32]| {
        let middle = (pool.positions[w[0] as usize] + pool.positions[w[1] as usize]) / 2.0;
        holds(f, pool, middle) && holds(g, pool, middle)
    };
    points.windows(2).filter(in_both).filter(|w| w[0] != w[1]).map(|w| edge(w[0], w[1])).collect()
}

/// Vertices of the facet on the plane of another, and where its edges cross that plane.
fn crossings(facet: &Facet, plane: &Facet, pool: &mut Pool) -> Vec<u32> {
    let mut out = Vec::new();
    for (u, v) in facet.edges() {
        // The same bits for both facets on an edge.
        let [a, b] = edge(u, v);
        let (p, q) = (pool.positions[a as usize], pool.positions[b as usize]);
        let (dp, dq) = (plane.height(p), plane.height(q));
        let on = |d: f64| d.abs() <= pool.tolerance;
        if on(dp) {
            out.push(a);
        }
        if on(dq) {
            out.push(b);
        }
        if !on(dp) && !on(dq) && (dp > 0.0) != (dq > 0.0) {
            out.push(pool.place(p + (q - p) * (dp / (dp - dq))));
        }
    }
    out
}

/// Whether a point of the facet's plane lies inside it or on its border.
fn holds(facet: &Facet, pool: &Pool, p: DVec3) -> bool {
    let at = |v: u32| pool.positions[v as usize];
    let on_border = |(a, b): (u32, u32)| distance_to_segment(p, at(a), at(b)) <= 2.0 * pool.tolerance;
    let flat: DVec2 = (facet.flat)(p);
    facet.contains(&pool.positions, flat) || facet.edges().any(on_border)
}

pub fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = (p - a).dot(along) / along.length_squared();
    p.distance(a + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 })
}
