//! Affine maps of meshes. In: a mesh and `target_from_source`. Out: the mesh in target coordinates.

use glam::{DAffine3, DMat3};
use smallvec::SmallVec;

use super::{Face, Mesh};

/// Maps every vertex; if the map mirrors, every face is turned so that it still points outwards.
pub fn transform(mesh: &Mesh, target_from_source: &DAffine3) -> Mesh {
    let mut out = transform_keeping_loops(mesh, target_from_source);
    if target_from_source.matrix3.determinant() < 0.0 {
        out.faces.iter_mut().for_each(turn_loops);
    }
    out
}

/// Maps every vertex and leaves the loops alone: under a mirroring map the faces then point inwards, which is what
/// CGA shows for an odd number of negative sizes (cga-reference C.7).
pub fn transform_keeping_loops(mesh: &Mesh, target_from_source: &DAffine3) -> Mesh {
    let positions = mesh.positions.iter().map(|&p| target_from_source.transform_point3(p)).collect();
    let mut faces = mesh.faces.clone();
    if faces.iter().any(|f| !f.normals.is_empty()) {
        let turn = normals_under(target_from_source.matrix3);
        faces.iter_mut().flat_map(|f| &mut f.normals).for_each(|n| *n = (turn * *n).normalize_or(*n));
    }
    Mesh { positions, faces }
}

/// How normals go under a linear map, up to length: by its cofactors, which flat maps have too.
pub fn normals_under(map: DMat3) -> DMat3 {
    let (x, y, z) = (map.x_axis, map.y_axis, map.z_axis);
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * map.determinant().signum()
}

/// Turns a face over, and its normals with it. The first edge stays the first edge, run the other way: [0, 1, .. n-1] becomes [1, 0, n-1, .. 2].
pub fn flip_face(face: &mut Face) {
    turn_loops(face);
    face.normals.iter_mut().for_each(|n| *n = -*n);
}

/// As [`flip_face`] for a face that was mirrored: normals stay, each at its corner.
pub fn turn_loops(face: &mut Face) {
    if face.uvs.is_empty() && face.normals.is_empty() {
        face.loops_mut().for_each(flip_loop);
        return;
    }
    let lengths: SmallVec<[usize; 4]> = face.loops().map(<[u32]>::len).collect();
    flip_loop(&mut face.outer);
    face.holes.iter_mut().for_each(|h| flip_loop(h));
    face.uvs.iter_mut().for_each(|(_, uv)| turn_corners(uv, &lengths));
    turn_corners(&mut face.normals, &lengths);
}

/// Turns values per corner as the loops of these lengths are turned.
fn turn_corners<T>(mut rest: &mut [T], lengths: &[usize]) {
    for &n in lengths {
        let n = n.min(rest.len());
        let (ring, tail) = std::mem::take(&mut rest).split_at_mut(n);
        flip_loop(ring);
        rest = tail;
    }
}

/// Reverses a loop keeping its first edge first.
pub fn flip_loop<T>(ring: &mut [T]) {
    ring.reverse();
    if ring.len() >= 2 {
        ring.rotate_right(2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn flipping_keeps_the_first_edge_and_the_uvs_of_each_corner() {
        let mut face = Face::with_holes(vec![0, 1, 2, 3, 4], [vec![5, 6, 7]]);
        face.uvs.push((0, (0..8).map(|i| DVec2::splat(i as f64)).collect()));
        face.normals = (0..8).map(|i| DVec3::new(0.0, i as f64, 1.0)).collect();
        flip_face(&mut face);
        assert_eq!(face.outer[..], [1, 0, 4, 3, 2]);
        assert_eq!(face.holes[0][..], [6, 5, 7]);
        let corners: Vec<f64> = face.loops().flatten().map(|&i| i as f64).collect();
        assert_eq!(face.uvs[0].1.iter().map(|uv| uv.x).collect::<Vec<_>>(), corners);
        assert_eq!(face.normals.iter().map(|n| -n.y).collect::<Vec<_>>(), corners);
    }

    #[test]
    fn a_mirrored_face_still_points_up() {
        let mesh = Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, -1.0)],
            faces: vec![Face::new([0, 1, 2].as_slice())],
        };
        let mirror = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(-2.0, 1.0, 1.0)));
        let flipped = transform(&mesh, &mirror);
        assert_eq!(flipped.newell(&flipped.faces[0]), DVec3::new(0.0, 2.0, 0.0));
        let kept = transform_keeping_loops(&mesh, &mirror);
        assert_eq!(kept.newell(&kept.faces[0]), DVec3::new(0.0, -2.0, 0.0));
    }
}
