//! A roof in plan. In: faces as loops of nodes that have a plan position and a height. Out: a [`Roof`].

use glam::{DVec2, DVec3};

use super::{Roof, RoofPart, RoofWarning};
use crate::geometry::mesh::{Face, Loop, Mesh};
use crate::geometry::polygon::Polygon;
use crate::geometry::skeleton::Skeleton;

/// A face of a roof, counter-clockwise seen from outside; starts with its eave.
#[derive(Clone, Debug)]
pub(super) struct PlanFace {
    pub part: RoofPart,
    pub ring: Vec<u32>,
    pub holes: Vec<Vec<u32>>,
}

/// A corner of a roof: plan position and height, metres. Until the slope is applied, height is that at slope 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlanNode {
    pub position: DVec2,
    pub height: f64,
}

/// Roof faces over a polygon, whose vertices are the first nodes (outer ring, then holes).
#[derive(Clone, Debug, Default)]
pub(super) struct PlanRoof {
    pub nodes: Vec<PlanNode>,
    pub faces: Vec<PlanFace>,
    pub warnings: Vec<RoofWarning>,
}

impl PlanRoof {
    /// The faces of a skeleton, at slope 1.
    pub fn of_skeleton(skeleton: Skeleton) -> PlanRoof {
        let nodes = skeleton.nodes.iter().map(|n| PlanNode { position: n.position, height: n.time }).collect();
        let faces = skeleton.faces.into_iter().map(|f| PlanFace {
            part: RoofPart::Top { edge: Some(f.edge) },
            ring: f.boundary,
            holes: f.holes,
        });
        PlanRoof { nodes, faces: faces.collect(), warnings: Vec::new() }
    }

    /// The vertices of a polygon, no faces.
    pub fn of_vertices(polygon: &Polygon) -> PlanRoof {
        let nodes = polygon.rings().flatten().map(|&position| PlanNode { position, height: 0.0 }).collect();
        PlanRoof { nodes, ..PlanRoof::default() }
    }

    pub fn add_node(&mut self, position: DVec2, height: f64) -> u32 {
        self.nodes.push(PlanNode { position, height });
        (self.nodes.len() - 1) as u32
    }

    pub fn node(&self, id: u32) -> &PlanNode {
        &self.nodes[id as usize]
    }

    pub fn highest(&self) -> f64 {
        self.nodes.iter().fold(0.0, |m, n| f64::max(m, n.height))
    }

    pub fn scale_heights(&mut self, tangent: f64) {
        self.nodes.iter_mut().for_each(|n| n.height *= tangent);
    }

    /// Add the bottom, leave out nodes no face uses, and go to space: plan (x, y) becomes (x, height, -y).
    pub fn into_roof(mut self, polygon: &Polygon) -> Roof {
        self.faces.insert(0, bottom(polygon));
        self.into_sheet()
    }

    /// The same without a bottom.
    pub fn into_sheet(self) -> Roof {
        let PlanRoof { nodes, mut faces, warnings } = self;
        unite_doubled(&nodes, &mut faces);
        let mut mesh = Mesh { positions: Vec::with_capacity(nodes.len()), faces: Vec::with_capacity(faces.len()) };
        let mut parts = Vec::with_capacity(faces.len());
        let mut number = vec![u32::MAX; nodes.len()];
        for face in &faces {
            let mut placed = |ring: &Vec<u32>| -> Loop {
                ring.iter().map(|&id| number_of(&mut number, &mut mesh.positions, &nodes, id)).collect()
            };
            let outer = placed(&face.ring);
            let holes = face.holes.iter().map(placed).collect();
            mesh.faces.push(Face { outer, holes, ..Face::default() });
            parts.push(face.part);
        }
        Roof { mesh, parts, warnings }
    }
}

