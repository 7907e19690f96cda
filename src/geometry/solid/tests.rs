//! Volumes add up, closed stays closed, faces lie where they should.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::geometry::Face;
use crate::geometry::mesh_checks::{degenerate_triangles, is_closed, surface_area, volume};
use crate::geometry::transform::transform;

fn cuboid(lo: [f64; 3], hi: [f64; 3]) -> Mesh {
    let pick = |i: usize, axis: usize| if i >> axis & 1 == 1 { hi[axis] } else { lo[axis] };
    let positions = (0..8).map(|i| DVec3::new(pick(i, 0), pick(i, 1), pick(i, 2))).collect();
    let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    Mesh { positions, faces: quads.into_iter().map(|q| Face::new(q.to_vec())).collect() }
}

/// A prism over a star-shaped polygon with these radii, along y from 0 to `height`.
fn prism(radii: &[f64], height: f64) -> Mesh {
    let n = radii.len() as u32;
    let corner = |i: usize, y: f64| {
        let angle = std::f64::consts::TAU * i as f64 / radii.len() as f64;
        DVec3::new(radii[i] * libm::cos(angle), y, -radii[i] * libm::sin(angle))
    };
    let mut mesh = Mesh::default();
    for y in [0.0, height] {
        mesh.positions.extend((0..radii.len()).map(|i| corner(i, y)));
    }
    mesh.faces.push(Face::new((0..n).rev().collect::<Vec<u32>>()));
    mesh.faces.push(Face::new((n..2 * n).collect::<Vec<u32>>()));
    mesh.faces.extend((0..n).map(|i| Face::new(vec![i, (i + 1) % n, (i + 1) % n + n, i + n])));
    mesh
}

fn plane_at(y: f64, half: f64) -> Mesh {
    let positions = vec![
        DVec3::new(-half, y, half),
        DVec3::new(half, y, half),
        DVec3::new(half, y, -half),
        DVec3::new(-half, y, -half),
    ];
    Mesh { positions, faces: vec![Face::new(vec![0, 1, 2, 3])] }
}

fn moved(mesh: &Mesh, turn: [f64; 3], by: [f64; 3]) -> Mesh {
    let axis = DVec3::new(0.3, 0.9, 0.2).normalize();
    let matrix = DMat3::from_axis_angle(axis, turn[0])
        * DMat3::from_axis_angle(DVec3::X, turn[1])
        * DMat3::from_axis_angle(DVec3::Z, turn[2]);
    transform(mesh, &DAffine3::from_mat3_translation(matrix, by.into()))
}

#[track_caller]
fn combined(a: &Mesh, b: &Mesh, operator: Operator) -> Mesh {
    let result = combine(a, b, operator, OpenMeshes::HalfSpaces).expect("the operands are fine");
    assert_eq!(result.mesh.faces.len(), result.origins.len());
    result.mesh
}

/// Checks what must hold for closed operands; gives the volumes of union, difference and intersection.
#[track_caller]
fn volumes(a: &Mesh, b: &Mesh) -> [f64; 3] {
    let out = [Operator::Union, Operator::Subtract, Operator::Intersect].map(|operator| {
        let mesh = combined(a, b, operator);
        assert!(mesh.faces.is_empty() || is_closed(&mesh), "{operator:?} is open");
        assert!(degenerate_triangles(&mesh).is_empty(), "{operator:?} has faces that cannot be filled");
        volume(&mesh)
    });
    let (va, vb) = (volume(a), volume(b));
    let close = |x: f64, y: f64| (x - y).abs() <= 1e-6 * (va + vb);
    assert!(close(out[0] + out[2], va + vb), "union {} + intersection {} is not {va} + {vb}", out[0], out[2]);
    assert!(close(out[1], va - out[2]), "difference {} is not {va} - {}", out[1], out[2]);
    out
}

#[track_caller]
fn near(got: [f64; 3], expected: [f64; 3]) {
    assert!(got.iter().zip(expected).all(|(g, e)| (g - e).abs() < 1e-9), "{got:?}, not {expected:?}");
}

#[test]
fn boxes_in_every_position() {
    let a = cuboid([0.0; 3], [4.0, 4.0, 4.0]);
    let b = |lo: [f64; 3], hi: [f64; 3]| volumes(&a, &cuboid(lo, hi));
    near(b([1.0, 1.0, 1.0], [6.0, 6.0, 6.0]), [64.0 + 125.0 - 27.0, 37.0, 27.0]);
    near(b([0.0; 3], [4.0, 4.0, 4.0]), [64.0, 0.0, 64.0]); // the same
    near(b([4.0, 0.0, 0.0], [6.0, 4.0, 4.0]), [96.0, 64.0, 0.0]); // wall to wall
    near(b([4.0, 1.0, 1.0], [6.0, 3.0, 3.0]), [72.0, 64.0, 0.0]); // against the middle of a wall
    near(b([4.0, 4.0, 0.0], [6.0, 6.0, 4.0]), [80.0, 64.0, 0.0]); // edge to edge
    near(b([4.0, 4.0, 4.0], [6.0, 6.0, 6.0]), [72.0, 64.0, 0.0]); // corner to corner
    near(b([1.0, 1.0, 1.0], [3.0, 3.0, 3.0]), [64.0, 56.0, 8.0]); // inside
    near(b([1.0, 1.0, -1.0], [3.0, 3.0, 5.0]), [64.0 + 8.0, 48.0, 16.0]); // right through
    near(b([0.0, 0.0, 0.0], [2.0, 4.0, 4.0]), [64.0, 32.0, 32.0]); // half, flush
    near(b([1.0, 0.0, 1.0], [3.0, 4.0, 3.0]), [64.0, 48.0, 16.0]); // a shaft, flush above and below
    near(b([9.0; 3], [10.0; 3]), [65.0, 64.0, 0.0]); // apart
}

