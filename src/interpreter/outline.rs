//! The edges of the initial shape with what the host says about them. In: the start mesh and [`HostData`]. Out: which
//! edge a geometry lies along (`edgeAttr.*`, reference 6.9).

use glam::{DVec2, DVec3};

use super::form::Form;
use super::host::{HostData, edges_with_length};
use super::placement::perpendicular;
use crate::geometry::{Mesh, PlaneFrame, Polygon};

/// An edge of the initial shape in the plane of the shape.
#[derive(Clone, Copy, Debug)]
pub struct OutlineEdge {
    pub from: DVec2,
    pub to: DVec2,
    /// Away from the face, unit length.
    pub outward: DVec2,
    /// Number of the edge in the host's mesh.
    pub number: usize,
}

/// All face edges of the initial shape in its average plane.
#[derive(Clone, Debug)]
pub struct Outline {
    pub edges: Vec<OutlineEdge>,
    pub frame: PlaneFrame,
}

/// Lengths below this are none, metres.
const NO_LENGTH: f64 = 1e-6;

impl Outline {
    /// `given` is the host's mesh, `mesh` the one derived from.
    pub fn new(given: &Mesh, mesh: &Mesh) -> Outline {
        let sum: DVec3 = mesh.faces.iter().map(|f| mesh.newell(f)).sum();
        let normal = sum.try_normalize().unwrap_or(DVec3::Y);
        let origin = mesh.positions.first().copied().unwrap_or_default();
        let u = perpendicular(normal, DVec3::X, DVec3::Z);
        let frame = PlaneFrame { origin, u, v: normal.cross(u), normal };
        let numbers = edges_with_length(given);
        let edges = mesh.faces.iter().flat_map(|face| face.edges()).zip(numbers).map(|((a, b), number)| {
            let [from, to] = [a, b].map(|v| frame.to_plan(mesh.positions[v as usize]));
            OutlineEdge { from, to, outward: -(to - from).perp().normalize_or_zero(), number }
        });
        Outline { edges: edges.collect(), frame }
    }

    /// The number of the edge that the geometry covers most of, seen along its average normal.
    pub fn covered_most(&self, form: &Form) -> Option<usize> {
        let mesh = &form.mesh;
        let normal: DVec3 = mesh.faces.iter().map(|f| mesh.newell(f)).chain(form.normals.iter().copied()).sum();
        let across = DVec2::new(normal.dot(self.frame.u), normal.dot(self.frame.v));
        let lengths = if across.length() > NO_LENGTH * normal.length() {
            self.hit_lengths(mesh, across.normalize())
        } else {
            self.lengths_below(mesh)
        };
        let mut best: Option<(usize, f64)> = None;
        for (edge, length) in self.edges.iter().zip(lengths) {
            if length > 0.0 && best.is_none_or(|(_, most)| length > most * (1.0 + 1e-9)) {
                best = Some((edge.number, length));
            }
        }
        best.map(|(number, _)| number)
    }

    /// Per edge the length that is met first, looking from the geometry along `along`; where nothing lies ahead, the
    /// nearest edge behind.
    fn hit_lengths(&self, mesh: &Mesh, along: DVec2) -> Vec<f64> {
        let side = along.perp();
        let points: Vec<DVec2> = mesh.positions.iter().map(|&p| self.frame.to_plan(p)).collect();
        let (low, high) = range(points.iter().map(|p| p.dot(side)));
        let depth = points.iter().map(|p| p.dot(along)).sum::<f64>() / points.len().max(1) as f64;
        let mut cuts: Vec<f64> = self.edges.iter().flat_map(|e| [e.from.dot(side), e.to.dot(side)]).collect();
        cuts.retain(|&c| c > low && c < high);
        cuts.extend([low, high]);
        cuts.sort_by(f64::total_cmp);
        let mut lengths = vec![0.0; self.edges.len()];
        for pair in cuts.windows(2) {
            let width = (pair[1] - pair[0]).max(NO_LENGTH);
            if let Some(i) = self.first_hit((pair[0] + pair[1]) / 2.0, depth, along, side) {
                lengths[i] += width / self.edges[i].outward.dot(along);
            }
        }
        lengths
    }

