//! What a reader finds in a geometry file. In: faces with materials and groups, one after the other. Out: a form in
//! which every part has a use.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geometry::Face;
use crate::interpreter::form::Form;
use crate::interpreter::labels::Labels;
use crate::interpreter::tree::Scalar;

#[derive(Debug, Default)]
pub struct Contents {
    pub form: Form,
    pub metadata: BTreeMap<Arc<str>, Scalar>,
    /// What could not be used.
    pub notes: Vec<String>,
    groups: Vec<Arc<str>>,
    /// Index into `groups` plus one per face, 0 for none.
    face_groups: Vec<u16>,
    numbers: BTreeMap<Arc<str>, u16>,
    current: u16,
}

impl Contents {
    /// Faces from here on belong to this group, new or known; the empty name is none.
    pub fn begin_group(&mut self, name: &str) -> Result<(), String> {
        if name.is_empty() {
            self.current = 0;
            return Ok(());
        }
        if let Some(&known) = self.numbers.get(name) {
            self.current = known;
            return Ok(());
        }
        let name: Arc<str> = name.into();
        self.groups.push(name.clone());
        self.current = u16::try_from(self.groups.len()).map_err(|_| "there are too many groups")?;
        self.numbers.insert(name, self.current);
        Ok(())
    }

    /// Adds a face; `material` counts from 1, 0 for none.
    pub fn face(&mut self, face: Face, material: u16) {
        self.form.mesh.faces.push(face);
        self.form.face_materials.push(material);
        self.face_groups.push(self.current);
    }

    /// Drops the uv sets and normals that only some faces of a group have (reference 4.11, "Mesh consistency").
    pub fn even_channels(&mut self) {
        let mut common: BTreeMap<u16, (Vec<u8>, bool)> = BTreeMap::new();
        for (face, group) in self.form.mesh.faces.iter().zip(&self.face_groups) {
            let has = |set: &u8| face.uv(*set).is_some();
            match common.get_mut(group) {
                Some((sets, normals)) => {
                    sets.retain(|set| has(set));
                    *normals &= !face.normals.is_empty();
                }
                None => drop(common.insert(*group, ((0..10).filter(has).collect(), !face.normals.is_empty()))),
            }
        }
        for (face, group) in self.form.mesh.faces.iter_mut().zip(&self.face_groups) {
            let (sets, normals) = &common[group];
            face.uvs.retain(|(set, _)| sets.contains(set));
            if !normals {
                face.normals = Vec::new();
            }
        }
    }

    /// Without vertices and groups that no face uses; groups in the order of their first faces.
    pub fn finished(mut self) -> Self {
        let mut order: Vec<u16> = Vec::new();
        let mut places = vec![0u16; self.groups.len() + 1];
        for group in &mut self.face_groups {
            if *group > 0 && places[usize::from(*group)] == 0 {
                order.push(*group);
                places[usize::from(*group)] = order.len() as u16;
            }
            *group = places[usize::from(*group)];
        }
        if !order.is_empty() {
            let group_names = order.iter().map(|&g| self.groups[usize::from(g) - 1].clone()).collect();
            let face_groups = std::mem::take(&mut self.face_groups);
            self.form.labels = Some(Box::new(Labels { face_groups, group_names, ..Labels::default() }));
        }
        if self.form.face_materials.iter().all(|&m| m == 0) {
            self.form.face_materials = Vec::new();
        }
        let faces: Vec<usize> = (0..self.form.mesh.faces.len()).collect();
        let form = self.form.part(&faces);
        self.form = Form { instanced: true, ..form };
        self
    }
}