/// The number of a node in the mesh; a new one if it has none yet.
fn number_of(number: &mut [u32], positions: &mut Vec<DVec3>, nodes: &[PlanNode], id: u32) -> u32 {
    let n = &mut number[id as usize];
    if *n == u32::MAX {
        *n = positions.len() as u32;
        let PlanNode { position: p, height } = nodes[id as usize];
        positions.push(DVec3::new(p.x, height, -p.y));
    }
    *n
}

/// Where rings of the polygon touch in a corner, faces run from the corner of one ring to that of the other: an edge
/// without length. Make one corner of the two, so that no face repeats a point.
fn unite_doubled(nodes: &[PlanNode], faces: &mut [PlanFace]) {
    let same = |&(u, v): &(u32, u32)| u != v && nodes[u as usize] == nodes[v as usize];
    let neighbours = |r: &Vec<u32>| (0..r.len()).map(|k| (r[k], r[(k + 1) % r.len()])).filter(same).collect::<Vec<_>>();
    let doubled: Vec<(u32, u32)> = faces.iter().flat_map(|f| neighbours(&f.ring)).collect();
    if doubled.is_empty() {
        return;
    }
    let mut stands_for: Vec<u32> = (0..nodes.len() as u32).collect();
    for (u, v) in doubled {
        let (u, v) = (stands_for[u as usize], stands_for[v as usize]);
        stands_for.iter_mut().filter(|n| **n == u.max(v)).for_each(|n| *n = u.min(v));
    }
    for face in faces {
        for ring in std::iter::once(&mut face.ring).chain(&mut face.holes) {
            ring.iter_mut().for_each(|n| *n = stands_for[*n as usize]);
            ring.dedup();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
        }
    }
}

/// The polygon facing down: every ring as vertex 1, 0, n - 1, ..., 2.
fn bottom(polygon: &Polygon) -> PlanFace {
    let mut first = 0;
    let mut rings = polygon.rings().map(|ring| {
        let n = ring.len() as u32;
        let start = first;
        first += n;
        (0..n).map(|k| start + (n + 1 - k) % n).collect::<Vec<u32>>()
    });
    let ring = rings.next().unwrap_or_default();
    PlanFace { part: RoofPart::Bottom, ring, holes: rings.collect() }
}

/// The edges of a polygon.
#[derive(Clone, Debug)]
pub(super) struct Edges {
    /// (start, end) vertex numbers by edge.
    pub ends: Vec<(u32, u32)>,
    points: Vec<DVec2>,
}

impl Edges {
    pub fn of(polygon: &Polygon) -> Edges {
        let mut ends = Vec::new();
        for ring in polygon.rings() {
            let (first, n) = (ends.len() as u32, ring.len() as u32);
            ends.extend((0..n).map(|i| (first + i, first + (i + 1) % n)));
        }
        Edges { ends, points: polygon.rings().flatten().copied().collect() }
    }

    /// The edge that ends where `edge` starts.
    pub fn before(&self, edge: usize) -> usize {
        let start = self.ends[edge].0;
        // In its ring every edge but the last ends one vertex farther on.
        match edge.checked_sub(1) {
            Some(e) if self.ends[e].1 == start => e,
            _ => self.ends.iter().position(|e| e.1 == start).expect("a ring comes back to its first vertex"),
        }
    }

    /// The edge that starts where `edge` ends (edges have the number of their start).
    pub fn after(&self, edge: usize) -> usize {
        self.ends[edge].1 as usize
    }

    pub fn start(&self, edge: usize) -> DVec2 {
        self.points[self.ends[edge].0 as usize]
    }

    pub fn end(&self, edge: usize) -> DVec2 {
        self.points[self.ends[edge].1 as usize]
    }

    /// Unit vector to the inner side; zero for an edge without length.
    pub fn normal(&self, edge: usize) -> DVec2 {
        (self.end(edge) - self.start(edge)).perp().normalize_or_zero()
    }

    /// Distance from the line of an edge, positive on the inner side.
    pub fn distance(&self, edge: usize, p: DVec2) -> f64 {
        self.normal(edge).dot(p - self.start(edge))
    }
}
