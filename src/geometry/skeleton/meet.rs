//! One procedure for everything that can happen in a point (`../shared/numerics.md` §5.6).
//!
//! In: a place and the wavefront. Out: the wavefront after it, and which fragments changed. Edge, split and vertex events,
//! simultaneous ones of any number, collapsing bays and ridges all go through [`Meeting::settle`].

use std::cmp::Ordering;

use super::SkeletonError;
use super::faces::Union;
use super::line::{Line, Place};
use super::slab::Slab;
use super::wavefront::{LineId, NodeId, VertexId, Wavefront};

/// Neighbouring gathered vertices: the wavefront comes in along the fragment of `l` that starts in `from`, and goes out
/// along that of `r` which ends in `to`.
#[derive(Clone, Copy, Debug)]
struct Chain {
    from: VertexId,
    l: LineId,
    r: LineId,
    to: VertexId,
}

/// One end of a chain seen from the place.
#[derive(Clone, Copy, Debug)]
struct Ray {
    dx: i64,
    dy: i64,
    outgoing: bool,
    chain: usize,
}

/// Working memory of the procedure.
#[derive(Debug, Default)]
pub(super) struct Meeting {
    /// Starts of the fragments that changed since the caller last emptied this list.
    pub changed: Vec<VertexId>,
    /// Number of the present call in `on_line` and `gathered`.
    call: u32,
    on_line: Vec<u32>,
    gathered: Vec<u32>,
    /// Fragments that may be there.
    asked: Vec<VertexId>,
    hits: Vec<VertexId>,
    dying: Vec<VertexId>,
    chains: Vec<Chain>,
    rays: Vec<Ray>,
    ridges: Vec<VertexId>,
}

impl Meeting {
    /// Forget everything but the memory.
    pub fn clear(&mut self) {
        self.changed.clear();
        self.ridges.clear();
        self.on_line.clear();
        self.gathered.clear();
        self.call = 0;
    }

    /// Settle all that happens in `place`, where `lines` are known to meet, and the ridges that form at the same moment.
    /// False if nothing does.
    pub fn settle(
        &mut self,
        wf: &mut Wavefront,
        place: &Place,
        lines: [LineId; 3],
        step: u32,
        slab: Option<&Slab>,
    ) -> Result<bool, SkeletonError> {
        if !self.settle_once(wf, place, lines, None, step, slab)? {
            return Ok(false);
        }
        while let Some(ridge) = self.ridges.pop() {
            if wf.vertex(ridge).alive {
                self.settle_ridge(wf, ridge, step, slab)?;
            }
        }
        Ok(true)
    }

    /// The strip between opposite lines vanishes: go on where it ends (step 7).
    fn settle_ridge(
        &mut self,
        wf: &mut Wavefront,
        ridge: VertexId,
        step: u32,
        slab: Option<&Slab>,
    ) -> Result<(), SkeletonError> {
        let vertex = *wf.vertex(ridge);
        let (before, after) = (*wf.vertex(vertex.prev), *wf.vertex(vertex.next));
        if vertex.prev == vertex.next {
            if before.turn != 0 {
                return Err(SkeletonError::Unresolved);
            }
            wf.kill(ridge, before.birth);
            wf.kill(vertex.prev, before.birth);
            return Ok(());
        }
        let (i, o, h) = (*wf.line(vertex.l), *wf.line(vertex.r), *wf.line(after.r));
        let left = Place::of(wf.line(before.l), &i, &o);
        let right = Place::of(&i, &o, &h);
        let (near, far) = ([before.l, vertex.l, vertex.r], [vertex.l, vertex.r, after.r]);
        let (place, lines) = match (left, right) {
            (Some(left), Some(_)) if left.side(&h) * after.turn >= 0 => (left, near),
            (_, Some(right)) => (right, far),
            (Some(left), None) => (left, near),
            (None, None) => return Err(SkeletonError::Unresolved),
        };
        if self.settle_once(wf, &place, lines, Some(ridge), step, slab)? {
            Ok(())
        } else {
            Err(SkeletonError::Unresolved)
        }
    }

