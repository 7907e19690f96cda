//! The usual split: one quad cut across by parallel planes, again and again. In: a piece and planes. Out: for each plane
//! what the general way gives, to the bit, or nothing where the cut is not that simple.
//!
//! What is left of the quad stays in place between cuts; only what is cut off becomes a mesh.

use std::array::from_fn;

use glam::DVec3;

use super::face::{Corner, Side, corner_normals, corner_uv};
use super::{Origin, Piece, cut_point};
use crate::geometry::{Face, Mesh, Plane};

/// Which corner of a part starts its first edge, by the edge of the quad that the part begins on: a part runs along this
/// edge and the next two, and starts with the one of the least number.
const FIRST_EDGE: [usize; 4] = [0, 0, 2, 1];

/// What is left of a quad.
pub(super) struct Quad {
    /// `outer` numbers the positions.
    face: Face,
    positions: [DVec3; 4],
    origin: Origin,
}

/// One side of a cut.
struct Part {
    /// Corner numbers into `positions`, starting with the first edge.
    outer: [u32; 4],
    positions: [DVec3; 4],
    /// The edge of the quad that the part begins on, and where the cut points are on that edge and the opposite one.
    from: usize,
    shares: [f64; 2],
}

impl Quad {
    /// `None` unless the mesh is one face without holes between its four vertices.
    pub fn of(mesh: &Mesh) -> Option<Quad> {
        let ([face], Ok(positions)) = (&mesh.faces[..], <[DVec3; 4]>::try_from(&mesh.positions[..])) else {
            return None;
        };
        let is_quad = face.outer.len() == 4 && (0..4).all(|v| face.outer.contains(&v));
        (is_quad && face.holes.is_empty()).then(|| Quad { face: face.clone(), positions, origin: Origin::Face(0) })
    }

    /// Takes off what lies behind a plane: nothing, or a quad that leaves a quad. `None` where that is not so.
    pub fn cut(&mut self, plane: &Plane, thickness: f64) -> Option<Piece> {
        let at = |i: usize| self.positions[self.face.outer[i % 4] as usize];
        let distances: [f64; 4] = from_fn(|i| plane.signed_distance(at(i)));
        let sides = distances.map(|d| Side::of(d, thickness));
        if !sides.contains(&Side::Behind) && sides.contains(&Side::Front) {
            return Some(Piece::default());
        }
        // The edge that leaves the space behind the plane; the opposite one comes back.
        let leaving = (0..4).find(|&i| sides[i] == Side::Behind && sides[(i + 1) % 4] == Side::Front)?;
        let back = (leaving + 2) % 4;
        if sides[back] != Side::Front || sides[(back + 1) % 4] != Side::Behind {
            return None;
        }
        let cut_point = |i: usize| {
            let j = (i + 1) % 4;
            let share = distances[i] / (distances[i] - distances[j]);
            (cut_point((at(i), distances[i]), (at(j), distances[j]), plane), share)
        };
        let (points, shares): ([DVec3; 2], [f64; 2]) = {
            let [(p, s), (q, t)] = [cut_point(leaving), cut_point(back)];
            ([p, q], [s, t])
        };
        if points[0] == points[1] {
            return None;
        }
        let behind = self.part(back, [points[1], points[0]], [shares[1], shares[0]]);
        let front = self.part(leaving, points, shares);
        let piece = Piece {
            mesh: Mesh { positions: behind.positions.to_vec(), faces: vec![self.face_of(&behind)] },
            origins: [self.origin].as_slice().into(),
        };
        self.face = self.face_of(&front);
        self.positions = front.positions;
        Some(piece)
    }

    /// The part from the cut point on edge `from` to that on the opposite edge, which are given in this order.
    fn part(&self, from: usize, points: [DVec3; 2], shares: [f64; 2]) -> Part {
        let [va, vb] = [1, 2].map(|step| self.face.outer[(from + step) % 4]);
        // Vertices keep their order; cut points come after them, in the order of their edges.
        let (pa, pb) = (self.positions[va as usize], self.positions[vb as usize]);
        let (na, nb, old) = if va < vb { (0, 1, [pa, pb]) } else { (1, 0, [pb, pa]) };
        let (start, end, new) = if from < 2 { (2, 3, points) } else { (3, 2, [points[1], points[0]]) };
        let mut outer = [start, na, nb, end];
        outer.rotate_left(FIRST_EDGE[from]);
        Part { outer, positions: [old[0], old[1], new[0], new[1]], from, shares }
    }

