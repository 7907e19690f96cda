//! Pairs: a cube passes every check; break one thing, and exactly that defect is found.

use proptest::prelude::*;

use super::*;
use crate::geometry::Face;
use crate::geometry::extrude::{Direction, extrude};
use crate::geometry::transform::flip_face;

fn cube() -> Mesh {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, -1.0), DVec3::NEG_Z];
    let square = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2, 3])] };
    extrude(&square, Direction::FaceNormal, 1.0).expect("a square has area").mesh
}

/// Number of findings of every check, in order.
fn findings(mesh: &Mesh) -> [usize; 9] {
    [
        open_edges(mesh).len(),
        edges_used_more_than_twice(mesh).len(),
        edges_run_twice_the_same_way(mesh).len(),
        faces_without_area(mesh).len(),
        doubled_corners(mesh).len(),
        non_planar_faces(mesh, 1e-9).len(),
        non_finite_vertices(mesh).len(),
        degenerate_triangles(mesh).len(),
        faces_not_triangulated(mesh).len(),
    ]
}

#[test]
fn a_cube_has_no_defect() {
    assert!(missing_vertices(&cube()).is_empty());
    assert_eq!(findings(&cube()), [0; 9]);
    assert!(is_closed(&cube()));
    assert_eq!((volume(&cube()), surface_area(&cube())), (1.0, 6.0));
}

