//! Caps of a cut. In: the faces on one side and which of them belong to closed components. Out: faces in the plane
//! that close them.
//!
//! The cap's edges are those in the plane that the piece's faces run only one way, turned over.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::face::Side;
use crate::geometry::plane::PlaneFrame;
use crate::geometry::polygon::{ring_contains, signed_area};
use crate::geometry::{Face, Mesh, Plane};

/// A body has at least this many faces: fewer are sheets, which get no caps.
const LEAST_FACES: usize = 4;

/// Per face: is its component (faces joined by shared vertices) closed, every edge run once each way?
pub(super) fn faces_of_closed_components(mesh: &Mesh) -> Vec<bool> {
    if mesh.faces.len() < LEAST_FACES {
        return vec![false; mesh.faces.len()];
    }
    let mut leader: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for face in &mesh.faces {
        let mut corners = face.corners();
        let Some(first) = corners.next() else { continue };
        for corner in corners {
            let (a, b) = (find(&mut leader, first), find(&mut leader, corner));
            leader[a.max(b) as usize] = a.min(b);
        }
    }
    let mut open = vec![false; mesh.positions.len()];
    for run in unmatched(mesh.faces.iter().flat_map(|f| f.edges().map(|(a, b)| (a, b, 0)))) {
        open[find(&mut leader, run.from) as usize] = true;
    }
    let mut is_closed = |f: &Face| f.outer.first().is_some_and(|&v| !open[find(&mut leader, v) as usize]);
    mesh.faces.iter().map(&mut is_closed).collect()
}

fn find(leader: &mut [u32], mut i: u32) -> u32 {
    while leader[i as usize] != i {
        leader[i as usize] = leader[leader[i as usize] as usize];
        i = leader[i as usize];
    }
    i
}

/// The runs (from, to, face) of edges that have no run the other way to match, in order of vertices.
fn unmatched(runs: impl Iterator<Item = (u32, u32, usize)>) -> Vec<CapEdge> {
    let mut runs: Vec<CapEdge> = runs.map(|(from, to, face)| CapEdge { from, to, face }).collect();
    let edge = |r: &CapEdge| (r.from.min(r.to), r.from.max(r.to));
    runs.sort_unstable_by_key(|r| (edge(r), r.from > r.to, r.face));
    let mut left = Vec::new();
    for same in runs.chunk_by(|r, s| edge(r) == edge(s)) {
        let forth = same.iter().filter(|r| r.from < r.to).count();
        let (forth, back) = same.split_at(forth);
        let matched = forth.len().min(back.len());
        left.extend(forth[matched..].iter().chain(&back[matched..]).copied());
    }
    left
}

/// A run of an edge and the source face it belongs to, or (turned over) lies beside.
#[derive(Clone, Copy)]
pub(in crate::geometry) struct CapEdge {
    pub from: u32,
    pub to: u32,
    pub face: usize,
}

/// The caps of the faces on one side, those beside the earliest faces first.
pub(super) fn caps(
    positions: &[DVec3],
    faces: &[(usize, Face)],
    closed: &[bool],
    plane: &Plane,
    side: Side,
    on_plane: impl Fn(u32) -> bool,
) -> Vec<Face> {
    let own = faces.iter().filter(|(index, _)| closed[*index]);
    let in_plane = own.flat_map(|(index, f)| f.edges().map(move |(a, b)| (a, b, *index)));
    let mut edges = unmatched(in_plane.filter(|&(a, b, _)| on_plane(a) && on_plane(b)));
    let Some(&CapEdge { from, .. }) = edges.first() else { return Vec::new() };
    edges.iter_mut().for_each(|e| std::mem::swap(&mut e.from, &mut e.to));
    let outward = if side == Side::Behind { *plane } else { plane.flipped() };
    let frame = PlaneFrame::of_plane(&outward, positions[from as usize]);
    let plan = |v: u32| frame.to_plan(positions[v as usize]);
    nest(loops(edges, plan), plan)
}

/// Chains edges to loops; where several leave a vertex the leftmost turn is taken, so loops that touch stay apart.
/// An edge without a successor is dropped (the component was not closed there).
pub(in crate::geometry) fn loops(edges: Vec<CapEdge>, plan: impl Fn(u32) -> DVec2) -> Vec<Vec<u32>> {
    let mut leaving: BTreeMap<u32, Vec<CapEdge>> = BTreeMap::new();
    edges.iter().for_each(|&e| leaving.entry(e.from).or_default().push(e));
    let mut by_face = edges;
    by_face.sort_by_key(|e| (e.face, e.from, e.to));
    let mut loops = Vec::new();
    for first in by_face {
        let Some(start) = leaving.get_mut(&first.from) else { continue };
        let Some(at) = start.iter().position(|e| e.to == first.to) else { continue };
        let mut edge = start.remove(at);
        let mut ring = vec![edge.from];
        while edge.to != first.from {
            let Some(choices) = leaving.get_mut(&edge.to).filter(|c| !c.is_empty()) else { break };
            let incoming = plan(edge.to) - plan(edge.from);
            let turn = |e: &CapEdge| left_turn(incoming, plan(e.to) - plan(e.from));
            let best = (0..choices.len()).max_by(|&i, &j| turn(&choices[i]).total_cmp(&turn(&choices[j])));
            edge = choices.remove(best.expect("there is a choice"));
            ring.push(edge.from);
        }
        if edge.to == first.from && ring.len() >= 3 {
            loops.push(ring);
        }
    }
    loops
}

/// Rises with the angle from one direction to another, from -2 (back, by the right) to 2 (back, by the left).
fn left_turn(from: DVec2, to: DVec2) -> f64 {
    let scale = from.length() * to.length();
    let (sine, cosine) = (from.perp_dot(to) / scale, from.dot(to) / scale);
    if sine >= 0.0 { 1.0 - cosine } else { cosine - 1.0 }
}

/// Counter-clockwise loops are outlines, the others holes of the smallest outline around them.
pub(in crate::geometry) fn nest(loops: Vec<Vec<u32>>, plan: impl Fn(u32) -> DVec2) -> Vec<Face> {
    let flat = |l: &[u32]| -> Vec<DVec2> { l.iter().map(|&v| plan(v)).collect() };
    let (mut caps, mut outlines, mut holes) = (Vec::new(), Vec::new(), Vec::new());
    for ring in loops {
        let plan = flat(&ring);
        let area = signed_area(&plan);
        if area > 0.0 {
            caps.push(Face::new(ring));
            outlines.push((area, plan));
        } else {
            holes.push((ring, plan));
        }
    }
    for (ring, plan) in holes {
        let around = |outline: &[DVec2]| plan.iter().filter(|&&q| ring_contains(outline, q)).count() * 2 > plan.len();
        let candidates = (0..caps.len()).filter(|&i| around(&outlines[i].1));
        if let Some(home) = candidates.min_by(|&i, &j| outlines[i].0.total_cmp(&outlines[j].0)) {
            caps[home].holes.push(ring.into());
        }
    }
    caps
}
