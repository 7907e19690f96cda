//! Faces made in the plane of a source face. In: plan polygons. Out: a form whose faces share equal vertices and carry
//! the source's material and texture coordinates.

use std::collections::BTreeMap;

use glam::{DAffine2, DMat2, DVec2, DVec3};

use super::super::form::Form;
use crate::geometry::mesh::Loop;
use crate::geometry::transform::flip_face;
use crate::geometry::{Face, Mesh, PlaneFrame, Polygon};

pub struct PlanFaces<'a> {
    source: &'a Form,
    mesh: Mesh,
    sources: Vec<Option<u32>>,
    known: BTreeMap<[u64; 3], u32>,
}

/// A source face: its plane and, per uv set, the map from plan to texture.
pub struct SourceFace {
    number: usize,
    frame: PlaneFrame,
    uvs: Vec<(u8, DAffine2)>,
}

impl<'a> PlanFaces<'a> {
    pub fn new(source: &'a Form) -> Self {
        PlanFaces { source, mesh: Mesh::default(), sources: Vec::new(), known: BTreeMap::new() }
    }

    pub fn face(&self, number: usize, frame: PlaneFrame) -> SourceFace {
        let face = &self.source.mesh.faces[number];
        let points: Vec<DVec2> =
            face.corners().map(|v| frame.to_plan(self.source.mesh.positions[v as usize])).collect();
        let uvs = face.uvs.iter().filter_map(|(set, uv)| Some((*set, affine(&points, uv)?))).collect();
        SourceFace { number, frame, uvs }
    }

    /// Adds a counter-clockwise polygon in the plane of its source face.
    pub fn push(&mut self, source: &SourceFace, polygon: &Polygon) {
        let outer = self.ring(source, &polygon.outer);
        let holes = polygon.holes.iter().map(|hole| self.ring(source, hole)).collect();
        let corner = || polygon.rings().flatten();
        let uvs = source.uvs.iter().map(|(set, map)| (*set, corner().map(|p| map.transform_point2(*p)).collect()));
        self.mesh.faces.push(Face { outer, holes, uvs: uvs.collect(), normals: Vec::new() });
        self.sources.push(Some(source.number as u32));
    }

    /// As [`PlanFaces::push`], turned over.
    pub fn push_flipped(&mut self, source: &SourceFace, polygon: &Polygon) {
        self.push(source, polygon);
        if let Some(face) = self.mesh.faces.last_mut() {
            flip_face(face);
        }
    }

    fn ring(&mut self, source: &SourceFace, ring: &[DVec2]) -> Loop {
        ring.iter().map(|&p| self.vertex(source.frame.to_space(p, 0.0))).collect()
    }

    fn vertex(&mut self, p: DVec3) -> u32 {
        // Adding 0 makes -0 and 0 one.
        let key = (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let positions = &mut self.mesh.positions;
        *self.known.entry(key).or_insert_with(|| {
            positions.push(p);
            positions.len() as u32 - 1
        })
    }

    pub fn into_form(self) -> Form {
        self.source.derived(self.mesh, self.sources.into_iter())
    }
}

/// The affine map that takes three far-apart points to their values; `None` if all lie on a line.
fn affine(points: &[DVec2], values: &[DVec2]) -> Option<DAffine2> {
    let (&origin, &value) = (points.first()?, values.first()?);
    let far = |i: &usize| (points[*i] - origin).length_squared();
    let second = (0..points.len()).max_by(|a, b| far(a).total_cmp(&far(b)))?;
    let across = |i: &usize| (points[second] - origin).perp_dot(points[*i] - origin).abs();
    let third = (0..points.len()).max_by(|a, b| across(a).total_cmp(&across(b)))?;
    let plan = DMat2::from_cols(points[second] - origin, points[third] - origin);
    if plan.determinant() == 0.0 {
        return None;
    }
    let texture = DMat2::from_cols(*values.get(second)? - value, *values.get(third)? - value);
    let linear = texture * plan.inverse();
    Some(DAffine2 { matrix2: linear, translation: value - linear * origin })
}
