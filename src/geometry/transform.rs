//! Affine maps of meshes. In: a mesh and `target_from_source`. Out: the mesh in target coordinates.

use glam::DAffine3;

use super::{Face, Mesh};

/// Maps every vertex; if the map mirrors, every face is turned so that it still points outwards.
pub fn transform(mesh: &Mesh, target_from_source: &DAffine3) -> Mesh {
    let mut out = transform_keeping_loops(mesh, target_from_source);
    if target_from_source.matrix3.determinant() < 0.0 {
        out.faces.iter_mut().for_each(flip_face);
    }
    out
}

/// Maps every vertex and leaves the loops alone: under a mirroring map the faces then point inwards, which is what
/// CGA shows for an odd number of negative sizes (cga-reference C.7).
pub fn transform_keeping_loops(mesh: &Mesh, target_from_source: &DAffine3) -> Mesh {
    let positions = mesh.positions.iter().map(|&p| target_from_source.transform_point3(p)).collect();
    Mesh { positions, faces: mesh.faces.clone() }
}

/// Turns a face over. The first edge stays the first edge, run the other way: [0, 1, .. n-1] becomes [1, 0, n-1, .. 2].
pub fn flip_face(face: &mut Face) {
    flip_loop(&mut face.outer);
    face.holes.iter_mut().for_each(|h| flip_loop(h));
    let lengths: Vec<usize> = face.loops().map(Vec::len).collect();
    for (_, uv) in &mut face.uvs {
        let mut rest = uv.as_mut_slice();
        for &n in &lengths {
            let n = n.min(rest.len());
            let (ring, tail) = std::mem::take(&mut rest).split_at_mut(n);
            flip_loop(ring);
            rest = tail;
        }
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
    use glam::{DMat3, DVec2, DVec3};

    #[test]
    fn flipping_keeps_the_first_edge_and_the_uvs_of_each_corner() {
        let mut face = Face { outer: vec![0, 1, 2, 3, 4], holes: vec![vec![5, 6, 7]], uvs: Vec::new() };
        face.uvs.push((0, (0..8).map(|i| DVec2::splat(i as f64)).collect()));
        flip_face(&mut face);
        assert_eq!(face.outer, [1, 0, 4, 3, 2]);
        assert_eq!(face.holes, [vec![6, 5, 7]]);
        let corners: Vec<f64> = face.loops().flatten().map(|&i| i as f64).collect();
        assert_eq!(face.uvs[0].1.iter().map(|uv| uv.x).collect::<Vec<_>>(), corners);
    }

    #[test]
    fn a_mirrored_face_still_points_up() {
        let mesh = Mesh {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, -1.0)],
            faces: vec![Face::new(vec![0, 1, 2])],
        };
        let mirror = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(-2.0, 1.0, 1.0)));
        let flipped = transform(&mesh, &mirror);
        assert_eq!(flipped.newell(&flipped.faces[0]), DVec3::new(0.0, 2.0, 0.0));
        let kept = transform_keeping_loops(&mesh, &mirror);
        assert_eq!(kept.newell(&kept.faces[0]), DVec3::new(0.0, -2.0, 0.0));
    }
}
