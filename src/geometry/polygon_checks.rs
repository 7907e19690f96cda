//! Defects of plan polygons. In: a polygon. Out: every case of one defect, by the function of its name.
//!
//! All decisions are exact. A polygon with none of these defects but touching edges is ready for every algorithm here.

use std::cmp::Ordering;

use glam::DVec2;

use super::Polygon;
use super::orientation::orientation;
use super::polygon::{ring_contains, signed_area};

/// A corner: ring (0 = outer, then the holes) and index in it. An edge goes by the name of its first corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Corner {
    pub ring: usize,
    pub index: usize,
}

/// Corners with a coordinate that is not finite. The checks below need this one to find nothing.
pub fn non_finite_points(polygon: &Polygon) -> Vec<Corner> {
    corners(polygon).filter(|(_, p)| !p.is_finite()).map(|(c, _)| c).collect()
}

/// Rings with fewer than three points.
pub fn rings_too_short(polygon: &Polygon) -> Vec<usize> {
    polygon.rings().enumerate().filter(|(_, r)| r.len() < 3).map(|(i, _)| i).collect()
}

/// Corners equal to the corner before them.
pub fn doubled_points(polygon: &Polygon) -> Vec<Corner> {
    let mut found = Vec::new();
    for (ring, points) in polygon.rings().enumerate() {
        let n = points.len();
        found.extend(
            (0..n).filter(|&i| n > 1 && points[i] == points[(i + n - 1) % n]).map(|index| Corner { ring, index }),
        );
    }
    found
}

/// Pairs of edges that cross or lie on each other over a length (also neighbours that double back).
pub fn crossing_edges(polygon: &Polygon) -> Vec<(Corner, Corner)> {
    contacts(polygon).filter(|(_, contact)| *contact == Contact::Crossing).map(|(pair, _)| pair).collect()
}

/// Pairs of edges, not neighbours, that have a single point in common which is an end of at least one.
pub fn touching_edges(polygon: &Polygon) -> Vec<(Corner, Corner)> {
    contacts(polygon).filter(|(_, contact)| *contact == Contact::Touching).map(|(pair, _)| pair).collect()
}

/// Rings that run the wrong way: a clockwise outline, a counter-clockwise hole.
pub fn reversed_rings(polygon: &Polygon) -> Vec<usize> {
    let wrong = |(i, r): &(usize, &Vec<DVec2>)| if *i == 0 { signed_area(r) < 0.0 } else { signed_area(r) > 0.0 };
    polygon.rings().enumerate().filter(wrong).map(|(i, _)| i).collect()
}

/// Holes (0 = the first) that do not lie inside the outline; decided at one corner, for rings that do not cross.
pub fn holes_outside(polygon: &Polygon) -> Vec<usize> {
    (0..polygon.holes.len()).filter(|&i| !ring_inside(&polygon.holes[i], &polygon.outer)).collect()
}

/// Pairs of holes (inner, outer) one of which lies inside the other, for rings that do not cross.
pub fn nested_holes(polygon: &Polygon) -> Vec<(usize, usize)> {
    let holes = &polygon.holes;
    let pairs = (0..holes.len()).flat_map(|i| (0..holes.len()).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| i != j && ring_inside(&holes[i], &holes[j])).collect()
}

/// No defect at all, not even touching edges.
pub(super) fn is_strictly_valid(polygon: &Polygon) -> bool {
    polygon.rings().all(|r| r.len() >= 3)
        && contacts(polygon).next().is_none()
        && reversed_rings(polygon).is_empty()
        && holes_outside(polygon).is_empty()
        && nested_holes(polygon).is_empty()
}

/// Whether a ring that does not cross `outline` lies inside it: by the first corner that is not on it.
fn ring_inside(ring: &[DVec2], outline: &[DVec2]) -> bool {
    let free = ring.iter().find(|&&p| !on_ring(outline, p));
    free.is_some_and(|&p| ring_contains(outline, p))
}

