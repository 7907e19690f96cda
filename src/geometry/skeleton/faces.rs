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
    pub fn clear(&mut self) {
        self.parent.clear();
        self.unions.clear();
    }

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

    /// Let every line point to the one that stands for it.
    pub fn flatten(&mut self) {
        for line in 0..self.parent.len() {
            self.parent[line] = self.parent[self.parent[line] as usize];
        }
    }

    /// [`FaceBuilder::root`], which shortens the way for the next time.
    fn root_mut(&mut self, mut line: LineId) -> LineId {
        while let Some(&parent) = self.parent.get(line as usize) {
            if parent == line {
                break;
            }
            let above = self.parent[parent as usize];
            self.parent[line as usize] = above;
            line = above;
        }
        line
    }

    /// Let two edges share a face; remembers where they met if they did not share one yet.
    pub fn unite(&mut self, union: Union) {
        let (left, right) = (self.root_mut(union.left), self.root_mut(union.right));
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
    from: NodeId,
    to: NodeId,
}

/// No half-arc.
const END: u32 = u32::MAX;

/// Working memory of chaining: the pieces, sorted by face, and lists of the unused ones that leave a node.
#[derive(Debug, Default)]
pub(super) struct Chainer {
    /// Where the pieces of a face begin, by the line that stands for it.
    begins: Vec<u32>,
    /// The pieces as they come, with the line of their face.
    pieces: Vec<(LineId, HalfArc)>,
    halves: Vec<HalfArc>,
    head: Vec<u32>,
    next: Vec<u32>,
}

/// Chain the border pieces of every face. `tops` are (line, from, to) pieces where the wavefront was stopped.
pub(super) fn chain_faces(
    wf: &Wavefront,
    weld: &[NodeId],
    tops: &[(LineId, NodeId, NodeId)],
    chainer: &mut Chainer,
) -> Result<Vec<FaceLoops>, SkeletonError> {
    chainer.sort(wf, weld, tops);
    let mut faces = Vec::with_capacity(wf.eaves.len());
    for root in 0..wf.lines.len() {
        let (begin, end) = (chainer.begins[root] as usize, chainer.begins[root + 1] as usize);
        if begin < end {
            faces.push(chainer.face(root as LineId, begin, end)?);
        }
    }
    Ok(faces)
}

impl Chainer {
    /// Sort the pieces by face: by counting, so that the eaves stay first within theirs.
    fn sort(&mut self, wf: &Wavefront, weld: &[NodeId], tops: &[(LineId, NodeId, NodeId)]) {
        self.begins.clear();
        self.begins.resize(wf.lines.len() + 2, 0);
        self.pieces.clear();
        let mut enter = |line: LineId, from: NodeId, to: NodeId| {
            let half = HalfArc { from: weld[from as usize], to: weld[to as usize] };
            if half.from != half.to {
                let root = wf.faces.root(line);
                self.begins[root as usize + 2] += 1;
                self.pieces.push((root, half));
            }
        };
        for &(line, from, to) in wf.eaves.iter().chain(tops) {
            enter(line, from, to);
        }
        for &Arc { from, to, l, r } in &wf.arcs {
            enter(l, from, to);
            enter(r, to, from);
        }
        for k in 2..self.begins.len() {
            self.begins[k] += self.begins[k - 1];
        }
        // Entering the pieces moves the beginning of each face to that of the next.
        let count = self.pieces.len();
        self.halves.clear();
        self.halves.resize(count, HalfArc { from: 0, to: 0 });
        for &(root, half) in &self.pieces {
            let place = &mut self.begins[root as usize + 1];
            self.halves[*place as usize] = half;
            *place += 1;
        }
        self.head.clear();
        self.head.resize(wf.nodes.len(), END);
        self.next.clear();
        self.next.resize(count, END);
    }

    /// The loops of the half-arcs `begin..end`.
    fn face(&mut self, root: LineId, begin: usize, end: usize) -> Result<FaceLoops, SkeletonError> {
        for k in (begin..end).rev() {
            let from = self.halves[k].from as usize;
            self.next[k] = self.head[from];
            self.head[from] = k as u32;
        }
        let mut face = FaceLoops { root, outer: Vec::with_capacity(end - begin), holes: Vec::new() };
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

/// Nodes closer than this many grid steps are one, where that folds no face.
pub(super) const WELD_STEPS: f64 = 8.0;

/// What f64 rounds exact places by, and some, in grid steps: nodes that close are one in any case.
pub(super) const ROUNDING_STEPS: f64 = 1e-4;

/// In a unit of τ a line of weight 1 moves 2^32 grid steps.
pub(super) const STEPS_PER_TAU: f64 = 4_294_967_296.0;

/// Into `parent`, for every node the node that stands for it: ends of arcs shorter than `steps` are united, inner nodes
/// with each other or with one input node, never two input nodes. Whether places moved by more than rounding.
pub(super) fn weld_nodes(wf: &Wavefront, parent: &mut Vec<NodeId>, steps: f64) -> bool {
    let mut moved = false;
    parent.clear();
    parent.extend(0..wf.nodes.len() as NodeId);
    let root = |parent: &[NodeId], mut n: NodeId| {
        while parent[n as usize] != n {
            n = parent[n as usize];
        }
        n
    };
    for arc in &wf.arcs {
        let (p, q) = (root(parent, arc.from), root(parent, arc.to));
        let (low, high) = (p.min(q), p.max(q));
        let two_inputs = (high as usize) < wf.input_nodes;
        let (kept, other) = (&wf.nodes[low as usize], &wf.nodes[high as usize]);
        if low != high && !two_inputs && near(kept, other, steps) {
            parent[high as usize] = low;
            moved |= !near(kept, other, ROUNDING_STEPS);
        }
    }
    // The lower number stands for the higher one: one pass upwards.
    for n in 0..parent.len() {
        parent[n] = parent[parent[n] as usize];
    }
    moved
}

pub(super) fn near(p: &GridNode, q: &GridNode, steps: f64) -> bool {
    let (dx, dy, dt) = (p.x - q.x, p.y - q.y, (p.tau - q.tau) * STEPS_PER_TAU);
    dx * dx + dy * dy + dt * dt < steps * steps
}
