//! Where vertices come from while shapes are taken apart to be put together again (reference 4.16.5). In: forms before
//! and after an operation. Out: for every vertex the source it stands for: a vertex of the shape that was taken apart,
//! or a place on one of its edges.
//!
//! A form's vertices have sources beside it ([`Shape::provenance`]); operations know nothing of them. A vertex that an
//! operation left in place keeps its source, one it made on an edge gets a place on that edge, all others have none.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::form::Form;
use super::shape::Shape;

/// A vertex without a source.
pub const NONE: u32 = u32::MAX;

/// Two sources and a place from the first (0) to the second (1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnEdge {
    pub ends: [u32; 2],
    pub place: f64,
}

struct Source {
    /// Where it is if nothing is moved.
    home: DVec3,
    on: Option<OnEdge>,
}

/// The sources of one shape that is taken apart.
pub struct Sources {
    list: Vec<Source>,
    /// By the edge's ends and the place in parts of 1e9.
    known: BTreeMap<([u32; 2], i64), u32>,
    /// Shapes that end in NIL: they move vertices and leave no faces.
    pub discarded: Vec<Shape>,
}

/// Distance from an edge, as a share of its length, within which a new vertex lies on it.
const NEAR: f64 = 1e-9;
const PARTS: f64 = 1e9;

impl Sources {
    /// One source per vertex of a form in world positions.
    pub fn of(form: &Form) -> Sources {
        let source = |&home: &DVec3| Source { home, on: None };
        let list = form.mesh.positions.iter().map(source).collect();
        Sources { list, known: BTreeMap::new(), discarded: Vec::new() }
    }

    pub fn home(&self, source: u32) -> DVec3 {
        self.list[source as usize].home
    }

    /// The edge a source lies on, if it is not a vertex.
    pub fn on(&self, source: u32) -> Option<OnEdge> {
        self.list[source as usize].on
    }

    /// The place of a source on the edge between two vertices.
    pub fn place_on(&self, source: u32, ends: [u32; 2]) -> Option<f64> {
        if source == NONE {
            return None;
        }
        match self.on(source) {
            Some(on) => (on.ends == ends).then_some(on.place),
            None => ends.iter().position(|&e| e == source).map(|i| i as f64),
        }
    }

    /// The edge of the shape that both sources lie on; the two themselves if there is none.
    pub fn edge_of(&self, a: u32, b: u32) -> [u32; 2] {
        let candidates = [a, b].into_iter().filter_map(|s| self.on(s)).map(|on| on.ends);
        let shared =
            candidates.into_iter().find(|&ends| self.place_on(a, ends).is_some() && self.place_on(b, ends).is_some());
        shared.unwrap_or([a.min(b), a.max(b)])
    }

    /// The source at a place from `a` (0) to `b` (1).
    fn between(&mut self, a: u32, b: u32, place: f64) -> u32 {
        let ends = self.edge_of(a, b);
        let (Some(from), Some(to)) = (self.place_on(a, ends), self.place_on(b, ends)) else { return NONE };
        let place = from + (to - from) * place;
        let key = (ends, (place * PARTS).round() as i64);
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let home = self.home(ends[0]).lerp(self.home(ends[1]), place);
        self.list.push(Source { home, on: Some(OnEdge { ends, place }) });
        let source = self.list.len() as u32 - 1;
        self.known.insert(key, source);
        source
    }

    /// Sources of the vertices of `after`, an operation's result, from those of `before`; both in world positions.
    pub fn carried(&mut self, before: &Form, sources: &[u32], after: &Form) -> Arc<[u32]> {
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut at: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        for (&p, &source) in before.mesh.positions.iter().zip(sources).filter(|(_, s)| **s != NONE) {
            at.entry(key(p)).or_insert(source);
        }
        let mut edges: Vec<(u32, u32)> = before.mesh.faces.iter().flat_map(|f| f.edges()).collect();
        edges.extend(before.edges.iter().map(|e| (e[0], e[1])));
        let of = |v: u32| sources.get(v as usize).copied().unwrap_or(NONE);
        edges.retain(|&(a, b)| of(a) != NONE && of(b) != NONE);
        let mut source_at = |&p: &DVec3| {
            if let Some(&source) = at.get(&key(p)) {
                return source;
            }
            let on = edges.iter().find_map(|&(a, b)| {
                let [from, to] = [a, b].map(|v| before.mesh.positions[v as usize]);
                let along = to - from;
                let place = (p - from).dot(along) / along.length_squared();
                let near = p.distance(from + along * place) <= NEAR * along.length();
                (near && place > 0.0 && place < 1.0).then_some((of(a), of(b), place))
            });
            on.map_or(NONE, |(a, b, place)| self.between(a, b, place))
        };
        after.mesh.positions.iter().map(&mut source_at).collect()
    }
}
