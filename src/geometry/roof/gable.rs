//! CGA `roofGable`: a hip roof whose triangular ends stand upright. In: polygon, slope, overhangs. Out: planes and
//! pediments.

use glam::DVec2;

use super::hip::level_ridges;
use super::overhang::{add_strips, extend_with};
use super::plan::{Edges, PlanFace, PlanNode, PlanRoof};
use super::{Roof, RoofError, RoofPart, RoofWarning, Slope, check_overhang};
use crate::geometry::polygon::Polygon;
use crate::geometry::predicates::orientation;
use crate::geometry::skeleton::skeleton;

/// Hip faces that are triangles become pediments over their edge. `overhang_x` continues the planes at their eaves,
/// `overhang_y` along the ridge beyond the pediments, both metres on the plane. `index` puts the pediments over that edge
/// and the opposite one; convex outlines without holes only (CGA reference 4.9, compatibility notes).
///
/// # Errors
/// Slope or overhang outside their domain; those of the skeleton.
pub fn gable(
    polygon: &Polygon,
    slope: Slope,
    overhang_x: f64,
    overhang_y: f64,
    even: bool,
    index: Option<i64>,
) -> Result<Roof, RoofError> {
    let (out, beyond) = (check_overhang(overhang_x)?, check_overhang(overhang_y)?);
    slope.tangent(1.0)?;
    let mut plan = match index {
        Some(index) if polygon.holes.is_empty() && is_convex(polygon) => gabled_over(polygon, index)?,
        _ => gabled(polygon)?,
    };
    let tangent = slope.tangent(plan.highest())?;
    let ignored = index.is_some() && !(polygon.holes.is_empty() && is_convex(polygon));
    plan.warnings.extend(ignored.then_some(RoofWarning::IndexIgnored));
    plan.scale_heights(tangent);
    if even && (index.is_none() || ignored) {
        level_ridges(&mut plan, polygon);
    }
    if out > 0.0 || beyond > 0.0 {
        continue_planes(&mut plan, polygon, tangent, out, beyond)?;
    }
    Ok(plan.into_roof(polygon))
}

/// OSM `roof:shape=half-hipped`: gables whose tip is a small hip. `fraction` of the pediment's height stays upright.
///
/// # Errors
/// Slope or fraction outside their domain; those of the skeleton.
pub fn half_hipped(polygon: &Polygon, slope: Slope, fraction: f64) -> Result<Roof, RoofError> {
    half_hipped_over(gabled(polygon)?, polygon, slope, fraction)
}

/// The same over a gable roof of slope 1.
pub(super) fn half_hipped_over(
    mut plan: PlanRoof,
    polygon: &Polygon,
    slope: Slope,
    fraction: f64,
) -> Result<Roof, RoofError> {
    if !(0.0..=1.0).contains(&fraction) {
        return Err(RoofError::Fraction(fraction));
    }
    slope.tangent(1.0)?;
    if fraction < 1.0 {
        clip_gables(&mut plan, polygon, fraction);
    }
    let tangent = slope.tangent(plan.highest())?;
    plan.scale_heights(tangent);
    Ok(plan.into_roof(polygon))
}

/// The gable roof of slope 1 without a chosen ridge. A triangle gets its pediment over the shortest edge, an outline of four
/// edges whose hips all meet in one point over edges 1 and 3.
pub(super) fn gabled(polygon: &Polygon) -> Result<PlanRoof, RoofError> {
    let edges = Edges::of(polygon);
    if edges.ends.len() == 3 {
        let length = |e: usize| edges.start(e).distance_squared(edges.end(e));
        let shortest = (0..3).min_by(|&p, &q| length(p).total_cmp(&length(q))).unwrap_or(0);
        return upright_at(polygon, &[shortest]);
    }
    let hip = skeleton(polygon, None)?;
    let single = hip.nodes.len() == edges.ends.len() + 1;
    if single && edges.ends.len() == 4 {
        return upright_at(polygon, &[1, 3]);
    }
    let mut plan = PlanRoof::of_skeleton(hip);
    let ends: Vec<usize> = (0..plan.faces.len()).filter(|&f| !single && is_end(&plan, &edges, f)).collect();
    for f in ends {
        if let RoofPart::Top { edge: Some(edge) } = plan.faces[f].part
            && let Some(tip) = tip_over(&edges, edge)
        {
            let node = plan.faces[f].ring[2];
            plan.nodes[node as usize] = tip;
            plan.faces[f].part = RoofPart::Side { edge };
        }
    }
    Ok(plan)
}

