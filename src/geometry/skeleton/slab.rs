//! Large wavefronts one slab of time after the other. In: the wavefront and the present. Out: which fragments and which
//! reflex vertices can meet before the end of the slab, by the cells of the plan that they pass until then.
//!
//! Splits after the end of a slab are left to the next. A fragment between two corners stays within the convex hull of
//! where the corners are at the beginning and at the end.

use super::cells::{Cover, Frame, Lists};
use super::path::Path;
use super::wavefront::{VertexId, Wavefront};

/// Smaller wavefronts are searched as a whole.
pub(super) const LARGE: usize = 160;

/// No slab is shorter, in τ: 2^-40.
const LEAST: f64 = 1.0 / 1_099_511_627_776.0;

/// Slabs end before this τ, in which a line of weight 1 crosses the whole grid.
const LAST: f64 = 0.25;

/// The present slab.
#[derive(Debug, Default)]
pub(super) struct Slab {
    /// τ at its end; `None` if it never ends, and nothing is kept by cells.
    end: Option<f64>,
    frame: Frame,
    fragments: Lists,
    reflex: Lists,
    cover: Cover,
    /// The number of the slab, and for every fragment that of the one in which it became a large one.
    number: u32,
    large: Vec<u32>,
    steps: Vec<f64>,
}

impl Slab {
    /// Begin the slab that follows `begin`, and enter the fragments; returns its end. `paths` are those of the living
    /// reflex vertices.
    pub fn follow(&mut self, wf: &Wavefront, begin: f64, paths: impl Iterator<Item = Path>) -> Option<f64> {
        self.end = None;
        if wf.active.len() < LARGE {
            return None;
        }
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for node in &wf.nodes[..wf.input_nodes] {
            low = [low[0].min(node.x), low[1].min(node.y)];
            high = [high[0].max(node.x), high[1].max(node.y)];
        }
        self.frame = Frame::over(low, high, wf.active.len());
        self.steps.clear();
        self.steps.extend(paths.map(|path| self.frame.side() / path.speed()));
        if self.steps.is_empty() {
            return None;
        }
        // Half of the reflex vertices stay within a cell or so.
        let middle = self.steps.len() / 2;
        let step = *self.steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let end = begin + step.max(begin / 2.0).max(LEAST);
        if end >= LAST {
            return None;
        }
        self.end = Some(end);
        self.number += 1;
        self.fragments.clear(self.frame.cells());
        self.reflex.clear(self.frame.cells());
        for &s in &wf.active {
            self.cover_fragment(wf, s, begin);
            self.enter_fragment(wf, s);
        }
        Some(end)
    }

    /// What a fragment passes from `now` to the end of the slab.
    pub fn cover_fragment(&mut self, wf: &Wavefront, s: VertexId, now: f64) {
        let corners = [s, wf.vertex(s).next].map(|v| wf.vertex(v));
        let Some(end) = self.end.filter(|_| corners.iter().all(|v| v.turn != 0)) else {
            self.cover.large = true;
            return;
        };
        let [p, q] = corners.map(|v| Path::of(wf.line(v.l), wf.line(v.r)));
        self.frame.cover(&[p.spot(now), p.spot(end), q.spot(now), q.spot(end)], &mut self.cover);
    }

    /// What a corner passes from `now` to `latest`.
    pub fn cover_path(&mut self, path: &Path, now: f64, latest: f64) {
        self.frame.cover(&[path.spot(now), path.spot(latest)], &mut self.cover);
    }

    /// Enter the fragment that was covered last.
    pub fn enter_fragment(&mut self, wf: &Wavefront, s: VertexId) {
        if self.cover.large {
            self.large.resize(wf.vertices.len(), 0);
            if std::mem::replace(&mut self.large[s as usize], self.number) == self.number {
                return;
            }
            self.fragments.large.retain(|&s| wf.vertex(s).alive);
        }
        self.fragments.enter(&self.cover, s);
    }

    /// Enter the reflex vertex whose path was covered last.
    pub fn enter_reflex(&mut self, v: VertexId) {
        self.reflex.enter(&self.cover, v);
    }

    /// Fragments that may pass a point; some of them dead, some more than once.
    pub fn fragments_at(&self, at: [f64; 2]) -> impl Iterator<Item = VertexId> {
        self.fragments.in_cell(self.frame.cell(at)).chain(self.fragments.large.iter().copied())
    }

    /// Fragments that may pass what [`Slab::cover`] covers: `None`: all may.
    pub fn fragments_near(&self) -> Option<impl Iterator<Item = VertexId>> {
        let cells = self.cover.cells.iter().flat_map(|&cell| self.fragments.in_cell(cell as usize));
        (!self.cover.large).then(|| cells.chain(self.fragments.large.iter().copied()))
    }

    /// Reflex vertices that may pass what [`Slab::cover`] covers: `None`: all may.
    pub fn reflex_near(&self) -> Option<impl Iterator<Item = VertexId>> {
        let cells = self.cover.cells.iter().flat_map(|&cell| self.reflex.in_cell(cell as usize));
        (!self.cover.large).then(|| cells.chain(self.reflex.large.iter().copied()))
    }
}
