//! Split events: which fragment a reflex vertex runs into first. In: the wavefront, fragments that changed. Out: for every
//! reflex vertex its earliest split under the present neighbours of all fragments, as an event.
//!
//! Floats turn most fragments down; the integers decide on the rest.

use std::cmp::Ordering;

use super::events::{Event, Events, Kind};
use super::line::{Moment, Place, determinant, time_numerator};
use super::path::Path;
use super::wavefront::{FloatLine, NONE, VertexId, Wavefront};

/// The best split of a reflex vertex, with a number that tells it from its predecessors.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Split {
    pub moment: Option<Moment>,
    pub stamp: u32,
}

/// A living reflex vertex.
#[derive(Clone, Copy, Debug)]
struct Reflex {
    path: Path,
    /// τ after which a split is of no interest.
    latest: f64,
    vertex: VertexId,
    /// The update in which one of its own fragments changed last.
    changed: u32,
}

/// The living reflex vertices.
#[derive(Debug, Default)]
pub(super) struct ReflexList {
    entries: Vec<Reflex>,
    /// Where a vertex stands in `entries`.
    slots: Vec<u32>,
    update: u32,
}

impl ReflexList {
    pub fn clear(&mut self) {
        self.entries.clear();
        self.slots.clear();
    }

    /// Take in the reflex vertices that were born, drop those that died.
    pub fn follow(&mut self, wf: &mut Wavefront, keep_order: bool) {
        self.slots.resize(wf.vertices.len(), NONE);
        let mut gone = false;
        for &v in &wf.dead {
            let slot = std::mem::replace(&mut self.slots[v as usize], NONE);
            gone |= slot != NONE;
            if slot != NONE && !keep_order {
                self.entries.swap_remove(slot as usize);
                if let Some(moved) = self.entries.get(slot as usize) {
                    self.slots[moved.vertex as usize] = slot;
                }
            }
        }
        wf.dead.clear();
        if gone && keep_order {
            self.drop_dead();
        }
        for &v in &wf.reflex {
            let vertex = *wf.vertex(v);
            if vertex.alive && self.slots[v as usize] == NONE {
                self.slots[v as usize] = self.entries.len() as u32;
                let path = Path::of(wf.line(vertex.l), wf.line(vertex.r));
                self.entries.push(Reflex { path, latest: f64::INFINITY, vertex: v, changed: 0 });
            }
        }
        wf.reflex.clear();
    }
}

impl ReflexList {
    fn drop_dead(&mut self) {
        let slots = &mut self.slots;
        let mut slot = 0;
        self.entries.retain(|e| {
            let stays = slots[e.vertex as usize] != NONE;
            if stays {
                slots[e.vertex as usize] = slot;
                slot += 1;
            }
            stays
        });
    }

    pub fn paths(&self) -> impl Iterator<Item = Path> {
        self.entries.iter().map(|e| e.path)
    }

    /// Give the reflex vertices at the ends of `fragments` the number of this update.
    fn mark_changed(&mut self, wf: &Wavefront, fragments: &[VertexId]) {
        self.update += 1;
        for &s in fragments {
            for v in [s, wf.vertex(s).next] {
                let slot = self.slots[v as usize];
                if slot != NONE {
                    self.entries[slot as usize].changed = self.update;
                }
            }
        }
    }

    fn is_changed(&self, slot: u32) -> bool {
        self.entries[slot as usize].changed == self.update
    }
}

/// A search for the earliest split of one vertex.
struct Search<'a> {
    wf: &'a Wavefront,
    events: &'a Events,
    reflex: Reflex,
    /// The earliest so far, or the bound; `None` if there is none, or not asked for yet.
    best: Option<Moment>,
    asked: bool,
    found: VertexId,
}

