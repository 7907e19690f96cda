//! Booleans of plan polygons. In: two sets of polygons. Out: disjoint polygons with holes, on a common integer grid.
//!
//! Ring directions do not matter, polygons of a set may overlap. Corners of the input keep their coordinates bit for
//! bit, straight points of the input stay, new ones only appear where edges cross (to within the grid step,
//! 2^-30 of the extent). Outlines start at their corner that comes first in the input. Slivers that may come from
//! rounding alone, on the mean no wider than two grid steps, are dropped.

pub(super) mod engine;

use std::collections::BTreeMap;

use glam::DVec2;
use i_overlay::core::overlay_rule::OverlayRule;

use super::Polygon;
use super::grid::Grid;
use super::polygon::signed_area;
use engine::{GridPoint, GridRing, GridShape, Keepsakes};

/// The world's errors of the boolean engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BooleanError {
    #[error("a coordinate is not a finite number")]
    NotFinite,
    #[error("the polygons reach over more than 1e9 metres")]
    TooLarge,
    #[error("the polygon engine failed")]
    EngineFailed,
}

/// What lies in a or in b; parts that share a border are joined.
pub fn union(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    combine(a, b, OverlayRule::Union)
}

/// What lies in a and in b.
pub fn intersection(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    combine(a, b, OverlayRule::Intersect)
}

/// What lies in a and not in b.
pub fn difference(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    combine(a, b, OverlayRule::Difference)
}

/// What lies in exactly one of a and b.
pub fn symmetric_difference(a: &[Polygon], b: &[Polygon]) -> Result<Vec<Polygon>, BooleanError> {
    combine(a, b, OverlayRule::Xor)
}

/// Widest extent, metres (numerics 4.1).
const GREATEST_EXTENT: f64 = 1e9;

fn combine(a: &[Polygon], b: &[Polygon], rule: OverlayRule) -> Result<Vec<Polygon>, BooleanError> {
    let points = || a.iter().chain(b).flat_map(|p| p.rings()).flatten().copied();
    if points().any(|p| !p.is_finite()) {
        return Err(BooleanError::NotFinite);
    }
    let Some(first) = points().next() else { return Ok(Vec::new()) };
    let (lo, hi) = points().fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
    if (hi - lo).max_element() > GREATEST_EXTENT {
        return Err(BooleanError::TooLarge);
    }
    let Some(grid) = Grid::over(lo, hi) else { return Ok(Vec::new()) };
    let mut input = Input { grid, originals: BTreeMap::new(), keepsakes: Keepsakes::default() };
    let subject: Vec<GridRing> = a.iter().flat_map(|p| input.add(p)).collect();
    let clip: Vec<GridRing> = b.iter().flat_map(|p| input.add(p)).collect();
    let shapes = engine::overlay(&subject, &clip, rule).map_err(|_| BooleanError::EngineFailed)?;
    Ok(input.polygons(shapes))
}

/// What must be remembered of the input.
struct Input {
    grid: Grid,
    /// Positions before rounding.
    originals: BTreeMap<GridPoint, DVec2>,
    keepsakes: Keepsakes,
}

impl Input {
    /// The rings of a polygon on the grid, outline counter-clockwise, holes clockwise.
    fn add(&mut self, polygon: &Polygon) -> Vec<GridRing> {
        let mut rings = Vec::new();
        for (i, source) in polygon.rings().enumerate() {
            let mut ring: GridRing = source.iter().map(|&p| self.grid.snap(p)).collect();
            for (&on_grid, &p) in ring.iter().zip(source) {
                self.originals.entry(on_grid).or_insert(p);
            }
            ring.dedup();
            self.keepsakes.add(&ring);
            if (signed_area(source) < 0.0) == (i == 0) {
                ring.reverse();
            }
            rings.push(ring);
        }
        rings
    }

    fn polygons(&self, mut shapes: Vec<GridShape>) -> Vec<Polygon> {
        self.keepsakes.tidy(&mut shapes);
        let plan = |p: &GridPoint| {
            let rounded = || self.grid.plan(p[0] as f64, p[1] as f64);
            self.originals.get(p).copied().unwrap_or_else(rounded)
        };
        let mut polygons = Vec::with_capacity(shapes.len());
        for shape in shapes {
            let mut rings = shape.iter().map(|r| r.iter().map(plan).collect());
            if let Some(outer) = rings.next() {
                polygons.push(Polygon { outer, holes: rings.collect() });
            }
        }
        polygons
    }
}

/// A point inside the polygon, off its border: the middle of the widest stretch inside along a level line half-way
/// between two corner heights. `None` if the polygon has no area.
pub fn point_on_surface(polygon: &Polygon) -> Option<DVec2> {
    let mut heights: Vec<f64> = polygon.rings().flatten().map(|p| p.y).filter(|y| y.is_finite()).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let mut bands: Vec<(f64, f64)> = heights.windows(2).map(|w| (w[1] - w[0], (w[0] + w[1]) / 2.0)).collect();
    bands.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    let best_of =
        |&(thick, y): &(f64, f64)| widest_stretch(polygon, y).map(|(wide, x)| (wide.min(thick), DVec2::new(x, y)));
    let mut best: Option<(f64, DVec2)> = None;
    for band in &bands {
        if best.is_some_and(|(room, _)| room >= band.0) {
            break;
        }
        if let Some(found) = best_of(band)
            && best.is_none_or(|(room, _)| found.0 > room)
        {
            best = Some(found);
        }
    }
    best.map(|(_, p)| p)
}

/// Length and middle of the widest stretch inside along the line at height y, which passes through no corner.
fn widest_stretch(polygon: &Polygon, y: f64) -> Option<(f64, f64)> {
    let mut crossings = Vec::new();
    for ring in polygon.rings() {
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            if (a.y > y) != (b.y > y) {
                crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    let stretches = crossings.chunks_exact(2).map(|c| (c[1] - c[0], (c[0] + c[1]) / 2.0));
    stretches.filter(|s| s.0 > 0.0).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)))
}

#[cfg(test)]
mod tests;