fn on_ring(ring: &[DVec2], p: DVec2) -> bool {
    (0..ring.len()).any(|i| on_segment(ring[i], ring[(i + 1) % ring.len()], p))
}

fn on_segment(a: DVec2, b: DVec2, p: DVec2) -> bool {
    a.min(b).cmple(p).all() && p.cmple(a.max(b)).all() && orientation(a, b, p) == Ordering::Equal
}

fn corners(polygon: &Polygon) -> impl Iterator<Item = (Corner, DVec2)> + '_ {
    let of_ring = |(ring, points): (usize, &'_ Vec<DVec2>)| -> Vec<(Corner, DVec2)> {
        points.iter().enumerate().map(|(index, &p)| (Corner { ring, index }, p)).collect()
    };
    polygon.rings().enumerate().flat_map(of_ring)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Contact {
    Crossing,
    Touching,
}

struct Edge {
    from: Corner,
    to: Corner,
    a: DVec2,
    b: DVec2,
}

/// All contacts of edges. Candidates come from a sweep over x: edges in order of their least x, each against those
/// that start before it ends.
fn contacts(polygon: &Polygon) -> impl Iterator<Item = ((Corner, Corner), Contact)> {
    let mut edges = Vec::new();
    for (ring, points) in polygon.rings().enumerate() {
        for index in 0..points.len() {
            let next = (index + 1) % points.len();
            let (from, to) = (Corner { ring, index }, Corner { ring, index: next });
            edges.push(Edge { from, to, a: points[index], b: points[next] });
        }
    }
    edges.sort_by(|e, f| e.a.x.min(e.b.x).total_cmp(&f.a.x.min(f.b.x)).then(e.from.cmp(&f.from)));
    let (mut i, mut j) = (0, 0);
    std::iter::from_fn(move || {
        while i < edges.len() {
            j += 1;
            if j >= edges.len() || edges[j].a.x.min(edges[j].b.x) > edges[i].a.x.max(edges[i].b.x) {
                i += 1;
                j = i;
                continue;
            }
            let (e, f) = (&edges[i], &edges[j]);
            if let Some(contact) = contact(e, f) {
                return Some(((e.from.min(f.from), e.from.max(f.from)), contact));
            }
        }
        None
    })
}

fn contact(e: &Edge, f: &Edge) -> Option<Contact> {
    if e.a.y.max(e.b.y) < f.a.y.min(f.b.y) || f.a.y.max(f.b.y) < e.a.y.min(e.b.y) {
        return None;
    }
    if e.to == f.from {
        return doubles_back(e.a, e.b, f.b).then_some(Contact::Crossing);
    }
    if f.to == e.from {
        return doubles_back(f.a, f.b, e.b).then_some(Contact::Crossing);
    }
    let (sa, sb) = (orientation(f.a, f.b, e.a), orientation(f.a, f.b, e.b));
    let (ta, tb) = (orientation(e.a, e.b, f.a), orientation(e.a, e.b, f.b));
    if [sa, sb, ta, tb] == [Ordering::Equal; 4] {
        let axis = if (e.b - e.a).abs().x >= (e.b - e.a).abs().y { DVec2::X } else { DVec2::Y };
        let span = |g: &Edge| (g.a.dot(axis).min(g.b.dot(axis)), g.a.dot(axis).max(g.b.dot(axis)));
        let ((lo, hi), (low, high)) = (span(e), span(f));
        return match lo.max(low).total_cmp(&hi.min(high)) {
            Ordering::Less => Some(Contact::Crossing),
            Ordering::Equal => Some(Contact::Touching),
            Ordering::Greater => None,
        };
    }
    let apart = |p: Ordering, q: Ordering| p == q && p != Ordering::Equal;
    if apart(sa, sb) || apart(ta, tb) {
        return None;
    }
    let ends = [sa, sb, ta, tb].contains(&Ordering::Equal);
    Some(if ends { Contact::Touching } else { Contact::Crossing })
}

