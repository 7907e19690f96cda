//! In: boxes and polygons. Out: what is near what, against slower ways to find it.

use glam::{DMat3, DVec3};
use proptest::prelude::*;

use super::*;

/// A box of a size at a corner, turned about the vertical (degrees).
fn block(corner: [f64; 3], size: [f64; 3], turn: f64) -> Mesh {
    let body = oriented(corner, size, turn);
    let faces = [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6], [2, 3, 1, 0]];
    let faces = faces.iter().map(|f: &[u32; 4]| Face::new(f.to_vec())).collect();
    let mesh = Mesh { positions: body.corners().to_vec(), faces };
    assert!(crate::geometry::mesh_checks::volume(&mesh) > 0.0);
    mesh
}

fn oriented(corner: [f64; 3], size: [f64; 3], turn: f64) -> OrientedBox {
    let (sin, cos) = libm::sincos(turn.to_radians());
    let axes = DMat3::from_cols(DVec3::new(cos, 0.0, -sin), DVec3::Y, DVec3::new(sin, 0.0, cos));
    OrientedBox { origin: corner.into(), axes, size: size.into() }
}

fn meeting(solid: &Mesh, other: &Mesh) -> Meeting {
    let solid = Solid::new(solid).expect("it is closed");
    other.faces.iter().map(|f| solid.meeting(other, f)).fold(Meeting::default(), Meeting::or)
}

const UNIT: [f64; 3] = [1.0; 3];

#[test]
fn a_block_against_blocks() {
    let cube = block([0.0; 3], [4.0; 3], 0.0);
    let case = |corner: [f64; 3], size: [f64; 3]| {
        let m = meeting(&cube, &block(corner, size, 0.0));
        [m.inside, m.outside, m.same, m.opposite]
    };
    assert_eq!(case([1.0; 3], UNIT), [true, false, false, false], "within");
    assert_eq!(case([0.0; 3], UNIT), [true, false, true, false], "in a corner");
    assert_eq!(case([0.0; 3], [4.0; 3]), [false, false, true, false], "the same");
    assert_eq!(case([4.0, 1.0, 1.0], UNIT), [false, true, false, true], "beside");
    assert_eq!(case([4.0, 4.0, 0.0], [4.0; 3]), [false, true, false, false], "along an edge");
    assert_eq!(case([3.5, 1.0, 1.0], UNIT), [true, true, false, false], "half in");
    assert_eq!(case([9.0; 3], UNIT), [false, true, false, false], "far");
    assert_eq!(case([-1.0; 3], [6.0; 3]), [false, true, false, false], "around");
}

#[test]
fn within_the_tolerance_shapes_touch_and_beyond_they_do_not() {
    let cube = block([0.0; 3], [4.0; 3], 0.0);
    for (gap, touching) in [(-0.9e-3, true), (0.0, true), (1e-9, true), (0.9e-3, true), (1.2e-3, false)] {
        let m = meeting(&cube, &block([4.0 + gap, 1.0, 1.0], UNIT, 0.0));
        assert_eq!((m.opposite, m.inside), (touching, false), "{gap}");
    }
    let m = meeting(&cube, &block([4.0 - 5e-3, 1.0, 1.0], UNIT, 0.0));
    assert_eq!((m.inside, m.opposite), (true, false));
}

#[test]
fn open_meshes_are_no_solids_and_seams_do_not_open_them() {
    let mut cube = block([0.0; 3], UNIT, 0.0);
    cube.faces.pop();
    assert!(Solid::new(&cube).is_none());
    let cube = block([0.0; 3], UNIT, 0.0);
    let mut seamed = Mesh::default();
    for face in &cube.faces {
        let start = seamed.positions.len() as u32;
        seamed.positions.extend(face.corners().map(|v| cube.positions[v as usize]));
        seamed.faces.push(Face::new((start..start + 4).collect::<Vec<u32>>()));
    }
    assert!(Solid::new(&seamed).is_some());
}

#[test]
fn points_and_lines() {
    let solid = Solid::new(&block([0.0; 3], [4.0; 3], 30.0)).expect("it is closed");
    let middle = solid.bounds.lo.midpoint(solid.bounds.hi);
    assert_eq!(solid.locate(middle), Location::Inside);
    assert_eq!(solid.locate(solid.mesh.positions[3]), Location::Surface);
    assert_eq!(solid.locate(solid.bounds.hi), Location::Outside);
    let up = DVec3::Y * 9.0;
    use Location::{Inside, Outside};
    assert_eq!(solid.locations(middle - up, middle + up), [Outside, Inside, Outside]);
}