#[test]
fn faces_stay_whole_where_they_can() {
    let a = cuboid([0.0; 3], [4.0, 4.0, 4.0]);
    let niche = combined(&a, &cuboid([1.0, 1.0, 3.0], [3.0, 3.0, 5.0]), Operator::Subtract);
    // Six faces, the front with a hole, and five of the niche.
    assert_eq!((niche.faces.len(), niche.positions.len()), (11, 16));
    assert_eq!(niche.faces.iter().filter(|f| f.holes.len() == 1).count(), 1);
    let joined = combined(&a, &cuboid([4.0, 0.0, 0.0], [6.0, 4.0, 4.0]), Operator::Union);
    assert_eq!((joined.faces.len(), joined.positions.len()), (10, 12));
    let apart = combined(&a, &cuboid([4.0, 1.0, 1.0], [6.0, 3.0, 3.0]), Operator::Subtract);
    assert_eq!(apart, a);
}

#[test]
fn first_edges_and_texture_coordinates_survive() {
    let mut a = cuboid([0.0; 3], [4.0, 4.0, 4.0]);
    for face in &mut a.faces {
        let uv = face.outer.iter().map(|&v| DVec2::new(a.positions[v as usize].x, a.positions[v as usize].y)).collect();
        face.uvs.push((0, uv));
    }
    let result = combine(&a, &cuboid([3.0, 3.0, 3.0], [5.0; 3]), Operator::Subtract, OpenMeshes::HalfSpaces);
    let result = result.expect("boxes combine");
    for (face, origin) in result.mesh.faces.iter().zip(&result.origins) {
        let at = |i: usize| result.mesh.positions[face.outer[i] as usize];
        if origin.operand == 1 {
            assert!(face.uvs.is_empty());
            continue;
        }
        let corners = face.outer.iter().map(|&v| result.mesh.positions[v as usize]);
        assert!(corners.zip(&face.uvs[0].1).all(|(p, uv)| p.x == uv.x && p.y == uv.y));
        let old = &a.faces[origin.face as usize].outer;
        assert_eq!(at(0), a.positions[old[0] as usize]);
        let along = a.positions[old[1] as usize] - a.positions[old[0] as usize];
        assert!((at(1) - at(0)).cross(along).length() < 1e-12);
    }
    // Three edges of the cut in each of the three cut faces.
    assert_eq!(result.cuts.len(), 6);
}

#[test]
fn planes_are_half_spaces_unless_they_end_inside() {
    // A ball and a plane through its middle, normal up.
    let ball = moved(&prism(&[2.0; 8], 4.0), [0.0; 3], [0.0, -2.0, 0.0]);
    let (top, side) = (surface_area(&plane_at(0.0, 1.0)), 0.0);
    assert_eq!((top, side), (4.0, 0.0));
    let octagon = volume(&ball) / 4.0;
    let wall = (surface_area(&ball) - 2.0 * octagon) / 2.0;
    let plane = plane_at(0.0, 5.0);
    let area = |a: &Mesh, b: &Mesh, operator| surface_area(&combined(a, b, operator));
    let close = |got: f64, expected: f64| assert!((got - expected).abs() < 1e-9, "{got}, not {expected}");
    close(area(&plane, &ball, Operator::Union), 100.0 - octagon + wall + octagon);
    close(area(&plane, &ball, Operator::Subtract), 100.0 - octagon + wall + octagon);
    let upper = combined(&ball, &plane, Operator::Subtract);
    assert!(is_closed(&upper));
    close(volume(&upper), octagon * 2.0);
    assert!(upper.bounds().expect("half a ball").0.y.abs() < 1e-12);
    let lower = combined(&plane, &ball, Operator::Intersect);
    assert!(is_closed(&lower));
    assert!(lower.bounds().expect("half a ball").1.y.abs() < 1e-12);
    // It ends inside the ball.
    let small = plane_at(0.0, 0.5);
    close(area(&small, &ball, Operator::Union), surface_area(&ball));
    assert!(combined(&small, &ball, Operator::Subtract).faces.is_empty());
    assert_eq!(combined(&ball, &small, Operator::Subtract).faces.len(), ball.faces.len());
    close(area(&small, &ball, Operator::Intersect), 1.0);
    // As a surface it encloses nothing.
    let sheet = combine(&plane, &ball, Operator::Union, OpenMeshes::Surfaces).expect("they combine").mesh;
    close(surface_area(&sheet), 100.0 - octagon + surface_area(&ball));
}

