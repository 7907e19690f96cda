//! What happens next: edge events and split events in exact order (`../shared/numerics.md` §5.5).
//!
//! In: the wavefront after a change. Out: the earliest event that still holds. Every reflex vertex keeps its earliest
//! split under the present neighbours of all fragments; whoever changes a fragment offers it to every reflex vertex
//! again, so nothing is discarded for good.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::line::{Moment, Place, determinant, time_numerator};
use super::wavefront::{NONE, VertexId, Wavefront};

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

impl Ord for Event {
    /// Reversed, so that the heap gives the earliest first.
    fn cmp(&self, other: &Event) -> Ordering {
        other.moment.compare(&self.moment)
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Event) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Event {
    fn eq(&self, other: &Event) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Event {}

/// The best split of a reflex vertex, with a number that tells it from its predecessors.
#[derive(Clone, Copy, Debug, Default)]
struct Split {
    moment: Option<Moment>,
    stamp: u32,
}

/// The queue of events and what it remembers of every vertex.
#[derive(Debug)]
pub(super) struct Events {
    heap: BinaryHeap<Event>,
    /// When the fragment that starts in a vertex vanishes.
    vanish: Vec<Option<Moment>>,
    splits: Vec<Split>,
    /// The present.
    now: Moment,
    /// Counts the different moments so far; [`FIRST_STEP`] at the start.
    pub step: u32,
}

/// The number of the moment τ = 0.
pub(super) const FIRST_STEP: u32 = 1;

/// Coefficients of D and T of a vertex with any third line, for the float test.
struct Probe {
    d: [f64; 3],
    t: [f64; 3],
}

impl Probe {
    fn of(wf: &Wavefront, v: VertexId) -> Probe {
        let vertex = wf.vertex(v);
        let (l, r) = (wf.line(vertex.l), wf.line(vertex.r));
        let minor =
            |u: i64, v: i64, s: i64, t: i64| (i128::from(u) * i128::from(v) - i128::from(s) * i128::from(t)) as f64;
        let cross = l.cross(r) as f64;
        Probe {
            d: [minor(r.w, l.b, l.w, r.b), minor(l.w, r.a, r.w, l.a), cross],
            t: [minor(r.c, l.b, l.c, r.b), minor(l.c, r.a, r.c, l.a), cross],
        }
    }
}

impl Events {
    pub fn with_capacity(edges: usize) -> Events {
        let heap = BinaryHeap::with_capacity(2 * edges);
        Events { heap, vanish: Vec::new(), splits: Vec::new(), now: Moment::START, step: FIRST_STEP }
    }

    /// The earliest event that still holds, if it is not later than `stop`; the present moves on to it.
    pub fn next(&mut self, wf: &Wavefront, stop: Option<&Moment>) -> Option<Event> {
        loop {
            let event = *self.heap.peek()?;
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
    }

    fn advance(&mut self, moment: Moment) {
        if self.now.compare(&moment) == Ordering::Less {
            self.step += 1;
            self.now = moment;
        }
    }

    /// Where an event takes place.
    pub fn place(&self, wf: &Wavefront, event: &Event) -> Option<Place> {
        let line = |id| wf.line(id);
        match event.kind {
            Kind::Edge { start, end } => {
                let (s, e) = (wf.vertex(start), wf.vertex(end));
                Place::of(line(s.l), line(s.r), line(e.r))
            }
            Kind::Split { vertex, fragment, .. } => {
                let v = wf.vertex(vertex);
                Place::of(line(v.l), line(v.r), line(wf.vertex(fragment).r))
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
        let mut reflex = std::mem::take(&mut wf.reflex);
        reflex.retain(|&v| wf.vertex(v).alive);
        for &v in &reflex {
            let vertex = wf.vertex(v);
            if fragments.contains(&v) || fragments.contains(&vertex.prev) {
                self.search(wf, v);
            } else {
                self.offer(wf, v, fragments);
            }
        }
        wf.reflex = reflex;
    }

    /// The first update: every fragment is new.
    pub fn start(&mut self, wf: &Wavefront) {
        self.vanish.resize(wf.vertices.len(), None);
        self.splits.resize(wf.vertices.len(), Split::default());
        for s in 0..wf.vertices.len() {
            self.schedule_edge(wf, s as VertexId);
        }
        for &v in &wf.reflex {
            self.search(wf, v);
        }
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

    /// Find the earliest split of `v` among all fragments.
    pub fn search(&mut self, wf: &Wavefront, v: VertexId) {
        self.splits[v as usize].moment = None;
        self.splits[v as usize].stamp += 1;
        self.offer(wf, v, &wf.active);
    }

    /// See whether `v` runs into one of `fragments` earlier than into what it has.
    fn offer(&mut self, wf: &Wavefront, v: VertexId, fragments: &[VertexId]) {
        let probe = Probe::of(wf, v);
        let mut best = self.bound(wf, v);
        let mut found = NONE;
        let now = self.now.tau;
        for &s in fragments {
            let latest = best.as_ref().map_or(f64::INFINITY, |m| m.tau);
            if !may_hit(wf, &probe, s, now, latest) {
                continue;
            }
            if let Some(moment) = self.hit(wf, v, s, best.as_ref(), found != NONE) {
                best = Some(moment);
                found = s;
            }
        }
        if found != NONE
            && let Some(moment) = best
        {
            let split = &mut self.splits[v as usize];
            split.moment = Some(moment);
            split.stamp += 1;
            let kind = Kind::Split { vertex: v, fragment: found, stamp: split.stamp };
            self.heap.push(Event { moment, kind });
        }
    }

    /// The moment after which a split of `v` is of no interest: it has a better one, or its own fragments vanish.
    fn bound(&self, wf: &Wavefront, v: VertexId) -> Option<Moment> {
        let prev = wf.vertex(v).prev;
        [self.splits[v as usize].moment, self.vanish[v as usize], self.vanish[prev as usize]]
            .into_iter()
            .flatten()
            .min_by(Moment::compare)
    }

    /// The moment at which `v` hits the fragment that starts in `s`, exactly: from the inner side, not in the past, not
    /// later than `best` (earlier if `strict`), on the fragment as it is then.
    fn hit(&self, wf: &Wavefront, v: VertexId, s: VertexId, best: Option<&Moment>, strict: bool) -> Option<Moment> {
        let vertex = wf.vertex(v);
        let (l, r, f) = (wf.line(vertex.l), wf.line(vertex.r), wf.line(wf.vertex(s).r));
        let d = determinant(l, r, f);
        if d >= 0 {
            return None;
        }
        let moment = Moment::new(time_numerator(l, r, f), d);
        match moment.compare(&self.now) {
            Ordering::Less => return None,
            // Everything in the place where it was born has just been settled.
            Ordering::Equal if vertex.born == self.step => return None,
            _ => {}
        }
        match best.map(|best| moment.compare(best)) {
            Some(Ordering::Greater) => return None,
            Some(Ordering::Equal) if strict => return None,
            _ => {}
        }
        let place = Place::of(l, r, f)?;
        wf.on_fragment(s, &place).then_some(moment)
    }
}

/// Float test: false if `v` certainly does not hit the line of the fragment between `now` and `latest`.
fn may_hit(wf: &Wavefront, probe: &Probe, s: VertexId, now: f64, latest: f64) -> bool {
    const DOUBT: f64 = 4e-15;
    let f = &wf.floats[wf.vertices[s as usize].r as usize];
    let terms = [f.a * probe.d[0], f.b * probe.d[1], f.w * probe.d[2]];
    let d = terms[0] + terms[1] + terms[2];
    let d_doubt = DOUBT * (terms[0].abs() + terms[1].abs() + terms[2].abs());
    if d > d_doubt {
        return false;
    }
    let terms = [f.a * probe.t[0], f.b * probe.t[1], f.c * probe.t[2]];
    let t = terms[0] + terms[1] + terms[2];
    let t_doubt = DOUBT * (terms[0].abs() + terms[1].abs() + terms[2].abs());
    // With d < 0: t / d < now is t > now d, t / d > latest is t < latest d.
    if t - now * d > t_doubt + now * d_doubt {
        return false;
    }
    latest == f64::INFINITY || t - latest * d >= -(t_doubt + latest * d_doubt + DOUBT * (latest * d).abs())
}
