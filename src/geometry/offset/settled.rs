//! Outward offsets of outlines that the grid of what they grow into is too coarse for (rounded to it they cross
//! themselves), or that touch themselves in sharp corners (which keep no bevel). In: such a polygon and a distance. Out:
//! the offset of the outline settled on that grid, a few of its steps smaller where it touched itself.

use glam::DVec2;

use super::{MITRE_LIMIT, Offset, assemble, borders, frame, points};
use crate::geometry::polygon::{Polygon, Ring};
use crate::geometry::repair::{Options as RepairOptions, repair};
use crate::geometry::skeleton::{Options, Skeleton, SkeletonError, run};

/// Corners in one point are moved apart by this share of the width of the result: a few steps of its grid.
const APART: f64 = 1e-8;

/// As [`super::offset`] outwards. Edges keep the numbers of the nearest edges they had; a border may start a few steps of
/// the coarser grid beside its edge.
///
/// # Errors
/// [`SkeletonError::NotSimple`] if nothing of the outline is left on the grid, or two corners do not come apart.
pub(super) fn outwards(polygon: &Polygon, distance: f64) -> Result<Offset, SkeletonError> {
    let mut made = Offset::default();
    let mut rings = Vec::new();
    let around = regions(&[frame(polygon, distance)?, polygon.outer.clone()]);
    // The part with the frame is the first and starts with its first corner. Without a hole in it nothing is left that
    // could grow.
    let framed = around.first().filter(|region| !region.holes.is_empty());
    let corner = framed.ok_or(SkeletonError::NotSimple)?.outer[0];
    let in_holes = polygon.holes.iter().flat_map(|hole| regions(std::slice::from_ref(hole)));
    for mut region in around.into_iter().chain(in_holes) {
        let framed = region.outer.contains(&corner);
        open_touching_corners(&mut region);
        let skeleton = grown(&region, corner, distance)?;
        let edges: Vec<Option<usize>> = sides(&region).map(|side| nearest(polygon, side)).collect();
        if framed && !skeleton.tops.iter().any(|top| is_frame(&points(&skeleton, top), &region.outer)) {
            return Err(SkeletonError::NotSimple);
        }
        let own = |edge: usize| edges[edge].filter(|_| !framed || edge >= region.outer.len());
        made.borders.extend(borders(&skeleton, own));
        let grown = skeleton.tops.iter().map(|top| points(&skeleton, top));
        rings.extend(grown.filter(|ring| !ring.contains(&corner)));
    }
    rings.iter_mut().for_each(|ring| ring.reverse());
    made.borders.sort_by_key(|b| b.edge);
    made.inside = assemble(rings);
    Ok(made)
}

/// What lies inside the first ring and outside the second, without crossings on the grid of the first.
fn regions(rings: &[Ring]) -> Vec<Polygon> {
    repair(rings, &RepairOptions { weld: 0.0, min_area: 0.0 }).polygons
}

/// Whether a ring is the frame and nothing else: nothing has reached it.
pub(super) fn is_frame(ring: &Ring, frame: &Ring) -> bool {
    ring.len() == frame.len() && ring.iter().all(|p| frame.contains(p))
}

/// Move corners that stand in one point apart, away from the region.
fn open_touching_corners(region: &mut Polygon) {
    let Some((low, high)) = region.bounds() else { return };
    let step = (high - low).max_element() * APART;
    let mut all: Vec<DVec2> = region.rings().flatten().copied().collect();
    all.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    let doubled: Vec<DVec2> = all.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect();
    for ring in std::iter::once(&mut region.outer).chain(&mut region.holes) {
        let before = ring.clone();
        let unit = |from: usize, to: usize| (before[to] - before[from]).normalize_or_zero();
        for k in (0..before.len()).filter(|&k| doubled.contains(&before[k])) {
            let (last, next) = ((k + before.len() - 1) % before.len(), (k + 1) % before.len());
            // The region lies to the left of its rings.
            let away = (unit(last, k) + unit(k, next)).perp();
            ring[k] -= away.normalize_or_zero() * step;
        }
    }
}

/// What the edges sweep within the distance; those of the frame, which has `corner`, stand still.
fn grown(region: &Polygon, corner: DVec2, distance: f64) -> Result<Skeleton, SkeletonError> {
    let weight = |ring: &Ring| vec![if ring.contains(&corner) { 0.0 } else { distance }; ring.len()];
    let weights: Vec<f64> = region.rings().flat_map(weight).collect();
    run(region, Some(&weights), Some(1.0), &Options { mitre_limit: Some(MITRE_LIMIT), ..Options::default() })
}

fn sides(polygon: &Polygon) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    polygon.rings().flat_map(|r| (0..r.len()).map(|i| (r[i], r[(i + 1) % r.len()])))
}

/// The edge of `polygon` that comes nearest to both ends of a side.
fn nearest(polygon: &Polygon, (start, end): (DVec2, DVec2)) -> Option<usize> {
    let far = |(a, b): (DVec2, DVec2)| distance_to(a, b, start).max(distance_to(a, b, end));
    sides(polygon).map(far).enumerate().min_by(|p, q| p.1.total_cmp(&q.1)).map(|(edge, _)| edge)
}

fn distance_to(a: DVec2, b: DVec2, p: DVec2) -> f64 {
    let along = b - a;
    let share = if a == b { 0.0 } else { ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    p.distance(a + along * share)
}
