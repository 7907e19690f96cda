//! Many shapes made one (reference 4.16.1). In: finished shapes. Out: one form with their materials, groups and tags,
//! and what they agree on.

use std::sync::Arc;

use super::appearance::Appearance;
use super::form::Form;
use super::labels::Labels;
use super::shape::Shape;

/// A form and the material it is shown with.
#[derive(Clone, Debug)]
pub struct Dressed {
    pub form: Arc<Form>,
    pub appearance: Arc<Appearance>,
}

impl Dressed {
    /// Nothing, shown as the shape is.
    pub fn empty(shape: &Shape) -> Dressed {
        Dressed { form: Arc::default(), appearance: shape.state.appearance.clone() }
    }
}

/// Puts forms behind each other; vertices are not merged. Where the materials the forms are shown with differ, they are
/// written to the faces and nothing is set above them.
pub fn appended(parts: &[Dressed]) -> Dressed {
    let [first, rest @ ..] = parts else { return Dressed { form: Arc::default(), appearance: Arc::default() } };
    if rest.is_empty() {
        return first.clone();
    }
    let alike = rest.iter().all(|p| Arc::ptr_eq(&p.appearance, &first.appearance) || p.appearance == first.appearance);
    let mut out = Appended::default();
    parts.iter().for_each(|part| out.add(&part.form, (!alike).then_some(&*part.appearance)));
    Dressed { form: Arc::new(out.finish()), appearance: if alike { first.appearance.clone() } else { Arc::default() } }
}

#[derive(Default)]
struct Appended {
    form: Form,
    materials: Vec<Appearance>,
    groups: Vec<Arc<str>>,
}

impl Appended {
    /// Adds a form; `over` is written over its faces' own materials.
    fn add(&mut self, form: &Form, over: Option<&Appearance>) {
        let (faces, vertices) = (self.form.mesh.faces.len(), self.form.mesh.positions.len());
        self.form.mesh.positions.extend_from_slice(&form.mesh.positions);
        for face in &form.mesh.faces {
            let mut face = face.clone();
            face.loops_mut().flatten().for_each(|v| *v += vertices as u32);
            self.form.mesh.faces.push(face);
        }
        self.form.edges.extend(form.edges.iter().map(|e| e.map(|v| v + vertices as u32)));
        self.form.normals.extend_from_slice(&form.normals);
        let mut known: Vec<Option<u16>> = vec![None; form.materials.len() + 1];
        for face in 0..form.mesh.faces.len() {
            let own = usize::from(form.face_material(face));
            let place = known[own].unwrap_or_else(|| self.material(form, own, over));
            known[own] = Some(place);
            self.form.face_materials.push(place);
        }
        if let Some(labels) = &form.labels {
            self.label(labels, faces, vertices, form.mesh.faces.len());
        }
    }

    /// The place of a face's material, 0 for none.
    fn material(&mut self, form: &Form, own: usize, over: Option<&Appearance>) -> u16 {
        let below = own.checked_sub(1).and_then(|i| form.materials.get(i));
        let material = match (over, below) {
            (Some(over), Some(below)) => over.over(below),
            (Some(over), None) => over.clone(),
            (None, Some(below)) => below.clone(),
            (None, None) => return 0,
        };
        if material == Appearance::default() {
            return 0;
        }
        let place = self.materials.iter().position(|m| *m == material).unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        });
        u16::try_from(place + 1).unwrap_or(0)
    }

    fn label(&mut self, labels: &Labels, faces: usize, vertices: usize, count: usize) {
        let own = self.form.labels.get_or_insert_default();
        own.tags.append(&labels.tags, faces, vertices);
        if labels.face_groups.is_empty() {
            return;
        }
        own.face_groups.resize(faces, 0);
        for face in 0..count {
            let name = usize::from(labels.group(face)).checked_sub(1).and_then(|i| labels.group_names.get(i));
            let place = name.map_or(0, |name| {
                let known = self.groups.iter().position(|n| n == name);
                known.unwrap_or_else(|| {
                    self.groups.push(name.clone());
                    self.groups.len() - 1
                }) + 1
            });
            own.face_groups.push(u16::try_from(place).unwrap_or(0));
        }
    }

    fn finish(mut self) -> Form {
        if !self.form.mesh.faces.is_empty() {
            self.form.edges.clear();
            self.form.normals.clear();
        }
        if self.form.face_materials.iter().all(|&m| m == 0) {
            self.form.face_materials.clear();
        }
        self.form.materials = self.materials.into();
        if let Some(labels) = &mut self.form.labels {
            if !labels.face_groups.is_empty() {
                labels.face_groups.resize(self.form.mesh.faces.len(), 0);
            }
            labels.group_names = self.groups.into();
        }
        self.form
    }
}

/// Attribute values that all shapes agree on; the current shape keeps its own where they do not.
pub fn take_common_attributes(shape: &mut Shape, parts: &[Shape]) {
    let Some(first) = parts.first() else { return };
    if parts.iter().all(|p| Arc::ptr_eq(&p.state.attributes, &first.state.attributes)) {
        shape.state_mut().attributes = first.state.attributes.clone();
        return;
    }
    for i in 0..shape.state.attributes.len() {
        let value = &first.state.attributes[i];
        if *value != shape.state.attributes[i] && parts.iter().all(|p| p.state.attributes[i] == *value) {
            Arc::make_mut(&mut shape.state_mut().attributes)[i] = value.clone();
        }
    }
}
