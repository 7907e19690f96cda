//! From arcs to faces (`../shared/numerics.md` §5.7).
//!
//! In: the arcs dead vertices left, the eaves, and which edges were united. Out: closed loops of nodes, one face per united
//! edge, after welding nodes that lie within a few grid steps. No geometry is consulted to close a loop.

use super::SkeletonError;
use super::wavefront::{Arc, GridNode, LineId, NodeId, Wavefront};

/// Two edges on one line became neighbours in `node`: a footprint vertex or an inner node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Union {
    pub left: LineId,
    pub right: LineId,
    pub node: NodeId,
}

/// Which edges share a face so far: a forest over line numbers.
#[derive(Debug, Default)]
pub(super) struct FaceBuilder {
    parent: Vec<LineId>,
    pub unions: Vec<Union>,
}

impl FaceBuilder {
    /// The line that stands for the face of `line`.
    pub fn root(&self, mut line: LineId) -> LineId {
        while let Some(&parent) = self.parent.get(line as usize) {
            if parent == line {
                break;
            }
            line = parent;
        }
        line
    }

    /// Let two edges share a face; remembers where they met if they did not share one yet.
    pub fn unite(&mut self, union: Union) {
        let (left, right) = (self.root(union.left), self.root(union.right));
        if left == right {
            return;
        }
        let (low, high) = (left.min(right), left.max(right));
        while self.parent.len() <= high as usize {
            self.parent.push(self.parent.len() as LineId);
        }
        self.parent[high as usize] = low;
        self.unions.push(union);
    }
}

/// A face as loops of nodes, of all the edges united in it.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceLoops {
    /// The line that stands for the face.
    pub root: LineId,
    pub outer: Vec<NodeId>,
    /// Loops that go round standing parts (only with weights).
    pub holes: Vec<Vec<NodeId>>,
}

/// A directed piece of a face's border.
#[derive(Clone, Copy, Debug)]
struct HalfArc {
    root: LineId,
    from: NodeId,
    to: NodeId,
}

/// No half-arc.
const END: u32 = u32::MAX;

/// Chain the border pieces of every face. `tops` are (line, from, to) pieces where the wavefront was stopped.
pub(super) fn chain_faces(
    wf: &Wavefront,
    weld: &[NodeId],
    tops: &[(LineId, NodeId, NodeId)],
) -> Result<Vec<FaceLoops>, SkeletonError> {
    let mut halves = Vec::with_capacity(2 * wf.arcs.len() + wf.eaves.len() + tops.len());
    let mut push = |line: LineId, from: NodeId, to: NodeId| {
        let (from, to) = (weld[from as usize], weld[to as usize]);
        if from != to {
            halves.push(HalfArc { root: wf.faces.root(line), from, to });
        }
    };
    for &(line, from, to) in wf.eaves.iter().chain(tops) {
        push(line, from, to);
    }
    for &Arc { from, to, l, r } in &wf.arcs {
        push(l, from, to);
        push(r, to, from);
    }
    // Stable: the eaves stay first within their face.
    halves.sort_by_key(|h| h.root);
    let mut chainer = Chainer { head: vec![END; wf.nodes.len()], next: vec![END; halves.len()], halves: &halves };
    let mut faces = Vec::with_capacity(wf.eaves.len());
    let mut begin = 0;
    while begin < halves.len() {
        let root = halves[begin].root;
        let end = begin + halves[begin..].iter().take_while(|h| h.root == root).count();
        faces.push(chainer.face(begin, end)?);
        begin = end;
    }
    Ok(faces)
}

/// Lists the unused half-arcs that leave a node.
struct Chainer<'a> {
    halves: &'a [HalfArc],
    head: Vec<u32>,
    next: Vec<u32>,
}

impl Chainer<'_> {
    /// The loops of the half-arcs `begin..end`.
    fn face(&mut self, begin: usize, end: usize) -> Result<FaceLoops, SkeletonError> {
        for k in (begin..end).rev() {
            let from = self.halves[k].from as usize;
            self.next[k] = self.head[from];
            self.head[from] = k as u32;
        }
        let mut face = FaceLoops { root: self.halves[begin].root, ..FaceLoops::default() };
        self.walk(self.halves[begin].from, &mut face.outer)?;
        let mut used = face.outer.len();
        while used < end - begin {
            let at = face.outer.iter().position(|&n| self.head[n as usize] != END);
            let mut part = Vec::new();
            if let Some(at) = at {
                self.walk(face.outer[at], &mut part)?;
                used += part.len();
                face.outer.splice(at..at, part);
            } else {
                let start = (begin..end).find(|&k| self.head[self.halves[k].from as usize] != END);
                let start = start.ok_or(SkeletonError::Unresolved)?;
                self.walk(self.halves[start].from, &mut part)?;
                used += part.len();
                face.holes.push(part);
            }
        }
        Ok(face)
    }

    /// Follow unused half-arcs from `start` until it is reached again.
    fn walk(&mut self, start: NodeId, out: &mut Vec<NodeId>) -> Result<(), SkeletonError> {
        let mut at = start;
        loop {
            let k = self.head[at as usize];
            if k == END {
                return Err(SkeletonError::Unresolved);
            }
            self.head[at as usize] = self.next[k as usize];
            out.push(at);
            at = self.halves[k as usize].to;
            if at == start {
                return Ok(());
            }
        }
    }
}

/// Nodes closer than this many grid steps are one.
pub(super) const WELD_STEPS: f64 = 8.0;

/// In a unit of τ a line of weight 1 moves 2^32 grid steps.
pub(super) const STEPS_PER_TAU: f64 = 4_294_967_296.0;

/// For every node the node that stands for it: ends of short arcs are united, inner nodes with each other or with one
/// input node, never two input nodes.
pub(super) fn weld_nodes(wf: &Wavefront) -> Vec<NodeId> {
    let mut parent: Vec<NodeId> = (0..wf.nodes.len() as NodeId).collect();
    let root = |parent: &[NodeId], mut n: NodeId| {
        while parent[n as usize] != n {
            n = parent[n as usize];
        }
        n
    };
    for arc in &wf.arcs {
        let (p, q) = (root(&parent, arc.from), root(&parent, arc.to));
        let (low, high) = (p.min(q), p.max(q));
        let two_inputs = (high as usize) < wf.input_nodes;
        if low != high && !two_inputs && near(&wf.nodes[low as usize], &wf.nodes[high as usize]) {
            parent[high as usize] = low;
        }
    }
    (0..parent.len() as NodeId).map(|n| root(&parent, n)).collect()
}

pub(super) fn near(p: &GridNode, q: &GridNode) -> bool {
    let (dx, dy, dt) = (p.x - q.x, p.y - q.y, (p.tau - q.tau) * STEPS_PER_TAU);
    dx * dx + dy * dy + dt * dt < WELD_STEPS * WELD_STEPS
}
