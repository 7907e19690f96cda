//! Puts a shape together again from its edited parts (reference 4.16.5). In: parts whose vertices know their sources.
//! Out: one form; vertices with one source are one, moved by the sum of what their copies were moved.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::form::Form;
use super::merging::{Dressed, appended};
use super::provenance::{NONE, Sources};
use super::shape::Shape;
use crate::geometry::{Face, Mesh};

/// What came of it, with the source of every vertex.
pub struct Recomposed {
    pub dressed: Dressed,
    pub sources: Vec<u32>,
}

/// Joins the faces of the shapes; shapes without faces, and the discarded ones, only move vertices. Positions are those
/// of the world.
pub fn recompose(sources: &Sources, shapes: &[Shape]) -> Recomposed {
    let with_faces: Vec<&Shape> = shapes.iter().filter(|s| !s.form.mesh.faces.is_empty()).collect();
    let dressed = |s: &&Shape| Dressed { form: s.form.clone(), appearance: s.state.appearance.clone() };
    let parts = appended(&with_faces.iter().map(dressed).collect::<Vec<_>>());
    let of_parts: Vec<u32> = with_faces.iter().flat_map(|s| sources_of(s)).collect();
    let shown: BTreeSet<u32> = of_parts.iter().copied().filter(|&s| s != NONE).collect();
    let joints = Joints::new(sources, &shown);
    let mut moves: BTreeMap<u32, DVec3> = BTreeMap::new();
    for shape in shapes.iter().chain(&sources.discarded) {
        joints.add_moves(&shape.form, &sources_of(shape), &mut moves);
    }
    let position = |source: u32| sources.home(source) + moves.get(&source).copied().unwrap_or(DVec3::ZERO);
    let mut out = Welded::default();
    for face in &parts.form.mesh.faces {
        let face = joints.completed(face, &of_parts, &parts.form.mesh);
        out.add(face, &parts.form.mesh, &of_parts, position);
    }
    let count = parts.form.mesh.faces.len() as u32;
    let form = parts.form.derived(out.mesh, (0..count).map(Some));
    Recomposed { dressed: Dressed { form: Arc::new(form), appearance: parts.appearance }, sources: out.sources }
}

fn sources_of(shape: &Shape) -> Vec<u32> {
    let count = shape.form.mesh.positions.len();
    match &shape.provenance {
        Some(own) if own.len() == count => own.to_vec(),
        _ => vec![NONE; count],
    }
}

/// A corner of a face that is being completed: a vertex of the parts, or a source between two of them.
#[derive(Clone, Copy)]
enum Corner {
    Old(u32),
    New(u32),
}

/// Sources on edges that faces show, by edge, in order of place.
struct Joints<'a> {
    sources: &'a Sources,
    on: BTreeMap<[u32; 2], Vec<(f64, u32)>>,
}

impl<'a> Joints<'a> {
    fn new(sources: &'a Sources, shown: &BTreeSet<u32>) -> Self {
        let mut on: BTreeMap<[u32; 2], Vec<(f64, u32)>> = BTreeMap::new();
        for &source in shown {
            if let Some(place) = sources.on(source) {
                on.entry(place.ends).or_default().push((place.place, source));
            }
        }
        on.values_mut().for_each(|list| list.sort_by(|a, b| a.0.total_cmp(&b.0)));
        Joints { sources, on }
    }

    /// Sources strictly between two, with their share of the way from `a`.
    fn between(&self, a: u32, b: u32) -> Vec<(f64, u32)> {
        if a == NONE || b == NONE || a == b {
            return Vec::new();
        }
        let ends = self.sources.edge_of(a, b);
        let places = (self.sources.place_on(a, ends), self.sources.place_on(b, ends));
        let (Some(from), Some(to)) = places else { return Vec::new() };
        let share = |&(place, source): &(f64, u32)| ((place - from) / (to - from), source);
        let on_edge = self.on.get(&ends).map(Vec::as_slice).unwrap_or_default();
        let mut inner: Vec<(f64, u32)> =
            on_edge.iter().map(share).filter(|&(s, source)| s > 0.0 && s < 1.0 && source != a && source != b).collect();
        inner.sort_by(|a, b| a.0.total_cmp(&b.0));
        inner
    }

