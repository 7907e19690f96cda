//! Mitred offsets of a polygon. In: a repaired [`Polygon`] and distances. Out: what is left inside, and one border
//! face per edge, which share their vertices bit for bit.

mod settled;

use glam::DVec2;

use crate::geometry::grid::Grid;
use crate::geometry::polygon::{Polygon, Ring, ring_contains, signed_area};
use crate::geometry::polygon_checks::crossing_edges;
use crate::geometry::skeleton::{Options, Skeleton, SkeletonError, run};

/// The strip between an edge and its new place, counter-clockwise seen from above.
#[derive(Clone, Debug, PartialEq)]
pub struct Border {
    /// Index over the edges of the outer ring, then those of the holes.
    pub edge: usize,
    /// Starts with the edge: in its own direction if it moved inwards, against it if it moved outwards.
    pub ring: Ring,
    /// Clockwise loops around parts that were not swept; only in [`setback`] of polygons with unmoved holes.
    pub holes: Vec<Ring>,
}

/// Result of [`offset`] and [`setback`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Offset {
    /// The offset polygons; empty once the distance has eaten the polygon.
    pub inside: Vec<Polygon>,
    /// In edge order; edges that did not move have none.
    pub borders: Vec<Border>,
}

/// Longest mitre of an outward offset, in distances; sharper corners are cut off square there.
pub const MITRE_LIMIT: f64 = 4.0;

/// Offset by `distance` metres along the straight skeleton: negative inwards, positive outwards, as CGA `offset`.
/// Outwards, a corner reaches at most [`MITRE_LIMIT`] times the distance.
///
/// # Errors
/// Those of the skeleton; outwards, [`SkeletonError::NotSimple`] if the outline is too small beside the distance.
pub fn offset(polygon: &Polygon, distance: f64) -> Result<Offset, SkeletonError> {
    if distance > 0.0 {
        return outwards(polygon, distance);
    }
    let skeleton = run(polygon, None, Some(-distance), &Options::default())?;
    Ok(Offset { inside: polygons(&skeleton, &skeleton.tops), borders: borders(&skeleton, Some) })
}

/// Move every edge inwards by its own distance (missing: 0), as CGA `setback`. A strip attaches to an unmoved neighbour at a
/// convex corner and ends square at a concave one.
///
/// # Errors
/// Those of the skeleton.
pub fn setback(polygon: &Polygon, distances: &[f64]) -> Result<Offset, SkeletonError> {
    let edges = polygon.rings().map(Vec::len).sum();
    if distances.len() > edges {
        return Err(SkeletonError::WeightCount { given: distances.len(), edges });
    }
    let mut weights = distances.to_vec();
    weights.resize(edges, 0.0);
    let options = Options { square_ends: true, ..Options::default() };
    let skeleton = run(polygon, Some(&weights), Some(1.0), &options)?;
    let moved = |edge: usize| (weights[edge] > 0.0).then_some(edge);
    Ok(Offset { inside: polygons(&skeleton, &skeleton.tops), borders: borders(&skeleton, moved) })
}

/// What lies outside the polygon up to a distance: the skeleton of the region around it, inside a frame that stands
/// still, and those of its holes.
pub(crate) struct Outside {
    /// Its edge `frame_edges + i` is edge `i` of the outer ring, reversed.
    pub around: Skeleton,
    /// The region whose skeleton [`Outside::around`] is: the frame, and the outer ring as a hole.
    pub region: Polygon,
    /// One per hole; edges likewise reversed.
    pub in_holes: Vec<Skeleton>,
}

impl Outside {
    /// Whether nothing has reached the frame. Where sharp corners touch each other they keep no bevel, and do.
    fn is_inside_frame(&self) -> bool {
        self.around.tops.iter().any(|top| settled::is_frame(&points(&self.around, top), &self.region.outer))
    }
}

/// Corners of the frame.
pub(crate) const FRAME: usize = 4;

/// Index in its own ring of an edge of a reversed ring of `count` edges.
pub(crate) fn reversed_edge(edge: usize, count: usize) -> usize {
    (2 * count - 2 - edge) % count
}

/// A rectangle that nothing reaches that moves outwards by at most `farthest`.
fn frame(polygon: &Polygon, farthest: f64) -> Result<Ring, SkeletonError> {
    let (min, max) = polygon.bounds().ok_or(SkeletonError::TooFewPoints)?;
    let margin = DVec2::splat(2.0 * farthest * MITRE_LIMIT);
    let (low, high) = (min - margin, max + margin);
    Ok(vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)])
}

/// Whether a ring crosses itself once it is rounded to the grid over a frame around it, coarser than its own.
fn crosses_on_grid_of(frame: &Ring, ring: &Ring) -> bool {
    let Some(grid) = Grid::over(frame[0], frame[2]) else { return false };
    let rounded = |&p: &DVec2| {
        let [x, y] = grid.snap(p);
        grid.plan(x as f64, y as f64)
    };
    let mut outer: Ring = ring.iter().map(rounded).collect();
    if &outer == ring {
        return false;
    }
    outer.dedup();
    while outer.len() > 1 && outer.first() == outer.last() {
        outer.pop();
    }
    !crossing_edges(&Polygon { outer, holes: Vec::new() }).is_empty()
}

