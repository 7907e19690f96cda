//! In: polygons in the plan. Out: their borders inside the area's box, as lattice segments that follow the terrain.

use glam::DVec2;

use super::GroundError;
use super::lattice::{MAX_COORDINATE_M, Segment, metres, segment, snap};
use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;

/// Collects borders.
pub(super) struct Borders<'a> {
    lo: DVec2,
    hi: DVec2,
    terrain: &'a Terrain,
    tolerance_m: f64,
    /// Straight pieces, before bending.
    straight: Vec<Segment>,
}

impl<'a> Borders<'a> {
    /// `tolerance_m`: greatest vertical distance between the terrain and a straight piece.
    pub(super) fn new(lo: DVec2, hi: DVec2, terrain: &'a Terrain, tolerance_m: f64) -> Self {
        Borders { lo, hi, terrain, tolerance_m, straight: Vec::new() }
    }

    /// Adds all rings of a polygon.
    pub(super) fn add_polygon(&mut self, polygon: &Polygon) -> Result<(), GroundError> {
        for ring in polygon.rings() {
            if ring.iter().any(|p| !p.is_finite() || p.abs().max_element() > MAX_COORDINATE_M) {
                return Err(GroundError::Coordinate);
            }
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                if let Some((a, b)) = clip(a, b, self.lo, self.hi) {
                    self.straight.extend(segment(snap(a), snap(b)));
                }
            }
        }
        Ok(())
    }

    /// The pieces, bent where the terrain needs it, and their greatest vertical distance to the terrain.
    pub(super) fn finish(mut self) -> (Vec<Segment>, f64) {
        self.straight.sort_unstable();
        self.straight.dedup();
        let (mut pieces, mut worst) = (Vec::with_capacity(self.straight.len()), 0.0_f64);
        for &[a, b] in &self.straight {
            let bends = self.terrain.bends(metres(a), metres(b));
            let stops: Vec<_> = bends.into_iter().map(|t| metres(a).lerp(metres(b), t)).collect();
            let mut nodes = vec![a];
            nodes.extend(stops.iter().map(|&p| snap(p)));
            nodes.push(b);
            let heights: Vec<f64> = nodes.iter().map(|&n| self.terrain.height(metres(n)).unwrap_or(f64::NAN)).collect();
            let along: Vec<f64> = nodes.iter().map(|&n| metres(n).distance(metres(a))).collect();
            let (kept, error) = simplify(&along, &heights, self.tolerance_m);
            worst = worst.max(error);
            pieces.extend(kept.windows(2).filter_map(|w| segment(nodes[w[0]], nodes[w[1]])));
        }
        (pieces, worst)
    }
}

/// The part of a segment inside a box (Liang and Barsky, 1984); ends on a side of the box lie exactly on it.
fn clip(a: DVec2, b: DVec2, lo: DVec2, hi: DVec2) -> Option<(DVec2, DVec2)> {
    let d = b - a;
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-d.x, a.x - lo.x), (d.x, hi.x - a.x), (-d.y, a.y - lo.y), (d.y, hi.y - a.y)] {
        if p == 0.0 && q < 0.0 {
            return None;
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else if p > 0.0 {
            t1 = t1.min(q / p);
        }
    }
    let at = |t: f64| {
        if t == 0.0 {
            a
        } else if t == 1.0 {
            b
        } else {
            (a + d * t).clamp(lo, hi)
        }
    };
    (t0 < t1).then(|| (at(t0), at(t1)))
}

/// Douglas and Peucker on a height profile: which points to keep so that no other is further than `tolerance` above
/// or below the straight lines between them; with the greatest distance left. Points without height are ignored.
fn simplify(along: &[f64], heights: &[f64], tolerance: f64) -> (Vec<usize>, f64) {
    let last = along.len() - 1;
    let (mut kept, mut worst) = (vec![0, last], 0.0_f64);
    let mut open = vec![(0, last)];
    while let Some((i, j)) = open.pop() {
        let slope = (heights[j] - heights[i]) / (along[j] - along[i]);
        let error = |k: usize| (heights[k] - heights[i] - slope * (along[k] - along[i])).abs();
        let mut far = (0.0, i);
        for k in i + 1..j {
            if error(k) > far.0 {
                far = (error(k), k);
            }
        }
        if far.0 > tolerance {
            kept.push(far.1);
            open.extend([(i, far.1), (far.1, j)]);
        } else {
            worst = worst.max(far.0);
        }
    }
    kept.sort_unstable();
    (kept, worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_keeps_what_is_inside() {
        let (lo, hi) = (DVec2::ZERO, DVec2::splat(10.0));
        let c = |a: [f64; 2], b: [f64; 2]| clip(a.into(), b.into(), lo, hi).map(|(a, b)| (a.to_array(), b.to_array()));
        assert_eq!(c([-5.0, 5.0], [15.0, 5.0]), Some(([0.0, 5.0], [10.0, 5.0])));
        assert_eq!(c([1.0, 1.0], [2.0, 3.0]), Some(([1.0, 1.0], [2.0, 3.0])));
        assert_eq!((c([-5.0, 0.0], [0.0, 15.0]), c([11.0, 0.0], [11.0, 9.0])), (None, None));
        assert_eq!(c([3.0, 10.0], [8.0, 10.0]), Some(([3.0, 10.0], [8.0, 10.0])));
    }

    #[test]
    fn profiles_keep_what_bends() {
        let along: Vec<f64> = (0..=10).map(f64::from).collect();
        let peak: Vec<f64> = along.iter().map(|x| 5.0 - (x - 4.0).abs()).collect();
        assert_eq!(simplify(&along, &peak, 0.1), (vec![0, 4, 10], 0.0));
        assert_eq!(simplify(&along, &peak, 9.0).0, vec![0, 10]);
        let mut gap = peak;
        gap[2] = f64::NAN;
        assert_eq!(simplify(&along, &gap, 0.1).0, vec![0, 4, 10]);
    }
}
