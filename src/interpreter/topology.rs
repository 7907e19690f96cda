//! Which faces meet at which edges. In: a mesh. Out: its edges in order of first use, with the faces on them.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::geometry::Mesh;

/// One edge, run as its first face runs it.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    pub from: u32,
    pub to: u32,
    /// The first two faces on it, the same one twice if a face meets itself.
    pub first: u32,
    pub second: Option<u32>,
    /// Number of face edges here.
    pub uses: u32,
}

impl Edge {
    /// One face on one side only.
    pub fn is_border(&self) -> bool {
        self.uses == 1
    }
}

/// The edges of a mesh: faces in order, outer loop before holes, an edge met again is skipped (reference 3.4).
#[derive(Clone, Debug, Default)]
pub struct Topology {
    pub edges: Vec<Edge>,
    /// Edge index of every face edge, faces one after the other.
    pub edge_of_face_edge: Vec<u32>,
    /// Where each face's edges start in `edge_of_face_edge`; one more than there are faces.
    pub face_starts: Vec<u32>,
}

/// Up to this many edges a linear search beats a tree.
const FEW: usize = 24;

impl Topology {
    pub fn of(mesh: &Mesh) -> Topology {
        let uses = mesh.faces.iter().flat_map(|face| face.loops()).map(<[u32]>::len).sum();
        let mut out = Topology {
            edges: Vec::with_capacity(uses),
            edge_of_face_edge: Vec::with_capacity(uses),
            face_starts: Vec::with_capacity(mesh.faces.len() + 1),
        };
        out.face_starts.push(0);
        let mut index: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (f, face) in mesh.faces.iter().enumerate() {
            for (from, to) in face.edges() {
                let place = out.place(&mut index, from, to, f as u32);
                out.edge_of_face_edge.push(place);
            }
            out.face_starts.push(out.edge_of_face_edge.len() as u32);
        }
        out
    }

    fn place(&mut self, index: &mut BTreeMap<(u32, u32), u32>, from: u32, to: u32, face: u32) -> u32 {
        let key = (from.min(to), from.max(to));
        let known = if index.is_empty() {
            self.edges.iter().position(|e| (e.from.min(e.to), e.from.max(e.to)) == key).map(|i| i as u32)
        } else {
            index.get(&key).copied()
        };
        if let Some(known) = known {
            let edge = &mut self.edges[known as usize];
            edge.second = edge.second.or(Some(face));
            edge.uses += 1;
            return known;
        }
        let next = self.edges.len() as u32;
        self.edges.push(Edge { from, to, first: face, second: None, uses: 1 });
        if self.edges.len() == FEW {
            let entry = |(i, e): (usize, &Edge)| ((e.from.min(e.to), e.from.max(e.to)), i as u32);
            *index = self.edges.iter().enumerate().map(entry).collect();
        } else if !index.is_empty() {
            index.insert(key, next);
        }
        next
    }

    /// Edge indices of one face.
    pub fn face_edges(&self, face: usize) -> &[u32] {
        &self.edge_of_face_edge[self.face_starts[face] as usize..self.face_starts[face + 1] as usize]
    }

    /// Whether the face has an edge that no other face touches.
    pub fn is_border_face(&self, face: usize) -> bool {
        self.face_edges(face).iter().any(|&e| self.edges[e as usize].is_border())
    }

    /// At least one face, and every edge between exactly two.
    pub fn is_closed(&self) -> bool {
        !self.edges.is_empty() && self.edges.iter().all(|e| e.uses == 2)
    }
}

/// Mean of the unit normals of the faces on an edge, normalised; zero where they cancel.
pub fn edge_normal(mesh: &Mesh, edge: &Edge) -> DVec3 {
    let normal = |f: u32| mesh.normal(&mesh.faces[f as usize]);
    let sum = normal(edge.first) + edge.second.map_or(DVec3::ZERO, normal);
    sum.normalize_or_zero()
}

/// Normalised mean of the normals of the faces at every vertex.
pub fn vertex_normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for face in &mesh.faces {
        let normal = mesh.normal(face);
        for v in face.corners() {
            sums[v as usize] += normal;
        }
    }
    sums.iter().map(|n| n.normalize_or_zero()).collect()
}

/// The vertices faces use, in order of first use.
pub fn used_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut seen = vec![false; mesh.positions.len()];
    let mut order = Vec::new();
    for v in mesh.faces.iter().flat_map(|f| f.corners()) {
        if !std::mem::replace(&mut seen[v as usize], true) {
            order.push(v);
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Face;

    fn strip(quads: u32) -> Mesh {
        let positions = (0..=quads).flat_map(|i| [0.0, 1.0].map(|z| DVec3::new(f64::from(i), 0.0, -z))).collect();
        let faces = (0..quads).map(|i| Face::new(vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1])).collect();
        Mesh { positions, faces }
    }

    #[test]
    fn counts_shared_edges_once_for_small_and_large_meshes() {
        for quads in [1, 2, 40] {
            let topology = Topology::of(&strip(quads));
            assert_eq!(topology.edges.len() as u32, 3 * quads + 1);
            let inner = topology.edges.iter().filter(|e| !e.is_border()).count() as u32;
            assert_eq!(inner, quads - 1);
            assert!(!topology.is_closed());
        }
    }
}
