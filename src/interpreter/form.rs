//! What a shape holds between its scope's walls. In: meshes from operations and assets. Out: [`Form`], a mesh with
//! per-face materials, or bare edges or points left by a component split.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use super::appearance::Appearance;
use super::labels::Labels;
use crate::geometry::mesh::Loop;
use crate::geometry::transform::normals_under;
use crate::geometry::{Face, Mesh};

/// The geometry of a shape, shared until it is changed. Positions are in the world as they were when it was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Form {
    pub mesh: Mesh,
    /// Edge geometry (vertex indices), only where there are no faces.
    pub edges: Vec<[u32; 2]>,
    /// What `comp(e)`, `comp(fe)` and `comp(v)` know about the faces they left: outward directions, one per edge or
    /// per vertex of this form.
    pub normals: Vec<DVec3>,
    /// Index into `materials` plus one per face, 0 for none; empty where no face has a material of its own.
    pub face_materials: Vec<u16>,
    pub materials: Materials,
    /// Groups and tags, where there are any.
    pub labels: Option<Box<Labels>>,
    /// An inserted asset as it came (`geometry.isInstanced`).
    pub instanced: bool,
}

/// Shared materials, most often none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials(Option<Arc<[Appearance]>>);

impl std::ops::Deref for Materials {
    type Target = [Appearance];

    fn deref(&self) -> &[Appearance] {
        self.0.as_deref().unwrap_or_default()
    }
}

impl From<Vec<Appearance>> for Materials {
    fn from(list: Vec<Appearance>) -> Self {
        Materials((!list.is_empty()).then(|| list.into()))
    }
}

impl FromIterator<Appearance> for Materials {
    fn from_iter<I: IntoIterator<Item = Appearance>>(materials: I) -> Self {
        materials.into_iter().collect::<Vec<_>>().into()
    }
}

impl Form {
    pub fn from_mesh(mesh: Mesh) -> Self {
        Form { mesh, ..Form::default() }
    }

    pub fn is_empty(&self) -> bool {
        self.mesh.positions.is_empty()
    }

    /// Takes the faces' corner normals along under a linear map of the positions. Loops stay, so a map that mirrors
    /// turns faces inside out, and their normals with them.
    pub fn turn_corner_normals(&mut self, map: DMat3) {
        if self.mesh.faces.iter().any(|f| !f.normals.is_empty()) {
            let turn = normals_under(map) * map.determinant().signum();
            let normals = self.mesh.faces.iter_mut().flat_map(|f| &mut f.normals);
            normals.for_each(|n| *n = (turn * *n).normalize_or(*n));
        }
    }

    /// The material index of a face: 0 for none.
    pub fn face_material(&self, face: usize) -> u16 {
        self.face_materials.get(face).copied().unwrap_or(0)
    }

    /// The material of the first face that has one of its own.
    pub fn first_material(&self) -> Option<&Appearance> {
        let first = self.face_materials.iter().find(|&&m| m > 0)?;
        self.materials.get(usize::from(*first) - 1)
    }

    /// A form of this one's materials over new faces; `sources` names the face each new face came from.
    pub fn derived(&self, mesh: Mesh, sources: impl Iterator<Item = Option<u32>>) -> Form {
        if self.face_materials.is_empty() && self.labels.is_none() {
            return Form { mesh, materials: self.materials.clone(), ..Form::default() };
        }
        let sources: Vec<Option<u32>> = sources.collect();
        let face_materials = if self.face_materials.is_empty() {
            Vec::new()
        } else {
            sources.iter().map(|source| source.map_or(0, |f| self.face_material(f as usize))).collect()
        };
        let labels = self.labels.as_ref().map(|labels| Box::new(labels.carried(&self.mesh, &mesh, &sources)));
        Form { mesh, face_materials, materials: self.materials.clone(), labels, ..Form::default() }
    }

    /// The faces with these indices, with only the vertices they use, in their old order.
    pub fn part(&self, faces: &[usize]) -> Form {
        let mesh = submesh(&self.mesh, faces);
        self.derived(mesh, faces.iter().map(|&f| Some(f as u32)))
    }
}

/// Copies the named faces with the vertices they use, numbered in the order the faces run through them.
fn submesh(mesh: &Mesh, faces: &[usize]) -> Mesh {
    if let &[face] = faces
        && let Some(single) = single_face(mesh, &mesh.faces[face])
    {
        return single;
    }
    let corners = faces.iter().map(|&f| mesh.faces[f].corners().count()).sum::<usize>();
    let most = corners.min(mesh.positions.len());
    let mut out = Mesh { positions: Vec::with_capacity(most), faces: Vec::with_capacity(faces.len()) };
    let mut places = Renumbering::for_at_most(most);
    for &f in faces {
        let mut face = mesh.faces[f].clone();
        for v in face.outer.iter_mut().chain(face.holes.iter_mut().flatten()) {
            *v = places.place(*v, || out.positions.push(mesh.positions[*v as usize]));
        }
        out.faces.push(face);
    }
    out
}

/// A face of few corners, all different, without holes: its vertices are its corners in order.
fn single_face(mesh: &Mesh, face: &Face) -> Option<Mesh> {
    let ring = &face.outer;
    let repeats = |(i, v): (usize, &u32)| ring[..i].contains(v);
    if !face.holes.is_empty() || ring.len() > Renumbering::FEW || ring.iter().enumerate().any(repeats) {
        return None;
    }
    let positions = ring.iter().map(|&v| mesh.positions[v as usize]).collect();
    let mut single = match ring.len() {
        4 => Face::new([0, 1, 2, 3]),
        corners => Face::new((0..corners as u32).collect::<Loop>()),
    };
    if !face.uvs.is_empty() || !face.normals.is_empty() {
        (single.uvs, single.normals) = (face.uvs.clone(), face.normals.clone());
    }
    Some(Mesh { positions, faces: vec![single] })
}

/// New numbers for old vertices, in order of first use: a list while there are few, a tree for many.
struct Renumbering {
    few: SmallVec<[u32; 16]>,
    many: BTreeMap<u32, u32>,
}

impl Renumbering {
    const FEW: usize = 48;

    fn for_at_most(most: usize) -> Self {
        Renumbering { few: SmallVec::with_capacity(most.min(Self::FEW)), many: BTreeMap::new() }
    }

    fn place(&mut self, old: u32, add: impl FnOnce()) -> u32 {
        let known = if self.many.is_empty() {
            self.few.iter().position(|&v| v == old).map(|i| i as u32)
        } else {
            self.many.get(&old).copied()
        };
        if let Some(place) = known {
            return place;
        }
        let next = if self.many.is_empty() { self.few.len() } else { self.many.len() } as u32;
        if self.many.is_empty() && self.few.len() == Self::FEW {
            self.many = self.few.iter().enumerate().map(|(i, &v)| (v, i as u32)).collect();
        }
        if self.many.is_empty() {
            self.few.push(old);
        } else {
            self.many.insert(old, next);
        }
        add();
        next
    }
}
