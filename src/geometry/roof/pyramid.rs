//! CGA `roofPyramid`: one triangle per edge to an apex. In: polygon, slope. Out: the roof; holes are covered.

use glam::DVec2;

use super::plan::{Edges, PlanFace, PlanRoof};
use super::{Roof, RoofError, RoofPart, RoofWarning, Slope};
use crate::geometry::polygon::Polygon;

/// Apex over the mean of the vertices, even where that lies outside; `Slope::Angle` is the slope of the first triangle
/// (CGA reference 4.9, compatibility notes).
///
/// # Errors
/// Slope outside its domain.
pub fn pyramid(polygon: &Polygon, slope: Slope) -> Result<Roof, RoofError> {
    let covered = Polygon { outer: polygon.outer.clone(), holes: Vec::new() };
    let edges = Edges::of(&covered);
    let Some(&origin) = covered.outer.first() else {
        return Err(crate::geometry::skeleton::SkeletonError::TooFewPoints.into());
    };
    // About the first vertex, so that far coordinates cost no digits.
    let sum: DVec2 = covered.outer.iter().map(|&p| p - origin).sum();
    let apex = origin + sum / covered.outer.len() as f64;
    let height = match slope {
        Slope::Angle(_) => slope.tangent(1.0)? * edges.distance(0, apex).abs(),
        Slope::Height(_) => slope.tangent(1.0)?,
    };
    let mut plan = PlanRoof::of_vertices(&covered);
    let top = plan.add_node(apex, height);
    for (edge, &(start, end)) in edges.ends.iter().enumerate() {
        let part = RoofPart::Top { edge: Some(edge) };
        plan.faces.push(PlanFace { part, ring: vec![start, end, top], holes: Vec::new() });
    }
    if !polygon.holes.is_empty() {
        plan.warnings.push(RoofWarning::HolesDropped);
    }
    let tolerance = 1e-9 * covered.bounds().map_or(0.0, |(low, high)| (high - low).max_element());
    if (0..edges.ends.len()).any(|edge| edges.distance(edge, apex) < -tolerance) {
        plan.warnings.push(RoofWarning::Overlapping);
    }
    Ok(plan.into_roof(&covered))
}
