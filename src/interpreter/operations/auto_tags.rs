//! Tags that operations make and pass on (reference 4.15.3, 4.15.4). In: the form an operation began with, and what
//! each face of its result is. Out: the result's tags. Nothing is made where no rule can ask for it.

use glam::DVec3;

use super::super::form::Form;
use super::super::labels::Tags;
use crate::cga::program::Program;
use crate::geometry::Face;
use crate::geometry::extrude::{Origin, Role};
use crate::geometry::roof::RoofPart;
use crate::geometry::transform::flip_face;

/// Bottom and top are copies of their source with all its tags. Sides have those of the edge they stand on, upright
/// edges those of their vertex.
pub fn extrusion(program: &Program, source: &Form, form: &mut Form, origins: &[Origin]) {
    if let Some(old) = source.tags().filter(|tags| !tags.is_empty()) {
        let mut tags = Tags::default();
        let mut bottom_turned = true;
        for (number, origin) in origins.iter().enumerate() {
            let base = &source.mesh.faces[origin.face as usize];
            if origin.role == Role::Bottom {
                bottom_turned = !starts_at(source, base.corners().next(), form, number);
            }
            match origin.role {
                Role::Bottom => copy(old, origin.face, base, bottom_turned, form, number, &mut tags),
                Role::Top => copy(old, origin.face, base, !bottom_turned, form, number, &mut tags),
                Role::SideOuter | Role::SideInner => {
                    let edge = origin.edge.and_then(|e| base.edges().nth(e as usize));
                    let Some((a, b)) = edge else { continue };
                    let ends = if starts_at(source, Some(a), form, number) { [a, b] } else { [b, a] };
                    side(old, ends, &form.mesh.faces[number], number, &mut tags);
                }
            }
        }
        *form.tags_mut() = tags;
    }
    if program.observes_tags() {
        let name = |origin: &Origin| {
            Some(match origin.role {
                Role::Bottom => "extrude.bottom",
                Role::Top => "extrude.top",
                Role::SideOuter => "extrude.side.outer",
                Role::SideInner => "extrude.side.inner",
            })
        };
        form.auto_tag_faces("extrude", origins.iter().map(name));
    }
}

/// Whether the first corner of a result face stands where this vertex of the source does.
fn starts_at(source: &Form, vertex: Option<u32>, form: &Form, face: usize) -> bool {
    let here = form.mesh.faces[face].corners().next().map(|v| form.mesh.positions[v as usize]);
    here == vertex.map(|v| source.mesh.positions[v as usize])
}

/// All tags of a face for its copy, corner by corner.
fn copy(old: &Tags, from: u32, base: &Face, turned: bool, form: &Form, to: usize, tags: &mut Tags) {
    tags.set_face(to, old.face(from as usize).clone());
    let mut base = base.clone();
    if turned {
        flip_face(&mut base);
    }
    let face = &form.mesh.faces[to];
    for (v, new) in base.corners().zip(face.corners()) {
        tags.extend_vertex(new, old.vertex(v));
    }
    for ((a, b), (c, d)) in base.edges().zip(face.edges()) {
        tags.extend_edge([c, d], old.edge([a, b]));
    }
}

/// Tags of a quad on an edge: its corners are the edge's ends and their copies, backwards.
fn side(old: &Tags, [a, b]: [u32; 2], quad: &Face, number: usize, tags: &mut Tags) {
    tags.set_face(number, old.edge([a, b]).clone());
    if let &[i, j, above_j, above_i] = &quad.outer[..] {
        tags.extend_edge([i, above_i], old.vertex(a));
        tags.extend_edge([j, above_j], old.vertex(b));
    }
}

/// Walls on bare edges, one per edge: the tags of the edge go to the wall and stay on its foot.
pub fn walls(source: &Form, form: &mut Form) {
    let Some(old) = source.tags().filter(|tags| !tags.is_empty()) else { return };
    let mut tags = Tags::default();
    for (number, &ends) in source.edges.iter().enumerate() {
        let quad = &form.mesh.faces[number];
        side(old, ends, quad, number, &mut tags);
        tags.extend_edge([quad.outer[0], quad.outer[1]], old.edge(ends));
    }
    *form.tags_mut() = tags;
}

/// A pyramid over the source's first face: the bottom first, then a side per edge; vertices are the face's outer
/// corners, then the apex.
pub fn taper(program: &Program, source: &Form, form: &mut Form) {
    let corners = &source.mesh.faces[0].outer;
    let apex = corners.len() as u32;
    if let Some(old) = source.tags().filter(|tags| !tags.is_empty()) {
        let tags = form.tags_mut();
        for (i, &v) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            tags.set_face(i + 1, old.edge([v, next]).clone());
            tags.extend_edge([i as u32, apex], old.vertex(v));
        }
    }
    if program.observes_tags() {
        let name = |face: u32| Some(if face == 0 { "taper.bottom" } else { "taper.side" });
        form.auto_tag_faces("taper", (0..=apex).map(name));
    }
}

/// How a roof's vertical faces are named.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// `roof.side`.
    Plain,
    /// `roof.side.outer`, and `roof.side.inner` around holes.
    OuterAndInner,
}

/// `parts` gives the source face of every result face and what it is.
pub fn roof(program: &Program, source: &Form, form: &mut Form, sides: Sides, parts: &[(usize, RoofPart)]) {
    if !program.observes_tags() {
        return;
    }
    let name = |&(face, part): &(usize, RoofPart)| {
        Some(match (part, sides) {
            (RoofPart::Bottom, _) => "roof.bottom",
            (RoofPart::Top { .. }, _) => "roof.top",
            (RoofPart::Side { .. }, Sides::Plain) => "roof.side",
            (RoofPart::Side { edge }, _) if edge < source.mesh.faces[face].outer.len() => "roof.side.outer",
            (RoofPart::Side { .. }, _) => "roof.side.inner",
        })
    };
    form.auto_tag_faces("roof", parts.iter().map(name));
}

/// Border faces of an offset and sides of an envelope have the tags of their edge instead of their face's. `borders` gives the source face and
/// edge of every result face that is one.
pub fn borders(source: &Form, form: &mut Form, borders: &[Option<(usize, usize)>]) {
    let Some(old) = source.tags().filter(|tags| !tags.is_empty()) else { return };
    for (number, border) in borders.iter().enumerate() {
        let Some((face, edge)) = border else { continue };
        let base = &source.mesh.faces[*face];
        let Some((a, b)) = base.edges().nth(*edge) else { continue };
        let quad = form.mesh.faces[number].clone();
        let [at_a, at_b] = [a, b].map(|v| source.mesh.positions[v as usize]);
        let tags = form.labels.get_or_insert_default();
        tags.tags.set_face(number, old.edge([a, b]).clone());
        for (c, d) in quad.edges() {
            let [from, to] = [c, d].map(|v| form.mesh.positions[v as usize]);
            let near = |p: DVec3, q: DVec3| p.distance(q) <= 1e-7 * at_a.distance(at_b);
            for (vertex, place, other) in [(a, at_a, at_b), (b, at_b, at_a)] {
                // The edges that leave the original edge, not that edge itself.
                let leaves = near(from, place) && !near(to, other) || near(to, place) && !near(from, other);
                if leaves {
                    tags.tags.extend_edge([c, d], old.vertex(vertex));
                }
            }
        }
    }
}
