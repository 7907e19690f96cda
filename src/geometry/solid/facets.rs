//! The faces of both operands over common vertices. In: two meshes. Out: planar facets (faces that are not planar in
//! triangles), their components, and the vertex pool.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::pool::Pool;
use crate::geometry::box_tree::Bounds;
use crate::geometry::plane::unit;
use crate::geometry::triangulate::{dropped_axis, triangulate_face};
use crate::geometry::{Face, Mesh};

/// An edge as a pair of pool vertices, the lesser first.
pub type Edge = [u32; 2];

pub fn edge(a: u32, b: u32) -> Edge {
    [a.min(b), a.max(b)]
}

/// A planar polygon with holes.
pub struct Facet {
    pub operand: u8,
    /// The face it is, or is part of.
    pub face: u32,
    pub component: u32,
    /// Pool vertices; the outline first.
    pub loops: Vec<Vec<u32>>,
    pub normal: DVec3,
    pub offset: f64,
    /// Grown by the tolerance.
    pub bounds: Bounds,
    pub flat: fn(DVec3) -> DVec2,
}

/// Facets of one operand that share vertices.
pub struct Component {
    pub is_closed: bool,
}

pub struct Facets {
    pub pool: Pool,
    /// Number of vertices that come from the meshes.
    pub originals: u32,
    pub list: Vec<Facet>,
    /// Facets of the first operand end here.
    pub second: usize,
    pub components: Vec<Component>,
}

impl Facet {
    pub fn edges(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.loops.iter().flat_map(|l| (0..l.len()).map(move |i| (l[i], l[(i + 1) % l.len()])))
    }

    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// Even-odd test in the facet's projection; on the border either.
    pub fn contains(&self, positions: &[DVec3], p: DVec2) -> bool {
        self.contains_along(self.flat, positions, p)
    }

    /// The same in another facet's projection.
    pub fn contains_along(&self, flat: fn(DVec3) -> DVec2, positions: &[DVec3], p: DVec2) -> bool {
        let mut inside = false;
        for (a, b) in self.edges() {
            let (a, b) = (flat(positions[a as usize]), flat(positions[b as usize]));
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }
}

impl Facets {
    pub fn new(a: &Mesh, b: &Mesh, tolerance: f64) -> Facets {
        let mut facets =
            Facets { pool: Pool::new(tolerance), originals: 0, list: Vec::new(), second: 0, components: Vec::new() };
        facets.add(a, 0);
        facets.second = facets.list.len();
        facets.add(b, 1);
        facets.originals = facets.pool.positions.len() as u32;
        facets.find_components();
        facets
    }

    fn add(&mut self, mesh: &Mesh, operand: u8) {
        let places: Vec<u32> = mesh.positions.iter().map(|&p| self.pool.place(p)).collect();
        for (number, face) in mesh.faces.iter().enumerate() {
            let number = number as u32;
            let loops: Vec<Vec<u32>> = face.loops().map(|l| welded(l, &places)).collect();
            match self.planar(operand, number, loops) {
                Planar::Yes(facet) => self.list.push(facet),
                Planar::Bent => self.add_triangles(mesh, face, operand, number, &places),
                Planar::Gone => {}
            }
        }
    }

    fn add_triangles(&mut self, mesh: &Mesh, face: &Face, operand: u8, number: u32, places: &[u32]) {
        let corners: Vec<u32> = face.corners().collect();
        for triangle in triangulate_face(mesh, face) {
            let ring = triangle.map(|c| corners[c as usize]);
            let ring = welded(&ring, places);
            if let Planar::Yes(facet) = self.planar(operand, number, vec![ring]) {
                self.list.push(facet);
            }
        }
    }

    fn planar(&self, operand: u8, face: u32, mut loops: Vec<Vec<u32>>) -> Planar {
        if loops[0].len() < 3 {
            return Planar::Gone;
        }
        loops.retain(|l| l.len() >= 3);
        let at = |v: u32| self.pool.positions[v as usize];
        let origin = at(loops[0][0]);
        let newell = loops[0].windows(2).map(|w| (at(w[0]) - origin).cross(at(w[1]) - origin)).sum::<DVec3>();
        let Some(normal) = unit(newell) else { return Planar::Gone };
        let Some(flat) = dropped_axis(newell) else { return Planar::Gone };
        let heights = || loops.iter().flatten().map(|&v| normal.dot(at(v) - origin));
        let (lo, hi) = heights().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), h| (lo.min(h), hi.max(h)));
        if hi - lo > self.pool.tolerance && loops.iter().map(Vec::len).sum::<usize>() > 3 {
            return Planar::Bent;
        }
        let offset = normal.dot(origin) + (lo + hi) / 2.0;
        let bounds = Bounds::around(loops.iter().flatten().map(|&v| at(v)));
        let bounds = bounds.expect("a loop has corners").grown(self.pool.tolerance);
        Planar::Yes(Facet { operand, face, component: 0, loops, normal, offset, bounds, flat })
    }

    /// Joins facets of one operand that share vertices; a component is closed if every edge is run as often either way.
    fn find_components(&mut self) {
        let mut leader: BTreeMap<(u8, u32), (u8, u32)> = BTreeMap::new();
        fn find(leader: &mut BTreeMap<(u8, u32), (u8, u32)>, v: (u8, u32)) -> (u8, u32) {
            let mut at = v;
            while let Some(&up) = leader.get(&at).filter(|&&up| up != at) {
                at = up;
            }
            leader.insert(v, at);
            at
        }
        for facet in &self.list {
            let first = find(&mut leader, (facet.operand, facet.loops[0][0]));
            for &v in facet.loops.iter().flatten() {
                let other = find(&mut leader, (facet.operand, v));
                let root = find(&mut leader, first);
                leader.insert(other.max(root), other.min(root));
            }
        }
        let mut numbers: BTreeMap<(u8, u32), u32> = BTreeMap::new();
        let mut runs: BTreeMap<(u32, Edge), i32> = BTreeMap::new();
        for facet in &mut self.list {
            let root = find(&mut leader, (facet.operand, facet.loops[0][0]));
            let next = numbers.len() as u32;
            facet.component = *numbers.entry(root).or_insert(next);
            for (a, b) in facet.edges() {
                *runs.entry((facet.component, edge(a, b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        self.components = (0..numbers.len()).map(|_| Component { is_closed: true }).collect();
        for ((component, _), _) in runs.iter().filter(|(_, balance)| **balance != 0) {
            self.components[*component as usize].is_closed = false;
        }
    }

    /// Facet numbers of one operand.
    pub fn of(&self, operand: u8) -> std::ops::Range<usize> {
        if operand == 0 { 0..self.second } else { self.second..self.list.len() }
    }

    pub fn position(&self, v: u32) -> DVec3 {
        self.pool.positions[v as usize]
    }
}

enum Planar {
    Yes(Facet),
    /// Its corners lie in no plane.
    Bent,
    /// It has no area.
    Gone,
}

/// A loop over pool vertices without doubled corners.
fn welded(ring: &[u32], places: &[u32]) -> Vec<u32> {
    let mut out: Vec<u32> = ring.iter().map(|&v| places[v as usize]).collect();
    out.dedup();
    while out.len() > 1 && out.first() == out.last() {
        out.pop();
    }
    out
}
