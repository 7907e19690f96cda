//! One face per edge: cut faces that several edges on one line share (`../shared/numerics.md` §5.7).
//!
//! In: faces of united edges and the points where the edges met. Out: faces with one edge each, cut along the inward
//! normal; the end of a cut becomes a corner of the face on its other side too.

use super::SkeletonError;
use super::faces::{FaceLoops, STEPS_PER_TAU, WELD_STEPS, near};
use super::wavefront::{GridNode, LineId, NONE, NodeId, Wavefront};

/// Cut every shared face at its unions. `weld` maps nodes to those that stand for them; `tops` are the loops of the
/// stopped wavefront, which get the new corners too.
pub(super) fn cut_united(
    wf: &mut Wavefront,
    weld: &[NodeId],
    faces: &mut Vec<FaceLoops>,
    tops: &mut [Vec<NodeId>],
) -> Result<(), SkeletonError> {
    let unions = std::mem::take(&mut wf.faces.unions);
    for union in &unions {
        let node = weld[union.node as usize];
        let root = wf.faces.root(union.left);
        let Some((face, at)) = find_corner(faces, root, node) else { continue };
        let frame = Frame::of(wf, root);
        let Some((edge, stop)) = frame.upper_edge(wf, &faces[face].outer, at) else { continue };
        let end = match stop {
            Stop::Corner(corner) => corner,
            Stop::Inside(new) => {
                // The edges may meet at the very moment at which their face ends there: a cut of no length.
                let id = if near(&new, &wf.nodes[node as usize], WELD_STEPS) { node } else { wf.push_node(new) };
                let outer = &faces[face].outer;
                let (u, v) = (outer[edge], outer[(edge + 1) % outer.len()]);
                insert_between(faces, tops, u, v, id);
                id
            }
        };
        split_face(faces, face, node, end)?;
    }
    name_by_eaves(wf, weld, faces);
    Ok(())
}

/// The face of `root` (or a part of it) and the corner in it that is `node`.
fn find_corner(faces: &[FaceLoops], root: LineId, node: NodeId) -> Option<(usize, usize)> {
    faces.iter().enumerate().filter(|(_, f)| f.root == root).find_map(|(k, f)| {
        let at = f.outer.iter().position(|&n| n == node)?;
        Some((k, at))
    })
}

/// Put `id` into the edge between `u` and `v`, in either direction, wherever it occurs.
fn insert_between(faces: &mut [FaceLoops], tops: &mut [Vec<NodeId>], u: NodeId, v: NodeId, id: NodeId) {
    let loops = faces.iter_mut().flat_map(|f| std::iter::once(&mut f.outer).chain(&mut f.holes)).chain(tops);
    for ring in loops {
        let joins = |k: usize| {
            let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
            (p, q) == (u, v) || (p, q) == (v, u)
        };
        if let Some(k) = (0..ring.len()).find(|&k| joins(k)) {
            ring.insert(k + 1, id);
        }
    }
}

/// Cut a face in two along the segment between two of its corners.
fn split_face(faces: &mut Vec<FaceLoops>, face: usize, p: NodeId, q: NodeId) -> Result<(), SkeletonError> {
    let outer = &mut faces[face].outer;
    let start = outer.iter().position(|&n| n == p).ok_or(SkeletonError::Unresolved)?;
    outer.rotate_left(start);
    let end = 1 + outer.iter().skip(1).position(|&n| n == q).ok_or(SkeletonError::Unresolved)?;
    let mut second = outer.split_off(end);
    if p != q {
        outer.push(q);
        second.push(p);
    }
    let root = faces[face].root;
    faces.push(FaceLoops { root, outer: second, holes: Vec::new() });
    Ok(())
}

/// Let every part of a shared face be known by the eave it contains, and start with it.
fn name_by_eaves(wf: &Wavefront, weld: &[NodeId], faces: &mut [FaceLoops]) {
    type Eave = (LineId, NodeId, NodeId, LineId);
    let of_face = |&(line, from, to): &(LineId, NodeId, NodeId)| -> Eave {
        (wf.faces.root(line), weld[from as usize], weld[to as usize], line)
    };
    let mut eaves: Vec<Eave> = wf.eaves.iter().map(of_face).collect();
    eaves.sort_unstable();
    for face in faces {
        let count = face.outer.len();
        let mut best: Option<(LineId, usize)> = None;
        for k in 0..count {
            let key = (face.root, face.outer[k], face.outer[(k + 1) % count]);
            let found = eaves.binary_search_by_key(&key, |&(root, from, to, _)| (root, from, to));
            if let Ok(e) = found
                && best.is_none_or(|(line, _)| eaves[e].3 < line)
            {
                best = Some((eaves[e].3, k));
            }
        }
        match best {
            Some((line, k)) => {
                face.root = line;
                face.outer.rotate_left(k);
            }
            // A part of an auxiliary line that ran into an edge on its own line.
            None => face.root = NONE,
        }
    }
}

/// Coordinates along an edge and in time; a face is a polygon in them, also where the edge stands still.
struct Frame {
    ux: f64,
    uy: f64,
}

/// Where a cut ends.
enum Stop {
    Corner(NodeId),
    Inside(GridNode),
}

impl Frame {
    fn of(wf: &Wavefront, line: LineId) -> Frame {
        let f = &wf.floats[line as usize];
        let length = (f.a * f.a + f.b * f.b).sqrt();
        Frame { ux: f.b / length, uy: -f.a / length }
    }

    /// Distance along the edge of `p` from `q`.
    fn along(&self, p: &GridNode, q: &GridNode) -> f64 {
        self.ux * (p.x - q.x) + self.uy * (p.y - q.y)
    }

    /// The lowest edge of the loop straight above corner `at`, and the point on it. Corners within [`WELD_STEPS`] of the
    /// cut are used as its end.
    fn upper_edge(&self, wf: &Wavefront, ring: &[NodeId], at: usize) -> Option<(usize, Stop)> {
        let base = wf.nodes[ring[at] as usize];
        let lowest = base.tau - WELD_STEPS / STEPS_PER_TAU;
        let mut best: Option<(f64, usize, Stop)> = None;
        for k in 0..ring.len() {
            let next = (k + 1) % ring.len();
            if k == at || next == at {
                continue;
            }
            let (p, q) = (wf.nodes[ring[k] as usize], wf.nodes[ring[next] as usize]);
            let (sp, sq) = (self.along(&p, &base), self.along(&q, &base));
            // An upper edge of a counter-clockwise face runs backwards.
            if sp < -WELD_STEPS || sq > WELD_STEPS || sp <= sq {
                continue;
            }
            let (tau, stop) = if sp <= WELD_STEPS {
                (p.tau, Stop::Corner(ring[k]))
            } else if sq >= -WELD_STEPS {
                (q.tau, Stop::Corner(ring[next]))
            } else {
                let f = sp / (sp - sq);
                let mix = |a: f64, b: f64| a + (b - a) * f;
                let node = GridNode { x: mix(p.x, q.x), y: mix(p.y, q.y), tau: mix(p.tau, q.tau) };
                (node.tau, Stop::Inside(node))
            };
            if tau >= lowest && best.as_ref().is_none_or(|b| tau < b.0) {
                best = Some((tau, k, stop));
            }
        }
        best.map(|(_, edge, stop)| (edge, stop))
    }
}