#[test]
fn a_missing_face_leaves_open_edges() {
    let mut mesh = cube();
    mesh.faces.remove(1);
    assert_eq!(open_edges(&mesh), [(5, 4), (4, 7), (6, 5), (7, 6)]);
    assert_eq!(findings(&mesh), [4, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert!(!is_closed(&mesh));
}

#[test]
fn a_repeated_face_uses_its_edges_three_times() {
    let mut mesh = cube();
    mesh.faces.push(mesh.faces[0].clone());
    assert_eq!(edges_used_more_than_twice(&mesh)[0], ((0, 1), 3));
    assert_eq!(findings(&mesh), [0, 4, 0, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn a_flipped_face_runs_its_edges_the_same_way_as_its_neighbours() {
    let mut mesh = cube();
    flip_face(&mut mesh.faces[1]);
    assert_eq!(edges_run_twice_the_same_way(&mesh), [(4, 5), (4, 7), (5, 6), (6, 7)]);
    assert_eq!(findings(&mesh), [0, 0, 4, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn a_face_between_two_vertices_has_no_area() {
    let mut mesh = cube();
    mesh.faces = vec![Face::new(vec![0, 1])];
    assert_eq!(faces_without_area(&mesh), [0]);
}

#[test]
fn a_doubled_corner_is_named() {
    let mut mesh = cube();
    mesh.positions.push(mesh.positions[2]);
    mesh.faces = vec![Face::new(vec![0, 1, 2, 8, 3])];
    assert_eq!(doubled_corners(&mesh), [(0, 3)]);
}

#[test]
fn a_lifted_corner_bends_its_three_faces() {
    let mut mesh = cube();
    mesh.positions[6] += DVec3::splat(0.25);
    assert_eq!(non_planar_faces(&mesh, 1e-9).len(), 3);
    assert_eq!(findings(&mesh), [0, 0, 0, 0, 0, 3, 0, 0, 0]);
}

#[test]
fn a_crossing_loop_is_not_triangulated_in_full() {
    let mut mesh = cube();
    mesh.faces = vec![Face::new(vec![0, 2, 1, 3])];
    assert_eq!(faces_not_triangulated(&mesh), [0]);
}

#[test]
fn a_vertex_at_infinity_and_a_missing_one_are_named() {
    let mut mesh = cube();
    mesh.positions[3].y = f64::INFINITY;
    assert_eq!(non_finite_vertices(&mesh), [3]);
    mesh.faces[2].outer[1] = 99;
    assert_eq!(missing_vertices(&mesh), [(2, 1)]);
}

#[test]
fn a_cube_far_from_the_origin_keeps_its_volume() {
    let mut mesh = cube();
    mesh.positions.iter_mut().for_each(|p| *p += DVec3::new(1048576.0, 0.0, -2097152.0));
    assert_eq!(volume(&mesh), 1.0);
}

#[test]
fn a_cube_through_a_cube_is_a_self_intersection() {
    assert!(self_intersections(&cube(), 1e-9).is_empty());
    let shifted = |by: DVec3| {
        let mut both = cube();
        let other = cube();
        both.positions.extend(other.positions.iter().map(|p| *p + by));
        both.faces.extend(other.faces.iter().cloned().map(|mut f| {
            f.loops_mut().flatten().for_each(|v| *v += 8);
            f
        }));
        self_intersections(&both, 1e-9)
    };
    // Corner in corner: three faces of each through three of the other.
    assert_eq!(shifted(DVec3::new(0.5, 0.25, 0.125)).len(), 6);
    // Face to face, edge to edge, corner to corner, apart.
    for by in [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::new(0.3, 1.0, 0.3), DVec3::splat(3.0)] {
        assert_eq!(shifted(by), [], "{by}");
    }
    // Two sides of each lie in planes of the other and face the same way.
    assert!(shifted(DVec3::new(0.5, 0.0, 0.0)).contains(&(0, 6)));
}

#[test]
fn defects_have_names_and_counts() {
    assert_eq!(defects(&cube(), &[]), []);
    let mut open = cube();
    open.faces.remove(1);
    assert_eq!(defects(&open, &[]), [(Defect::OpenEdge, 4)]);
    assert_eq!(defects(&open, &[Defect::OpenEdge]), []);
    let mut inside_out = cube();
    inside_out.faces.iter_mut().for_each(flip_face);
    assert_eq!(defects(&inside_out, &[]), [(Defect::NegativeVolume, 1)]);
    let mut bent = cube();
    let corner = bent.faces[0].outer[0] as usize;
    bent.positions[corner] += DVec3::new(0.3, 0.5, 0.2);
    let found: Vec<Defect> = defects(&bent, &[]).into_iter().map(|(defect, _)| defect).collect();
    assert_eq!(found, [Defect::NonPlanarFace, Defect::VolumeAgainstAnalytic]);
    let mut names: Vec<&str> = Defect::ALL.iter().map(|d| d.name()).collect();
    names.dedup();
    assert_eq!(names.len(), Defect::ALL.len());
}

proptest! {
    /// Without triangles and with them: prisms over stars.
    #[test]
    fn volumes_by_planes_and_by_triangles_agree(radii in prop::collection::vec(0.5f64..10.0, 3..40), height in 0.1f64..30.0) {
        let n = radii.len();
        let at = |k: usize, y: f64| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / n as f64);
            DVec3::new(radii[k] * cos, y, -radii[k] * sin)
        };
        let positions: Vec<DVec3> = (0..2 * n).map(|k| at(k % n, if k < n { 0.0 } else { height })).collect();
        let corner = |k: usize| (k % n) as u32;
        let side = |k: usize| Face::new(vec![corner(k), corner(k + 1), n as u32 + corner(k + 1), n as u32 + corner(k)]);
        let mut faces: Vec<Face> = (0..n).map(side).collect();
        faces.push(Face::new((0..n as u32).rev().collect::<Vec<_>>()));
        faces.push(Face::new((n as u32..2 * n as u32).collect::<Vec<_>>()));
        let mesh = Mesh { positions, faces };
        let plan: f64 = (0..n).map(|k| radii[k] * radii[(k + 1) % n] / 2.0).sum::<f64>() * libm::sin(std::f64::consts::TAU / n as f64);
        prop_assert!((volume_by_planes(&mesh) - plan * height).abs() < 1e-9 * (1.0 + plan * height));
        prop_assert!((volume(&mesh) - plan * height).abs() < 1e-9 * (1.0 + plan * height));
    }
}
