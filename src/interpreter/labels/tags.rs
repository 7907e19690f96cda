//! Sets of tags on faces, edges and vertices of one mesh.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Query;
use crate::geometry::Mesh;

pub type TagSet = BTreeSet<Arc<str>>;

static NONE: TagSet = BTreeSet::new();

/// The kinds of component that carry tags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    Faces,
    Edges,
    Vertices,
}

impl Level {
    pub const ALL: &'static [Level] = &[Level::Faces, Level::Edges, Level::Vertices];
}

/// Tags by face index, by the two vertices of an edge, by vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tags {
    faces: BTreeMap<u32, TagSet>,
    edges: BTreeMap<[u32; 2], TagSet>,
    vertices: BTreeMap<u32, TagSet>,
}

/// The same edge whichever way it is run.
fn key([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Tags {
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty() && !self.any_edges() && !self.any_vertices()
    }

    pub fn any_edges(&self) -> bool {
        !self.edges.is_empty()
    }

    pub fn any_vertices(&self) -> bool {
        !self.vertices.is_empty()
    }

    pub fn face(&self, face: usize) -> &TagSet {
        self.faces.get(&(face as u32)).unwrap_or(&NONE)
    }

    pub fn edge(&self, edge: [u32; 2]) -> &TagSet {
        self.edges.get(&key(edge)).unwrap_or(&NONE)
    }

    pub fn vertex(&self, vertex: u32) -> &TagSet {
        self.vertices.get(&vertex).unwrap_or(&NONE)
    }

    pub fn add_face(&mut self, face: usize, name: Arc<str>) {
        self.faces.entry(face as u32).or_default().insert(name);
    }

    pub fn add_edge(&mut self, edge: [u32; 2], name: Arc<str>) {
        self.edges.entry(key(edge)).or_default().insert(name);
    }

    pub fn add_vertex(&mut self, vertex: u32, name: Arc<str>) {
        self.vertices.entry(vertex).or_default().insert(name);
    }

    pub fn extend_face(&mut self, face: usize, names: &TagSet) {
        if !names.is_empty() {
            self.faces.entry(face as u32).or_default().extend(names.iter().cloned());
        }
    }

    /// In place of the tags the face had.
    pub fn set_face(&mut self, face: usize, names: TagSet) {
        self.faces.remove(&(face as u32));
        self.extend_face(face, &names);
    }

    pub fn extend_edge(&mut self, edge: [u32; 2], names: &TagSet) {
        if !names.is_empty() {
            self.edges.entry(key(edge)).or_default().extend(names.iter().cloned());
        }
    }

    pub fn extend_vertex(&mut self, vertex: u32, names: &TagSet) {
        if !names.is_empty() {
            self.vertices.entry(vertex).or_default().extend(names.iter().cloned());
        }
    }

    /// The same tags after vertices became others; edges that fell together to a point lose theirs.
    pub fn renumbered(&self, place: impl Fn(u32) -> u32) -> Tags {
        let mut out = Tags { faces: self.faces.clone(), ..Tags::default() };
        for (&[a, b], names) in &self.edges {
            let [a, b] = [place(a), place(b)];
            if a != b {
                out.extend_edge([a, b], names);
            }
        }
        self.vertices.iter().for_each(|(&v, names)| out.extend_vertex(place(v), names));
        out
    }

    /// The same tags where face `i` is what face `sources[i]` was.
    pub fn with_faces(&self, sources: &[usize]) -> Tags {
        let mut out = Tags { edges: self.edges.clone(), vertices: self.vertices.clone(), ..Tags::default() };
        sources.iter().enumerate().for_each(|(i, &source)| out.extend_face(i, self.face(source)));
        out
    }

    /// Vertices that are tagged or end a tagged edge.
    pub fn marked_vertices(&self) -> BTreeSet<u32> {
        self.vertices.keys().copied().chain(self.edges.keys().flatten().copied()).collect()
    }

    /// Removes the tags that match from components of these kinds.
    pub fn remove(&mut self, query: &Query, levels: &[Level]) {
        fn strip<K: Ord>(sets: &mut BTreeMap<K, TagSet>, query: &Query) {
            sets.retain(|_, names| {
                names.retain(|name| !query.matches(name));
                !names.is_empty()
            });
        }
        for level in levels {
            match level {
                Level::Faces => strip(&mut self.faces, query),
                Level::Edges => strip(&mut self.edges, query),
                Level::Vertices => strip(&mut self.vertices, query),
            }
        }
    }

    /// Adds the tags of another mesh whose faces and vertices were put behind the first `faces` and `vertices` of
    /// this one's.
    pub fn append(&mut self, other: &Tags, faces: usize, vertices: usize) {
        let (f, v) = (faces as u32, vertices as u32);
        other.faces.iter().for_each(|(face, names)| self.extend_face((face + f) as usize, names));
        other.edges.iter().for_each(|([a, b], names)| self.extend_edge([a + v, b + v], names));
        other.vertices.iter().for_each(|(vertex, names)| self.extend_vertex(vertex + v, names));
    }

    /// Whether a face matches: by its own tags.
    pub fn face_matches(&self, query: &Query, face: u32) -> bool {
        self.face(face as usize).iter().any(|name| query.matches(name))
    }

    /// Whether an edge matches: by its own tags or those of faces on it (reference 4.15.2).
    pub fn edge_matches(&self, query: &Query, mesh: &Mesh, edge: [u32; 2]) -> bool {
        let on_it = |f: &crate::geometry::Face| f.edges().any(|(a, b)| key([a, b]) == key(edge));
        self.edge(edge).iter().any(|name| query.matches(name)) || self.some_face(query, mesh, on_it)
    }

    /// Whether a vertex matches: by its own tags or those of edges and faces at it.
    pub fn vertex_matches(&self, query: &Query, mesh: &Mesh, vertex: u32) -> bool {
        let own = self.vertex(vertex).iter().any(|name| query.matches(name));
        let mut edges = self.edges.iter().filter(|(ends, _)| ends.contains(&vertex));
        own || edges.any(|(_, names)| names.iter().any(|name| query.matches(name)))
            || self.some_face(query, mesh, |f| f.corners().any(|v| v == vertex))
    }

    fn some_face(&self, query: &Query, mesh: &Mesh, test: impl Fn(&crate::geometry::Face) -> bool) -> bool {
        let matching = self.faces.iter().filter(|(_, names)| names.iter().any(|name| query.matches(name)));
        matching.into_iter().any(|(&f, _)| mesh.faces.get(f as usize).is_some_and(&test))
    }
}
