//! CGA `roofRidge`: two planes that meet in one level ridge. In: polygon, slope, direction. Out: the planes, walls up to
//! them, the bottom.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::plan::{PlanFace, PlanNode, PlanRoof};
use super::{Roof, RoofError, RoofPart, Slope};
use crate::geometry::cut::cut;
use crate::geometry::mesh::{Face, Mesh};
use crate::geometry::plane::Plane;
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::SkeletonError;

/// A ridge in direction `along` (plan) over the middle of the polygon's extent across it; the outline is cut there, walls
/// rise to the planes (CGA reference 4.9). `Slope::Height` is that of the ridge.
///
/// # Errors
/// Slope outside its domain; a direction without length.
pub fn ridge(polygon: &Polygon, slope: Slope, along: DVec2) -> Result<Roof, RoofError> {
    let across = along.try_normalize().ok_or(RoofError::Direction(along))?.perp();
    crested(polygon, slope, across, 0.5)
}

/// Planes of one slope that rise in direction `across` (length 1) over `share` of the polygon's extent and fall beyond.
pub(super) fn crested(polygon: &Polygon, slope: Slope, across: DVec2, share: f64) -> Result<Roof, RoofError> {
    let Some(&origin) = polygon.outer.first() else { return Err(SkeletonError::TooFewPoints.into()) };
    let extent =
        |f: fn(f64, f64) -> f64, start: f64| polygon.outer.iter().map(|&p| across.dot(p - origin)).fold(start, f);
    let (low, high) = (extent(f64::min, f64::INFINITY), extent(f64::max, f64::NEG_INFINITY));
    if high.is_nan() || low.is_nan() || high <= low {
        return Err(SkeletonError::TooFewPoints.into());
    }
    let reach = (high - low) * share;
    let crest = low + reach;
    let tangent = slope.tangent(reach)?;
    let height = |p: DVec2| match reach - (across.dot(p - origin) - crest).abs() {
        h if h <= 1e-9 * reach => 0.0,
        h => h * tangent,
    };
    let mut welded = Welded::default();
    for halves in cut_at(polygon, across, across.dot(origin) + crest) {
        welded.add(&halves);
    }
    welded.divide(across.perp(), |p| height(p) >= reach * tangent * (1.0 - 1e-9));
    Ok(welded.into_roof(polygon, height))
}

/// The polygon cut along the line `across . p = offset`: the side before the line, and the one beyond.
fn cut_at(polygon: &Polygon, across: DVec2, offset: f64) -> [Mesh; 2] {
    let mut mesh = Mesh::default();
    let mut face = Face::default();
    for (number, ring) in polygon.rings().enumerate() {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(ring.iter().map(|p| DVec3::new(p.x, 0.0, -p.y)));
        let ids = (first..mesh.positions.len() as u32).collect();
        if number == 0 { face.outer = ids } else { face.holes.push(ids) }
    }
    mesh.faces.push(face);
    let plane = Plane { normal: DVec3::new(across.x, 0.0, -across.y), offset };
    let sides = cut(&mesh, &plane);
    [sides.behind.mesh, sides.front.mesh]
}

/// Plan faces that share their corners by position.
#[derive(Default)]
struct Welded {
    ids: BTreeMap<(u64, u64), u32>,
    points: Vec<DVec2>,
    faces: Vec<Vec<Vec<u32>>>,
}

impl Welded {
    fn id(&mut self, p: DVec2) -> u32 {
        // + 0.0 makes the two zeros one.
        let key = ((p.x + 0.0).to_bits(), (p.y + 0.0).to_bits());
        *self.ids.entry(key).or_insert_with(|| {
            self.points.push(p);
            (self.points.len() - 1) as u32
        })
    }

    fn add(&mut self, mesh: &Mesh) {
        for face in &mesh.faces {
            let mut loops = Vec::new();
            for ring in face.loops() {
                let at = |&v: &u32| DVec2::new(mesh.positions[v as usize].x, -mesh.positions[v as usize].z);
                loops.push(ring.iter().map(|v| self.id(at(v))).collect());
            }
            self.faces.push(loops);
        }
    }

