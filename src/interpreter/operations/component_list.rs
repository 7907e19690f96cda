//! Lists of components in the order of their indices (reference 3.4). In: a form. Out: [`Part`]s with what selectors
//! see of them.

use glam::DVec3;

use super::super::environment::{Facet, Place, RoofEdge};
use super::super::form::Form;
use super::super::shape::Shape;
use super::super::topology::{Edge, Topology, edge_normal, used_vertices, vertex_normals};
use super::comp::Wanted;
use super::components::Part;
use super::roof_edges;
use crate::cga::program::Component;
use crate::geometry::{Face, Mesh};

/// Parts, and the facets they are made of, in the same order.
pub type List = (Vec<Part>, Vec<Facet>);

/// A list of parts of one facet each.
fn list(parts: impl Iterator<Item = (Part, Facet)>) -> List {
    let mut out = (Vec::with_capacity(parts.size_hint().0), Vec::with_capacity(parts.size_hint().0));
    for (number, (part, facet)) in parts.enumerate() {
        out.0.push(Part { facets: number as u32, ..part });
        out.1.push(facet);
    }
    out
}

fn facet(place: Place, direction: DVec3, is_border: bool) -> Facet {
    Facet { place, direction, is_border, roof_edge: None, uv_side: None }
}

fn face_part(mesh: &Mesh, face: &Face, normal: DVec3) -> Part {
    let corner = |i: usize| face.outer.get(i).map_or(DVec3::ZERO, |&v| mesh.positions[v as usize]);
    Part { facets: 0, ends: [0, 0], origin: corner(0), along: corner(1) - corner(0), normal }
}

fn face_facet(number: usize, normal: DVec3, borders: Option<&Topology>) -> Facet {
    facet(Place::Face(number as u32), normal, borders.is_some_and(|topology| topology.is_border_face(number)))
}

/// What tells border faces from others, where somebody asks.
fn borders(mesh: &Mesh, wanted: Wanted) -> Option<Topology> {
    wanted.borders.then(|| Topology::of(mesh))
}

pub fn faces(mesh: &Mesh, wanted: Wanted) -> List {
    let borders = borders(mesh, wanted);
    let real = mesh.faces.iter().enumerate().filter(|(_, face)| !face.outer.is_empty());
    list(real.map(|(number, face)| {
        let normal = mesh.normal(face);
        (face_part(mesh, face, normal), face_facet(number, normal, borders.as_ref()))
    }))
}

/// Faces by a number each has (a group, a material), sets in the order of their first faces.
pub fn sets(mesh: &Mesh, wanted: Wanted, set: impl Fn(usize) -> u16) -> List {
    let borders = borders(mesh, wanted);
    let mut members: Vec<(u16, Vec<usize>)> = Vec::new();
    for (number, _) in mesh.faces.iter().enumerate().filter(|(_, face)| !face.outer.is_empty()) {
        let own = set(number);
        match members.iter_mut().find(|(known, _)| *known == own) {
            Some((_, list)) => list.push(number),
            None => members.push((own, vec![number])),
        }
    }
    let mut out: List = (Vec::with_capacity(members.len()), Vec::with_capacity(mesh.faces.len()));
    for (_, list) in members {
        let first = &mesh.faces[list[0]];
        out.0.push(Part { facets: out.1.len() as u32, ..face_part(mesh, first, mesh.normal(first)) });
        out.1.extend(list.into_iter().map(|f| face_facet(f, mesh.normal(&mesh.faces[f]), borders.as_ref())));
    }
    out
}

pub fn holes(mesh: &Mesh, wanted: Wanted) -> List {
    let borders = borders(mesh, wanted);
    let mut found = Vec::new();
    for (number, face) in mesh.faces.iter().enumerate() {
        let normal = mesh.normal(face);
        for (hole, ring) in face.holes.iter().enumerate().filter(|(_, ring)| ring.len() >= 2) {
            let [a, b] = [ring[0], ring[1]].map(|v| mesh.positions[v as usize]);
            let ends = [number as u32, hole as u32];
            let part = Part { facets: 0, ends, origin: a, along: b - a, normal };
            found.push((part, face_facet(number, normal, borders.as_ref())));
        }
    }
    list(found.into_iter())
}

pub fn edges(shape: &Shape, roof: bool) -> List {
    let mesh = &shape.form.mesh;
    let topology = Topology::of(mesh);
    let up = if roof { roof_edges::up(shape) } else { shape.scope.frame.axes.y_axis };
    let kinds: Vec<Option<RoofEdge>> =
        if roof { roof_edges::classify(shape, &topology) } else { vec![None; topology.edges.len()] };
    let part = |(edge, kind): (&Edge, &Option<RoofEdge>)| {
        let (from, to) = (mesh.positions[edge.from as usize], mesh.positions[edge.to as usize]);
        let downwards = up.dot(to) < up.dot(from);
        let turned = downwards && matches!(kind, Some(RoofEdge::Hip | RoofEdge::Valley | RoofEdge::Ridge));
        let ends = if turned { [edge.to, edge.from] } else { [edge.from, edge.to] };
        let facet = Facet { roof_edge: *kind, ..facet(Place::Edge(ends), edge_normal(mesh, edge), edge.is_border()) };
        (edge_part(&mesh.positions, ends, facet.direction), facet)
    };
    list(topology.edges.iter().zip(&kinds).map(part))
}

