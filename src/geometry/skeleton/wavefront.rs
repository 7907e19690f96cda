//! The shrinking outline: circular lists of vertices between moving lines (`../shared/numerics.md` §5.4).
//!
//! In: lines and vertices from the set-up. Out: linked loops that can be queried and re-linked, and the arcs that dead
//! vertices leave behind.

use super::faces::FaceBuilder;
use super::line::{Line, Moment, Place};

/// Edges and lines share their numbers; auxiliary lines come after the edges.
pub(super) type LineId = u32;
pub(super) type VertexId = u32;
pub(super) type NodeId = u32;

/// No vertex, or no edge.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of the wavefront, between line `l` (whose fragment ends here) and `r` (whose fragment starts here).
/// The fragment that starts here is known by the vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub l: LineId,
    pub r: LineId,
    pub prev: VertexId,
    pub next: VertexId,
    pub birth: NodeId,
    /// Sign of [l, r]: 1 convex, -1 reflex, 0 between opposite lines.
    pub turn: i32,
    pub alive: bool,
    /// The number of the moment at which it was born in an inner node; 0 if in an input node.
    pub born: u32,
    /// Where it stands in the list of active vertices.
    pub slot: u32,
}

/// What a dead vertex leaves: a piece of the border between the faces of `l` and `r`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub from: NodeId,
    pub to: NodeId,
    pub l: LineId,
    pub r: LineId,
}

/// A node in grid steps, at a value of τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GridNode {
    pub x: f64,
    pub y: f64,
    pub tau: f64,
}

/// Float copies of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct FloatLine {
    pub a: f64,
    pub b: f64,
    pub c: f64,
    pub w: f64,
}

/// The state of the wavefront.
#[derive(Debug, Default)]
pub(super) struct Wavefront {
    pub lines: Vec<Line>,
    pub floats: Vec<FloatLine>,
    pub vertices: Vec<Vertex>,
    /// Living vertices, in no meaningful order.
    pub active: Vec<VertexId>,
    /// The lines that carry the fragments which start in the active vertices, in the same order.
    pub carried: Vec<FloatLine>,
    /// Reflex vertices born and vertices died since somebody last emptied these lists.
    pub reflex: Vec<VertexId>,
    pub dead: Vec<VertexId>,
    pub nodes: Vec<GridNode>,
    pub input_nodes: usize,
    pub arcs: Vec<Arc>,
    /// (edge, start node, end node) of every edge with a length.
    pub eaves: Vec<(LineId, NodeId, NodeId)>,
    pub faces: FaceBuilder,
}

impl Wavefront {
    /// Forget everything but the memory.
    pub fn clear(&mut self) {
        self.lines.clear();
        self.floats.clear();
        self.vertices.clear();
        self.active.clear();
        self.carried.clear();
        self.reflex.clear();
        self.dead.clear();
        self.nodes.clear();
        self.input_nodes = 0;
        self.arcs.clear();
        self.eaves.clear();
        self.faces.clear();
    }

    pub fn add_input_node(&mut self, point: [i64; 2]) {
        self.nodes.push(GridNode { x: point[0] as f64, y: point[1] as f64, tau: 0.0 });
        self.input_nodes = self.nodes.len();
    }

    pub fn add_node(&mut self, place: &Place) -> NodeId {
        self.push_node(GridNode { x: place.x, y: place.y, tau: place.moment.tau })
    }

    pub fn push_node(&mut self, node: GridNode) -> NodeId {
        self.nodes.push(node);
        (self.nodes.len() - 1) as NodeId
    }

    pub fn add_line(&mut self, line: Line) -> LineId {
        self.lines.push(line);
        self.floats.push(FloatLine { a: line.a as f64, b: line.b as f64, c: line.c as f64, w: line.w as f64 });
        (self.lines.len() - 1) as LineId
    }

    /// A new vertex, not yet linked.
    pub fn add_vertex(&mut self, l: LineId, r: LineId, birth: NodeId) -> VertexId {
        let turn = self.line(l).cross(self.line(r)).signum() as i32;
        let id = self.vertices.len() as VertexId;
        let slot = self.active.len() as u32;
        self.vertices.push(Vertex { l, r, prev: NONE, next: NONE, birth, turn, alive: true, born: 0, slot });
        self.active.push(id);
        self.carried.push(self.floats[r as usize]);
        if turn < 0 {
            self.reflex.push(id);
        }
        id
    }

    /// Change the line of the fragment that starts in a vertex.
    pub fn set_right(&mut self, id: VertexId, r: LineId) {
        let vertex = self.vertices[id as usize];
        let turn = self.line(vertex.l).cross(self.line(r)).signum() as i32;
        self.vertices[id as usize] = Vertex { r, turn, ..vertex };
        self.carried[vertex.slot as usize] = self.floats[r as usize];
        if turn < 0 {
            self.reflex.push(id);
        }
    }

    pub fn line(&self, id: LineId) -> &Line {
        &self.lines[id as usize]
    }

    pub fn vertex(&self, id: VertexId) -> &Vertex {
        &self.vertices[id as usize]
    }

    /// Link the fragment that starts in `u` to end in `w`.
    pub fn link(&mut self, u: VertexId, w: VertexId) {
        self.vertices[u as usize].next = w;
        self.vertices[w as usize].prev = u;
    }

    /// A vertex ends in `node` and leaves an arc.
    pub fn kill(&mut self, id: VertexId, node: NodeId) {
        let vertex = &mut self.vertices[id as usize];
        vertex.alive = false;
        let Vertex { l, r, birth, slot, .. } = *vertex;
        self.active.swap_remove(slot as usize);
        self.carried.swap_remove(slot as usize);
        self.dead.push(id);
        if let Some(&moved) = self.active.get(slot as usize) {
            self.vertices[moved as usize].slot = slot;
        }
        if birth != node {
            self.arcs.push(Arc { from: birth, to: node, l, r });
        }
    }

    /// Where a vertex is at a moment; `None` between opposite lines.
    pub fn place(&self, id: VertexId, moment: Moment) -> Option<Place> {
        let vertex = self.vertex(id);
        Place::at(moment, self.line(vertex.l), self.line(vertex.r))
    }

    /// Whether a place on the line of the fragment that starts in `s` lies on the fragment as it is at that moment;
    /// its ends count.
    pub fn on_fragment(&self, s: VertexId, place: &Place) -> bool {
        let start = self.vertex(s);
        let end = self.vertex(start.next);
        place.side(self.line(start.l)) * start.turn >= 0 && place.side(self.line(end.r)) * end.turn >= 0
    }
}
