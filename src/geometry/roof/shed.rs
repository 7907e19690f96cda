//! CGA `roofShed`: one inclined plane. In: polygon, slope, edge. Out: the plane, walls up to it, the bottom.

use glam::DVec2;

use super::plan::{Edges, PlanFace, PlanRoof};
use super::{Roof, RoofError, RoofPart, Slope};
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::SkeletonError;

/// Cosines of edges that face alike differ by no more than this.
const ALIKE: f64 = 1e-9;

/// One plane through edge `index` (modulo the edges of the outer ring), rising away from it; a negative angle falls. The
/// whole is lifted so that its lowest point lies on the polygon (CGA reference 4.9).
///
/// # Errors
/// Slope outside its domain (here -90 to 90 degrees); an edge without length.
pub fn shed(polygon: &Polygon, slope: Slope, index: i64) -> Result<Roof, RoofError> {
    let count = polygon.outer.len();
    if count < 3 {
        return Err(SkeletonError::TooFewPoints.into());
    }
    let edge = index.rem_euclid(count as i64) as usize;
    let normal = Edges::of(polygon).normal(edge);
    inclined(polygon, slope, normal, edge)
}

/// One plane that falls in direction `downhill` (plan vector), for OSM `roof:shape=skillion` with `roof:direction`.
///
/// # Errors
/// Slope outside its domain; a direction without length.
pub fn skillion(polygon: &Polygon, slope: Slope, downhill: DVec2) -> Result<Roof, RoofError> {
    let uphill = -downhill.try_normalize().ok_or(RoofError::Direction(downhill))?;
    let edges = Edges::of(polygon);
    // The eave is the edge that faces downhill most; of edges alike the one farthest down, so that turned outlines agree.
    let facing = |e: usize| edges.normal(e).dot(uphill);
    let most = (0..polygon.outer.len()).map(facing).fold(f64::NEG_INFINITY, f64::max);
    let alike = (0..polygon.outer.len()).filter(|&e| facing(e) >= most - ALIKE);
    let place = |p: DVec2| uphill.dot(p - polygon.outer[0]);
    let height = |e: usize| place(edges.start(e)).min(place(edges.end(e)));
    let eave = alike.min_by(|&p, &q| height(p).total_cmp(&height(q)));
    inclined(polygon, slope, uphill, eave.ok_or(SkeletonError::TooFewPoints)?)
}

/// The plane that rises in direction `uphill`; its face starts with `eave`.
fn inclined(polygon: &Polygon, slope: Slope, uphill: DVec2, eave: usize) -> Result<Roof, RoofError> {
    let up = match slope {
        Slope::Angle(degrees) if degrees < 0.0 => -uphill,
        _ => uphill,
    };
    let edges = Edges::of(polygon);
    let mut plan = PlanRoof::of_vertices(polygon);
    let along = |k: usize| up.dot(plan.nodes[k].position - plan.nodes[0].position);
    let heights: Vec<f64> = (0..plan.nodes.len()).map(along).collect();
    let (low, high) = heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
    if high.is_nan() || low.is_nan() || high <= low {
        return Err(SkeletonError::TooFewPoints.into());
    }
    let tangent = match slope {
        Slope::Angle(degrees) => Slope::Angle(degrees.abs()).tangent(1.0).map_err(|_| RoofError::Angle(degrees))?,
        Slope::Height(_) => slope.tangent(high - low)?,
    };
    // Vertices on the lowest line, up to rounding, belong to the bottom and the plane alike.
    let level = 1e-9 * (high - low);
    let top: Vec<u32> = (0..heights.len())
        .map(|k| match heights[k] - low {
            h if h <= level || tangent == 0.0 => k as u32,
            h => plan.add_node(plan.nodes[k].position, h * tangent),
        })
        .collect();
    for (edge, &(s, e)) in edges.ends.iter().enumerate() {
        let (ts, te) = (top[s as usize], top[e as usize]);
        let mut ring = vec![s, e, te, ts];
        ring.dedup();
        if ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() >= 3 {
            plan.faces.push(PlanFace { part: RoofPart::Side { edge }, ring, holes: Vec::new() });
        }
    }
    let (outer, mut rest) = top.split_at(polygon.outer.len());
    let mut ring = outer.to_vec();
    ring.rotate_left(eave);
    let mut holes = Vec::new();
    for hole in &polygon.holes {
        let (own, others) = rest.split_at(hole.len());
        holes.push(own.to_vec());
        rest = others;
    }
    plan.faces.push(PlanFace { part: RoofPart::Top { edge: Some(eave) }, ring, holes });
    Ok(plan.into_roof(polygon))
}
