//! Names on the components of a form: groups and tags. In: names from assets, `tag` and operations. Out: [`Labels`],
//! which follow their faces, edges and vertices through every operation (reference 3.11, 4.15).
//!
//! A form without names has none of this: [`Form::labels`] is `None`.

mod carry;
mod query;
mod tags;

use std::collections::BTreeSet;
use std::sync::Arc;

pub use query::{Query, tag_name};
pub use tags::{Level, TagSet, Tags};

use super::form::Form;
use crate::geometry::Mesh;

/// Groups and tags of one form.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// Index into `group_names` plus one per face, 0 for none; empty where no face has a group. The points of `scatter`
    /// have no faces and are of the only group named.
    pub face_groups: Vec<u16>,
    pub group_names: Arc<[Arc<str>]>,
    pub tags: Tags,
}

impl Labels {
    /// The group of a face: 0 for none.
    pub fn group(&self, face: usize) -> u16 {
        self.face_groups.get(face).copied().unwrap_or(0)
    }

    /// What is left of these names on other faces; `sources` names the face each new face came from.
    pub fn carried(&self, old: &Mesh, new: &Mesh, sources: &[Option<u32>]) -> Labels {
        let face_groups = if self.face_groups.is_empty() {
            Vec::new()
        } else {
            sources.iter().map(|source| source.map_or(0, |f| self.group(f as usize))).collect()
        };
        let tags = carry::carried(&self.tags, old, new, sources);
        Labels { face_groups, group_names: self.group_names.clone(), tags }
    }
}

impl Form {
    /// The tags, if there are any.
    pub fn tags(&self) -> Option<&Tags> {
        self.labels.as_deref().map(|labels| &labels.tags)
    }

    pub fn tags_mut(&mut self) -> &mut Tags {
        &mut self.labels.get_or_insert_default().tags
    }

    /// The group of a face: 0 for none, else the place in the list of names plus one.
    pub fn group(&self, face: usize) -> u16 {
        self.labels.as_ref().map_or(0, |labels| labels.group(face))
    }

    /// The groups of a form without faces.
    pub fn bare_groups(&self) -> &[Arc<str>] {
        let names = self.labels.as_ref().map(|labels| &labels.group_names[..]).unwrap_or_default();
        if self.mesh.faces.is_empty() && !self.is_empty() { names } else { &[] }
    }

    pub fn group_name(&self, group: u16) -> Arc<str> {
        let names = self.labels.as_ref().map(|labels| &labels.group_names[..]).unwrap_or_default();
        usize::from(group).checked_sub(1).and_then(|i| names.get(i)).cloned().unwrap_or_else(|| "".into())
    }

    /// Gives every face the name an operation makes for it, in place of those this operation made before
    /// (reference 4.15.3). `base` is the first part of all names of the operation, such as `extrude`.
    pub fn auto_tag_faces<'n>(&mut self, base: &str, names: impl IntoIterator<Item = Option<&'n str>>) {
        let tags = self.tags_mut();
        tags.remove(&Query::new(base), &[Level::Faces]);
        for (face, name) in names.into_iter().enumerate() {
            if let Some(name) = name {
                tags.add_face(face, name.into());
            }
        }
    }

    /// Edge counterpart of [`Form::auto_tag_faces`]; edges by their vertices.
    pub fn auto_tag_edges<'n>(&mut self, base: &str, names: impl IntoIterator<Item = ([u32; 2], &'n str)>) {
        let tags = self.tags_mut();
        tags.remove(&Query::new(base), &[Level::Edges]);
        for (edge, name) in names {
            tags.add_edge(edge, name.into());
        }
    }

    /// Every edge by its vertices, once, as its first face runs it; the bare edges where there are no faces.
    pub fn edge_list(&self) -> Vec<[u32; 2]> {
        if self.mesh.faces.is_empty() {
            return self.edges.clone();
        }
        super::topology::Topology::of(&self.mesh).edges.iter().map(|e| [e.from, e.to]).collect()
    }

    /// Every vertex that a face, edge or point uses, once.
    pub fn vertex_list(&self) -> Vec<u32> {
        if self.mesh.faces.is_empty() {
            return (0..self.mesh.positions.len() as u32).collect();
        }
        super::topology::used_vertices(&self.mesh)
    }

    /// Names of the tags on components of these kinds that match, sorted.
    pub fn tag_names(&self, query: &Query, levels: &[Level]) -> BTreeSet<Arc<str>> {
        let Some(tags) = self.tags() else { return BTreeSet::new() };
        let mut sets: Vec<&TagSet> = Vec::new();
        if levels.contains(&Level::Faces) {
            sets.extend((0..self.mesh.faces.len()).map(|f| tags.face(f)));
        }
        if levels.contains(&Level::Edges) && tags.any_edges() {
            sets.extend(self.edge_list().into_iter().map(|e| tags.edge(e)));
        }
        if levels.contains(&Level::Vertices) && tags.any_vertices() {
            sets.extend(self.vertex_list().into_iter().map(|v| tags.vertex(v)));
        }
        sets.into_iter().flatten().filter(|name| query.matches(name)).cloned().collect()
    }
}

#[cfg(test)]
mod tests;
