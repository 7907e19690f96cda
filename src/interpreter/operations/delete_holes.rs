//! `deleteHoles` (reference 4.12). In: any faces. Out: the same faces, filled.

use std::sync::Arc;

use super::super::shape::Shape;

pub fn apply(shape: &mut Shape) {
    shape.bake();
    if shape.form.mesh.faces.iter().all(|f| f.holes.is_empty()) {
        return;
    }
    let mut form = (*shape.form).clone();
    for face in &mut form.mesh.faces {
        let corners = face.outer.len();
        face.holes.clear();
        face.uvs.iter_mut().for_each(|(_, uv)| uv.truncate(corners));
        face.normals.truncate(corners);
    }
    let all: Vec<usize> = (0..form.mesh.faces.len()).collect();
    shape.form = Arc::new(form.part(&all));
}
