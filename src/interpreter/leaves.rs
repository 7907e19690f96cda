//! Finished shapes. In: shapes without a rule. Out: [`Leaf`]s in world coordinates with interned materials.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::appearance::Appearance;
use super::form::Form;
use super::material::Material;
use super::shape::Shape;
use super::steps::{StepId, Steps};
use super::tree::{Leaf, Scalar};

#[derive(Default)]
pub struct Leaves<'p> {
    list: Vec<Leaf>,
    names: Names<'p>,
    attributes: Arc<[(Arc<str>, Scalar)]>,
    materials: MaterialTable,
}

impl<'p> Leaves<'p> {
    pub fn set_attributes(&mut self, attributes: Arc<[(Arc<str>, Scalar)]>) {
        self.attributes = attributes;
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn into_list(self) -> Vec<Leaf> {
        self.list
    }

    /// Adds a leaf: one entry per material its faces have of their own. Shapes without geometry leave nothing.
    pub fn push(&mut self, name: &'p Arc<str>, mut shape: Box<Shape>, steps: &Steps<'p>, step: StepId) {
        shape.bake();
        let Shape { form, state, .. } = *shape;
        if form.is_empty() {
            return;
        }
        let path = steps.path(step);
        let rule = self.names.own(name);
        if form.face_materials.is_empty() {
            let material = self.materials.intern(&state.appearance);
            let mesh = Arc::try_unwrap(form).map_or_else(|shared| shared.mesh.clone(), |form| form.mesh);
            self.list.push(Leaf { rule, path, attributes: self.attributes.clone(), material, mesh });
            return;
        }
        for (own, part) in parts_by_material(form) {
            let appearance = match own.and_then(|i| part.materials.get(i)) {
                Some(below) => Arc::new(state.appearance.over(below)),
                None => state.appearance.clone(),
            };
            let material = self.materials.intern(&appearance);
            let mesh = Arc::try_unwrap(part).map_or_else(|shared| shared.mesh.clone(), |form| form.mesh);
            let (rule, path, attributes) = (rule.clone(), path.clone(), self.attributes.clone());
            self.list.push(Leaf { rule, path, attributes, material, mesh });
        }
    }
}

/// The form by the materials of its faces (index into its materials, `None` for none), in order of first use.
fn parts_by_material(form: Arc<Form>) -> Vec<(Option<usize>, Arc<Form>)> {
    let Some(&first) = form.face_materials.first() else { return vec![(None, form)] };
    let index = |m: u16| usize::from(m).checked_sub(1);
    if form.face_materials.iter().all(|&m| m == first) {
        return vec![(index(first), form)];
    }
    let mut groups: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
    for face in 0..form.mesh.faces.len() {
        groups.entry(form.face_material(face)).or_default().push(face);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(_, faces)| faces[0]);
    groups.into_iter().map(|(m, faces)| (index(m), Arc::new(form.part(&faces)))).collect()
}

/// Copies of the program's names, one each for the whole tree: counting references to the program's own would make
/// threads that derive at the same time wait for each other.
#[derive(Default)]
struct Names<'p> {
    last: Option<(&'p Arc<str>, Arc<str>)>,
    /// Sorted.
    known: Vec<(&'p str, Arc<str>)>,
}

impl<'p> Names<'p> {
    fn own(&mut self, name: &'p Arc<str>) -> Arc<str> {
        if let Some((last, own)) = &self.last
            && std::ptr::eq(*last, name)
        {
            return own.clone();
        }
        let own = match self.known.binary_search_by(|(known, _)| (*known).cmp(name)) {
            Ok(place) => self.known[place].1.clone(),
            Err(place) => {
                let own: Arc<str> = Arc::from(&**name);
                self.known.insert(place, (name, own.clone()));
                own
            }
        };
        self.last = Some((name, own.clone()));
        own
    }
}

/// Equal materials are one.
#[derive(Default)]
struct MaterialTable {
    /// Those met last, by the address of what they come from.
    recent: Vec<(Arc<Appearance>, Arc<Material>)>,
    /// The one to forget next.
    oldest: usize,
    /// Those forgotten, by the bits of colour and opacity.
    known: BTreeMap<[u64; 4], Vec<Arc<Material>>>,
}

impl MaterialTable {
    const RECENT: usize = 8;

    fn intern(&mut self, appearance: &Arc<Appearance>) -> Arc<Material> {
        if let Some((_, material)) = self.recent.iter().find(|(known, _)| Arc::ptr_eq(known, appearance)) {
            return material.clone();
        }
        let material = self.equal_one(appearance.material());
        let met = (appearance.clone(), material.clone());
        if self.recent.len() < Self::RECENT {
            self.recent.push(met);
        } else {
            let (_, forgotten) = std::mem::replace(&mut self.recent[self.oldest], met);
            self.oldest = (self.oldest + 1) % Self::RECENT;
            let same_color = self.known.entry(key(&forgotten)).or_default();
            if !same_color.iter().any(|known| Arc::ptr_eq(known, &forgotten)) {
                same_color.push(forgotten);
            }
        }
        material
    }

    /// The material met before that is equal to this one, or else this one.
    fn equal_one(&self, material: Material) -> Arc<Material> {
        let mut recent = self.recent.iter().map(|(_, known)| known);
        let known = || self.known.get(&key(&material)).into_iter().flatten().find(|known| ***known == material);
        recent.find(|known| ***known == material).or_else(known).cloned().unwrap_or_else(|| Arc::new(material))
    }
}

fn key(material: &Material) -> [u64; 4] {
    let [r, g, b] = material.color.map(f64::to_bits);
    [r, g, b, material.opacity.to_bits()]
}