    /// Corners on the crest divide the edges along it: a corner that only touches it is missing on its other side.
    fn divide(&mut self, along: DVec2, is_crest: impl Fn(DVec2) -> bool) {
        let points = &self.points;
        let at = |id: u32| along.dot(points[id as usize]);
        let mut crest: Vec<u32> = (0..points.len() as u32).filter(|&id| is_crest(points[id as usize])).collect();
        crest.sort_by(|&p, &q| at(p).total_cmp(&at(q)));
        for ring in self.faces.iter_mut().flatten() {
            let mut divided = Vec::with_capacity(ring.len());
            for (k, &p) in ring.iter().enumerate() {
                divided.push(p);
                let q = ring[(k + 1) % ring.len()];
                if crest.contains(&p) && crest.contains(&q) {
                    let (low, high) = (at(p).min(at(q)), at(p).max(at(q)));
                    let between = crest.iter().copied().filter(|&id| at(id) > low && at(id) < high);
                    let first = divided.len();
                    divided.extend(between);
                    if at(p) > at(q) {
                        divided[first..].reverse();
                    }
                }
            }
            *ring = divided;
        }
    }

    /// Lift the faces, add walls below their outer edges, and the bottom.
    fn into_roof(mut self, polygon: &Polygon, height: impl Fn(DVec2) -> f64) -> Roof {
        let mut plan = PlanRoof::of_vertices(polygon);
        let base: Vec<u32> = polygon.rings().flatten().map(|&p| self.id(p)).collect();
        let mut bottom = vec![u32::MAX; self.points.len()];
        for (vertex, &id) in base.iter().enumerate() {
            bottom[id as usize] = vertex as u32;
        }
        for (id, &p) in self.points.iter().enumerate() {
            if bottom[id] == u32::MAX {
                bottom[id] = plan.add_node(p, 0.0);
            }
        }
        let mut top = bottom.clone();
        for (id, &position) in self.points.iter().enumerate() {
            let h = height(position);
            if h > 0.0 {
                plan.nodes.push(PlanNode { position, height: h });
                top[id] = (plan.nodes.len() - 1) as u32;
            }
        }
        let pieces = Pieces { welded: &self, polygon, base: &base, top: &top };
        pieces.add_walls(&mut plan);
        for loops in &self.faces {
            let mut rings = loops.iter().map(|r| r.iter().map(|&id| top[id as usize]).collect::<Vec<u32>>());
            let ring = rings.next().unwrap_or_default();
            plan.faces.push(PlanFace { part: RoofPart::Top { edge: None }, ring, holes: rings.collect() });
        }
        plan.into_roof(polygon)
    }
}

struct Pieces<'a> {
    welded: &'a Welded,
    polygon: &'a Polygon,
    /// What each vertex of the polygon was welded to; rings that touch have several at one place.
    base: &'a [u32],
    top: &'a [u32],
}

impl Pieces<'_> {
    /// A wall for every footprint edge that has a height somewhere, with a corner where the ridge crosses it.
    fn add_walls(&self, plan: &mut PlanRoof) {
        let mut next: BTreeMap<(u32, u32), ()> = BTreeMap::new();
        for ring in self.welded.faces.iter().flatten() {
            next.extend((0..ring.len()).map(|k| ((ring[k], ring[(k + 1) % ring.len()]), ())));
        }
        let id = |vertex: u32| self.base[vertex as usize];
        let ends = super::plan::Edges::of(self.polygon).ends;
        for (edge, &(start, end)) in ends.iter().enumerate() {
            let (s, e) = (id(start), id(end));
            // The outline is cut at most once per edge.
            let middle = if next.contains_key(&(s, e)) {
                None
            } else {
                next.range((s, 0)..=(s, u32::MAX)).map(|(&(_, m), _)| m).find(|&m| next.contains_key(&(m, e)))
            };
            let mut ring = vec![start, end, self.top[e as usize]];
            ring.extend(middle.map(|m| self.top[m as usize]));
            ring.push(self.top[s as usize]);
            ring.dedup();
            if ring.first() == ring.last() {
                ring.pop();
            }
            if ring.len() >= 3 {
                plan.faces.push(PlanFace { part: RoofPart::Side { edge }, ring, holes: Vec::new() });
            }
        }
    }
}
