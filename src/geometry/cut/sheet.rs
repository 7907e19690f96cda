//! The usual cut: one face without holes, cut once across. In: a piece and a plane. Out: what the general way gives, to
//! the bit, or nothing where the cut is not that simple.

use glam::DVec3;
use smallvec::SmallVec;

use super::face::{Corner, Side, corner_normals, corner_uv, start_with_first_edge};
use super::{Cut, Piece, cut_point};
use crate::geometry::{Face, Mesh, Plane};

/// Where a piece goes.
pub(super) enum Sheet {
    Behind,
    Front,
    Both(Cut),
}

/// Values per corner, in place for faces of usual size.
type PerCorner<T> = SmallVec<[T; 8]>;

/// A corner of the boundary with the cut points put in.
#[derive(Clone, Copy)]
struct Place {
    corner: Corner,
    side: Side,
    position: DVec3,
}

/// `None` unless the piece is a single face without holes whose boundary meets the plane in no points or in two that
/// part it into one run behind and one in front.
pub(super) fn cut(piece: &Piece, plane: &Plane, thickness: f64) -> Option<Sheet> {
    let [face] = &piece.mesh.faces[..] else { return None };
    if !face.holes.is_empty() {
        return None;
    }
    let distance = |c: u32| plane.signed_distance(piece.mesh.positions[c as usize]);
    let distances: PerCorner<f64> = face.outer.iter().map(|&c| distance(c)).collect();
    let has = |side: Side| distances.iter().any(|&d| Side::of(d, thickness) == side);
    match (has(Side::Behind), has(Side::Front)) {
        (true, false) => return Some(Sheet::Behind),
        (false, true) => return Some(Sheet::Front),
        (false, false) => return None,
        (true, true) => (),
    }
    let ring = boundary(&piece.mesh, face, &distances, plane, thickness);
    let [behind, front] = [Side::Behind, Side::Front].map(|side| run(&ring, side));
    let build = |run| part(piece, face, &ring, run);
    let (behind, front) = (behind?, front?);
    Some(Sheet::Both(Cut { behind: build(behind), front: build(front) }))
}

/// The corners in order; cut points are numbered after the vertices of the mesh.
fn boundary(mesh: &Mesh, face: &Face, distances: &[f64], plane: &Plane, thickness: f64) -> PerCorner<Place> {
    let n = face.outer.len();
    let side = |i: usize| Side::of(distances[i], thickness);
    let position = |i: usize| mesh.positions[face.outer[i] as usize];
    let mut ring = PerCorner::with_capacity(n + 2);
    let mut fresh = mesh.positions.len() as u32;
    for i in 0..n {
        let next = (i + 1) % n;
        let corner = Corner { vertex: face.outer[i], edge: Some(i), from: (i, i, 0.0) };
        ring.push(Place { corner, side: side(i), position: position(i) });
        if Some(side(i)) == side(next).opposite() {
            let share = distances[i] / (distances[i] - distances[next]);
            let corner = Corner { vertex: fresh, edge: Some(i), from: (i, next, share) };
            let position = cut_point((position(i), distances[i]), (position(next), distances[next]), plane);
            ring.push(Place { corner, side: Side::On, position });
            fresh += 1;
        }
    }
    ring
}

/// Start and length of the only run on a side, with the two different corners on the plane that bound it.
fn run(ring: &[Place], side: Side) -> Option<(usize, usize)> {
    let n = ring.len();
    let on = |i: usize| ring[i % n].side == Side::On;
    let mut found = (0..n).filter(|&i| on(i));
    let (Some(first), Some(second), None) = (found.next(), found.next(), found.next()) else { return None };
    let (start, end) = if ring[(first + 1) % n].side == side { (first, second) } else { (second, first + n) };
    let inside = start + 1..end;
    let whole = !inside.is_empty() && inside.clone().all(|i| ring[i % n].side == side);
    let apart =
        ring[first].corner.vertex != ring[second].corner.vertex && ring[first].position != ring[second].position;
    (whole && apart).then_some((start, end - start + 1))
}

