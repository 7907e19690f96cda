//! Vertex and face order of the compatibility notes; volume is area times height; closed with and without holes.

use super::*;
use crate::geometry::Polygon;
use crate::geometry::mesh_checks::{is_closed, surface_area, volume};
use crate::geometry::plane::PlaneFrame;
use proptest::prelude::*;

fn lot(polygon: &Polygon) -> Mesh {
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(&mut mesh, polygon, 0.0);
    mesh
}

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn l_shape() -> Polygon {
    Polygon {
        outer: ring(&[(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (8.0, 8.0), (8.0, 15.0), (0.0, 15.0)]),
        holes: Vec::new(),
    }
}

fn square_ring() -> Polygon {
    let hole = ring(&[(2.0, 2.0), (2.0, 6.0), (6.0, 6.0), (6.0, 2.0)]);
    Polygon { outer: ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]), holes: vec![hole] }
}

#[test]
fn order_of_vertices_and_faces() {
    let out = extrude(&lot(&l_shape()), Direction::FaceNormal, 3.0).expect("has area");
    assert_eq!(out.mesh.positions.len(), 12);
    assert_eq!(out.mesh.positions[7], DVec3::new(20.0, 3.0, 0.0));
    let loops: Vec<&[u32]> = out.mesh.faces.iter().map(|f| f.outer.as_slice()).collect();
    assert_eq!(loops[0], [1, 0, 5, 4, 3, 2]);
    assert_eq!(loops[1], [6, 7, 8, 9, 10, 11]);
    assert_eq!(loops[2], [0, 1, 7, 6]);
    assert_eq!(loops[7], [5, 0, 6, 11]);
    assert_eq!(out.origins[0], Origin { role: Role::Bottom, face: 0, edge: None });
    assert_eq!(out.origins[7], Origin { role: Role::SideOuter, face: 0, edge: Some(5) });
}

#[test]
fn a_hole_gets_walls() {
    let out = extrude(&lot(&square_ring()), Direction::FaceNormal, 2.5).expect("has area");
    assert_eq!((out.mesh.faces.len(), out.mesh.positions.len()), (10, 16));
    assert_eq!(out.mesh.faces.iter().map(|f| f.holes.len()).sum::<usize>(), 2);
    assert_eq!(out.origins.iter().filter(|o| o.role == Role::SideInner).count(), 4);
    assert!(is_closed(&out.mesh));
    assert!((volume(&out.mesh) - 84.0 * 2.5).abs() < 1e-9);
}

#[test]
fn downwards_the_faces_still_point_outwards() {
    let out = extrude(&lot(&square_ring()), Direction::FaceNormal, -2.5).expect("has area");
    assert!(is_closed(&out.mesh));
    assert!((volume(&out.mesh) - 84.0 * 2.5).abs() < 1e-9);
    assert_eq!(out.mesh.faces[0].outer[..], [0, 1, 2, 3]);
    assert_eq!(out.mesh.positions[8].y, -2.5);
}

#[test]
fn a_downward_face_goes_down() {
    let mut mesh = lot(&l_shape());
    flip_face(&mut mesh.faces[0]);
    let out = extrude(&mesh, Direction::FaceNormal, 3.0).expect("has area");
    assert_eq!(out.mesh.positions[6].y, -3.0);
    assert!(volume(&out.mesh) > 0.0);
    let up = extrude(&mesh, Direction::Along(DVec3::Y), 3.0).expect("has area");
    assert!((volume(&up.mesh) - volume(&out.mesh)).abs() < 1e-9);
}

#[test]
fn the_least_distance_changes_nothing() {
    let mesh = lot(&l_shape());
    for d in [0.0, 0.001, -0.001, f64::NAN, f64::INFINITY] {
        assert_eq!(extrude(&mesh, Direction::FaceNormal, d), None);
    }
    assert!(extrude(&mesh, Direction::FaceNormal, 0.002).is_some());
    assert_eq!(extrude(&Mesh::default(), Direction::FaceNormal, 1.0), None);
}

/// Two unit squares beside each other; the second one rises by `rise`.
fn two_squares(rise: f64) -> Mesh {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let positions = vec![
        p(0.0, 0.0, 0.0),
        p(1.0, 0.0, 0.0),
        p(1.0, 0.0, -1.0),
        p(0.0, 0.0, -1.0),
        p(2.0, rise, 0.0),
        p(2.0, rise, -1.0),
    ];
    Mesh { positions, faces: vec![Face::new(vec![0, 1, 2, 3]), Face::new(vec![1, 4, 5, 2])] }
}