/// Points of a grid in a box.
fn samples(body: &OrientedBox) -> Vec<DVec3> {
    let steps = || (0..=12).map(|i| f64::from(i) / 12.0);
    let places = steps().flat_map(|x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))));
    places.map(|q| body.origin + body.axes * (body.size * q)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// A face turned and moved into the solid's plane lies to it as its samples do.
    #[test]
    fn meetings_agree_with_points(
        corner in prop::array::uniform3(-4.0..4.0f64), size in prop::array::uniform3(0.5..4.0f64), turn in 0.0..360.0f64
    ) {
        let cube = block([0.0; 3], [4.0; 3], 0.0);
        let solid = Solid::new(&cube).expect("it is closed");
        let other = block(corner, size, turn);
        for face in &other.faces {
            let m = solid.meeting(&other, face);
            let c = |i: usize| other.positions[face.outer[i] as usize];
            let steps = || (0..=20).map(|i| 0.01 + 0.98 * f64::from(i) / 20.0);
            for (s, t) in steps().flat_map(|s| steps().map(move |t| (s, t))) {
                let p = c(0) + (c(1) - c(0)) * s + (c(3) - c(0)) * t;
                let depth = p.min(DVec3::splat(4.0) - p).min_element();
                // Samples well inside or outside have room for a piece that counts.
                prop_assert!(depth < 0.3 || m.inside, "{p}");
                prop_assert!(depth > -0.3 || m.outside, "{p}");
            }
            let near_all = face.outer.iter().all(|&v| {
                let p = other.positions[v as usize];
                p.min(DVec3::splat(4.0) - p).min_element() > 0.0
            });
            prop_assert!(!near_all || !m.outside);
        }
    }

    /// Turning and moving everything changes nothing.
    #[test]
    fn meetings_do_not_depend_on_the_frame(
        corner in prop::array::uniform3(-4.0..4.0f64), turn in 0.0..360.0f64, axis in prop::array::uniform3(-1.0..1.0f64)
    ) {
        prop_assume!(DVec3::from(axis).length() > 0.1);
        let spin = DMat3::from_axis_angle(DVec3::from(axis).normalize(), 1.0);
        let moved = |mesh: &Mesh| {
            let positions = mesh.positions.iter().map(|p| spin * *p + DVec3::new(731.0, 12.0, -517.0)).collect();
            Mesh { positions, faces: mesh.faces.clone() }
        };
        let corner = corner.map(|c| (c * 2.0).round() / 2.0);
        let (a, b) = (block([0.0; 3], [4.0; 3], 0.0), block(corner, [1.0, 2.0, 3.0], (turn / 90.0).round() * 90.0));
        prop_assert_eq!(meeting(&a, &b), meeting(&moved(&a), &moved(&b)));
    }

    #[test]
    fn distances_of_boxes_are_those_of_their_points(
        a in prop::array::uniform3(-6.0..6.0f64), b in prop::array::uniform3(-6.0..6.0f64),
        size in prop::array::uniform3(0.0..4.0f64), turn in 0.0..360.0f64
    ) {
        let (a, b) = (oriented(a, [3.0, 0.0, 2.0], 0.0), oriented(b, size, turn));
        let distance = a.distance(&b);
        prop_assert!((distance - b.distance(&a)).abs() < 1e-9);
        let nearest = samples(&b).into_iter().map(|p| a.distance_to(p)).fold(f64::INFINITY, f64::min);
        prop_assert!(distance <= nearest + 1e-9);
        prop_assert!(nearest - distance < 0.4, "{nearest} {distance}");
    }
}

#[test]
fn boxes_at_known_distances() {
    let a = oriented([0.0; 3], [2.0; 3], 0.0);
    assert_eq!(a.distance(&oriented([5.0, 0.0, 0.0], UNIT, 0.0)), 3.0);
    assert_eq!(a.distance(&oriented([5.0, 6.0, 0.0], UNIT, 0.0)), 5.0);
    assert_eq!(a.distance(&oriented([5.0, 0.0, 0.0], [-1.0, 1.0, 1.0], 0.0)), 2.0);
    assert_eq!(a.distance(&oriented([0.5; 3], UNIT, 0.0)), 0.0);
    // A beam through the middle has no corner in the cube.
    assert_eq!(a.distance(&oriented([-9.0, 0.9, 0.9], [20.0, 0.1, 0.1], 0.0)), 0.0);
    // Edge against edge: a level rod passes the upright edge at (2, 2) askew.
    let axes =
        DMat3::from_cols(DVec3::new(1.0, 0.0, -1.0).normalize(), DVec3::Y, DVec3::new(1.0, 0.0, 1.0).normalize());
    let middle = DVec3::new(3.0, 1.0, 3.0);
    let rod = OrientedBox { origin: middle - axes.x_axis * 2.0, axes, size: DVec3::new(4.0, 0.0, 0.0) };
    assert!((a.distance(&rod) - std::f64::consts::SQRT_2).abs() < 1e-12);
}
