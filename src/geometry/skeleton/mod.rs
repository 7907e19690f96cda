//! Weighted straight skeleton, exact in every decision (`../shared/numerics.md` §5).
//!
//! In: a repaired [`Polygon`] and, if wanted, one speed per edge. Out: nodes with the time at which the shrinking
//! outline reaches them, and one face per edge. Time is distance from the eaves where the weight is 1.

mod cells;
mod events;
mod faces;
mod fold;
mod heap;
mod line;
mod meet;
mod path;
mod quad;
mod setup;
mod slab;
mod splits;
mod unite;
mod wavefront;

#[cfg(test)]
mod tests;

use std::cell::Cell;

use glam::DVec2;

use self::events::{Event, Events, Kind};
use self::faces::{Chainer, FaceLoops, ROUNDING_STEPS, WELD_STEPS, chain_faces, weld_nodes};
use self::line::{Moment, Place};
use self::meet::Meeting;
pub(crate) use self::setup::Options;
use self::setup::{Setup, Side, set_up};
use self::unite::cut_united;
use self::wavefront::{GridNode, LineId, NodeId, VertexId, Wavefront};
use crate::geometry::polygon::Polygon;

/// A corner of a face: a vertex of the polygon (`time` 0) or a place where the shrinking outline changes its shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Plan position, metres, in the coordinates of the input.
    pub position: DVec2,
    /// Distance from the eaves, metres (for weight 1).
    pub time: f64,
}

/// What one edge of the polygon sweeps.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonFace {
    /// Index over the edges of the outer ring, then those of the holes; edge `i` of a ring runs from vertex `i` to `i + 1`.
    pub edge: usize,
    /// Node indices, counter-clockwise seen from above; the first two are the ends of the edge.
    pub boundary: Vec<u32>,
    /// Loops, clockwise, around parts that slower edges sweep; only with weights.
    pub holes: Vec<Vec<u32>>,
}

/// The faces swept by the edges of a polygon, sorted by edge. Faces of no extent are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skeleton {
    /// The vertices of the polygon in the order of its rings (node `i` starts edge `i`), then the inner nodes.
    pub nodes: Vec<Node>,
    pub faces: Vec<SkeletonFace>,
    /// Loops of the outline where it stopped: at the wanted time, or because no edge of it moves. Counter-clockwise
    /// around what is left, holes clockwise. Empty if the outline vanished.
    pub tops: Vec<Vec<u32>>,
    /// What auxiliary lines at corners sweep: bevels, and the steps between collinear edges of different weight (which
    /// are vertical and have no area in plan). Counter-clockwise.
    pub extras: Vec<Vec<u32>>,
}

/// Why there is no skeleton.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SkeletonError {
    #[error("the outline has fewer than three different points")]
    TooFewPoints,
    #[error("a coordinate is not a finite number, or the outline is wider than 1e9 m")]
    NotFinite,
    #[error("the outline crosses or overlaps itself")]
    NotSimple,
    #[error("{given} weights for {edges} edges")]
    WeightCount { given: usize, edges: usize },
    #[error("weight {weight} of edge {edge} is not a finite number of at least 0")]
    Weight { edge: usize, weight: f64 },
    #[error("the distance {0} is not a finite number of at least 0")]
    Distance(f64),
    #[error("the shrinking outline came into a state that has no consistent continuation")]
    Unresolved,
}

/// The straight skeleton of `polygon`. `weights` are the speeds of the edges (outer ring, then holes), 1 if `None`.
///
/// # Errors
/// See [`SkeletonError`]; none for a polygon that passed the repair door, with valid weights.
pub fn skeleton(polygon: &Polygon, weights: Option<&[f64]>) -> Result<Skeleton, SkeletonError> {
    if weights.is_none()
        && let Some(direct) = quad::skeleton(polygon)
    {
        return Ok(direct);
    }
    run(polygon, weights, None, &Options::default())
}

/// The skeleton as far as the outline has come at `time`; [`Skeleton::tops`] is the outline then.
///
/// # Errors
/// As [`skeleton`], and [`SkeletonError::Distance`].
pub fn wavefront(polygon: &Polygon, weights: Option<&[f64]>, time: f64) -> Result<Skeleton, SkeletonError> {
    run(polygon, weights, Some(time), &Options::default())
}

