//! The components of a shape. In: a baked shape and a kind. Out: for each component how selectors see it, and a shape
//! in its own frame (reference 4.1, "Frames").

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::super::environment::{Facet, RoofEdge};
use super::super::form::Form;
use super::super::placement::{Frame, perpendicular};
use super::super::shape::{Scope, Shape};
use super::super::topology::{Topology, edge_normal, used_vertices, vertex_normals};
use super::roof_edges;
use crate::cga::program::Component;
use crate::geometry::Mesh;

pub struct Components {
    kind: Component,
    keep_axes: bool,
    parts: Vec<Part>,
}

struct Part {
    facet: Facet,
    /// Face of a face or face edge.
    face: u32,
    /// Ends of an edge; a vertex twice.
    ends: [u32; 2],
    /// z axis of the frame.
    normal: DVec3,
}

impl Components {
    /// All components in index order (reference 3.4); none for kinds that are not evaluated yet.
    pub fn of(shape: &Shape, kind: Component, keep_axes: bool, roof_edges: bool) -> Components {
        let mesh = &shape.form.mesh;
        let parts = match kind {
            Component::Faces => faces(mesh),
            Component::Edges => edges(shape, roof_edges),
            Component::FaceEdges => face_edges(mesh),
            Component::Vertices => vertices(mesh),
            Component::FaceVertices | Component::Groups | Component::Materials | Component::Holes => Vec::new(),
        };
        Components { kind, keep_axes, parts }
    }

    pub fn len(&self) -> usize {
        self.parts.len()
    }

    pub fn facet(&self, i: usize) -> &Facet {
        &self.parts[i].facet
    }

    /// The shape of some components: the frame of the first, fitted to all. `group` is not empty.
    pub fn shape(&self, parent: &Shape, group: &[usize]) -> Shape {
        let mesh = &parent.form.mesh;
        let first = &self.parts[group[0]];
        let form = self.form(parent, group);
        let mut shape = parent.clone();
        if !self.keep_axes {
            let frame = self.frame(mesh, first, parent.scope.frame.axes);
            shape.pivot = frame;
            shape.scope = Scope { frame, size: DVec3::ZERO };
        }
        shape.scope = Scope::around(&form.mesh.positions, shape.scope.frame.axes).unwrap_or(shape.scope);
        shape.binding = shape.scope;
        shape.form = Arc::new(form);
        shape
    }

    fn form(&self, parent: &Shape, group: &[usize]) -> Form {
        if self.kind == Component::Faces {
            let faces: Vec<usize> = group.iter().map(|&i| self.parts[i].face as usize).collect();
            return parent.form.part(&faces);
        }
        let mut form = Form::default();
        for &i in group {
            let part = &self.parts[i];
            let start = form.mesh.positions.len() as u32;
            let [a, b] = part.ends.map(|v| parent.form.mesh.positions[v as usize]);
            form.mesh.positions.push(a);
            if self.kind != Component::Vertices {
                form.mesh.positions.push(b);
                form.edges.push([start, start + 1]);
            }
            form.normals.push(part.normal);
        }
        form
    }

    fn frame(&self, mesh: &Mesh, part: &Part, parent_axes: DMat3) -> Frame {
        let origin = mesh.positions[part.ends[0] as usize];
        let along = mesh.positions[part.ends[1] as usize] - origin;
        let (x, z) = match self.kind {
            Component::Faces => {
                let z = if part.normal == DVec3::ZERO { DVec3::Y } else { part.normal };
                (perpendicular(z, along, DVec3::X), z)
            }
            Component::Vertices => {
                let z = if part.normal == DVec3::ZERO { DVec3::Y } else { part.normal };
                (perpendicular(z, parent_axes.x_axis, parent_axes.z_axis), z)
            }
            _ => {
                let x = along.try_normalize().unwrap_or(DVec3::X);
                (x, perpendicular(x, part.normal, DVec3::Y))
            }
        };
        Frame::new(origin, x, z.cross(x), z)
    }

