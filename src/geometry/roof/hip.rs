//! CGA `roofHip`: a roof plane over every edge. In: polygon, slope, overhang. Out: the lifted straight skeleton.

use std::collections::BTreeMap;

use super::overhang::extend;
use super::plan::{Edges, PlanRoof};
use super::{Roof, RoofError, RoofPart, Slope, check_overhang};
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::skeleton;

/// The straight skeleton, lifted. `overhang` (metres, measured down the planes) continues every plane beyond its eave;
/// `even` levels the ridges at their mean height (CGA reference 4.9).
///
/// # Errors
/// Slope or overhang outside their domain; those of the skeleton.
pub fn hip(polygon: &Polygon, slope: Slope, overhang: f64, even: bool) -> Result<Roof, RoofError> {
    let overhang = check_overhang(overhang)?;
    slope.tangent(1.0)?;
    let mut plan = PlanRoof::of_skeleton(skeleton(polygon, None)?);
    let tangent = slope.tangent(plan.highest())?;
    plan.scale_heights(tangent);
    if even {
        level_ridges(&mut plan, polygon);
    }
    if overhang > 0.0 {
        // Measured on the plane: cos(a) of it in plan.
        let out = overhang / (1.0 + tangent * tangent).sqrt();
        let edges = Edges::of(polygon);
        extend(&mut plan, polygon, &vec![out; edges.ends.len()], |edge, p| tangent * edges.distance(edge, p))?;
    }
    Ok(plan.into_roof(polygon))
}

/// Set the ends of all ridges to their mean height. A ridge separates planes of edges that are not neighbours and rise
/// towards it.
pub(super) fn level_ridges(plan: &mut PlanRoof, polygon: &Polygon) {
    let edges = Edges::of(polygon);
    let mut sides: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for face in &plan.faces {
        if let RoofPart::Top { edge: Some(edge) } = face.part {
            let ring = &face.ring;
            sides.extend((0..ring.len()).map(|k| ((ring[k], ring[(k + 1) % ring.len()]), edge)));
        }
    }
    let inner = |n: u32| plan.node(n).height > 0.0;
    let mut ridge: Vec<u32> = sides
        .iter()
        .filter(|&(&(p, q), &left)| {
            let Some(&right) = sides.get(&(q, p)) else { return false };
            let neighbours = edges.after(left) == right || edges.before(left) == right;
            // Convex if on its own side the left plane is the lower one.
            let to_left = (plan.node(q).position - plan.node(p).position).perp();
            let convex = (edges.normal(left) - edges.normal(right)).dot(to_left) < 0.0;
            inner(p) && inner(q) && !neighbours && convex
        })
        .flat_map(|(&(p, q), _)| [p, q])
        .collect();
    ridge.sort_unstable();
    ridge.dedup();
    if ridge.is_empty() {
        return;
    }
    let mean = ridge.iter().map(|&n| plan.node(n).height).sum::<f64>() / ridge.len() as f64;
    for n in ridge {
        plan.nodes[n as usize].height = mean;
    }
}
