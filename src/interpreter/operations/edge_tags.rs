//! `setTagsFromEdgeAttrs` (reference 4.15.2). In: the string edge attributes of the initial shape. Out: every face edge
//! tagged `edgeattr.NAME.VALUE` with the value of the initial edge it lies along.

use std::sync::Arc;

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::host::EdgeValues;
use super::super::labels::tag_name;
use super::super::shape::Shape;
use crate::geometry::Mesh;

pub fn apply(run: &Derivation, shape: &mut Shape) {
    let Some(outline) = run.outline.as_ref().filter(|_| run.program.observes_tags()) else { return };
    shape.bake();
    let mesh = &shape.form.mesh;
    let mut tags = Vec::new();
    for face in &mesh.faces {
        let normal = mesh.normal(face);
        for (from, to) in face.edges() {
            let Some(place) = outline.covered_most(&bare_edge(mesh, from, to, normal)) else { continue };
            for attribute in &run.start.host.edge_attributes {
                let EdgeValues::Strings(values) = &attribute.values else { continue };
                let value = values.get(place).filter(|value| !value.is_empty());
                if let Some(name) = value.and_then(|v| tag_name(&format!("edgeattr.{}.{v}", attribute.name))) {
                    tags.push(([from, to], name));
                }
            }
        }
    }
    let form = Arc::make_mut(&mut shape.form);
    tags.into_iter().for_each(|(edge, name)| form.tags_mut().add_edge(edge, name));
}

/// The edge as `comp(fe)` gives it.
fn bare_edge(mesh: &Mesh, from: u32, to: u32, normal: DVec3) -> Form {
    let positions: Vec<DVec3> = [from, to].map(|v| mesh.positions[v as usize]).into();
    let outward = (positions[1] - positions[0]).cross(normal).normalize_or_zero();
    let mesh = Mesh { positions, faces: Vec::new() };
    Form { mesh, edges: vec![[0, 1]], normals: vec![outward], ..Form::default() }
}