    /// Sets of members that hang together, by lowest index: faces by shared edges, others by shared vertices.
    pub fn connected(&self, parent: &Shape, members: &[usize]) -> Vec<Vec<usize>> {
        let mut root: Vec<usize> = (0..members.len()).collect();
        fn find(root: &[usize], mut i: usize) -> usize {
            while root[i] != i {
                i = root[i];
            }
            i
        }
        let mut first_at: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for (place, &member) in members.iter().enumerate() {
            for link in self.links(&parent.form.mesh, member) {
                let other = *first_at.entry(link).or_insert(place);
                let (a, b) = (find(&root, other), find(&root, place));
                root[a.max(b)] = a.min(b);
            }
        }
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (place, &member) in members.iter().enumerate() {
            groups.entry(find(&root, place)).or_default().push(member);
        }
        groups.into_values().collect()
    }

    /// What another component must have too to hang on this one.
    fn links(&self, mesh: &Mesh, i: usize) -> Vec<(u32, u32)> {
        let part = &self.parts[i];
        if self.kind == Component::Faces {
            return mesh.faces[part.face as usize].edges().map(|(a, b)| (a.min(b), a.max(b))).collect();
        }
        part.ends.iter().map(|&v| (v, v)).collect()
    }
}

fn faces(mesh: &Mesh) -> Vec<Part> {
    let topology = Topology::of(mesh);
    let part = |(f, face): (usize, &crate::geometry::Face)| {
        let normal = mesh.normal(face);
        let ends = [face.outer.first(), face.outer.get(1).or(face.outer.first())].map(|v| v.copied().unwrap_or(0));
        let facet = Facet { direction: normal, is_border: topology.is_border_face(f), roof_edge: None };
        Part { facet, face: f as u32, ends, normal }
    };
    mesh.faces.iter().enumerate().filter(|(_, face)| !face.outer.is_empty()).map(part).collect()
}

fn edges(shape: &Shape, wanted: bool) -> Vec<Part> {
    let mesh = &shape.form.mesh;
    let topology = Topology::of(mesh);
    let up = if wanted { roof_edges::up(shape) } else { shape.scope.frame.axes.y_axis };
    let kinds: Vec<Option<RoofEdge>> =
        if wanted { roof_edges::classify(shape, &topology) } else { vec![None; topology.edges.len()] };
    let part = |(edge, kind): (&super::super::topology::Edge, &Option<RoofEdge>)| {
        let normal = edge_normal(mesh, edge);
        let facet = Facet { direction: normal, is_border: edge.is_border(), roof_edge: *kind };
        let (from, to) = (mesh.positions[edge.from as usize], mesh.positions[edge.to as usize]);
        let downwards = up.dot(to) < up.dot(from);
        let turned = downwards && matches!(kind, Some(RoofEdge::Hip | RoofEdge::Valley | RoofEdge::Ridge));
        let ends = if turned { [edge.to, edge.from] } else { [edge.from, edge.to] };
        Part { facet, face: edge.first, ends, normal }
    };
    topology.edges.iter().zip(&kinds).map(part).collect()
}

fn face_edges(mesh: &Mesh) -> Vec<Part> {
    let topology = Topology::of(mesh);
    let mut parts = Vec::with_capacity(topology.edge_of_face_edge.len());
    for (f, face) in mesh.faces.iter().enumerate() {
        let normal = mesh.normal(face);
        for ((from, to), &edge) in face.edges().zip(topology.face_edges(f)) {
            let along = mesh.positions[to as usize] - mesh.positions[from as usize];
            let outward = along.cross(normal).normalize_or_zero();
            let is_border = topology.edges[edge as usize].is_border();
            let facet = Facet { direction: outward, is_border, roof_edge: None };
            parts.push(Part { facet, face: f as u32, ends: [from, to], normal: outward });
        }
    }
    parts
}

fn vertices(mesh: &Mesh) -> Vec<Part> {
    let topology = Topology::of(mesh);
    let normals = vertex_normals(mesh);
    let mut border = vec![false; mesh.positions.len()];
    for edge in topology.edges.iter().filter(|e| e.is_border()) {
        border[edge.from as usize] = true;
        border[edge.to as usize] = true;
    }
    let part = |v: u32| {
        let normal = normals[v as usize];
        let facet = Facet { direction: normal, is_border: border[v as usize], roof_edge: None };
        Part { facet, face: 0, ends: [v, v], normal }
    };
    used_vertices(mesh).into_iter().map(part).collect()
}
