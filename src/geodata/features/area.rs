//! The area of a scene. In: a box or polygon in degrees. Out: its ring in the local frame, and lines cut to it.

use glam::DVec2;

use crate::geodata::osm::LonLatBox;
use crate::geometry::Ring;
use crate::geometry::polygon::{ring_contains, signed_area};

/// What belongs to the scene, degrees (longitude, latitude).
#[derive(Clone, Debug, PartialEq)]
pub enum Area {
    Box(LonLatBox),
    /// A closed ring without a repeated last point; any direction.
    Polygon(Vec<(f64, f64)>),
}

impl Area {
    /// The least box around the area; an empty polygon gives `None`.
    pub fn bounds(&self) -> Option<LonLatBox> {
        match self {
            Area::Box(b) => Some(*b),
            Area::Polygon(ring) => LonLatBox::around(ring.iter().copied()),
        }
    }

    /// Corners in the local frame, counter-clockwise.
    pub fn ring(&self, project: &dyn Fn(f64, f64) -> DVec2) -> Ring {
        let mut ring: Ring = match self {
            Area::Box(b) => [(b.west, b.south), (b.east, b.south), (b.east, b.north), (b.west, b.north)]
                .iter()
                .map(|&(lon, lat)| project(lon, lat))
                .collect(),
            Area::Polygon(ring) => ring.iter().map(|&(lon, lat)| project(lon, lat)).collect(),
        };
        if signed_area(&ring) < 0.0 {
            ring.reverse();
        }
        ring
    }
}

/// Cuts a line to a polygon: the pieces inside, in order, each of at least two points. Points keep their coordinates
/// bit for bit, cuts lie on the border.
pub fn clip_line(line: &[DVec2], ring: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut pieces: Vec<Vec<DVec2>> = Vec::new();
    let mut open = false;
    for w in line.windows(2) {
        let (a, b) = (w[0], w[1]);
        let mut cuts: Vec<f64> = (0..ring.len())
            .filter_map(|i| crossing(a, b, ring[i], ring[(i + 1) % ring.len()]))
            .chain([0.0, 1.0])
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        for t in cuts.windows(2) {
            let inside = ring_contains(ring, a.lerp(b, (t[0] + t[1]) / 2.0));
            let at = |t: f64| {
                if t == 0.0 {
                    a
                } else if t == 1.0 {
                    b
                } else {
                    a.lerp(b, t)
                }
            };
            match (inside, open, pieces.last_mut()) {
                (true, true, Some(piece)) => piece.push(at(t[1])),
                (true, ..) => pieces.push(vec![at(t[0]), at(t[1])]),
                (false, ..) => {}
            }
            open = inside;
        }
    }
    pieces
}

/// Where segment ab crosses edge cd, as a share of ab.
fn crossing(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<f64> {
    let (ab, cd, ac) = (b - a, d - c, c - a);
    let cross = ab.perp_dot(cd);
    if cross == 0.0 {
        return None;
    }
    let (t, u) = (ac.perp_dot(cd) / cross, ac.perp_dot(ab) / cross);
    ((0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Ring {
        [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(|(x, y)| DVec2::new(x, y)).to_vec()
    }

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    #[test]
    fn a_line_through_the_area_is_cut_at_both_borders() {
        let pieces = clip_line(&line(&[(-5.0, 5.0), (3.0, 5.0), (15.0, 5.0)]), &square());
        assert_eq!(pieces, vec![line(&[(0.0, 5.0), (3.0, 5.0), (10.0, 5.0)])]);
    }

    #[test]
    fn a_line_that_leaves_and_returns_falls_into_pieces() {
        let pieces = clip_line(&line(&[(2.0, 2.0), (2.0, 20.0), (8.0, 20.0), (8.0, 2.0)]), &square());
        assert_eq!(pieces, vec![line(&[(2.0, 2.0), (2.0, 10.0)]), line(&[(8.0, 10.0), (8.0, 2.0)])]);
    }

    #[test]
    fn outside_is_nothing_and_inside_is_untouched() {
        assert!(clip_line(&line(&[(20.0, 0.0), (20.0, 9.0)]), &square()).is_empty());
        let inside = line(&[(1.0, 1.0), (2.5, 7.25), (9.0, 9.0)]);
        assert_eq!(clip_line(&inside, &square()), vec![inside]);
    }
}