/// The part of the face along a run of its boundary, closed by one edge along the cut.
fn part(piece: &Piece, face: &Face, ring: &[Place], (start, length): (usize, usize)) -> Piece {
    let places = || (start..start + length).map(|i| &ring[i % ring.len()]);
    let mut corners: PerCorner<Corner> = places().map(|p| p.corner).collect();
    corners[length - 1].edge = None;
    start_with_first_edge(&mut corners);
    let mut used: PerCorner<(u32, DVec3)> = places().map(|p| (p.corner.vertex, p.position)).collect();
    used.sort_unstable_by_key(|(vertex, _)| *vertex);
    used.dedup_by_key(|(vertex, _)| *vertex);
    let place = |c: &Corner| used.partition_point(|(vertex, _)| *vertex < c.vertex) as u32;
    let complete = face.uvs.iter().filter(|(_, uv)| uv.len() == face.outer.len());
    let face = Face {
        outer: corners.iter().map(place).collect(),
        holes: Vec::new(),
        uvs: complete.map(|(set, uv)| (*set, corners.iter().map(|c| corner_uv(uv, c)).collect())).collect(),
        normals: corner_normals(face, face.outer.len(), corners.iter()),
    };
    let positions = used.iter().map(|(_, p)| *p).collect();
    Piece { mesh: Mesh { positions, faces: vec![face] }, origins: piece.origins.clone() }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::cut::{Origin, cut_any};
    use crate::geometry::mesh::Loop;

    /// A face with these corners in plan, turned into space, with a vertex nobody uses and texture coordinates.
    fn piece(corners: &[(f64, f64)], first: usize) -> Piece {
        let turn = glam::DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
        let mut positions = vec![DVec3::splat(50.0)];
        positions.extend(corners.iter().map(|&(x, y)| turn * DVec3::new(x, y, 3.0)));
        let n = corners.len();
        let outer = (0..n).map(|i| ((i + first) % n) as u32 + 1).collect();
        let uvs = [(0, (0..n).map(|i| DVec2::new(i as f64, -(i as f64) * 0.3)).collect())].into();
        let normals = (0..n).map(|i| (turn * DVec3::new(0.1 * i as f64, 0.0, 1.0)).normalize()).collect();
        Piece {
            mesh: Mesh { positions, faces: vec![Face { outer, holes: Vec::new(), uvs, normals }] },
            origins: [Origin::Face(4)].as_slice().into(),
        }
    }

    /// Cuts both ways and compares; whether the simple way cut it in two.
    fn compare(piece: &Piece, plane: &Plane) -> bool {
        let thickness = 1e-7;
        let general = cut_any(piece.clone(), plane, thickness);
        match cut(piece, plane, thickness) {
            Some(Sheet::Both(cut)) => {
                assert_eq!(cut, general);
                true
            }
            Some(Sheet::Behind) => {
                assert_eq!((&general.behind, general.front.is_empty()), (piece, true));
                false
            }
            Some(Sheet::Front) => {
                assert_eq!((&general.front, general.behind.is_empty()), (piece, true));
                false
            }
            None => false,
        }
    }

    fn polar(radii: &[f64], shift: f64) -> Vec<(f64, f64)> {
        let angle = |i: usize| (i as f64 + shift) * std::f64::consts::TAU / radii.len() as f64;
        radii.iter().enumerate().map(|(i, r)| (r * libm::cos(angle(i)), r * libm::sin(angle(i)))).collect()
    }

    proptest! {
        #[test]
        fn the_simple_way_gives_what_the_general_way_gives(
            convex in any::<bool>(),
            radii in prop::collection::vec(2.0f64..10.0, 3..14),
            shift in 0.0f64..1.0,
            first in 0usize..14,
            direction in prop::array::uniform3(-1.0f64..1.0),
            share in 0.01f64..0.99,
        ) {
            let Some(normal) = DVec3::from(direction).try_normalize() else { return Ok(()) };
            let radii = if convex { vec![radii[0]; radii.len()] } else { radii };
            let piece = piece(&polar(&radii, shift), first);
            let heights: Vec<f64> = piece.mesh.positions[1..].iter().map(|p| p.dot(normal)).collect();
            let lo = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let hi = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let simple = compare(&piece, &Plane { normal, offset: lo + (hi - lo) * share });
            prop_assert!(simple || !convex, "a convex face was not cut the simple way");
            // Through each corner.
            for offset in heights {
                compare(&piece, &Plane { normal, offset });
            }
        }
    }

    #[test]
    fn along_coordinate_planes_and_edges_too() {
        let l = [(0.0, 0.0), (12.0, 0.0), (12.0, 5.0), (6.0, 5.0), (6.0, 9.0), (0.0, 9.0)];
        let positions = l.map(|(x, y)| DVec3::new(x, 0.0, -y)).to_vec();
        for first in 0..6u32 {
            let face = Face::new((0..6).map(|i| (i + first) % 6).collect::<Loop>());
            let mesh = Mesh { positions: positions.clone(), faces: vec![face] };
            let piece = Piece { mesh, origins: [Origin::Face(0)].as_slice().into() };
            let cuts = |normal, offset| compare(&piece, &Plane { normal, offset });
            for offset in [0.0, 3.0, 6.0, 7.0, 12.0] {
                assert_eq!(cuts(DVec3::X, offset), [3.0, 7.0].contains(&offset));
                assert_eq!(cuts(DVec3::NEG_X, -offset), [3.0, 7.0].contains(&offset));
            }
            for offset in [0.0, 2.0, 5.0, 6.0, 9.0] {
                assert_eq!(cuts(DVec3::NEG_Z, offset), [2.0, 6.0].contains(&offset));
            }
            let diagonal = DVec3::new(5.0, 0.0, -6.0).normalize();
            assert!(!cuts(diagonal, diagonal.dot(DVec3::new(6.0, 0.0, -5.0))), "touched from inside");
        }
    }
}