#[test]
fn level_neighbours_have_no_wall_between() {
    let out = extrude(&two_squares(0.0), Direction::FaceNormal, 1.0).expect("has area");
    assert_eq!((out.mesh.faces.len(), out.mesh.positions.len()), (10, 12));
    assert!(is_closed(&out.mesh));
    assert!((volume(&out.mesh) - 2.0).abs() < 1e-12);
}

#[test]
fn sloped_neighbours_are_prisms_of_their_own_along_their_normals() {
    let out = extrude(&two_squares(0.5), Direction::FaceNormal, 1.0).expect("has area");
    assert_eq!((out.mesh.faces.len(), out.mesh.positions.len()), (12, 16));
    assert!(is_closed(&out.mesh));
    let joined = extrude(&two_squares(0.5), Direction::Along(DVec3::Y), 1.0).expect("has area");
    assert_eq!((joined.mesh.faces.len(), joined.mesh.positions.len()), (10, 12));
    assert!(is_closed(&joined.mesh));
    assert!((volume(&joined.mesh) - 2.0).abs() < 1e-12);
    let by_vertex = extrude(&two_squares(0.5), Direction::VertexNormal, 1.0).expect("has area");
    assert!(is_closed(&by_vertex.mesh));
    assert_eq!(by_vertex.mesh.positions.len(), 12);
}

#[test]
fn a_flat_top_is_level_and_never_below_the_shape() {
    let tops = |distance: f64| -> Vec<f64> {
        let out = extrude(&two_squares(0.5), Direction::AlongToFlatTop(DVec3::Y), distance).expect("has area");
        assert!(is_closed(&out.mesh));
        out.mesh.positions[6..].iter().map(|p| p.y).collect()
    };
    assert_eq!(tops(2.0), [2.0; 6]);
    assert_eq!(tops(0.25), [0.5; 6]);
    assert_eq!(tops(-2.0), [-1.5; 6]);
}

#[test]
fn sides_carry_the_uv_of_their_edge() {
    let mut mesh = lot(&square_ring());
    mesh.faces[0].uvs.push((3, (0..8).map(|i| DVec2::new(f64::from(i), 0.0)).collect()));
    let out = extrude(&mesh, Direction::FaceNormal, 1.0).expect("has area");
    let us = |face: usize| -> Vec<f64> { out.mesh.faces[face].uv(3).expect("kept").iter().map(|uv| uv.x).collect() };
    assert_eq!(us(1), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    assert_eq!(us(0), [1.0, 0.0, 3.0, 2.0, 5.0, 4.0, 7.0, 6.0]);
    assert_eq!(us(5), [3.0, 0.0, 0.0, 3.0]);
    assert_eq!(us(9), [7.0, 4.0, 4.0, 7.0]);
}

proptest! {
    #[test]
    fn volume_is_area_times_height(radii in prop::collection::vec(5.0f64..10.0, 3..20), hole in prop::collection::vec(0.5f64..2.4, 3..9), height in -20.0f64..20.0, tilt in -1.0f64..1.0) {
        prop_assume!(height.abs() > 0.01);
        let star = |radii: &[f64], turn: f64| -> Vec<DVec2> {
            let step = turn * std::f64::consts::TAU / radii.len() as f64;
            radii.iter().enumerate().map(|(i, r)| DVec2::new(libm::cos(step * i as f64), libm::sin(step * i as f64)) * *r).collect()
        };
        let outer = star(&radii, 1.0);
        prop_assume!(radii.len() > 4);
        let polygon = Polygon { outer, holes: vec![star(&hole, -1.0)] };
        let mut mesh = lot(&polygon);
        mesh.positions.iter_mut().for_each(|p| p.y += p.x * tilt);
        let area = mesh.area(&mesh.faces[0]);
        let out = extrude(&mesh, Direction::FaceNormal, height).expect("has area");
        prop_assert!(is_closed(&out.mesh));
        prop_assert!((volume(&out.mesh) - area * height.abs()).abs() < 1e-9 * area * height.abs());
        let sides: f64 = polygon.rings().flat_map(|r| (0..r.len()).map(move |i| (r[i], r[(i + 1) % r.len()]))).map(|(a, b)| a.distance(b)).sum();
        let upright = extrude(&lot(&polygon), Direction::Along(DVec3::Y), height).expect("has area");
        prop_assert!((surface_area(&upright.mesh) - 2.0 * polygon.area() - sides * height.abs()).abs() < 1e-8 * sides * 20.0);
    }
}