    /// Steps 1 to 6. `ridge` is the vertex between opposite lines that ends here, if that is the reason.
    fn settle_once(
        &mut self,
        wf: &mut Wavefront,
        place: &Place,
        lines: [LineId; 3],
        ridge: Option<VertexId>,
        step: u32,
        slab: Option<&Slab>,
    ) -> Result<bool, SkeletonError> {
        self.gather(wf, place, lines, slab);
        if let Some(ridge) = ridge {
            self.gather_ridge(wf, ridge);
        }
        let vanishing = self.find_chains(wf, place);
        let alone = self.chains.len() == 1 && self.dying.len() <= 1;
        if vanishing == 0 && (self.chains.is_empty() || alone) {
            return Ok(false);
        }
        let node = wf.add_node(place);
        for &v in &self.dying {
            wf.kill(v, node);
        }
        self.pair(wf, node, place, step)?;
        Ok(true)
    }

    /// Step 1: mark the fragments whose line passes through the place, list the vertices that are there. All have to be
    /// asked but for what the slab rules out.
    fn gather(&mut self, wf: &Wavefront, place: &Place, known: [LineId; 3], slab: Option<&Slab>) {
        self.call += 1;
        if self.on_line.len() < wf.vertices.len() {
            self.on_line.resize(wf.vertices.len(), 0);
            self.gathered.resize(wf.vertices.len(), 0);
        }
        self.hits.clear();
        self.dying.clear();
        if let Some(slab) = slab {
            self.asked.clear();
            self.asked.extend(slab.fragments_at([place.x, place.y]).chain(self.changed.iter().copied()));
            self.asked.retain(|&s| wf.vertex(s).alive);
            self.asked.sort_unstable();
            self.asked.dedup();
            for k in 0..self.asked.len() {
                let s = self.asked[k];
                if place.may_be_on(&wf.carried[wf.vertices[s as usize].slot as usize]) {
                    self.ask(wf, place, known, s);
                }
            }
        } else {
            for (&s, line) in wf.active.iter().zip(&wf.carried) {
                if place.may_be_on(line) {
                    self.ask(wf, place, known, s);
                }
            }
        }
        for &s in &self.hits {
            let vertex = wf.vertex(s);
            if vertex.turn != 0 && self.on_line[vertex.prev as usize] == self.call {
                self.gathered[s as usize] = self.call;
                self.dying.push(s);
            }
        }
    }

    /// Whether the line of a fragment passes through the place.
    fn ask(&mut self, wf: &Wavefront, place: &Place, known: [LineId; 3], s: VertexId) {
        let line = wf.vertices[s as usize].r;
        if known.contains(&line) || place.exact_side(wf.line(line)) == 0 {
            self.on_line[s as usize] = self.call;
            self.hits.push(s);
        }
    }

    /// A vertex between opposite lines is there when a neighbour is.
    fn gather_ridge(&mut self, wf: &Wavefront, ridge: VertexId) {
        let vertex = wf.vertex(ridge);
        if self.is_gathered(vertex.prev) || self.is_gathered(vertex.next) {
            self.gathered[ridge as usize] = self.call;
            self.dying.push(ridge);
        }
    }

    fn is_gathered(&self, v: VertexId) -> bool {
        self.gathered[v as usize] == self.call
    }

    /// Step 2: list the chains; returns how many gathered vertices belong to loops that vanish as a whole.
    fn find_chains(&mut self, wf: &Wavefront, place: &Place) -> usize {
        self.chains.clear();
        let mut in_chains = 0;
        for k in 0..self.dying.len() {
            let first = wf.vertex(self.dying[k]);
            if self.is_gathered(first.prev) {
                continue;
            }
            let mut last = first;
            in_chains += 1;
            while self.is_gathered(last.next) {
                last = wf.vertex(last.next);
                in_chains += 1;
            }
            self.chains.push(Chain { from: first.prev, l: first.l, r: last.r, to: last.next });
        }
        for &s in &self.hits {
            let vertex = wf.vertex(s);
            let end = wf.vertex(vertex.next);
            let inside = !self.is_gathered(s)
                && !self.is_gathered(vertex.next)
                && place.side(wf.line(vertex.l)) * vertex.turn > 0
                && place.side(wf.line(end.r)) * end.turn > 0;
            if inside {
                self.chains.push(Chain { from: s, l: vertex.r, r: vertex.r, to: vertex.next });
            }
        }
        self.dying.len() - in_chains
    }

