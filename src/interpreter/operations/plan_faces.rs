//! Faces made in the plane of a source face. In: plan polygons. Out: a form whose faces share equal vertices and carry
//! the source's material and texture coordinates.
//!
//! Corners of the source come back as they were, bit for bit. Where the source is not flat, other points get heights
//! from its triangles (reference A48); where its texture coordinates are not affine, they are interpolated likewise.

use std::collections::BTreeMap;

use glam::{DAffine2, DMat2, DVec2, DVec3};

use super::super::form::Form;
use crate::geometry::transform::flip_face;
use crate::geometry::triangulate::triangulate_polygon;
use crate::geometry::{Face, Mesh, PlaneFrame, Polygon};

pub struct PlanFaces<'a> {
    source: &'a Form,
    mesh: Mesh,
    sources: Vec<Option<u32>>,
    known: BTreeMap<[u64; 3], u32>,
}

/// A source face: its plane, its corners, and how to find height and texture between them.
pub struct SourceFace {
    number: usize,
    frame: PlaneFrame,
    /// Of all loops, in plan.
    points: Vec<DVec2>,
    corners: Vec<DVec3>,
    /// Metres in front of the plane, per corner; empty for flat faces.
    heights: Vec<f64>,
    /// Only where something has to be interpolated.
    triangles: Vec<[u32; 3]>,
    uvs: Vec<(u8, Texture)>,
    /// Per corner; empty for faces shaded flat.
    normals: Vec<DVec3>,
}

enum Texture {
    Affine(Vec<DVec2>, DAffine2),
    /// Values per corner, even within each triangle.
    Corners(Vec<DVec2>),
}

/// Heights and texture errors below this share of the extent are rounding.
const FLAT: f64 = 1e-9;

impl<'a> PlanFaces<'a> {
    pub fn new(source: &'a Form) -> Self {
        PlanFaces { source, mesh: Mesh::default(), sources: Vec::new(), known: BTreeMap::new() }
    }

    pub fn face(&self, number: usize, frame: PlaneFrame) -> SourceFace {
        SourceFace::new(&self.source.mesh, number, frame)
    }

    /// Adds a counter-clockwise polygon in the plane of its source face.
    pub fn push(&mut self, source: &SourceFace, polygon: &Polygon) {
        let outer = self.ring(source, &polygon.outer).collect();
        let holes = polygon.holes.iter().map(|hole| self.ring(source, hole).collect()).collect();
        let corner = || polygon.rings().flatten();
        let uvs = source.uvs.iter().map(|(set, map)| (*set, corner().map(|p| source.texture(map, *p)).collect()));
        let shaded = !source.normals.is_empty();
        let normals = corner().filter(|_| shaded).map(|p| source.normal(*p)).collect();
        self.mesh.faces.push(Face { outer, holes, uvs: uvs.collect(), normals });
        self.sources.push(Some(source.number as u32));
    }

    /// As [`PlanFaces::push`], turned over.
    pub fn push_flipped(&mut self, source: &SourceFace, polygon: &Polygon) {
        self.push(source, polygon);
        if let Some(face) = self.mesh.faces.last_mut() {
            flip_face(face);
        }
    }

    fn ring<'r>(&'r mut self, source: &'r SourceFace, ring: &'r [DVec2]) -> impl Iterator<Item = u32> + 'r {
        ring.iter().map(|&p| self.vertex(source.position(p)))
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

impl SourceFace {
    fn new(mesh: &Mesh, number: usize, frame: PlaneFrame) -> SourceFace {
        let face = &mesh.faces[number];
        let corners: Vec<DVec3> = face.corners().map(|v| mesh.positions[v as usize]).collect();
        let points: Vec<DVec2> = corners.iter().map(|&p| frame.to_plan(p)).collect();
        let extent = points.iter().fold(0.0, |m, p| f64::max(m, p.abs().max_element()));
        let mut heights: Vec<f64> = corners.iter().map(|&p| (p - frame.origin).dot(frame.normal)).collect();
        if heights.iter().all(|h| h.abs() <= FLAT * extent) {
            heights.clear();
        }
        let mut uvs = Vec::with_capacity(face.uvs.len());
        for (set, uv) in &face.uvs {
            let fits = |map: &DAffine2| {
                let range = uv.iter().fold(0.0, |m, p| f64::max(m, (p - uv[0]).abs().max_element()));
                points.iter().zip(uv).all(|(p, uv)| map.transform_point2(*p).distance(*uv) <= FLAT * range)
            };
            if let Some(map) = texture_map(&points, uv).filter(fits) {
                uvs.push((*set, Texture::Affine(uv.to_vec(), map)));
            } else if uv.len() == points.len() {
                uvs.push((*set, Texture::Corners(uv.to_vec())));
            }
        }
        let uneven = uvs.iter().any(|(_, texture)| matches!(texture, Texture::Corners(_)));
        let normals = if face.normals.len() == points.len() { face.normals.clone() } else { Vec::new() };
        let triangles = if heights.is_empty() && !uneven && normals.is_empty() {
            Vec::new()
        } else {
            triangulate_polygon(&frame.face_to_plan(mesh, face))
        };
        SourceFace { number, frame, points, corners, heights, triangles, uvs, normals }
    }

    /// The corner at a plan point.
    fn corner(&self, p: DVec2) -> Option<usize> {
        self.points.iter().position(|q| *q == p)
    }

    fn position(&self, p: DVec2) -> DVec3 {
        if let Some(corner) = self.corner(p) {
            return self.corners[corner];
        }
        let height = if self.heights.is_empty() { 0.0 } else { self.between(p, |c| self.heights[c], |h, k| h * k) };
        self.frame.to_space(p, height)
    }

    fn texture(&self, texture: &Texture, p: DVec2) -> DVec2 {
        let (Texture::Affine(values, _) | Texture::Corners(values)) = texture;
        match (self.corner(p), texture) {
            (Some(corner), _) => values[corner],
            (None, Texture::Affine(_, map)) => map.transform_point2(p),
            (None, Texture::Corners(values)) => self.between(p, |c| values[c], |v, k| v * k),
        }
    }

    fn normal(&self, p: DVec2) -> DVec3 {
        match self.corner(p) {
            Some(corner) => self.normals[corner],
            None => self.between(p, |c| self.normals[c], |n, k| n * k).normalize_or(self.frame.normal),
        }
    }

    /// A value of the corners, interpolated in the triangle that holds the point or comes nearest to doing so.
    fn between<T: Default + std::ops::Add<Output = T>>(
        &self,
        p: DVec2,
        value: impl Fn(usize) -> T,
        times: impl Fn(T, f64) -> T,
    ) -> T {
        let mut best = ([0; 3], [0.0; 3], f64::NEG_INFINITY);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.points[i as usize]);
            let area = (b - a).perp_dot(c - a);
            let weights =
                [(b - p).perp_dot(c - p) / area, (c - p).perp_dot(a - p) / area, (a - p).perp_dot(b - p) / area];
            let inside = weights[0].min(weights[1]).min(weights[2]);
            if inside > best.2 {
                best = (*triangle, weights, inside);
            }
        }
        let mut sum = T::default();
        for (corner, weight) in best.0.into_iter().zip(best.1) {
            sum = sum + times(value(corner as usize), weight);
        }
        sum
    }
}

/// The affine map that takes three far-apart points to their values; `None` if all lie on a line.
pub fn texture_map(points: &[DVec2], values: &[DVec2]) -> Option<DAffine2> {
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