/// Let every edge move outwards by its own distance (>= 0).
///
/// # Errors
/// Those of the skeleton; [`SkeletonError::NotSimple`] if the outline has details finer than the grid it grows on.
pub(crate) fn grow(polygon: &Polygon, distances: &[f64]) -> Result<Outside, SkeletonError> {
    let farthest = distances.iter().fold(0.0, |m, &d| f64::max(m, d));
    let outer = frame(polygon, farthest)?;
    if crosses_on_grid_of(&outer, &polygon.outer) {
        return Err(SkeletonError::NotSimple);
    }
    let region = Polygon { outer, holes: vec![polygon.outer.iter().rev().copied().collect()] };
    let options = Options { mitre_limit: Some(MITRE_LIMIT), ..Options::default() };
    let mut first = 0;
    let mut weights_of = |ring: &Ring| {
        let count = ring.len();
        let own = distances.get(first..first + count);
        first += count;
        let own = own.ok_or(SkeletonError::WeightCount { given: distances.len(), edges: first })?;
        Ok((0..count).map(|e| own[reversed_edge(e, count)]).collect::<Vec<f64>>())
    };
    let mut weights = vec![0.0; FRAME];
    weights.extend(weights_of(&polygon.outer)?);
    let around = run(&region, Some(&weights), Some(1.0), &options)?;
    let mut shrink = |hole: &Ring| {
        let reversed = Polygon { outer: hole.iter().rev().copied().collect(), holes: Vec::new() };
        run(&reversed, Some(&weights_of(hole)?), Some(1.0), &options)
    };
    let in_holes = polygon.holes.iter().map(&mut shrink).collect::<Result<_, _>>()?;
    Ok(Outside { around, region, in_holes })
}

fn outwards(polygon: &Polygon, distance: f64) -> Result<Offset, SkeletonError> {
    if !distance.is_finite() {
        return Err(SkeletonError::Distance(distance));
    }
    let edges = polygon.rings().map(Vec::len).sum();
    let outside = match grow(polygon, &vec![distance; edges]) {
        Err(SkeletonError::NotSimple) => return settled::outwards(polygon, distance),
        Ok(grown) if !grown.is_inside_frame() => return settled::outwards(polygon, distance),
        grown => grown?,
    };
    let count = polygon.outer.len();
    let own = |edge: usize| edge.checked_sub(FRAME).map(|e| reversed_edge(e, count));
    let mut borders_out = borders(&outside.around, own);
    // The tops are the frame and the grown outline, clockwise as holes of the region; pockets the outline has closed around
    // are loops of their own.
    let mut rings: Vec<Ring> = outside.around.tops.iter().map(|t| points(&outside.around, t)).collect();
    rings.retain(|ring| !ring.contains(&outside.region.outer[0]));
    let mut first = count;
    for (hole, skeleton) in polygon.holes.iter().zip(&outside.in_holes) {
        borders_out.extend(borders(skeleton, |e| Some(first + reversed_edge(e, hole.len()))));
        rings.extend(skeleton.tops.iter().map(|t| points(skeleton, t)));
        first += hole.len();
    }
    rings.iter_mut().for_each(|ring| ring.reverse());
    borders_out.sort_by_key(|b| b.edge);
    Ok(Offset { inside: assemble(rings), borders: borders_out })
}

fn points(skeleton: &Skeleton, ring: &[u32]) -> Ring {
    ring.iter().map(|&n| skeleton.nodes[n as usize].position).collect()
}

/// The faces of the edges that `own` gives a number.
fn borders(skeleton: &Skeleton, own: impl Fn(usize) -> Option<usize>) -> Vec<Border> {
    let mut borders: Vec<Border> = skeleton
        .faces
        .iter()
        .filter_map(|f| {
            let holes = f.holes.iter().map(|h| points(skeleton, h)).collect();
            Some(Border { edge: own(f.edge)?, ring: points(skeleton, &f.boundary), holes })
        })
        .collect();
    borders.sort_by_key(|b| b.edge);
    borders
}

/// Loops of a wavefront as polygons, those without area left out.
fn polygons(skeleton: &Skeleton, loops: &[Vec<u32>]) -> Vec<Polygon> {
    assemble(loops.iter().map(|ring| points(skeleton, ring)).collect())
}

/// Counter-clockwise rings become outlines, clockwise ones holes of the smallest outline around them.
fn assemble(rings: Vec<Ring>) -> Vec<Polygon> {
    let mut outlines: Vec<(f64, Polygon)> = Vec::new();
    let mut holes = Vec::new();
    for mut ring in rings {
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        let area = signed_area(&ring);
        if ring.len() >= 3 && area > 0.0 {
            outlines.push((area, Polygon { outer: ring, holes: Vec::new() }));
        } else if ring.len() >= 3 && area < 0.0 {
            holes.push(ring);
        }
    }
    for hole in holes {
        // Rings may touch in a vertex: the middle of an edge decides.
        let inside = (hole[0] + hole[1]) / 2.0;
        let around = outlines.iter_mut().filter(|(_, p)| ring_contains(&p.outer, inside));
        if let Some((_, polygon)) = around.min_by(|p, q| p.0.total_cmp(&q.0)) {
            polygon.holes.push(hole);
        }
    }
    outlines.into_iter().map(|(_, polygon)| polygon).collect()
}

#[cfg(test)]
mod tests;
