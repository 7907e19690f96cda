//! Polygon meshes in space: faces keep their holes until triangles are needed.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use smallvec::SmallVec;

use super::plane::unit;

/// Vertex indices of one loop; quads need no allocation.
pub type Loop = SmallVec<[u32; 4]>;

/// Texture coordinates of a face's corners in one set: the outer loop first, then the holes.
pub type CornerUvs = SmallVec<[DVec2; 4]>;

/// Texture coordinates per uv set, sorted by set.
pub type UvSets = SmallVec<[(u8, CornerUvs); 1]>;

/// One planar face. Loops index [`Mesh::positions`]; the outer loop is counter-clockwise seen from outside,
/// hole loops run the other way. The first edge runs from corner 0 to corner 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Face {
    pub outer: Loop,
    pub holes: Vec<Loop>,
    /// One value per corner and set, the outer loop first, then the holes.
    pub uvs: UvSets,
    /// Unit normals per corner in the same order; empty where the face is shaded flat.
    pub normals: Vec<DVec3>,
}

/// A polygon mesh in metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<DVec3>,
    pub faces: Vec<Face>,
}

impl Face {
    pub fn new(outer: impl Into<Loop>) -> Self {
        Face { outer: outer.into(), ..Face::default() }
    }

    /// With loops around holes.
    pub fn with_holes(outer: impl Into<Loop>, holes: impl IntoIterator<Item: Into<Loop>>) -> Self {
        Face { outer: outer.into(), holes: holes.into_iter().map(Into::into).collect(), ..Face::default() }
    }

    /// Outer loop, then holes.
    pub fn loops(&self) -> impl Iterator<Item = &[u32]> {
        std::iter::once(&self.outer).chain(&self.holes).map(|l| &l[..])
    }

    pub fn loops_mut(&mut self) -> impl Iterator<Item = &mut [u32]> {
        std::iter::once(&mut self.outer).chain(&mut self.holes).map(|l| &mut l[..])
    }

    /// Vertex indices of all corners: the outer loop, then the holes.
    pub fn corners(&self) -> impl Iterator<Item = u32> + '_ {
        self.outer.iter().chain(self.holes.iter().flatten()).copied()
    }

    /// Edges (from, to) of all loops in order: the face-edge index of CGA counts these.
    pub fn edges(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.loops().flat_map(|l| (0..l.len()).map(move |i| (l[i], l[(i + 1) % l.len()])))
    }

    /// Corner coordinates of a uv set, if the face has it.
    pub fn uv(&self, set: u8) -> Option<&[DVec2]> {
        self.uvs.iter().find(|(s, _)| *s == set).map(|(_, uv)| uv.as_slice())
    }
}

impl Mesh {
    /// Newell's vector of the outer loop: its length is twice the area of the face, its direction the outward normal.
    pub fn newell(&self, face: &Face) -> DVec3 {
        self.newell_of(&face.outer)
    }

    fn newell_of(&self, ring: &[u32]) -> DVec3 {
        let Some(&first) = ring.first() else { return DVec3::ZERO };
        let o = self.positions[first as usize];
        let mut sum = DVec3::ZERO;
        for w in ring.windows(2) {
            sum += (self.positions[w[0] as usize] - o).cross(self.positions[w[1] as usize] - o);
        }
        sum
    }

    /// Newell's vector of all loops, holes included: half its length is the area of the face less its holes.
    pub fn area_vector(&self, face: &Face) -> DVec3 {
        face.loops().map(|l| self.newell_of(l)).sum()
    }

    /// The unit normal, zero for a face without area (cga-reference C.4).
    pub fn normal(&self, face: &Face) -> DVec3 {
        unit(self.newell(face)).unwrap_or(DVec3::ZERO)
    }

    /// Area less holes, square metres.
    pub fn area(&self, face: &Face) -> f64 {
        self.area_vector(face).length() / 2.0
    }

    /// The mesh with vertices of equal position made one (no tolerance), in order of first occurrence.
    pub fn welded(&self) -> Mesh {
        let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits); // -0 and 0 are one position
        let mut places: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let mut out = Mesh { positions: Vec::new(), faces: self.faces.clone() };
        let place_of: Vec<u32> = (self.positions.iter())
            .map(|&p| {
                *places.entry(key(p)).or_insert_with(|| {
                    out.positions.push(p);
                    out.positions.len() as u32 - 1
                })
            })
            .collect();
        for face in &mut out.faces {
            face.loops_mut().flatten().for_each(|c| *c = place_of[*c as usize]);
        }
        out
    }

    /// Least and greatest coordinates; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let &first = self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_become_one_vertex() {
        let p = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let positions = vec![p(0.0, 0.0), p(1.0, 0.0), p(1.0, -1.0), p(-0.0, 0.0), p(1.0, -1.0), p(0.0, -1.0)];
        let mesh = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2]), Face::new(vec![3, 4, 5])] };
        let welded = mesh.welded();
        assert_eq!(welded.positions.len(), 4);
        assert_eq!((&welded.faces[0].outer[..], &welded.faces[1].outer[..]), (&[0, 1, 2][..], &[0, 2, 3][..]));
    }
}
