//! What happens next: edge events and split events in exact order (`../shared/numerics.md` §5.5).
//!
//! In: the wavefront after a change. Out: the earliest event that still holds. Every reflex vertex keeps its earliest
//! split under the present neighbours of all fragments; whoever changes a fragment offers it to every reflex vertex
//! again, so nothing is discarded for good.

use std::cmp::Ordering;

use super::heap::Heap;
use super::line::{Moment, determinant, time_numerator};
use super::slab::Slab;
use super::splits::{ReflexList, Split};
use super::wavefront::{LineId, VertexId, Wavefront};

/// A thing that may happen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub moment: Moment,
    pub kind: Kind,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// The fragment between two neighbours shrinks to a point.
    Edge { start: VertexId, end: VertexId },
    /// A reflex vertex runs into the fragment that starts in `fragment`.
    Split { vertex: VertexId, fragment: VertexId, stamp: u32 },
}

/// The queue of events and what it remembers of every vertex.
#[derive(Debug)]
pub(super) struct Events {
    pub(super) heap: Heap,
    /// When the fragment that starts in a vertex vanishes.
    pub(super) vanish: Vec<Option<Moment>>,
    pub(super) splits: Vec<Split>,
    pub(super) reflex: ReflexList,
    /// Where to look for splits, and until when: for all time if `None`.
    pub(super) slab: Slab,
    pub(super) horizon: Option<Moment>,
    /// The present.
    pub(super) now: Moment,
    /// Counts the different moments so far; [`FIRST_STEP`] at the start.
    pub step: u32,
}

/// The number of the moment τ = 0.
pub(super) const FIRST_STEP: u32 = 1;

impl Default for Events {
    fn default() -> Events {
        Events {
            heap: Heap::default(),
            vanish: Vec::new(),
            splits: Vec::new(),
            reflex: ReflexList::default(),
            slab: Slab::default(),
            horizon: None,
            now: Moment::START,
            step: FIRST_STEP,
        }
    }
}

impl Events {
    /// The earliest event that still holds, if it is not later than `stop`; the present moves on to it.
    pub fn next(&mut self, wf: &Wavefront, stop: Option<&Moment>) -> Option<Event> {
        // All that is left in the queue belongs to the dead.
        while !wf.active.is_empty() {
            let event = self.heap.peek().copied();
            if let Some(horizon) = self.horizon
                && event.is_none_or(|event| event.moment.compare(&horizon) == Ordering::Greater)
                && stop.is_none_or(|stop| stop.compare(&horizon) == Ordering::Greater)
            {
                self.widen(wf, horizon.tau);
                continue;
            }
            let event = event?;
            if stop.is_some_and(|stop| event.moment.compare(stop) == Ordering::Greater) {
                return None;
            }
            self.heap.pop();
            match event.kind {
                Kind::Edge { start, end } => {
                    let vertex = wf.vertex(start);
                    if !vertex.alive || vertex.next != end || !wf.vertex(end).alive {
                        continue;
                    }
                }
                Kind::Split { vertex, fragment, stamp } => {
                    if !wf.vertex(vertex).alive || self.splits[vertex as usize].stamp != stamp {
                        continue;
                    }
                    if !wf.vertex(fragment).alive {
                        self.search(wf, vertex);
                        continue;
                    }
                }
            }
            self.advance(event.moment);
            return Some(event);
        }
        None
    }

    /// What the slab rules out.
    pub fn slab(&self) -> Option<&Slab> {
        self.horizon.map(|_| &self.slab)
    }

    fn advance(&mut self, moment: Moment) {
        if self.now.compare(&moment) == Ordering::Less {
            self.step += 1;
            self.now = moment;
        }
    }

    /// The three lines whose meeting an event is.
    pub fn lines(&self, wf: &Wavefront, event: &Event) -> [LineId; 3] {
        match event.kind {
            Kind::Edge { start, end } => {
                let start = wf.vertex(start);
                [start.l, start.r, wf.vertex(end).r]
            }
            Kind::Split { vertex, fragment, .. } => {
                let vertex = wf.vertex(vertex);
                [vertex.l, vertex.r, wf.vertex(fragment).r]
            }
        }
    }

    /// Take note of fragments that changed (each known by its start), and of the vertices at their ends.
    pub fn update(&mut self, wf: &mut Wavefront, fragments: &[VertexId]) {
        self.vanish.resize(wf.vertices.len(), None);
        self.splits.resize(wf.vertices.len(), Split::default());
        for &s in fragments {
            self.schedule_edge(wf, s);
        }
        self.offer(wf, fragments);
    }

    /// The first update: every fragment is new.
    pub fn start(&mut self, wf: &mut Wavefront) {
        self.heap.clear();
        self.vanish.clear();
        self.vanish.resize(wf.vertices.len(), None);
        self.splits.clear();
        self.splits.resize(wf.vertices.len(), Split::default());
        self.reflex.clear();
        (self.now, self.step) = (Moment::START, FIRST_STEP);
        for s in 0..wf.vertices.len() {
            self.schedule_edge(wf, s as VertexId);
        }
        self.reflex.follow(wf, true);
        self.widen(wf, 0.0);
    }

    /// Find out when the fragment that starts in `s` vanishes: if D [p,e] [e,q] > 0, at T / D.
    fn schedule_edge(&mut self, wf: &Wavefront, s: VertexId) {
        let start = wf.vertex(s);
        let end = wf.vertex(start.next);
        let (p, e, q) = (wf.line(start.l), wf.line(start.r), wf.line(end.r));
        let d = determinant(p, e, q);
        let vanishes = d.signum() as i32 * start.turn * end.turn > 0;
        let moment = vanishes.then(|| Moment::new(time_numerator(p, e, q), d));
        self.vanish[s as usize] = moment;
        if let Some(moment) = moment {
            self.heap.push(Event { moment, kind: Kind::Edge { start: s, end: start.next } });
        }
    }
}