fn edge_part(positions: &[DVec3], ends: [u32; 2], normal: DVec3) -> Part {
    let [a, b] = ends.map(|v| positions[v as usize]);
    Part { facets: 0, ends, origin: a, along: b - a, normal }
}

pub fn face_edges(mesh: &Mesh) -> List {
    let topology = Topology::of(mesh);
    let mut found = Vec::with_capacity(topology.edge_of_face_edge.len());
    for (f, face) in mesh.faces.iter().enumerate() {
        let normal = mesh.normal(face);
        for ((from, to), &edge) in face.edges().zip(topology.face_edges(f)) {
            let along = mesh.positions[to as usize] - mesh.positions[from as usize];
            let outward = along.cross(normal).normalize_or_zero();
            let is_border = topology.edges[edge as usize].is_border();
            let facet = facet(Place::Edge([from, to]), outward, is_border);
            found.push((edge_part(&mesh.positions, [from, to], outward), facet));
        }
    }
    list(found.into_iter())
}

/// Which vertices end an edge of one face only.
fn border_vertices(mesh: &Mesh) -> Vec<bool> {
    let mut border = vec![false; mesh.positions.len()];
    for edge in Topology::of(mesh).edges.iter().filter(|e| e.is_border()) {
        border[edge.from as usize] = true;
        border[edge.to as usize] = true;
    }
    border
}

fn vertex_part(positions: &[DVec3], v: u32, along: DVec3, normal: DVec3) -> Part {
    Part { facets: 0, ends: [v, v], origin: positions[v as usize], along, normal }
}

pub fn vertices(mesh: &Mesh) -> List {
    let (normals, border) = (vertex_normals(mesh), border_vertices(mesh));
    list(used_vertices(mesh).into_iter().map(|v| {
        let normal = normals[v as usize];
        let facet = facet(Place::Vertex(v), normal, border[v as usize]);
        (vertex_part(&mesh.positions, v, DVec3::ZERO, normal), facet)
    }))
}

/// Every corner of every face: x halves the directions in and out, z points outwards.
pub fn face_vertices(mesh: &Mesh) -> List {
    let border = border_vertices(mesh);
    let mut found = Vec::new();
    for face in &mesh.faces {
        let normal = mesh.normal(face);
        for ring in face.loops() {
            let n = ring.len();
            let at = |i: usize| mesh.positions[ring[i % n] as usize];
            for (i, &v) in ring.iter().enumerate() {
                let into = (at(i) - at(i + n - 1)).normalize_or_zero();
                let out = (at(i + 1) - at(i)).normalize_or_zero();
                // A spike that turns right back has no direction between them.
                let tangent = (into + out).try_normalize().unwrap_or(out);
                let outward = tangent.cross(normal).normalize_or_zero();
                let facet = facet(Place::Vertex(v), outward, border[v as usize]);
                found.push((vertex_part(&mesh.positions, v, tangent, outward), facet));
            }
        }
    }
    list(found.into_iter())
}

/// Edge geometry: its edges as they are.
pub fn bare_edges(form: &Form) -> List {
    let normal = |i: usize| form.normals.get(i).copied().unwrap_or(DVec3::ZERO);
    list(form.edges.iter().enumerate().map(|(i, &ends)| {
        let facet = facet(Place::Edge(ends), normal(i), false);
        (edge_part(&form.mesh.positions, ends, normal(i)), facet)
    }))
}

/// The group of a form without faces, if it has one.
pub fn bare_group(form: &Form) -> List {
    let (mut parts, mut facets) = bare_vertices(form, Component::Vertices);
    parts.truncate(form.bare_groups().len().min(1));
    facets.truncate(parts.len());
    (parts, facets)
}

/// The vertices of edge geometry, or points: once each, or (`fv`) both ends of every edge, x along it.
pub fn bare_vertices(form: &Form, kind: Component) -> List {
    let positions = &form.mesh.positions;
    let normal = |i: usize| form.normals.get(i).copied().unwrap_or(DVec3::ZERO);
    let item = |v: u32, along: DVec3, normal: DVec3| {
        (vertex_part(positions, v, along, normal), facet(Place::Vertex(v), normal, false))
    };
    if form.edges.is_empty() {
        return list((0..positions.len()).map(|i| item(i as u32, DVec3::ZERO, normal(i))));
    }
    if kind == Component::FaceVertices {
        let along = |[a, b]: [u32; 2]| positions[b as usize] - positions[a as usize];
        let both = form.edges.iter().enumerate().flat_map(|(i, &e)| e.map(|v| item(v, along(e), normal(i))));
        return list(both.collect::<Vec<_>>().into_iter());
    }
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for (i, ends) in form.edges.iter().enumerate() {
        ends.iter().for_each(|&v| sums[v as usize] += normal(i));
    }
    list(sums.iter().enumerate().map(|(v, sum)| item(v as u32, DVec3::ZERO, sum.normalize_or_zero())))
}
