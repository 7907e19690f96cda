//! Cutting faces along lines of equal value. In: a mesh, a value for every corner (such as a texture coordinate) and
//! the levels to cut at. Out: the pieces between the levels, not capped.
//!
//! Along an edge the value runs evenly. Faces that share an edge with the same values share the cut point on it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::face::{CutFace, Side};
use super::{Origin, Piece, assemble};
use crate::geometry::{Face, Mesh, Plane};

/// The set in which a face carries its values while it is cut; real sets are numbered 0 to 9.
const VALUE: u8 = u8::MAX;

/// Values within this share of their range are equal.
const EQUAL: f64 = 1e-9;

/// Cuts along the lines where the value is a boundary (`boundaries` rising) into `boundaries.len() + 1` pieces: below
/// the first, between each pair, above the last. `values[f]` has one value per corner of face `f`, outer loop first;
/// faces without values are in no piece. Pieces may be empty.
pub fn slice_by_value(mesh: &Mesh, values: &[Option<Vec<f64>>], boundaries: &[f64]) -> Vec<Piece> {
    let all = || values.iter().flatten().flatten();
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    let tolerance = EQUAL * (high - low).max(0.0);
    let positions = mesh.positions.clone();
    let mut slicer = Slicer {
        sides: vec![Side::On; positions.len()],
        mesh: Mesh { positions, ..Mesh::default() },
        cut_points: BTreeMap::new(),
        tolerance,
    };
    let mut rest: Vec<(usize, Face)> = Vec::new();
    for (index, (face, own)) in mesh.faces.iter().zip(values).enumerate() {
        if let Some(own) = own {
            let mut face = face.clone();
            face.uvs.push((VALUE, own.iter().map(|&v| DVec2::new(v, 0.0)).collect()));
            rest.push((index, face));
        }
    }
    let origins: Vec<Origin> = (0..mesh.faces.len() as u32).map(Origin::Face).collect();
    let mut pieces = Vec::with_capacity(boundaries.len() + 1);
    for &level in boundaries {
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for (index, face) in rest {
            let [under, over] = slicer.cut(face, level);
            below.extend(under.into_iter().map(|f| (index, f)));
            above.extend(over.into_iter().map(|f| (index, f)));
        }
        pieces.push(slicer.piece(&origins, below));
        rest = above;
    }
    pieces.push(slicer.piece(&origins, rest));
    pieces
}

struct Slicer {
    /// The vertices of the source, then the cut points.
    mesh: Mesh,
    /// Of the face in hand.
    sides: Vec<Side>,
    /// By edge (lesser vertex first) and the values at its ends.
    cut_points: BTreeMap<(u32, u32, u64, u64, u64), u32>,
    tolerance: f64,
}

impl Slicer {
    /// The parts of a face below and above a level. A face all on the level goes below.
    fn cut(&mut self, face: Face, level: f64) -> [Vec<Face>; 2] {
        let heights: Vec<f64> = face.uv(VALUE).unwrap_or_default().iter().map(|v| v.x - level).collect();
        let sides: Vec<Side> = heights.iter().map(|&h| Side::of(h, self.tolerance)).collect();
        if !sides.contains(&Side::Front) {
            return [vec![face], Vec::new()];
        }
        if !sides.contains(&Side::Behind) {
            return [Vec::new(), vec![face]];
        }
        for (vertex, side) in face.corners().zip(&sides) {
            self.sides[vertex as usize] = *side;
        }
        let crossings = self.crossings(&face, &heights, &sides, level);
        let uphill = self.gradient(&face, &heights);
        let plane = Plane { normal: uphill, offset: 0.0 };
        let known = |a: u32, b: u32| crossings.iter().find(|c| (c.0, c.1) == (a, b)).map(|c| (c.2, c.3));
        let cut = CutFace::new(&self.mesh, &face, &plane, known);
        [Side::Behind, Side::Front].map(|side| cut.parts(side, &self.mesh.positions, &self.sides))
    }

    /// (from, to, cut point, place on the edge) for every edge that passes the level.
    fn crossings(&mut self, face: &Face, heights: &[f64], sides: &[Side], level: f64) -> Vec<(u32, u32, u32, f64)> {
        let corners: Vec<u32> = face.corners().collect();
        let mut found = Vec::new();
        let mut start = 0;
        for length in face.loops().map(|ring| ring.len()) {
            for i in start..start + length {
                let j = if i + 1 < start + length { i + 1 } else { start };
                if sides[i].opposite() == Some(sides[j]) {
                    let ends = [(corners[i], heights[i]), (corners[j], heights[j])];
                    let share = heights[i] / (heights[i] - heights[j]);
                    found.push((corners[i], corners[j], self.cut_point(ends, level), share));
                }
            }
            start += length;
        }
        found
    }

    /// The same vertex whichever way the edge is run.
    fn cut_point(&mut self, ends: [(u32, f64); 2], level: f64) -> u32 {
        let [a, b] = if ends[0].0 <= ends[1].0 { ends } else { [ends[1], ends[0]] };
        let key = (a.0, b.0, a.1.to_bits(), b.1.to_bits(), level.to_bits());
        let (p, q) = (self.mesh.positions[a.0 as usize], self.mesh.positions[b.0 as usize]);
        *self.cut_points.entry(key).or_insert_with(|| {
            self.mesh.positions.push(p + (q - p) * (a.1 / (a.1 - b.1)));
            self.sides.push(Side::On);
            self.mesh.positions.len() as u32 - 1
        })
    }

    /// Where the value rises fastest on a face (exact where it is linear): by Green's theorem the integral of the value
    /// over the outward normals of the border.
    fn gradient(&self, face: &Face, heights: &[f64]) -> DVec3 {
        let normal = self.mesh.newell(face);
        let n = face.outer.len();
        let at = |i: usize| self.mesh.positions[face.outer[i % n] as usize];
        let share = |i: usize| (at(i + 1) - at(i)).cross(normal) * (heights[i] + heights[(i + 1) % n]);
        (0..n).map(share).sum::<DVec3>().normalize_or_zero()
    }

    fn piece(&self, origins: &[Origin], mut faces: Vec<(usize, Face)>) -> Piece {
        faces.iter_mut().for_each(|(_, face)| face.uvs.retain(|(set, _)| *set != VALUE));
        assemble(&self.mesh.positions, origins, faces, Vec::new())
    }
}
