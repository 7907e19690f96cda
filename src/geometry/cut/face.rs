//! One face cut by a plane. In: a face with its cut points. Out: its parts on one side.
//!
//! The boundary falls into *chains* that run on the wanted side from the cut line back to it. Along the line the
//! material lies between the end of one chain and the start of the next, so the k-th end is joined to the k-th start.

use glam::{DVec2, DVec3};

use crate::geometry::polygon::ring_contains;
use crate::geometry::triangulate::dropped_axis;
use crate::geometry::{Face, Mesh, Plane};

/// Where a vertex lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Behind,
    On,
    Front,
}

impl Side {
    pub(super) fn of(distance: f64, thickness: f64) -> Side {
        if distance < -thickness {
            Side::Behind
        } else if distance > thickness {
            Side::Front
        } else {
            Side::On
        }
    }

    pub(super) fn opposite(self) -> Option<Side> {
        match self {
            Side::Behind => Some(Side::Front),
            Side::On => None,
            Side::Front => Some(Side::Behind),
        }
    }
}

/// A corner of the boundary with the cut points put in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    /// Face-edge of the source that starts here; `None` where a new edge along the cut starts.
    pub(super) edge: Option<usize>,
    /// The uv is that of source corner `from.0` moved by the share `from.2` towards that of `from.1`.
    pub(super) from: (usize, usize, f64),
}

/// The uv of a corner, from those of the source's corners.
pub(super) fn corner_uv(uv: &[DVec2], corner: &Corner) -> DVec2 {
    let (from, to, share) = corner.from;
    uv[from] + (uv[to] - uv[from]) * share
}

/// The normals of corners of a part, if the source has one per corner.
pub(super) fn corner_normals<'c>(source: &Face, count: usize, corners: impl Iterator<Item = &'c Corner>) -> Vec<DVec3> {
    if source.normals.len() != count {
        return Vec::new();
    }
    let mixed = |&Corner { from: (from, to, share), .. }: &Corner| {
        let (a, b) = (source.normals[from], source.normals[to]);
        if share == 0.0 { a } else { (a + (b - a) * share).normalize_or(a) }
    };
    corners.map(mixed).collect()
}

/// The boundary of a face with the cut points put in, so that no edge runs from one side to the other.
pub(super) struct CutFace<'a> {
    source: &'a Face,
    loops: Vec<Vec<Corner>>,
    normal: DVec3,
    /// Along the cut line, with the material behind the plane on the left.
    along: DVec3,
}

impl<'a> CutFace<'a> {
    /// `crossing(a, b)` gives the cut point of an edge and its place on it, if the edge crosses the plane.
    pub(super) fn new(
        mesh: &Mesh,
        source: &'a Face,
        plane: &Plane,
        mut crossing: impl FnMut(u32, u32) -> Option<(u32, f64)>,
    ) -> Self {
        let mut start = 0;
        let mut loops = Vec::new();
        for ring in source.loops() {
            let mut corners = Vec::with_capacity(ring.len() + 2);
            for i in 0..ring.len() {
                let next = (i + 1) % ring.len();
                let edge = Some(start + i);
                corners.push(Corner { vertex: ring[i], edge, from: (start + i, start + i, 0.0) });
                if let Some((vertex, share)) = crossing(ring[i], ring[next]) {
                    corners.push(Corner { vertex, edge, from: (start + i, start + next, share) });
                }
            }
            start += ring.len();
            loops.push(corners);
        }
        let normal = mesh.newell(source);
        CutFace { source, loops, normal, along: normal.cross(plane.normal) }
    }

    /// The parts on one side, in order of their first surviving edge.
    pub(super) fn parts(&self, side: Side, positions: &[DVec3], sides: &[Side]) -> Vec<Face> {
        let (mut outers, mut holes, mut chains) = (Vec::new(), Vec::new(), Vec::new());
        for (index, ring) in self.loops.iter().enumerate() {
            match self.chains(ring, side, positions, sides) {
                Chains::All if index == 0 => outers.push(ring.clone()),
                Chains::All => holes.push(ring.clone()),
                Chains::Some(some) => chains.extend(some),
            }
        }
        if let [_] = chains[..]
            && outers.is_empty()
            && holes.is_empty()
        {
            return self.single(chains.remove(0));
        }
        let along = if side == Side::Behind { self.along } else { -self.along };
        outers.extend(link(chains, |c| positions[c.vertex as usize].dot(along)));
        outers.iter_mut().for_each(|l| start_with_first_edge(l));
        outers.retain(|l| l.len() >= 3);
        outers.sort_by_key(|l| first_edge(l));
        self.nest(outers, holes, positions)
    }

    /// The usual case: one chain, closed by one edge along the cut.
    fn single(&self, mut ring: Vec<Corner>) -> Vec<Face> {
        close(&mut ring);
        start_with_first_edge(&mut ring);
        if ring.len() >= 3 { vec![self.face(&[ring])] } else { Vec::new() }
    }