impl Search<'_> {
    /// See whether the vertex runs into the fragment that starts in `s`, carried by `line`, earlier than into what it has.
    #[inline]
    fn see(&mut self, s: VertexId, line: &FloatLine) {
        if self.reflex.path.may_meet(line, self.events.now.tau, self.reflex.latest) {
            self.consider(s, line);
        }
    }

    /// The same for a fragment that may be dead.
    fn see_living(&mut self, s: VertexId) {
        let vertex = self.wf.vertex(s);
        if vertex.alive {
            self.see(s, &self.wf.carried[vertex.slot as usize]);
        }
    }

    /// The same for a fragment whose line it meets in time.
    #[inline(never)]
    fn consider(&mut self, s: VertexId, line: &FloatLine) {
        let Reflex { path, vertex: v, .. } = self.reflex;
        let wf = self.wf;
        let (vertex, start) = (wf.vertex(v), wf.vertex(s));
        if s == v || start.next == v {
            return;
        }
        // Where v meets a fragment next to its own, its own vanishes.
        let after = start.prev == v && start.turn > 0;
        let before = start.next == vertex.prev && wf.vertex(start.next).turn > 0;
        let side = |meet, line: u32, turn: i32| path.side(&wf.floats[line as usize], meet) * turn;
        let sides = path.meet(line).map(|m| {
            let end = wf.vertex(start.next);
            let first = if after { 1 } else { side(m, start.l, start.turn) };
            let second = if before { 1 } else { side(m, end.r, end.turn) };
            [first, second]
        });
        if sides.is_some_and(|sides| sides.contains(&-1)) {
            return;
        }
        let vanish = match (after, before) {
            (true, _) => Some(self.events.vanish[v as usize]),
            (_, true) => Some(self.events.vanish[vertex.prev as usize]),
            _ => None,
        };
        if !self.asked {
            (self.best, self.asked) = (self.events.bound(wf, v), true);
        }
        if let Some(moment) = self.hit(s, sides == Some([1, 1]), vanish) {
            self.reflex.latest = moment.tau;
            (self.best, self.found) = (Some(moment), s);
        }
    }

    /// The moment at which the vertex hits the fragment that starts in `s`, exactly: from the inner side, not in the past,
    /// not later than the best (earlier, once one was found), on the fragment as it is then (known if `inside`).
    /// `vanish` is when its own fragment between the two vanishes.
    fn hit(&self, s: VertexId, inside: bool, vanish: Option<Option<Moment>>) -> Option<Moment> {
        let wf = self.wf;
        let vertex = wf.vertex(self.reflex.vertex);
        let (l, r, f) = (wf.line(vertex.l), wf.line(vertex.r), wf.line(wf.vertex(s).r));
        let moment = match vanish {
            Some(moment) => moment?,
            None => {
                let d = determinant(l, r, f);
                if d >= 0 {
                    return None;
                }
                Moment::new(time_numerator(l, r, f), d)
            }
        };
        match moment.compare(&self.events.now) {
            Ordering::Less => return None,
            // Everything in the place where it was born has just been settled.
            Ordering::Equal if vertex.born == self.events.step => return None,
            _ => {}
        }
        match self.best.map(|best| moment.compare(&best)) {
            Some(Ordering::Greater) => return None,
            Some(Ordering::Equal) if self.found != NONE => return None,
            _ => {}
        }
        (inside || wf.on_fragment(s, &Place::of(l, r, f)?)).then_some(moment)
    }
}

impl Events {
    /// Find the earliest split of `v` among all fragments, up to the end of the slab.
    pub fn search(&mut self, wf: &Wavefront, v: VertexId) {
        let slot = self.reflex.slots[v as usize] as usize;
        self.splits[v as usize].moment = None;
        self.splits[v as usize].stamp += 1;
        let best = self.bound(wf, v);
        let mut reflex = self.reflex.entries[slot];
        reflex.latest = best.map_or(f64::INFINITY, |m| m.tau);
        let mut slab = std::mem::take(&mut self.slab);
        if self.horizon.is_some() {
            slab.cover_path(&reflex.path, self.now.tau, reflex.latest);
            slab.enter_reflex(v);
        }
        let mut search = Search { wf, events: self, reflex, best, asked: true, found: NONE };
        match self.horizon.and_then(|_| slab.fragments_near()) {
            Some(near) => near.for_each(|s| search.see_living(s)),
            None => wf.active.iter().zip(&wf.carried).for_each(|(&s, line)| search.see(s, line)),
        }
        let Search { reflex, best, found, .. } = search;
        self.slab = slab;
        self.reflex.entries[slot] = reflex;
        self.note(reflex.vertex, found, best);
    }

