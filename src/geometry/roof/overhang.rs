//! Overhangs: roof planes continued beyond their eaves. In: a roof over a polygon, distances in plan. Out: the same roof,
//! its planes joined with the strips outside.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::plan::{PlanFace, PlanRoof};
use super::{RoofError, RoofPart};
use crate::geometry::offset::{FRAME, grow, reversed_edge};
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::Skeleton;

/// The strip outside an edge: the nodes from the start of the edge outwards, along, and back to its end, without the ends.
pub(super) type Strip = Vec<u32>;

/// The strips outside all edges.
pub(super) struct Strips {
    /// By edge.
    pub outside: Vec<Strip>,
    /// Edges whose strips meet in a point where their planes are not equally high: before the same opening, say.
    pub torn: BTreeSet<usize>,
}

/// Planes may differ in height by rounding, as a share of the outline's extent.
const ROUNDING: f64 = 1e-9;

/// Continue every roof plane by the distance of its edge; `height` is that of the plane of an edge at a point.
pub(super) fn extend(
    plan: &mut PlanRoof,
    polygon: &Polygon,
    distances: &[f64],
    height: impl Fn(usize, DVec2) -> f64,
) -> Result<(), RoofError> {
    let strips = add_strips(plan, polygon, distances, &height)?;
    extend_with(plan, polygon, distances, &strips.outside);
    Ok(())
}

/// Join every roof plane with the strip outside its eave.
pub(super) fn extend_with(plan: &mut PlanRoof, polygon: &Polygon, distances: &[f64], strips: &[Strip]) {
    for face in &mut plan.faces {
        let RoofPart::Top { edge: Some(edge) } = face.part else { continue };
        if distances[edge] > 0.0 && face.ring.first() == Some(&(edge as u32)) {
            face.ring.splice(1..1, strips[edge].iter().copied());
        }
        remove_spikes(&mut face.ring);
    }
    drop_inner_vertices(plan, polygon);
}

/// a, b, a becomes a; a, a becomes a.
fn remove_spikes(ring: &mut Vec<u32>) {
    let mut k = 0;
    while ring.len() > 2 && k < ring.len() {
        let (here, next, after) = (ring[k], ring[(k + 1) % ring.len()], ring[(k + 2) % ring.len()]);
        if here == next {
            ring.remove((k + 1) % ring.len());
        } else if here == after {
            let first = (k + 1) % ring.len();
            ring.remove(first);
            ring.remove(if first < ring.len() { first } else { 0 });
        } else {
            k += 1;
            continue;
        }
        k = 0;
    }
}

/// Add the nodes of the strips outside, and the bevels of cut-off corners as faces. One strip per edge.
pub(super) fn add_strips(
    plan: &mut PlanRoof,
    polygon: &Polygon,
    distances: &[f64],
    height: &impl Fn(usize, DVec2) -> f64,
) -> Result<Strips, RoofError> {
    let outside = grow(polygon, distances)?;
    let mut strips = Strips { outside: vec![Strip::new(); distances.len()], torn: BTreeSet::new() };
    let extent = polygon.bounds().map_or(0.0, |(low, high)| (high - low).max_element());
    let raise = Raise { distances, height, tolerance: ROUNDING * extent };
    let rings = polygon.rings().zip(std::iter::once(&outside.around).chain(&outside.in_holes));
    let mut first = 0;
    for (number, (ring, skeleton)) in rings.enumerate() {
        let frame = if number == 0 { FRAME } else { 0 };
        let offset = Reversed { frame, first, count: ring.len() };
        add_ring_strips(plan, skeleton, &offset, &mut strips, &raise);
        first += ring.len();
    }
    Ok(strips)
}

/// How edges and vertices of a reversed ring are numbered in the polygon.
struct Reversed {
    frame: usize,
    first: usize,
    count: usize,
}

impl Reversed {
    fn edge(&self, edge: usize) -> Option<usize> {
        Some(self.first + reversed_edge(edge.checked_sub(self.frame)?, self.count))
    }

    fn vertex(&self, node: usize) -> Option<u32> {
        let k = node.checked_sub(self.frame)?;
        (k < self.count).then(|| (self.first + self.count - 1 - k) as u32)
    }
}

/// How high the planes of edges are outside.
struct Raise<'a, H> {
    distances: &'a [f64],
    height: &'a H,
    tolerance: f64,
}

impl<H: Fn(usize, DVec2) -> f64> Raise<'_, H> {
    /// Whether the plane of an edge that has a strip is not at the known height.
    fn tears(&self, edge: usize, p: DVec2, known: f64) -> bool {
        self.distances[edge] > 0.0 && ((self.height)(edge, p) - known).abs() > self.tolerance
    }
}

fn add_ring_strips(
    plan: &mut PlanRoof,
    skeleton: &Skeleton,
    numbers: &Reversed,
    strips: &mut Strips,
    raise: &Raise<'_, impl Fn(usize, DVec2) -> f64>,
) {
    let mut known: Vec<Option<u32>> = (0..skeleton.nodes.len()).map(|n| numbers.vertex(n)).collect();
    let mut raised_by: BTreeMap<u32, usize> = BTreeMap::new();
    // Edges without a strip have no say in the height of a corner that others have too.
    let mut faces: Vec<_> = skeleton.faces.iter().filter_map(|f| Some((numbers.edge(f.edge)?, f))).collect();
    faces.sort_by_key(|(edge, _)| raise.distances[*edge] == 0.0);
    for (edge, face) in faces {
        let ring = face.boundary.iter().map(|&n| {
            let p = skeleton.nodes[n as usize].position;
            let id = *known[n as usize].get_or_insert_with(|| {
                let id = plan.add_node(p, (raise.height)(edge, p));
                raised_by.insert(id, edge);
                id
            });
            if let Some(&other) = raised_by.get(&id)
                && raise.tears(edge, p, plan.node(id).height)
            {
                strips.torn.extend([edge, other]);
            }
            id
        });
        // The strip starts with the reversed edge: end, start.
        strips.outside[edge] = ring.skip(2).collect();
    }
    for extra in &skeleton.extras {
        let ring: Option<Vec<u32>> = extra.iter().map(|&n| known[n as usize]).collect();
        if let Some(ring) = ring {
            plan.faces.push(PlanFace { part: RoofPart::Top { edge: None }, ring, holes: Vec::new() });
        }
    }
}

/// A vertex of the polygon that now lies inside the seam of two continued planes is no corner of them any more.
fn drop_inner_vertices(plan: &mut PlanRoof, polygon: &Polygon) {
    let count: usize = polygon.rings().map(Vec::len).sum();
    let mut uses = vec![0; count];
    for &n in plan.faces.iter().flat_map(|f| &f.ring) {
        if (n as usize) < count {
            uses[n as usize] += 1;
        }
    }
    let inner: Vec<bool> = (0..count).map(|v| uses[v] == 2 && on_seam(plan, v as u32)).collect();
    for face in &mut plan.faces {
        face.ring.retain(|&n| !inner.get(n as usize).is_some_and(|&drop| drop));
    }
}

/// Whether the two faces that use a vertex have the same neighbours of it, on one line.
fn on_seam(plan: &PlanRoof, v: u32) -> bool {
    let mut neighbours = plan.faces.iter().filter_map(|f| {
        let at = f.ring.iter().position(|&n| n == v)?;
        let n = f.ring.len();
        let (p, q) = (f.ring[(at + n - 1) % n], f.ring[(at + 1) % n]);
        Some((p.min(q), p.max(q)))
    });
    neighbours.next().is_some_and(|first| neighbours.all(|other| other == first))
}
