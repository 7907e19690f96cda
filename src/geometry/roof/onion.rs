//! OSM `roof:shape=onion`: a bulb that is wider than its foot and ends in a point. In: polygon, slope. Out: bands of
//! planes over every edge; holes are covered.

use glam::DVec2;

use super::plan::{Edges, PlanFace, PlanRoof};
use super::{Roof, RoofError, RoofPart, RoofWarning, Slope};
use crate::geometry::polygon::{Polygon, centroid};
use crate::geometry::skeleton::SkeletonError;

/// (share of the outline, share of the height) of the corners, from foot to tip; our own drawing of a Bavarian tower.
const BULB: [(f64, f64); 10] = [
    (1.0, 0.0),
    (1.12, 0.08),
    (1.18, 0.18),
    (1.13, 0.29),
    (0.96, 0.40),
    (0.70, 0.50),
    (0.42, 0.60),
    (0.22, 0.71),
    (0.09, 0.84),
    (0.0, 1.0),
];

/// Copies of the outline, scaled about its centroid. `Slope::Angle` is that of a pyramid with the same tip over the
/// first edge.
///
/// # Errors
/// Slope outside its domain; an outline whose edges cannot all be seen from its centroid.
pub fn onion(polygon: &Polygon, slope: Slope) -> Result<Roof, RoofError> {
    let covered = Polygon { outer: polygon.outer.clone(), holes: Vec::new() };
    let edges = Edges::of(&covered);
    let centre = centroid(&covered.outer);
    if edges.ends.len() < 3 {
        return Err(SkeletonError::TooFewPoints.into());
    }
    if (0..edges.ends.len()).any(|edge| edges.distance(edge, centre) <= 0.0) {
        return Err(RoofError::HiddenEdge);
    }
    let height = match slope {
        Slope::Angle(_) => slope.tangent(1.0)? * edges.distance(0, centre),
        Slope::Height(_) => slope.tangent(1.0)?,
    };
    let mut plan = PlanRoof::of_vertices(&covered);
    let mut rings: Vec<Vec<u32>> = vec![(0..covered.outer.len() as u32).collect()];
    for &(share, rise) in &BULB[1..BULB.len() - 1] {
        let at = |&p: &DVec2| plan.add_node(centre + (p - centre) * share, rise * height);
        rings.push(covered.outer.iter().map(at).collect());
    }
    let tip = plan.add_node(centre, height);
    for (edge, &(start, end)) in edges.ends.iter().enumerate() {
        let (s, e) = (start as usize, end as usize);
        let mut add =
            |ring| plan.faces.push(PlanFace { part: RoofPart::Top { edge: Some(edge) }, ring, holes: Vec::new() });
        rings.windows(2).for_each(|w| add(vec![w[0][s], w[0][e], w[1][e], w[1][s]]));
        rings.last().into_iter().for_each(|last| add(vec![last[s], last[e], tip]));
    }
    plan.warnings.extend((!polygon.holes.is_empty()).then_some(RoofWarning::HolesDropped));
    Ok(plan.into_roof(&covered))
}