    fn face_of(&self, part: &Part) -> Face {
        let mut face = Face::new(part.outer);
        if !self.face.uvs.is_empty() || !self.face.normals.is_empty() {
            let corners = self.corners(part);
            let complete = self.face.uvs.iter().filter(|(_, uv)| uv.len() == 4);
            let uvs = complete.map(|(set, uv)| (*set, corners.each_ref().map(|c| corner_uv(uv, c)).into()));
            face.uvs = uvs.collect();
            face.normals = corner_normals(&self.face, 4, corners.iter());
        }
        face
    }

    /// What the corners of a part come from.
    fn corners(&self, part: &Part) -> [Corner; 4] {
        let edge = |step: usize| (part.from + step) % 4;
        let cut = |edge: usize, share: f64| (edge, (edge + 1) % 4, share);
        let from = [
            cut(edge(0), part.shares[0]),
            (edge(1), edge(1), 0.0),
            (edge(2), edge(2), 0.0),
            cut(edge(2), part.shares[1]),
        ];
        let first = FIRST_EDGE[part.from];
        from_fn(|i| Corner { vertex: part.outer[i], edge: None, from: from[(i + first) % 4] })
    }

    pub fn into_piece(self) -> Piece {
        let mesh = Mesh { positions: self.positions.to_vec(), faces: vec![self.face] };
        Piece { mesh, origins: [self.origin].as_slice().into() }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::super::{slice, slice_one_by_one, thickness};
    use super::*;

    fn quad(corners: &[(f64, f64); 4], first: usize, order: usize, extras: bool) -> Mesh {
        let turn = glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
        // Vertex `v` stands at corner `v + order`, so faces number their vertices in many ways.
        let at = |i: usize| DVec2::from(corners[i % 4]);
        let positions = (0..4).map(|v| turn * at(v + order).extend(3.0)).collect();
        let outer: [u32; 4] = from_fn(|i| ((i + first + 4 - order) % 4) as u32);
        let mut face = Face::new(outer);
        if extras {
            face.uvs = [0u8, 3].map(|set| (set, (0..4).map(|i| at(i + first) * 0.3).collect())).into_iter().collect();
            face.normals = (0..4).map(|i| (turn * DVec3::new(0.1 * i as f64, 0.0, 1.0)).normalize()).collect();
        }
        Mesh { positions, faces: vec![face] }
    }

    /// Slices both ways; how many cuts went the direct way.
    fn compare(mesh: &Mesh, normal: DVec3, shares: &[f64]) -> usize {
        let heights = || mesh.positions.iter().map(|p| p.dot(normal));
        let (lo, hi) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let mut boundaries: Vec<f64> = shares.iter().map(|share| lo + (hi - lo) * share).collect();
        boundaries.sort_by(f64::total_cmp);
        assert_eq!(slice(mesh, normal, &boundaries), slice_one_by_one(mesh, normal, &boundaries));
        let Some(mut quad) = Quad::of(mesh) else { return 0 };
        let planes = boundaries.iter().map(|&offset| Plane { normal, offset });
        planes.map_while(|plane| quad.cut(&plane, thickness(mesh))).count()
    }

    proptest! {
        #[test]
        fn gives_what_cutting_one_by_one_gives(
            corners in prop::array::uniform4((-10.0f64..10.0, -10.0f64..10.0)),
            (first, order, extras) in (0usize..4, 0usize..4, any::<bool>()),
            direction in prop::array::uniform3(-1.0f64..1.0),
            shares in prop::collection::vec(-0.1f64..1.1, 0..6),
        ) {
            let Some(normal) = DVec3::from(direction).try_normalize() else { return Ok(()) };
            compare(&quad(&corners, first, order, extras), normal, &shares);
        }

        #[test]
        fn rectangles_are_cut_the_direct_way(
            (w, d) in (0.5f64..60.0, 0.5f64..60.0),
            (first, order, extras, across) in (0usize..4, 0usize..4, any::<bool>(), any::<bool>()),
            shares in prop::collection::vec(0.001f64..0.999, 1..8),
        ) {
            let mesh = quad(&[(0.0, 0.0), (w, 0.0), (w, d), (0.0, d)], first, order, extras);
            let face = &mesh.faces[0].outer;
            let [a, b, c] = [0, 1, 2].map(|i| mesh.positions[face[i] as usize]);
            let normal = if across { (b - a).normalize() } else { (c - b).normalize() };
            prop_assert_eq!(compare(&mesh, normal, &shares), shares.len());
        }
    }

    #[test]
    fn planes_through_corners_are_left_to_the_general_way() {
        let mesh = quad(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)], 0, 0, true);
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| mesh.positions[i]);
        assert_eq!(compare(&mesh, (c - a).normalize(), &[0.25, 0.5, 0.75]), 0);
        assert_eq!(compare(&mesh, (b - a).normalize(), &[0.0, 0.5, 1.0]), 2);
        assert_eq!(compare(&mesh, (d - a).normalize(), &[-1.0, 0.5, 2.0]), 2);
    }
}