/// Whether a face is a triangle whose tip belongs to it and the planes of its two neighbours only.
fn is_end(plan: &PlanRoof, edges: &Edges, f: usize) -> bool {
    let face = &plan.faces[f];
    let (RoofPart::Top { edge: Some(edge) }, &[_, _, tip]) = (face.part, &face.ring[..]) else { return false };
    let around = plan.faces.iter().filter(|g| g.ring.contains(&tip)).map(|g| g.part);
    let own = [edges.before(edge), edge, edges.after(edge)].map(|e| RoofPart::Top { edge: Some(e) });
    let mut count = 0;
    for part in around {
        if !own.contains(&part) {
            return false;
        }
        count += 1;
    }
    count == 3
}

/// A neighbour that turns off by less than a part in so many leaves no room for a pediment beside its wall.
const LEAST_TURN: f64 = 1e-3;

/// Where the planes (of slope 1) of an edge's neighbours are equally high over the edge; nowhere if the edge goes on
/// almost straight, which no end of a building does.
fn tip_over(edges: &Edges, edge: usize) -> Option<PlanNode> {
    let (before, after) = (edges.before(edge), edges.after(edge));
    let (at_start, at_end) = (edges.distance(after, edges.start(edge)), edges.distance(before, edges.end(edge)));
    let least = LEAST_TURN * edges.start(edge).distance(edges.end(edge));
    if !(at_start > least && at_end > least) {
        return None;
    }
    let u = at_start / (at_start + at_end);
    Some(PlanNode { position: edges.start(edge).lerp(edges.end(edge), u), height: u * at_end })
}

/// The roof of slope 1 whose given edges carry pediments: the skeleton in which they stand still.
fn upright_at(polygon: &Polygon, upright: &[usize]) -> Result<PlanRoof, RoofError> {
    let mut weights = vec![1.0; polygon.rings().map(Vec::len).sum()];
    for &edge in upright {
        weights[edge] = 0.0;
    }
    let mut skeleton = skeleton(polygon, Some(&weights))?;
    let extras = std::mem::take(&mut skeleton.extras);
    let mut plan = PlanRoof::of_skeleton(skeleton);
    for face in &mut plan.faces {
        if let RoofPart::Top { edge: Some(edge) } = face.part
            && upright.contains(&edge)
        {
            face.part = RoofPart::Side { edge };
        }
    }
    for ring in extras {
        plan.faces.push(PlanFace { part: RoofPart::Top { edge: None }, ring, holes: Vec::new() });
    }
    Ok(plan)
}

/// The gable roof of slope 1 over a convex outline, with pediments over an edge and the opposite one.
pub(super) fn gabled_over(polygon: &Polygon, index: i64) -> Result<PlanRoof, RoofError> {
    upright_at(polygon, &opposite(polygon, index))
}

/// The edges that carry the pediments for an index: it and the opposite one; on a triangle the one opposite to vertex
/// `index`, where the ridge ends.
fn opposite(polygon: &Polygon, index: i64) -> Vec<usize> {
    let count = polygon.outer.len();
    let first = index.rem_euclid(count as i64) as usize;
    match count {
        3 => vec![(first + 1) % 3],
        _ => vec![first, (first + count / 2) % count],
    }
}

pub(super) fn is_convex(polygon: &Polygon) -> bool {
    let Some((low, high)) = polygon.bounds() else { return false };
    let Some(grid) = crate::geometry::grid::Grid::over(low, high) else { return false };
    let points: Vec<[i64; 2]> = polygon.outer.iter().map(|&p| grid.snap(p)).collect();
    let n = points.len();
    (0..n).all(|i| orientation(points[i], points[(i + 1) % n], points[(i + 2) % n]) >= 0)
}