/// The event loop, from the set-up to the faces.
pub(crate) fn run(
    polygon: &Polygon,
    weights: Option<&[f64]>,
    time: Option<f64>,
    options: &Options,
) -> Result<Skeleton, SkeletonError> {
    let mut work = WORKSPACE.take().unwrap_or_default();
    let result = work.run(polygon, weights, time, options);
    if work.wavefront.nodes.len() < KEPT {
        WORKSPACE.set(Some(work));
    }
    result
}

thread_local! {
    /// The memory of the last run, for the next one.
    static WORKSPACE: Cell<Option<Box<Workspace>>> = const { Cell::new(None) };
}

/// Memory that held this many nodes is given back.
const KEPT: usize = 1 << 14;

/// All that a run writes but its result.
#[derive(Default)]
struct Workspace {
    wavefront: Wavefront,
    events: Events,
    meeting: Meeting,
    weld: Vec<NodeId>,
    chainer: Chainer,
    number: Vec<u32>,
    sides: Vec<Side>,
}

impl Workspace {
    fn run(
        &mut self,
        polygon: &Polygon,
        weights: Option<&[f64]>,
        time: Option<f64>,
        options: &Options,
    ) -> Result<Skeleton, SkeletonError> {
        let Workspace { wavefront: wf, weld, chainer, .. } = self;
        let setup = set_up(wf, &mut self.sides, polygon, weights, options)?;
        let stop = time.map(|time| stop_moment(time, setup.metres_per_tau)).transpose()?;
        shrink(wf, &mut self.events, &mut self.meeting, stop.as_ref())?;
        let (mut tops, top_pieces) = stand_still(wf, stop)?;
        let moved = weld_nodes(wf, weld, WELD_STEPS);
        wf.faces.flatten();
        let mut faces = chain_faces(wf, weld, &top_pieces, chainer)?;
        if moved && fold::any(wf, &faces) {
            weld_nodes(wf, weld, ROUNDING_STEPS);
            faces = chain_faces(wf, weld, &top_pieces, chainer)?;
        }
        for node in tops.iter_mut().flatten() {
            *node = weld[*node as usize];
        }
        if !wf.faces.unions.is_empty() {
            cut_united(wf, weld, &mut faces, &mut tops)?;
        }
        Ok(finish(polygon, &setup, wf, &mut self.number, faces, tops))
    }
}

/// The moment of a real time. A float is a fraction; 2^20 parts of a grid step are enough.
fn stop_moment(time: f64, metres_per_tau: f64) -> Result<Moment, SkeletonError> {
    if !(time.is_finite() && time >= 0.0) {
        return Err(SkeletonError::Distance(time));
    }
    const PARTS: f64 = 4_503_599_627_370_496.0; // 2^52: parts of a unit of τ, which is 2^32 grid steps
    let t = (time / metres_per_tau * PARTS).min(1e18).round();
    Ok(Moment::new(t as i128, PARTS as i128))
}

/// Let the outline shrink until nothing happens any more, or nothing before `stop`.
fn shrink(
    wf: &mut Wavefront,
    events: &mut Events,
    meeting: &mut Meeting,
    stop: Option<&Moment>,
) -> Result<(), SkeletonError> {
    meeting.clear();
    events.start(wf);
    let mut calls_left = 40 * wf.vertices.len() + 100;
    while let Some(event) = events.next(wf, stop) {
        calls_left = calls_left.checked_sub(1).ok_or(SkeletonError::Unresolved)?;
        let lines = events.lines(wf, &event);
        let [p, e, q] = lines.map(|id| wf.line(id));
        let place = Place::of(p, e, q).ok_or(SkeletonError::Unresolved)?;
        if meeting.settle(wf, &place, lines, events.step, events.slab())? {
            meeting.changed.retain(|&v| wf.vertex(v).alive);
            meeting.changed.sort_unstable();
            meeting.changed.dedup();
            events.update(wf, &meeting.changed);
            meeting.changed.clear();
        } else if let Event { kind: Kind::Split { vertex, .. }, .. } = event {
            events.search(wf, vertex);
        }
    }
    Ok(())
}

/// A directed piece of a face's upper border: line, from, to.
type TopPiece = (LineId, NodeId, NodeId);

