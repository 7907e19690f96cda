//! The components of a shape. In: a baked shape and a kind. Out: for each component how selectors see it, and a shape
//! in its own frame (reference 4.1, "Frames").

use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use super::super::environment::{Facet, Place, UvSide};
use super::super::form::Form;
use super::super::placement::{Frame, perpendicular};
use super::super::shape::{Scope, Shape};
use super::super::trim_planes::{TrimParent, TrimSource};
use super::comp::Wanted;
use super::component_list as list;
use crate::cga::program::Component;
use crate::geometry::transform::flip_face;
use crate::geometry::{Face, Mesh};

/// Numbers of the components that become one shape.
pub type Group = SmallVec<[usize; 2]>;

pub struct Components {
    kind: Component,
    keep_axes: bool,
    parts: Vec<Part>,
    facets: Vec<Facet>,
}

/// One component.
pub struct Part {
    /// Its facets begin here; they end where the next part's begin.
    pub facets: u32,
    /// Ends of an edge; a vertex twice; for a hole its face and its number there.
    pub ends: [u32; 2],
    /// Position of the frame.
    pub origin: DVec3,
    /// What the x axis follows; zero where it follows the parent's.
    pub along: DVec3,
    /// z axis of the frame; zero for none.
    pub normal: DVec3,
}

impl Components {
    /// All components in index order (reference 3.4).
    pub fn of(shape: &Shape, kind: Component, keep_axes: bool, wanted: Wanted) -> Components {
        let form = &*shape.form;
        let bare = form.mesh.faces.is_empty();
        let (parts, facets) = match kind {
            Component::Faces => list::faces(&form.mesh, wanted),
            Component::Edges | Component::FaceEdges if bare => list::bare_edges(form),
            Component::Vertices | Component::FaceVertices if bare => list::bare_vertices(form, kind),
            Component::Edges => list::edges(shape, wanted.roof_edges),
            Component::FaceEdges => list::face_edges(&form.mesh),
            Component::Vertices => list::vertices(&form.mesh),
            Component::FaceVertices => list::face_vertices(&form.mesh),
            Component::Groups if form.mesh.faces.is_empty() => list::bare_group(form),
            Component::Groups => list::sets(&form.mesh, wanted, |f| form.group(f)),
            Component::Materials => list::sets(&form.mesh, wanted, |f| form.face_material(f)),
            Component::Holes => list::holes(&form.mesh, wanted),
        };
        Components { kind, keep_axes, parts, facets }
    }

    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// The faces that a component is made of; none for edges, vertices and holes.
    pub fn face_numbers(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let is_of_faces = matches!(self.kind, Component::Faces | Component::Groups | Component::Materials);
        let facets = if is_of_faces { self.facets(i) } else { &[] };
        facets.iter().filter_map(face_of)
    }

    /// What one component is made of: itself, or the faces of a group or material. Never empty.
    pub fn facets(&self, i: usize) -> &[Facet] {
        let end = self.parts.get(i + 1).map_or(self.facets.len(), |next| next.facets as usize);
        &self.facets[self.parts[i].facets as usize..end]
    }

    /// Notes where a face edge is in texture space.
    pub fn set_uv_side(&mut self, i: usize, side: UvSide) {
        if let Some(facet) = self.parts.get(i).and_then(|part| self.facets.get_mut(part.facets as usize)) {
            facet.uv_side = Some(side);
        }
    }

    /// The shape of some components: the frame of the first, fitted to all. `group` is not empty.
    pub fn shape(&self, parent: &Shape, group: &[usize]) -> Box<Shape> {
        let form = self.form(parent, group);
        // Groups and materials stay in the parent's frame.
        let stays = self.keep_axes || matches!(self.kind, Component::Groups | Component::Materials);
        let frame = (!stays).then(|| self.frame(&self.parts[group[0]], parent.scope.frame.axes));
        let empty = frame.map_or(parent.scope, |frame| Scope { frame, size: DVec3::ZERO });
        let scope = Scope::around(&form.mesh.positions, empty.frame.axes).unwrap_or(empty);
        let mut shape = parent.piece(form, scope);
        shape.pivot = frame.unwrap_or(parent.pivot);
        shape
    }

    /// What faces that are split off by `:` need for their trim planes (reference 3.8).
    pub fn trim_parent(&self, parent: &Shape) -> Option<Arc<TrimParent>> {
        let has_edges = self.kind == Component::Faces && parent.form.mesh.faces.len() > 1;
        has_edges.then(|| Arc::new(TrimParent::new(parent.form.clone())))
    }

    /// Gives a face shape its trim planes; the old ones are gone.
    pub fn add_trim_planes(&self, parent: &Arc<TrimParent>, i: usize, shape: &mut Shape) {
        if let Some(face) = self.facets(i).first().and_then(face_of) {
            let (parent, face) = (parent.clone(), face as u32);
            shape.trim_source = Some(Rc::new(TrimSource { parent, face, up: shape.pivot.axes.y_axis }));
        }
    }