/// Whether a-b-c turns straight back at b.
fn doubles_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    orientation(a, b, c) == Ordering::Equal && (b - a).dot(c - b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    /// A square of 20 with two square holes.
    fn sound() -> Polygon {
        let hole = |x: f64| ring(&[(x, 5.0), (x, 10.0), (x + 5.0, 10.0), (x + 5.0, 5.0)]);
        Polygon {
            outer: ring(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)]),
            holes: vec![hole(2.0), hole(12.0)],
        }
    }

    /// Number of findings of every check, in order.
    fn findings(p: &Polygon) -> [usize; 7] {
        [
            rings_too_short(p).len(),
            doubled_points(p).len(),
            crossing_edges(p).len(),
            touching_edges(p).len(),
            reversed_rings(p).len(),
            holes_outside(p).len(),
            nested_holes(p).len(),
        ]
    }

    fn at(ring: usize, index: usize) -> Corner {
        Corner { ring, index }
    }

    #[test]
    fn a_sound_polygon_has_no_defect() {
        assert!(non_finite_points(&sound()).is_empty());
        assert_eq!(findings(&sound()), [0; 7]);
        assert!(is_strictly_valid(&sound()));
    }

    #[test]
    fn a_nan_is_named() {
        let mut p = sound();
        p.holes[1][3].y = f64::NAN;
        assert_eq!(non_finite_points(&p), [at(2, 3)]);
    }

    #[test]
    fn a_short_ring_is_named() {
        let mut p = sound();
        p.holes[0].truncate(2);
        p.holes[0][1].x += 1.0;
        assert_eq!(rings_too_short(&p), [1]);
    }

    #[test]
    fn a_doubled_point_is_named() {
        let mut p = sound();
        p.outer.push(p.outer[0]);
        assert_eq!(doubled_points(&p), [at(0, 0)]);
    }

    #[test]
    fn crossings_overlaps_and_spikes_are_named() {
        let mut p = sound();
        p.holes[0][0].y = -1.0;
        assert_eq!(crossing_edges(&p), [(at(0, 0), at(1, 0)), (at(0, 0), at(1, 3))]);
        assert_eq!(findings(&p), [0, 0, 2, 0, 0, 1, 0]);
        let mut p = sound();
        p.holes[1] = ring(&[(7.0, 6.0), (7.0, 9.0), (9.0, 9.0), (9.0, 6.0)]);
        assert_eq!(findings(&p), [0, 0, 1, 2, 0, 0, 0]);
        let mut p = sound();
        p.outer.insert(1, DVec2::new(25.0, 0.0));
        assert_eq!(crossing_edges(&p), [(at(0, 0), at(0, 1))]);
    }

    #[test]
    fn touching_corners_are_named() {
        let mut p = sound();
        p.holes[0][0] = DVec2::new(2.0, 0.0);
        assert_eq!(touching_edges(&p), [(at(0, 0), at(1, 0)), (at(0, 0), at(1, 3))]);
        assert_eq!(findings(&p), [0, 0, 0, 2, 0, 0, 0]);
        assert!(!is_strictly_valid(&p));
    }

    #[test]
    fn reversed_rings_are_named() {
        let mut p = sound();
        p.outer.reverse();
        p.holes[1].reverse();
        assert_eq!(reversed_rings(&p), [0, 2]);
        assert_eq!(findings(&p), [0, 0, 0, 0, 2, 0, 0]);
    }

    #[test]
    fn misplaced_holes_are_named() {
        let mut p = sound();
        p.holes[1].iter_mut().for_each(|q| q.x += 20.0);
        assert_eq!(holes_outside(&p), [1]);
        assert_eq!(findings(&p), [0, 0, 0, 0, 0, 1, 0]);
        let mut p = sound();
        p.holes[1] = ring(&[(3.0, 6.0), (3.0, 7.0), (4.0, 7.0), (4.0, 6.0)]);
        assert_eq!(nested_holes(&p), [(1, 0)]);
        assert_eq!(findings(&p), [0, 0, 0, 0, 0, 0, 1]);
    }
}
