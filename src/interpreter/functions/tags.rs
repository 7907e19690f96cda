//! Questions about tags, groups and materials (reference 4.15.2, 6.6).

use std::sync::Arc;

use super::super::environment::{Env, Facet, Place};
use super::super::form::Form;
use super::super::labels::{Level, Query, Tags};
use super::super::operations::tag_levels;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::{Function as F, Word};
use crate::geometry::Mesh;

pub fn call(function: F, input: &Input, env: &Env) -> Option<Value> {
    let form = &*env.shape.form;
    Some(match function {
        F::IsTagged => Value::Bool(is_tagged(input, env)),
        F::GeometryTags => Value::strings(form.tag_names(&query(input), levels(input)).into_iter().collect()),
        F::GeometryHasTags => Value::Bool(!form.tag_names(&query(input), levels(input)).is_empty()),
        F::GeometryGroups if form.mesh.faces.is_empty() => Value::strings(form.bare_groups().to_vec()),
        F::GeometryGroups => names(form, |f| form.group(f), |group| form.group_name(group)),
        F::GeometryMaterials => names(form, |f| form.face_material(f), |m| material_name(form, m)),
        _ => return None,
    })
}

fn query(input: &Input) -> Query {
    if input.len() == 0 { Query::any() } else { Query::new(input.text(0)) }
}

fn levels(input: &Input) -> &'static [Level] {
    tag_levels(input.word(1))
}

/// One name per set of faces, sets in the order of their first faces as in `comp(g)` and `comp(m)`.
fn names(form: &Form, set: impl Fn(usize) -> u16, name: impl Fn(u16) -> Arc<str>) -> Value {
    let mut seen: Vec<u16> = Vec::new();
    for own in (0..form.mesh.faces.len()).map(set) {
        if !seen.contains(&own) {
            seen.push(own);
        }
    }
    Value::strings(seen.into_iter().map(name).collect())
}

/// Faces without a material of their own have the empty name.
fn material_name(form: &Form, material: u16) -> Arc<str> {
    let own = usize::from(material).checked_sub(1).and_then(|i| form.materials.get(i));
    own.and_then(|m| m.name.clone()).unwrap_or_else(|| "".into())
}

/// `isTagged(query [, e | v])` of the component a selector is asked about; elsewhere of the current shape: whether one
/// of its components of the highest dimension is.
fn is_tagged(input: &Input, env: &Env) -> bool {
    let (query, part) = (query(input), input.word(1));
    if let (Some(facets), Some(outer)) = (env.component, env.outer) {
        let Some(tags) = outer.form.tags() else { return false };
        return facets.iter().any(|facet| facet_is_tagged(tags, &outer.form.mesh, facet, &query, part));
    }
    let form = &env.shape.form;
    let Some(tags) = form.tags() else { return false };
    let place =
        |place: Place| Facet { place, direction: glam::DVec3::ZERO, is_border: false, roof_edge: None, uv_side: None };
    let tagged = |p: Place| facet_is_tagged(tags, &form.mesh, &place(p), &query, part);
    if !form.mesh.faces.is_empty() {
        (0..form.mesh.faces.len() as u32).any(|f| tagged(Place::Face(f)))
    } else if !form.edges.is_empty() {
        form.edges.iter().any(|&edge| tagged(Place::Edge(edge)))
    } else {
        form.vertex_list().into_iter().any(|v| tagged(Place::Vertex(v)))
    }
}

/// Whether a component is tagged, or with `e` or `v` one of its edges or vertices.
fn facet_is_tagged(tags: &Tags, mesh: &Mesh, facet: &Facet, query: &Query, part: Option<Word>) -> bool {
    let edge = |ends: [u32; 2]| tags.edge_matches(query, mesh, ends);
    let vertex = |v: u32| tags.vertex_matches(query, mesh, v);
    match (facet.place, part) {
        (Place::Face(f), Some(Word::E)) => mesh.faces[f as usize].edges().any(|(a, b)| edge([a, b])),
        (Place::Face(f), Some(Word::V)) => mesh.faces[f as usize].corners().any(vertex),
        (Place::Face(f), _) => tags.face_matches(query, f),
        (Place::Edge(ends), Some(Word::V)) => ends.into_iter().any(vertex),
        (Place::Edge(ends), _) => edge(ends),
        // A vertex has no edges of its own.
        (Place::Vertex(_), Some(Word::E)) => false,
        (Place::Vertex(v), _) => vertex(v),
    }
}