/// Direction of the ridge over an edge, from the pediment inwards, in plan; its rise per metre in planes of slope 1.
fn ridge_over(edges: &Edges, edge: usize) -> Option<(DVec2, f64)> {
    let (before, after) = (edges.normal(edges.before(edge)), edges.normal(edges.after(edge)));
    let mut along = (before - after).perp().try_normalize()?;
    if along.dot(edges.normal(edge)) < 0.0 {
        along = -along;
    }
    Some((along, before.dot(along)))
}

/// Overhangs: planes grow by `out` at eaves and by `beyond` at pediments.
fn continue_planes(
    plan: &mut PlanRoof,
    polygon: &Polygon,
    tangent: f64,
    out: f64,
    beyond: f64,
) -> Result<(), RoofError> {
    let edges = Edges::of(polygon);
    let mut distances = vec![out / (1.0 + tangent * tangent).sqrt(); edges.ends.len()];
    let mut pediments: Vec<(usize, u32)> = Vec::new();
    for face in &plan.faces {
        let RoofPart::Side { edge } = face.part else { continue };
        distances[edge] = 0.0;
        if let &[_, _, tip] = &face.ring[..]
            && let Some((along, rise)) = ridge_over(&edges, edge)
        {
            let slant = (1.0 + (rise * tangent) * (rise * tangent)).sqrt();
            distances[edge] = beyond * along.dot(edges.normal(edge)) / slant;
            pediments.push((edge, tip));
        }
    }
    let upright: Vec<usize> = pediments.iter().map(|p| p.0).collect();
    let height = |edge: usize, p: DVec2| {
        if upright.contains(&edge) {
            tangent * f64::min(edges.distance(edges.before(edge), p), edges.distance(edges.after(edge), p))
        } else {
            tangent * edges.distance(edge, p)
        }
    };
    let bare = plan.clone();
    let strips = loop {
        let strips = add_strips(plan, polygon, &distances, &height)?;
        // The strip before a pediment is no plane of its own: where it meets others it stays flush with its wall.
        let flush: Vec<usize> =
            strips.torn.iter().copied().filter(|e| upright.contains(e) && distances[*e] > 0.0).collect();
        if flush.is_empty() {
            break strips;
        }
        flush.into_iter().for_each(|edge| distances[edge] = 0.0);
        plan.clone_from(&bare);
    };
    for (edge, tip) in pediments {
        if distances[edge] > 0.0 {
            cover_pediment(plan, &edges, edge, tip, &strips.outside[edge]);
        }
    }
    extend_with(plan, polygon, &distances, &strips.outside);
    Ok(())
}

/// Continue the two planes beside a pediment over the strip outside it, up to the ridge's continuation.
fn cover_pediment(plan: &mut PlanRoof, edges: &Edges, edge: usize, tip: u32, strip: &[u32]) {
    let (before, after) = (edges.before(edge), edges.after(edge));
    let balance = |n: u32| {
        let p = plan.node(n).position;
        edges.distance(before, p) - edges.distance(after, p)
    };
    let Some(k) = (1..strip.len()).find(|&k| balance(strip[k - 1]) < 0.0 && balance(strip[k]) >= 0.0) else { return };
    let (p, q) = (strip[k - 1], strip[k]);
    let u = balance(p) / (balance(p) - balance(q));
    let position = plan.node(p).position.lerp(plan.node(q).position, u);
    // The ridge's height there: on the line through the tip and the planes' common slope.
    let inside = plan.node(tip);
    let scale = edges.distance(before, inside.position);
    let height = if scale > 0.0 { inside.height * edges.distance(before, position) / scale } else { inside.height };
    let end = plan.add_node(position, height);
    let (start, stop) = edges.ends[edge];
    for face in &mut plan.faces {
        let RoofPart::Top { edge: Some(own) } = face.part else { continue };
        if own == before
            && let Some(at) = face.ring.iter().position(|&n| n == start)
        {
            face.ring.splice(at + 1..at + 1, strip[..k].iter().copied().chain([end]));
        } else if own == after
            && let Some(at) = face.ring.iter().position(|&n| n == tip)
        {
            debug_assert_eq!(face.ring[(at + 1) % face.ring.len()], stop);
            face.ring.splice(at + 1..at + 1, std::iter::once(end).chain(strip[k..].iter().copied()));
        }
    }
}