    /// Offer changed fragments to every reflex vertex; search anew for those whose own fragments changed.
    pub fn offer(&mut self, wf: &mut Wavefront, fragments: &[VertexId]) {
        self.reflex.follow(wf, self.horizon.is_none());
        self.reflex.mark_changed(wf, fragments);
        if self.horizon.is_some() {
            self.offer_near(wf, fragments);
            return;
        }
        for slot in 0..self.reflex.entries.len() as u32 {
            if self.reflex.is_changed(slot) {
                self.search(wf, self.reflex.entries[slot as usize].vertex);
            } else {
                self.offer_to(wf, slot, fragments);
            }
        }
    }

    /// The same, where only those near each other have to be asked.
    fn offer_near(&mut self, wf: &Wavefront, fragments: &[VertexId]) {
        let mut slab = std::mem::take(&mut self.slab);
        for &s in fragments {
            slab.cover_fragment(wf, s, self.now.tau);
            slab.enter_fragment(wf, s);
            match slab.reflex_near() {
                Some(near) => {
                    for v in near {
                        let slot = self.reflex.slots[v as usize];
                        if slot != NONE && !self.reflex.is_changed(slot) {
                            self.offer_to(wf, slot, &[s]);
                        }
                    }
                }
                None => (0..self.reflex.entries.len() as u32).for_each(|slot| self.offer_to(wf, slot, &[s])),
            }
        }
        self.slab = slab;
        for &s in fragments {
            for v in [s, wf.vertex(s).next] {
                if self.reflex.slots[v as usize] != NONE {
                    self.search(wf, v);
                }
            }
        }
    }

    fn offer_to(&mut self, wf: &Wavefront, slot: u32, fragments: &[VertexId]) {
        let reflex = self.reflex.entries[slot as usize];
        let mut search = Search { wf, events: self, reflex, best: None, asked: false, found: NONE };
        for &s in fragments {
            search.see(s, &wf.carried[wf.vertices[s as usize].slot as usize]);
        }
        let Search { reflex, best, found, .. } = search;
        if found != NONE {
            self.reflex.entries[slot as usize] = reflex;
            self.note(reflex.vertex, found, best);
        }
    }

    /// Go on to the next slab of time, for which every reflex vertex has to be searched.
    pub fn widen(&mut self, wf: &Wavefront, begin: f64) {
        let end = self.slab.follow(wf, begin, self.reflex.paths());
        const PARTS: f64 = 4_503_599_627_370_496.0; // 2^52
        self.horizon = end.map(|end| Moment::new((end * PARTS) as i128, PARTS as i128));
        for slot in 0..self.reflex.entries.len() {
            self.search(wf, self.reflex.entries[slot].vertex);
        }
    }

    /// Enter what a search found.
    fn note(&mut self, vertex: VertexId, fragment: VertexId, moment: Option<Moment>) {
        if fragment != NONE
            && let Some(moment) = moment
        {
            let split = &mut self.splits[vertex as usize];
            split.moment = Some(moment);
            split.stamp += 1;
            let kind = Kind::Split { vertex, fragment, stamp: split.stamp };
            self.heap.push(Event { moment, kind });
        }
    }

    /// The moment after which a split of `v` is of no interest: it has a better one, its own fragments vanish, or
    /// the slab ends.
    fn bound(&self, wf: &Wavefront, v: VertexId) -> Option<Moment> {
        let prev = wf.vertex(v).prev;
        [self.splits[v as usize].moment, self.vanish[v as usize], self.vanish[prev as usize], self.horizon]
            .into_iter()
            .flatten()
            .min_by(Moment::compare)
    }
}