/// Turn what is left of the wavefront into loops of nodes, at the moment `stop`, or where it no longer moves.
fn stand_still(wf: &mut Wavefront, stop: Option<Moment>) -> Result<(Vec<Vec<NodeId>>, Vec<TopPiece>), SkeletonError> {
    if wf.active.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let mut alive = wf.active.clone();
    alive.sort_unstable();
    let (mut tops, mut pieces) = (Vec::new(), Vec::new());
    for v in alive {
        if !wf.vertex(v).alive {
            continue;
        }
        let members: Vec<VertexId> = loop_from(wf, v);
        let births = members.iter().map(|&v| wf.nodes[wf.vertex(v).birth as usize].tau);
        let last = births.fold(0.0, f64::max);
        let mut top = Vec::with_capacity(members.len());
        for &v in &members {
            top.push(end_of(wf, v, stop, last)?);
        }
        for (k, &v) in members.iter().enumerate() {
            wf.kill(v, top[k]);
            pieces.push((wf.vertex(v).r, top[(k + 1) % top.len()], top[k]));
        }
        tops.push(top);
    }
    Ok((tops, pieces))
}

/// The vertices of the loop of `v`.
fn loop_from(wf: &Wavefront, v: VertexId) -> Vec<VertexId> {
    let mut members = vec![v];
    let mut at = wf.vertex(v).next;
    while at != v {
        members.push(at);
        at = wf.vertex(at).next;
    }
    members
}

/// The node in which a vertex stands at the end. A vertex that never moves again stays where it was born, and rises to
/// `last`, when the last corner of its loop came to a halt.
fn end_of(wf: &mut Wavefront, v: VertexId, stop: Option<Moment>, last: f64) -> Result<NodeId, SkeletonError> {
    let vertex = *wf.vertex(v);
    if let Some(stop) = stop {
        let place = wf.place(v, stop).ok_or(SkeletonError::Unresolved)?;
        return Ok(wf.add_node(&place));
    }
    if wf.line(vertex.l).w != 0 || wf.line(vertex.r).w != 0 {
        return Err(SkeletonError::Unresolved);
    }
    let birth = wf.nodes[vertex.birth as usize];
    if birth.tau == last {
        return Ok(vertex.birth);
    }
    Ok(wf.push_node(GridNode { tau: last, ..birth }))
}

/// Back to metres: keep the nodes in use, sort the faces by edge.
fn finish(
    polygon: &Polygon,
    setup: &Setup,
    wf: &Wavefront,
    number: &mut Vec<u32>,
    faces: Vec<FaceLoops>,
    tops: Vec<Vec<NodeId>>,
) -> Skeleton {
    let mut nodes: Vec<Node> = Vec::with_capacity(wf.nodes.len());
    for ring in polygon.rings() {
        nodes.extend(ring.iter().map(|&position| Node { position, time: 0.0 }));
    }
    number.clear();
    number.resize(wf.nodes.len(), u32::MAX);
    for (k, n) in number.iter_mut().take(wf.input_nodes).enumerate() {
        *n = k as u32;
    }
    let mut renumber = |ring: &mut Vec<NodeId>| {
        for id in ring {
            let n = &mut number[*id as usize];
            if *n == u32::MAX {
                *n = nodes.len() as u32;
                let GridNode { x, y, tau } = wf.nodes[*id as usize];
                nodes.push(Node { position: setup.grid.plan(x, y), time: tau * setup.metres_per_tau });
            }
            *id = *n;
        }
    };
    let mut result = Skeleton { faces: Vec::with_capacity(faces.len()), ..Skeleton::default() };
    for FaceLoops { root, mut outer, mut holes } in faces {
        if outer.len() < 3 {
            continue;
        }
        renumber(&mut outer);
        holes.iter_mut().for_each(&mut renumber);
        if (root as usize) < wf.input_nodes {
            result.faces.push(SkeletonFace { edge: root as usize, boundary: outer, holes });
        } else {
            result.extras.push(outer);
        }
    }
    result.tops = tops;
    result.tops.iter_mut().for_each(&mut renumber);
    result.faces.sort_by_key(|f| f.edge);
    result.nodes = nodes;
    result
}