    /// Cuts one loop into the chains on the wanted side: edges with an end there, and edges in the plane that have
    /// the wanted side on their left. A chain also ends where the boundary touches the line from inside the material.
    fn chains(&self, ring: &[Corner], side: Side, positions: &[DVec3], sides: &[Side]) -> Chains {
        let n = ring.len();
        let at = |i: usize| positions[ring[i % n].vertex as usize];
        let side_of = |i: usize| sides[ring[i % n].vertex as usize];
        let along = if side == Side::Behind { self.along } else { -self.along };
        let kept: Vec<bool> = (0..n)
            .map(|i| match (side_of(i), side_of(i + 1)) {
                (Side::On, Side::On) => (at(i + 1) - at(i)).dot(along) > 0.0,
                (a, b) => a == side || b == side,
            })
            .collect();
        let touches = |i: usize| {
            let (before, after) = (i + n - 1, i + 1);
            side_of(i) == Side::On
                && side_of(before) == side
                && side_of(after) == side
                && (at(i) - at(before)).cross(at(after) - at(i)).dot(self.normal) < 0.0
        };
        let starts: Vec<usize> = (0..n).filter(|&i| kept[i] && (!kept[(i + n - 1) % n] || touches(i))).collect();
        if starts.is_empty() {
            return if kept.iter().all(|&k| k) { Chains::All } else { Chains::Some(Vec::new()) };
        }
        let follow = |&start: &usize| {
            let mut chain = vec![ring[start]];
            let mut i = start;
            while kept[i % n] && (i == start || !touches(i % n)) {
                i += 1;
                chain.push(ring[i % n]);
            }
            chain
        };
        Chains::Some(starts.iter().map(follow).collect())
    }

    /// Gives every hole to the part it lies in.
    fn nest(&self, outers: Vec<Vec<Corner>>, holes: Vec<Vec<Corner>>, positions: &[DVec3]) -> Vec<Face> {
        let Some(drop) = dropped_axis(self.normal) else { return Vec::new() };
        let plan = |l: &[Corner]| -> Vec<DVec2> { l.iter().map(|c| drop(positions[c.vertex as usize])).collect() };
        let plans: Vec<Vec<DVec2>> = outers.iter().map(|l| plan(l)).collect();
        let mut parts: Vec<Vec<Vec<Corner>>> = outers.into_iter().map(|l| vec![l]).collect();
        for hole in holes {
            let inside = |p: &Vec<DVec2>| plan(&hole).iter().filter(|&&q| ring_contains(p, q)).count() * 2 > hole.len();
            let home = if plans.len() == 1 { Some(0) } else { plans.iter().position(inside) };
            if let Some(home) = home {
                parts[home].push(hole);
            }
        }
        parts.iter().map(|loops| self.face(loops)).collect()
    }

    fn face(&self, loops: &[Vec<Corner>]) -> Face {
        let indices = |l: &Vec<Corner>| l.iter().map(|c| c.vertex).collect();
        let corners = self.source.corners().count();
        let complete = self.source.uvs.iter().filter(|(_, uv)| uv.len() == corners);
        Face {
            outer: indices(&loops[0]),
            holes: loops[1..].iter().map(indices).collect(),
            uvs: complete.map(|(set, uv)| (*set, loops.iter().flatten().map(|c| corner_uv(uv, c)).collect())).collect(),
            normals: corner_normals(self.source, corners, loops.iter().flatten()),
        }
    }
}

/// What one loop leaves on one side.
enum Chains {
    /// The whole loop.
    All,
    /// Open chains, perhaps none.
    Some(Vec<Vec<Corner>>),
}

/// Joins chains to loops along the cut line.
fn link(chains: Vec<Vec<Corner>>, place: impl Fn(&Corner) -> f64) -> Vec<Vec<Corner>> {
    let by_place = |key: &dyn Fn(usize) -> f64| {
        let mut order: Vec<usize> = (0..chains.len()).collect();
        order.sort_by(|&i, &j| key(i).total_cmp(&key(j)));
        order
    };
    let ends = by_place(&|i| place(chains[i].last().expect("a chain has corners")));
    let starts = by_place(&|i| place(&chains[i][0]));
    let mut next = vec![0; chains.len()];
    ends.iter().zip(&starts).for_each(|(&end, &start)| next[end] = start);
    let mut done = vec![false; chains.len()];
    let mut loops = Vec::new();
    for first in 0..chains.len() {
        let mut ring: Vec<Corner> = Vec::new();
        let mut i = first;
        while !done[i] {
            done[i] = true;
            ring.extend(&chains[i]);
            let end = ring.last_mut().expect("a chain has corners");
            end.edge = None;
            if end.vertex == chains[next[i]][0].vertex {
                ring.pop();
            }
            i = next[i];
        }
        if !ring.is_empty() {
            loops.push(ring);
        }
    }
    loops
}

/// Marks the edge from the end of a chain to its start as new; ends that are one vertex become one.
fn close(chain: &mut Vec<Corner>) {
    let start = chain[0].vertex;
    let end = chain.last_mut().expect("a chain has corners");
    end.edge = None;
    if end.vertex == start {
        chain.pop();
    }
}

fn first_edge(ring: &[Corner]) -> usize {
    ring.iter().filter_map(|c| c.edge).min().unwrap_or(usize::MAX)
}

pub(super) fn start_with_first_edge(ring: &mut [Corner]) {
    if let Some((start, _)) = ring.iter().enumerate().filter(|(_, c)| c.edge.is_some()).min_by_key(|(_, c)| c.edge) {
        ring.rotate_left(start);
    }
}