    fn form(&self, parent: &Shape, group: &[usize]) -> Form {
        match self.kind {
            Component::Groups if parent.form.mesh.faces.is_empty() => (*parent.form).clone(),
            Component::Faces | Component::Groups | Component::Materials => {
                if let &[single] = group
                    && let [facet] = self.facets(single)
                    && let Some(face) = face_of(facet)
                {
                    return parent.form.part(&[face]);
                }
                let facets = group.iter().flat_map(|&i| self.facets(i));
                let faces: Group = facets.filter_map(face_of).collect();
                parent.form.part(&faces)
            }
            Component::Holes => self.filled(&parent.form, group),
            _ => self.bare(&parent.form, group),
        }
    }

    /// Edges or points; those that met before meet again.
    fn bare(&self, parent: &Form, group: &[usize]) -> Form {
        let mut form = Form::default();
        let mut places: BTreeMap<u32, u32> = BTreeMap::new();
        for &i in group {
            let part = &self.parts[i];
            let mut place = |v: u32| {
                *places.entry(v).or_insert_with(|| {
                    form.mesh.positions.push(parent.mesh.positions[v as usize]);
                    form.mesh.positions.len() as u32 - 1
                })
            };
            let ends = part.ends.map(&mut place);
            match self.kind {
                Component::Vertices => form.normals.push(part.normal),
                // Corners of different faces are points of their own.
                Component::FaceVertices => {
                    places.clear();
                    form.normals.push(part.normal);
                }
                _ => {
                    form.edges.push(ends);
                    form.normals.push(part.normal);
                }
            }
            if let Some(tags) = parent.tags().filter(|tags| !tags.is_empty()) {
                let own = form.tags_mut();
                part.ends.iter().zip(ends).for_each(|(&old, new)| own.extend_vertex(new, tags.vertex(old)));
                if ends[0] != ends[1] {
                    own.extend_edge(ends, tags.edge(part.ends));
                }
            }
        }
        form
    }

    /// Holes as faces.
    fn filled(&self, parent: &Form, group: &[usize]) -> Form {
        let mut mesh = Mesh { positions: parent.mesh.positions.clone(), faces: Vec::with_capacity(group.len()) };
        let mut sources = Vec::with_capacity(group.len());
        for &i in group {
            let [face, hole] = self.parts[i].ends;
            let source = &parent.mesh.faces[face as usize];
            let before: usize = source.loops().take(hole as usize + 1).map(|l| l.len()).sum();
            let ring = &source.holes[hole as usize];
            let own = |uv: &[glam::DVec2]| uv.get(before..before + ring.len()).map(<[_]>::to_vec);
            let mut filled = Face::new(ring.clone());
            filled.uvs = source.uvs.iter().filter_map(|(set, uv)| Some((*set, own(uv)?.into()))).collect();
            flip_face(&mut filled);
            mesh.faces.push(filled);
            sources.push(Some(face));
        }
        let all: Vec<usize> = (0..group.len()).collect();
        parent.derived(mesh, sources.into_iter()).part(&all)
    }

    fn frame(&self, part: &Part, parent_axes: DMat3) -> Frame {
        let known = |v: DVec3, other: DVec3| if v == DVec3::ZERO { other } else { v };
        let (x, z) = match self.kind {
            Component::Edges | Component::FaceEdges | Component::FaceVertices if part.along != DVec3::ZERO => {
                let x = part.along.normalize_or(DVec3::X);
                (x, perpendicular(x, part.normal, DVec3::Y))
            }
            Component::Faces | Component::Holes => {
                let z = known(part.normal, DVec3::Y);
                (perpendicular(z, part.along, DVec3::X), z)
            }
            _ => {
                let z = known(part.normal, DVec3::Y);
                (perpendicular(z, parent_axes.x_axis, parent_axes.z_axis), z)
            }
        };
        Frame::new(part.origin, x, z.cross(x), z)
    }

    /// Sets of members that hang together, by lowest index: what has faces by shared edges, the rest by shared
    /// vertices.
    pub fn connected(&self, parent: &Shape, members: &[usize]) -> Vec<Group> {
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
        let mut groups: BTreeMap<usize, Group> = BTreeMap::new();
        for (place, &member) in members.iter().enumerate() {
            groups.entry(find(&root, place)).or_default().push(member);
        }
        groups.into_values().collect()
    }

    /// What another component must have too to hang on this one.
    fn links(&self, mesh: &Mesh, i: usize) -> Vec<(u32, u32)> {
        let edges = |ring: &[u32]| -> Vec<(u32, u32)> {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(&a, &b)| (a.min(b), a.max(b))).collect()
        };
        match self.kind {
            Component::Faces | Component::Groups | Component::Materials => {
                let loops = self.facets(i).iter().filter_map(face_of).flat_map(|f| mesh.faces[f].loops());
                loops.flat_map(edges).collect()
            }
            Component::Holes => {
                let [face, hole] = self.parts[i].ends;
                edges(&mesh.faces[face as usize].holes[hole as usize])
            }
            _ => self.parts[i].ends.iter().map(|&v| (v, v)).collect(),
        }
    }
}

fn face_of(facet: &Facet) -> Option<usize> {
    match facet.place {
        Place::Face(f) => Some(f as usize),
        Place::Edge(_) | Place::Vertex(_) => None,
    }
}
