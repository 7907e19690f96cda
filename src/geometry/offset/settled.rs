//! Outward offsets of outlines with details finer than the grid of what they grow into: rounded to it they cross
//! themselves. In: such a polygon and a distance. Out: the offset of the outline settled on that grid.

use glam::DVec2;

use super::{MITRE_LIMIT, Offset, assemble, borders, frame, points};
use crate::geometry::polygon::{Polygon, Ring};
use crate::geometry::repair::{Options as RepairOptions, repair};
use crate::geometry::skeleton::{Options, Skeleton, SkeletonError, run};

/// As [`super::offset`] outwards. Edges keep the numbers of the nearest edges they had; a border may start a step of the
/// coarser grid (2^-29 of the width of the result) beside its edge.
pub(super) fn outwards(polygon: &Polygon, distance: f64) -> Result<Offset, SkeletonError> {
    let frame = frame(polygon, distance)?;
    let corner = frame[0];
    let mut made = Offset::default();
    let mut rings = Vec::new();
    let around = regions(&[frame, polygon.outer.clone()]);
    // Without an outline nothing is left that could grow.
    if around.iter().all(|region| region.holes.is_empty()) {
        return Err(SkeletonError::NotSimple);
    }
    let in_holes = polygon.holes.iter().flat_map(|hole| regions(std::slice::from_ref(hole)));
    for region in around.into_iter().chain(in_holes) {
        let skeleton = grown(&region, corner, distance)?;
        let edges: Vec<Option<usize>> = sides(&region).map(|side| nearest(polygon, side)).collect();
        let framed = region.outer.contains(&corner);
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