    /// Adds how far every copy in a form was moved. A source that another part has between two vertices of this form
    /// is moved along with them.
    fn add_moves(&self, form: &Form, own: &[u32], moves: &mut BTreeMap<u32, DVec3>) {
        let moved = |v: u32| form.mesh.positions[v as usize] - self.sources.home(own[v as usize]);
        for (v, &source) in own.iter().enumerate().filter(|(_, s)| **s != NONE) {
            *moves.entry(source).or_default() += moved(v as u32);
        }
        let mut edges: BTreeSet<[u32; 2]> =
            form.mesh.faces.iter().flat_map(|f| f.edges()).map(|(a, b)| [a.min(b), a.max(b)]).collect();
        edges.extend(form.edges.iter().map(|e| [e[0].min(e[1]), e[0].max(e[1])]));
        for [a, b] in edges {
            for (share, source) in self.between(own[a as usize], own[b as usize]) {
                if !own.contains(&source) {
                    *moves.entry(source).or_default() += moved(a).lerp(moved(b), share);
                }
            }
        }
    }

    /// The face with the vertices that its neighbours have on its edges.
    fn completed(&self, face: &Face, own: &[u32], mesh: &Mesh) -> Completed {
        let mut out = Completed::default();
        let mut start = 0;
        for ring in face.loops() {
            let mut corners = Vec::with_capacity(ring.len());
            for (i, &v) in ring.iter().enumerate() {
                let next = (i + 1) % ring.len();
                let w = ring[next];
                corners.push(Corner::Old(v));
                out.values.push([(start + i, 1.0), (start + i, 0.0)]);
                for (share, source) in self.between(own[v as usize], own[w as usize]) {
                    let p = mesh.positions[v as usize].lerp(mesh.positions[w as usize], share);
                    if p.is_finite() {
                        corners.push(Corner::New(source));
                        out.values.push([(start + i, 1.0 - share), (start + next, share)]);
                    }
                }
            }
            start += ring.len();
            out.loops.push(corners);
        }
        out.source = face.clone();
        out
    }
}

#[derive(Default)]
struct Completed {
    loops: Vec<Vec<Corner>>,
    /// Shares of the source's corners in each corner.
    values: Vec<[(usize, f64); 2]>,
    source: Face,
}

/// Vertices by source; those without stay apart.
#[derive(Default)]
struct Welded {
    mesh: Mesh,
    sources: Vec<u32>,
    places: BTreeMap<u32, u32>,
    loose: BTreeMap<u32, u32>,
}

impl Welded {
    fn add(&mut self, face: Completed, parts: &Mesh, own: &[u32], position: impl Fn(u32) -> DVec3) {
        let mut place = |corner: Corner| {
            let (source, old) = match corner {
                Corner::Old(v) => (own[v as usize], v),
                Corner::New(source) => (source, NONE),
            };
            let next = self.mesh.positions.len() as u32;
            let known = if source == NONE { self.loose.entry(old) } else { self.places.entry(source) };
            let v = *known.or_insert(next);
            if v == next {
                let p = if source == NONE { parts.positions[old as usize] } else { position(source) };
                self.mesh.positions.push(p);
                self.sources.push(source);
            }
            v
        };
        let loops: Vec<Vec<u32>> = face.loops.iter().map(|l| l.iter().map(|&c| place(c)).collect()).collect();
        let mut rings = loops.into_iter();
        let mut out = Face::with_holes(rings.next().unwrap_or_default(), rings);
        for (set, uv) in &face.source.uvs {
            let value = |w: &[(usize, f64); 2]| w.iter().map(|&(c, share)| uv[c] * share).sum::<DVec2>();
            out.uvs.push((*set, face.values.iter().map(value).collect()));
        }
        if !face.source.normals.is_empty() {
            let normals = &face.source.normals;
            let value = |w: &[(usize, f64); 2]| w.iter().map(|&(c, share)| normals[c] * share).sum::<DVec3>();
            out.normals = face.values.iter().map(|w| value(w).normalize_or_zero()).collect();
        }
        self.mesh.faces.push(out);
    }
}
