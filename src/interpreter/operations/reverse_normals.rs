//! `reverseNormals` (reference 4.12). In: a shape. Out: its faces turned over, first edges still first.

use std::sync::Arc;

use super::super::shape::Shape;
use crate::geometry::transform::flip_face;

pub fn apply(shape: &mut Shape) {
    let form = Arc::make_mut(&mut shape.form);
    form.mesh.faces.iter_mut().for_each(flip_face);
    form.normals.iter_mut().for_each(|n| *n = -*n);
}