/// Share of a ridge that half hips leave at least.
const RIDGE_LEFT: f64 = 0.1;

/// A pediment that gets a half hip.
struct End {
    face: usize,
    edge: usize,
    corners: [u32; 2],
    tip: u32,
    /// Direction of the ridge inwards, and its rise per metre.
    along: DVec2,
    rise: f64,
    /// Where the plane of the edge itself would meet the ridge, metres from the tip.
    reach: f64,
}

fn ends(plan: &PlanRoof, edges: &Edges) -> Vec<End> {
    let end = |(face, f): (usize, &PlanFace)| {
        let (RoofPart::Side { edge }, &[start, stop, tip]) = (f.part, &f.ring[..]) else { return None };
        let (along, rise) = ridge_over(edges, edge)?;
        let reach = plan.node(tip).height / (along.dot(edges.normal(edge)) - rise);
        Some(End { face, edge, corners: [start, stop], tip, along, rise, reach })
    };
    plan.faces.iter().enumerate().filter_map(end).collect()
}

/// How much of each pediment's tip is clipped: `most`, or what leaves some of the ridge.
fn clipped(plan: &PlanRoof, ends: &[End], most: f64) -> Vec<f64> {
    let share = |end: &End| {
        let beside = plan.faces.iter().filter(|f| matches!(f.part, RoofPart::Top { .. }));
        let neighbours = beside.filter_map(|f| {
            let at = f.ring.iter().position(|&n| n == end.tip)?;
            let n = f.ring.len();
            [f.ring[(at + n - 1) % n], f.ring[(at + 1) % n]].into_iter().find(|n| !end.corners.contains(n))
        });
        let position = |n: u32| plan.node(n).position;
        let room = |n: u32| {
            let other = ends.iter().find(|e| e.tip == n).map_or(0.0, |e| e.reach);
            position(end.tip).distance(position(n)) * (1.0 - RIDGE_LEFT) / (end.reach + other)
        };
        neighbours.map(room).fold(most, f64::min)
    };
    ends.iter().map(share).collect()
}

/// Replace the tip of every pediment by a plane that starts at `fraction` of its height, higher where the ridge is short.
fn clip_gables(plan: &mut PlanRoof, polygon: &Polygon, fraction: f64) {
    let edges = Edges::of(polygon);
    let ends = ends(plan, &edges);
    let shares = clipped(plan, &ends, 1.0 - fraction);
    for (End { face: f, edge, corners: [start, stop], tip, along, rise, reach }, share) in ends.into_iter().zip(shares)
    {
        let top = *plan.node(tip);
        let shrunk = |p: DVec2, h: f64| (top.position.lerp(p, share), top.height + (h - top.height) * share);
        let mut add = |(position, height)| plan.add_node(position, height);
        let left = add(shrunk(edges.start(edge), 0.0));
        let right = add(shrunk(edges.end(edge), 0.0));
        let inner = add(shrunk(top.position + along * reach, top.height + rise * reach));
        for face in &mut plan.faces {
            if let RoofPart::Top { edge: Some(own) } = face.part
                && let Some(at) = face.ring.iter().position(|&n| n == tip)
            {
                let both = if own == edges.before(edge) { [left, inner] } else { [inner, right] };
                face.ring.splice(at..=at, both);
            }
        }
        plan.faces[f].ring = if share < 1.0 { vec![start, stop, right, left] } else { Vec::new() };
        let ring = vec![left, right, inner];
        plan.faces.push(PlanFace { part: RoofPart::Top { edge: Some(edge) }, ring, holes: Vec::new() });
    }
    plan.faces.retain(|f| !f.ring.is_empty());
    plan.faces.sort_by_key(|f| match f.part {
        RoofPart::Bottom => 0,
        RoofPart::Side { edge } | RoofPart::Top { edge: Some(edge) } => edge,
        RoofPart::Top { edge: None } => usize::MAX,
    });
}