    /// The edge facing `along` that lies nearest ahead of `depth` on the line at `across`, else nearest behind.
    fn first_hit(&self, across: f64, depth: f64, along: DVec2, side: DVec2) -> Option<usize> {
        let distance = |edge: &OutlineEdge| {
            let (a, b) = (edge.from.dot(side), edge.to.dot(side));
            if edge.outward.dot(along) <= NO_LENGTH || across < a.min(b) || across > a.max(b) {
                return None;
            }
            let t = if a == b { 0.5 } else { (across - a) / (b - a) };
            let ahead = edge.from.lerp(edge.to, t).dot(along) - depth;
            // Ahead before behind, near before far.
            Some((ahead < -NO_LENGTH, ahead.abs()))
        };
        let hits = self.edges.iter().enumerate().filter_map(|(i, e)| Some((i, distance(e)?)));
        hits.min_by(|(_, a), (_, b)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|(i, _)| i)
    }

    /// Per edge the length that lies in the geometry's projection onto the plane.
    fn lengths_below(&self, mesh: &Mesh) -> Vec<f64> {
        let faces: Vec<Polygon> = mesh.faces.iter().map(|f| self.frame.face_to_plan(mesh, f)).collect();
        let covered = |p: DVec2| faces.iter().any(|f| f.contains(p) || border_distance(f, p) <= NO_LENGTH);
        let length = |edge: &OutlineEdge| {
            let along = edge.to - edge.from;
            let mut cuts: Vec<f64> = vec![0.0, 1.0];
            for (a, b) in faces.iter().flat_map(|f| f.rings()).flat_map(|r| segments(r)) {
                cuts.extend(crossing(edge.from, along, a, b));
            }
            cuts.sort_by(f64::total_cmp);
            let parts = cuts.windows(2).filter(|w| covered(edge.from + along * ((w[0] + w[1]) / 2.0)));
            parts.map(|w| w[1] - w[0]).sum::<f64>() * along.length()
        };
        self.edges.iter().map(length).collect()
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

fn segments(ring: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]))
}

fn border_distance(polygon: &Polygon, p: DVec2) -> f64 {
    let all = polygon.rings().flat_map(|r| segments(r));
    all.map(|(a, b)| p.distance(nearest_on_segment(p, a, b))).fold(f64::INFINITY, f64::min)
}

/// The point of a segment nearest to `p`.
pub fn nearest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let along = b - a;
    let squared = along.length_squared();
    if squared == 0.0 { a } else { a + along * ((p - a).dot(along) / squared).clamp(0.0, 1.0) }
}

/// Where on `from + t along`, 0 < t < 1, the line meets segment `ab`, or passes its ends on one line with it.
fn crossing(from: DVec2, along: DVec2, a: DVec2, b: DVec2) -> Vec<f64> {
    let inside = |t: f64| t > 0.0 && t < 1.0;
    let (da, db) = (along.perp_dot(a - from), along.perp_dot(b - from));
    let squared = along.length_squared();
    if squared == 0.0 {
        return Vec::new();
    }
    if da.abs().max(db.abs()) <= NO_LENGTH * squared.sqrt() {
        return [a, b].map(|p| (p - from).dot(along) / squared).into_iter().filter(|&t| inside(t)).collect();
    }
    if (da > 0.0) == (db > 0.0) {
        return Vec::new();
    }
    let meet = a.lerp(b, da / (da - db));
    Some((meet - from).dot(along) / squared).filter(|&t| inside(t)).into_iter().collect()
}

/// The host's outline where it has data per edge; most hosts have none.
pub fn of_host(host: &HostData, given: &Mesh, mesh: &Mesh) -> Option<Outline> {
    (!host.edge_attributes.is_empty()).then(|| Outline::new(given, mesh))
}