    /// Step 5: join every chain's outgoing fragment with the incoming one that follows it counter-clockwise.
    fn pair(&mut self, wf: &mut Wavefront, node: NodeId, place: &Place, step: u32) -> Result<(), SkeletonError> {
        if let [chain] = self.chains[..] {
            self.join(wf, &chain, &chain, node, place, step);
            return Ok(());
        }
        self.rays.clear();
        for (chain, c) in self.chains.iter().enumerate() {
            let (l, r) = (wf.line(c.l), wf.line(c.r));
            self.rays.push(Ray { dx: r.b, dy: -r.a, outgoing: true, chain });
            self.rays.push(Ray { dx: -l.b, dy: l.a, outgoing: false, chain });
        }
        self.rays.sort_by(compare_rays);
        if (0..self.rays.len()).any(|k| self.rays[k].outgoing == self.rays[(k + 1) % self.rays.len()].outgoing) {
            return Err(SkeletonError::NotSimple);
        }
        for k in 0..self.rays.len() {
            if self.rays[k].outgoing {
                let incoming = self.chains[self.rays[(k + 1) % self.rays.len()].chain];
                let outgoing = self.chains[self.rays[k].chain];
                self.join(wf, &incoming, &outgoing, node, place, step);
            }
        }
        Ok(())
    }

    /// Step 6: join the fragment that comes in along chain `i` with the one that goes out along chain `o`.
    fn join(&mut self, wf: &mut Wavefront, i: &Chain, o: &Chain, node: NodeId, place: &Place, step: u32) {
        let (l, r) = (*wf.line(i.l), *wf.line(o.r));
        self.changed.push(i.from);
        if l == r {
            wf.link(i.from, o.to);
            wf.faces.unite(Union { left: i.l, right: o.r, node });
            return;
        }
        let first = wf.add_vertex(i.l, o.r, node);
        wf.link(i.from, first);
        let mut last = first;
        if l.cross(&r) == 0 {
            if l.same_direction(&r) {
                last = self.insert_step(wf, first, place, node);
            } else {
                self.ridges.push(first);
            }
        }
        wf.link(last, o.to);
        self.changed.push(first);
        self.changed.push(last);
        wf.vertices[first as usize].born = step;
        wf.vertices[last as usize].born = step;
    }

    /// Fragments of different speed go on side by side: put a standing line square to them between the two. `first` gets
    /// the left half of the corner, the returned vertex the right one.
    fn insert_step(&mut self, wf: &mut Wavefront, first: VertexId, place: &Place, node: NodeId) -> VertexId {
        let vertex = *wf.vertex(first);
        let (l, r) = (*wf.line(vertex.l), *wf.line(vertex.r));
        let inwards = if r.w > l.w { 1 } else { -1 };
        let (a, b) = (-r.b * inwards, r.a * inwards);
        let c = -(a as f64 * place.x + b as f64 * place.y).round() as i64;
        let between = wf.add_line(Line { a, b, c, w: 0 });
        let last = wf.add_vertex(between, vertex.r, node);
        wf.set_right(first, between);
        wf.link(first, last);
        last
    }
}

/// Counter-clockwise from the positive x axis; at equal direction outgoing first.
fn compare_rays(p: &Ray, q: &Ray) -> Ordering {
    let lower = |r: &Ray| r.dy < 0 || (r.dy == 0 && r.dx < 0);
    let cross = i128::from(p.dx) * i128::from(q.dy) - i128::from(p.dy) * i128::from(q.dx);
    lower(p).cmp(&lower(q)).then(0.cmp(&cross)).then(q.outgoing.cmp(&p.outgoing))
}