#[test]
fn a_plane_that_ends_on_the_walls_cuts_too() {
    let block = cuboid([-3.0, 0.0, -3.0], [3.0, 4.0, 3.0]);
    let upper = combined(&block, &plane_at(1.0, 3.0), Operator::Subtract);
    assert!(is_closed(&upper));
    assert!((volume(&upper) - 108.0).abs() < 1e-9);
}

#[test]
fn flat_polygons_keep_their_edges() {
    let shifted = moved(&plane_at(0.0, 2.0), [0.0; 3], [2.0, 0.0, 2.0]);
    let areas = |operator| -> Vec<f64> {
        let mesh = combined(&plane_at(0.0, 2.0), &shifted, operator);
        mesh.faces.iter().map(|f| mesh.area(f)).collect()
    };
    assert_eq!(areas(Operator::Union), [12.0, 4.0, 12.0]);
    assert_eq!(areas(Operator::Subtract), [12.0]);
    assert_eq!(areas(Operator::Intersect), [4.0]);
}

#[test]
fn what_cannot_be_combined_is_told() {
    let mut bad = cuboid([0.0; 3], [1.0; 3]);
    bad.positions[0].x = f64::NAN;
    let good = cuboid([0.0; 3], [1.0; 3]);
    assert_eq!(combine(&bad, &good, Operator::Union, OpenMeshes::Surfaces), Err(SolidError::NotFinite));
    assert_eq!(combine(&Mesh::default(), &good, Operator::Union, OpenMeshes::Surfaces).map(|c| c.mesh), Ok(good));
}

/// Coordinates on a coarse grid, so that faces, edges and corners often fall together.
fn grid_box() -> impl Strategy<Value = Mesh> {
    let axis = (0..5i32, 1..4i32);
    [axis.clone(), axis.clone(), axis]
        .prop_map(|axes| cuboid(axes.map(|(lo, _)| f64::from(lo)), axes.map(|(lo, size)| f64::from(lo + size))))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn volumes_of_boxes_on_a_grid_add_up(a in grid_box(), b in grid_box(), turn in 0..4u8) {
        let turn = [f64::from(turn) * 0.7, f64::from(turn) * 0.3, 0.0];
        volumes(&moved(&a, turn, [100.0, 3.0, 50.0]), &moved(&b, turn, [100.0, 3.0, 50.0]));
    }

    #[test]
    fn volumes_of_prisms_add_up(
        a in prop::collection::vec(1.0..4.0f64, 3..9),
        b in prop::collection::vec(1.0..4.0f64, 3..9),
        turn in prop::array::uniform3(-3.0..3.0f64),
        by in prop::array::uniform3(-4.0..4.0f64),
    ) {
        volumes(&prism(&a, 3.0), &moved(&prism(&b, 2.0), turn, by));
    }

    #[test]
    fn combining_again_with_the_result_adds_up(a in grid_box(), b in grid_box(), c in grid_box()) {
        let first = combined(&a, &b, Operator::Union);
        prop_assume!(crate::geometry::mesh_checks::edges_used_more_than_twice(&first).is_empty());
        volumes(&first, &c);
    }
}

#[test]
fn a_cut_that_runs_along_an_edge_leaves_no_sliver() {
    let a = prism(&[3.200872109055157, 3.1796945813335373, 1.0], 3.0);
    let turn = [-2.426284028736943, 1.7750767000296577, 2.8232133742220595];
    volumes(&a, &moved(&prism(&[1.0, 1.0, 2.695536563807577], 2.0), turn, [0.0, 2.494019929767064, 0.0]));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]
    #[test]
    fn any_faces_are_answered(
        corners in prop::collection::vec(prop::array::uniform3(-3..4i8), 4..10),
        faces in prop::collection::vec(prop::collection::vec(0..10u32, 0..6), 1..8),
        scale in prop::sample::select(vec![1.0, 1e-9, 1e9, 0.0]),
    ) {
        let positions: Vec<DVec3> = corners.iter().map(|c| DVec3::from(c.map(f64::from)) * scale).collect();
        let wrapped = |f: &Vec<u32>| Face::new(f.iter().map(|v| v % positions.len() as u32).collect::<Vec<_>>());
        let wild = Mesh { faces: faces.iter().map(wrapped).collect(), positions: positions.clone() };
        for operator in [Operator::Union, Operator::Subtract, Operator::Intersect] {
            if let Ok(result) = combine(&wild, &cuboid([-1.0; 3], [2.0; 3]), operator, OpenMeshes::HalfSpaces) {
                prop_assert!(crate::geometry::mesh_checks::missing_vertices(&result.mesh).is_empty());
                prop_assert!(result.mesh.positions.iter().all(|p| p.is_finite()));
            }
        }
    }
}
