//! The door to the polygon engine. In: rings on the integer grid. Out: shapes on the same grid, outlines
//! counter-clockwise, holes clockwise.
//!
//! `i_overlay` with its 32-bit integers: exact on coordinates up to 2^30, ours stay below (numerics 4.5).

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::i_float::int::point::IntPoint;

use crate::geometry::polygon::{Polygon, signed_area};
use crate::geometry::polygon_checks::is_strictly_valid;

/// A point in grid steps.
pub type GridPoint = [i64; 2];
pub type GridRing = Vec<GridPoint>;
/// Outline first, then holes.
pub type GridShape = Vec<GridRing>;

/// The engine panicked or was given a coordinate beyond its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EngineFailed;

/// Largest coordinate the engine takes.
pub const ENGINE_LIMIT: i64 = (1 << 30) - 1;

/// Fills subject and clip by the non-zero rule and combines them. Straight points of the input and cut points stay.
pub fn overlay(subject: &[GridRing], clip: &[GridRing], rule: OverlayRule) -> Result<Vec<GridShape>, EngineFailed> {
    let in_range = |r: &GridRing| r.iter().flatten().all(|c| c.abs() <= ENGINE_LIMIT);
    if !subject.iter().chain(clip).all(in_range) {
        return Err(EngineFailed);
    }
    let engine = |rings: &[GridRing]| -> Vec<Vec<IntPoint<i32>>> {
        rings.iter().map(|r| r.iter().map(|p| IntPoint::new(p[0] as i32, p[1] as i32)).collect()).collect()
    };
    let (subject, clip) = (engine(subject), engine(clip));
    let run = || {
        let options = IntOverlayOptions::keep_all_points();
        Overlay::from_subj_and_clip_custom(&subject, &clip, options, Solver::default()).overlay(rule, FillRule::NonZero)
    };
    let shapes = catch_unwind(AssertUnwindSafe(run)).map_err(|_| EngineFailed)?;
    let grid = |ring: Vec<IntPoint<i32>>| ring.iter().map(|p| [i64::from(p.x), i64::from(p.y)]).collect();
    Ok(shapes.into_iter().map(|s| s.into_iter().map(grid).collect()).collect())
}

/// Points where a ring goes straight on.
fn straight_points(ring: &[GridPoint]) -> impl Iterator<Item = GridPoint> + '_ {
    let n = ring.len();
    (0..n).filter(move |&i| is_straight(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n])).map(move |i| ring[i])
}

fn is_straight(a: GridPoint, b: GridPoint, c: GridPoint) -> bool {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    u[0] * v[1] == u[1] * v[0]
}

/// What must be remembered of the input to give the output its form back.
#[derive(Default)]
pub struct Keepsakes {
    /// Straight points of the input rings: facade breaks.
    pub breaks: BTreeSet<GridPoint>,
    /// Place of every input point, in order.
    pub order: BTreeMap<GridPoint, usize>,
}

impl Keepsakes {
    pub fn add(&mut self, ring: &[GridPoint]) {
        self.breaks.extend(straight_points(ring));
        for &p in ring {
            let next = self.order.len();
            self.order.entry(p).or_insert(next);
        }
    }

    /// Drops rounding dust, needles of such dust, and straight points that the input did not have; then rings start at,
    /// and come in the order of, their first input point.
    pub fn tidy(&self, shapes: &mut Vec<GridShape>) {
        shapes.retain(|s| !is_rounding_dust(&s[0]));
        for shape in &mut *shapes {
            shape.retain(|r| !is_rounding_dust(r));
            self.drop_needles(shape);
            shape.iter_mut().for_each(|r| self.tidy_ring(r));
            shape[1..].sort_by_key(|r| self.place(r[0]));
        }
        shapes.sort_by_key(|s| self.place(s[0][0]));
    }

    /// Takes off what a ring goes there and back along, no wider than rounding, unless the shape would touch itself.
    fn drop_needles(&self, shape: &mut GridShape) {
        if !shape.iter().any(|r| needle(r).is_some()) {
            return;
        }
        let mut without = shape.clone();
        for ring in &mut without {
            while let Some(tip) = needle(ring) {
                self.drop_needle(ring, tip);
            }
        }
        let points = |r: &GridRing| r.iter().map(|p| DVec2::new(p[0] as f64, p[1] as f64)).collect();
        let plain = Polygon { outer: points(&without[0]), holes: without[1..].iter().map(points).collect() };
        if is_strictly_valid(&plain) {
            *shape = without;
        }
    }

    /// Its two ends are one where only rounding keeps them apart: that of the input.
    fn drop_needle(&self, ring: &mut GridRing, tip: usize) {
        let n = ring.len();
        let (before, after) = ((tip + n - 1) % n, (tip + 1) % n);
        let apart = |axis: usize| (ring[before][axis] - ring[after][axis]).abs();
        let other = if self.place(ring[before]) <= self.place(ring[after]) { after } else { before };
        let both = apart(0).max(apart(1)) <= DUST_WIDTH;
        let mut number = 0..;
        ring.retain(|_| number.next().is_none_or(|i| i != tip && !(both && i == other)));
    }

    fn place(&self, p: GridPoint) -> (usize, GridPoint) {
        (self.order.get(&p).copied().unwrap_or(usize::MAX), p)
    }

    fn tidy_ring(&self, ring: &mut GridRing) {
        let mut i = 0;
        while i < ring.len() && ring.len() > 3 {
            let n = ring.len();
            let straight = is_straight(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            if straight && !self.breaks.contains(&ring[i]) {
                ring.remove(i);
                i = i.saturating_sub(1);
            } else {
                i += 1;
            }
        }
        let first = (0..ring.len()).min_by_key(|&i| self.place(ring[i]));
        ring.rotate_left(first.unwrap_or(0));
    }
}

/// Grid steps that rounding alone may put between two points.
const DUST_WIDTH: i64 = 2;

/// A corner where a ring of more than three turns back along the edge it came by, but for rounding.
pub fn needle(ring: &GridRing) -> Option<usize> {
    let n = ring.len();
    let turns_back = |&i: &usize| {
        let [a, b, c] = [n - 1, 0, 1].map(|k| ring[(i + k) % n]);
        (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0 && is_rounding_dust(&vec![a, b, c])
    };
    if n > 3 { (0..n).find(turns_back) } else { None }
}

/// Whether a ring is on the mean no wider than two grid steps: it may come from rounding alone.
pub fn is_rounding_dust(ring: &GridRing) -> bool {
    let points: Vec<DVec2> = ring.iter().map(|p| DVec2::new(p[0] as f64, p[1] as f64)).collect();
    let girth: f64 = (0..points.len()).map(|i| points[i].distance(points[(i + 1) % points.len()])).sum();
    signed_area(&points).abs() <= girth
}
