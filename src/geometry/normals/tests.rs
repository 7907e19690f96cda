//! Smoothing by angle, and turning faces to one side.

use proptest::prelude::*;

use super::*;
use crate::geometry::extrude::{Direction, extrude};
use crate::geometry::mesh_checks::volume;
use crate::geometry::{PlaneFrame, Polygon};

/// A prism over a regular polygon.
fn prism(sides: usize) -> Mesh {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / sides as f64;
    let outer = (0..sides).map(|i| glam::DVec2::new(libm::cos(angle(i)), libm::sin(angle(i)))).collect();
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(&mut mesh, &Polygon { outer, holes: Vec::new() }, 0.0);
    extrude(&mesh, Direction::FaceNormal, 1.0).expect("a polygon can be extruded").mesh
}

#[test]
fn walls_of_a_round_prism_are_smooth_and_its_ends_flat() {
    let mut mesh = prism(24);
    soften(&mut mesh, 30.0);
    for face in &mesh.faces {
        let normal = mesh.normal(face);
        if normal.y.abs() > 0.5 {
            assert!(face.normals.is_empty());
            continue;
        }
        for (v, n) in face.corners().zip(&face.normals) {
            let radial = mesh.positions[v as usize].with_y(0.0).normalize();
            assert!(n.distance(radial) < 1e-12, "{n} {radial}");
        }
        assert_eq!(face.normals.len(), 4);
    }
    soften(&mut mesh, 14.0);
    assert!(mesh.faces.iter().all(|f| f.normals.is_empty()), "walls differ by 15 degrees");
    soften(&mut mesh, 180.0);
    assert!(mesh.faces.iter().all(|f| f.normals.len() == f.outer.len()));
    let top = mesh.faces.iter().find(|f| mesh.normal(f).y > 0.5).expect("there is a top");
    assert!(top.normals.iter().all(|n| n.y > 0.1 && n.y < 0.9), "means of top and walls");
    soften(&mut mesh, 0.0);
    assert!(mesh.faces.iter().all(|f| f.normals.is_empty()));
}

proptest! {
    #[test]
    fn any_turning_of_faces_is_undone(sides in 3usize..9, turned in any::<u64>()) {
        let straight = prism(sides);
        let mut mesh = straight.clone();
        for (i, face) in mesh.faces.iter_mut().enumerate().filter(|(i, _)| turned >> i & 1 == 1) {
            flip_face(face);
            prop_assert!(i < 64);
        }
        conform(&mut mesh);
        prop_assert!((volume(&mesh) - volume(&straight)).abs() < 1e-12);
        for (a, b) in mesh.faces.iter().zip(&straight.faces) {
            prop_assert!(mesh.normal(a).distance(straight.normal(b)) < 1e-12);
        }
    }

    #[test]
    fn open_sheets_look_up(turned in any::<u8>()) {
        let mut mesh = Mesh {
            positions: (0..9u32).flat_map(|i| [0.0, 1.0].map(|z| DVec3::new(f64::from(i), 0.2 * f64::from(i % 2), -z))).collect(),
            faces: (0..8u32).map(|i| Face::new([2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1].as_slice())).collect(),
        };
        mesh.faces.iter_mut().enumerate().filter(|(i, _)| turned >> i & 1 == 1).for_each(|(_, f)| flip_face(f));
        conform(&mut mesh);
        prop_assert!(mesh.faces.iter().all(|f| mesh.normal(f).y > 0.0));
    }
}
