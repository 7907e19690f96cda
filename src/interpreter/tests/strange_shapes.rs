//! Planar operations on shapes and arguments they were not made for: nothing panics, nothing is lost without a word,
//! and what comes out is finite.

use super::*;
use crate::geometry::Face;
use crate::geometry::mesh_checks::{is_closed, missing_vertices, non_finite_vertices, volume};
use proptest::prelude::*;

/// Operations with a hole for a number.
const OPERATIONS: &[&str] = &[
    "scatter(surface, 3, uniform) { P. }",
    "scatter(surface, 3, gaussian, center, #) { P. }",
    "scatter(volume, #, uniform) { P. }",
    "scatter(scope, 3, gaussian, top, '#) { P. }",
    "split(u, uvSpace, 0) { # : P. | ~1 : P. }*",
    "setupProjection(0, scope.xz, 1, 1) projectUV(0) split(v, unitSpace, 0) { ~# : P. | 0.5 : P. }*",
    "split(x) { # : P. | ~1 : P. }",
    "split(z, noAdjust) { '# : P. | ~# : P. }",
    "splitArea(x) { # : P. | ~1 : P. }",
    "splitArea(z, noAdjust) { ~# : P. | '0.3 : P. }",
    "setback(#) { all : P. | remainder : P. }",
    "setback([#, 1, #]) { front = P. | 2 : P. | remainder = P. }",
    "setback(#) { uv.left : P. | remainder : P. }",
    "setbackPerEdge(# * comp.index) { all =: P. | remainder : P. }",
    "setbackToArea(#) { all = P. | remainder = P. }",
    "setbackToArea(5, [#], [2, #, 1]) { front : P. | left : P. | remainder = P. }",
    "shapeL(#, 1) { shape : P. | remainder : P. }",
    "shapeU(1, #, 2) { shape : P. | remainder : P. }",
    "shapeO(#, 1, 1, #) { shape : P. | remainder : P. }",
    "splitAndSetbackPerimeter(#) { ~3 : # : P. | 1 : 1 : P. }* { remainder : P. }",
    "splitAndSetbackPerimeter('#, #, [true, false, true]) { ~3 : 1 : P. }* { remainder : P. }",
    "innerRectangle(edge) { shape : P. | remainder : P. }",
    "innerRectangle(scope) { shape : P. | remainder : P. }",
    "offset(#) P.",
    "offset(#, inside) P.",
    "offset(#, border) P.",
    "alignScopeToGeometryBBox(zx) P.",
    "convexify P.",
    "convexify(#) P.",
    "rectify(#) P.",
    "reduceGeometry(#) P.",
    "cleanupGeometry(all, #) P.",
    "footprint() P.",
    "taper(#) P.",
    "envelope(normal, 5, #, 50) P.",
    "envelope(world.up, #, 2, 50, 1, #, 2, 60) P.",
    "envelope(normal, 4, [#, 1], [45, #, 45]) P.",
];

const NUMBERS: &[&str] = &["1", "0", "-1", "0.0000001", "1e9", "(0/0)", "3.7"];

fn mesh(points: &[(f64, f64, f64)], faces: &[&[u32]]) -> Mesh {
    let positions = points.iter().map(|&(x, y, z)| DVec3::new(x, y, z)).collect();
    Mesh { positions, faces: faces.iter().map(|ring| Face::new(ring.to_vec())).collect() }
}

fn shapes() -> Vec<(&'static str, Mesh)> {
    let square = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 0.0, -4.0), (0.0, 0.0, -4.0)];
    let mut frame = ground(&[(0.0, 0.0), (9.0, 0.0), (9.0, -9.0), (0.0, -9.0)]);
    frame.positions.extend([(3.0, 3.0), (3.0, 6.0), (6.0, 6.0), (6.0, 3.0)].map(|(x, z)| DVec3::new(x, 0.0, -z)));
    frame.faces[0].holes.push(vec![4, 5, 6, 7].into());
    let mut tiny = ground(SMALL);
    tiny.positions.iter_mut().for_each(|p| *p *= 1e-7);
    let mut huge = ground(SMALL);
    huge.positions.iter_mut().for_each(|p| *p *= 1e7);
    let mut far = ground(SMALL);
    far.positions.iter_mut().for_each(|p| *p += DVec3::new(3e6, 0.0, -5e6));
    vec![
        ("nothing", Mesh::default()),
        ("a point", mesh(&square[..1], &[])),
        ("a line", mesh(&[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)], &[&[0, 1, 2]])),
        ("a lot", ground(SMALL)),
        ("a clockwise lot", mesh(&square, &[&[0, 3, 2, 1]])),
        ("a bow", mesh(&square, &[&[0, 2, 1, 3]])),
        (
            "a twisted quad",
            mesh(&[(0.0, 0.0, 0.0), (4.0, 1.0, 0.0), (4.0, 0.0, -4.0), (0.0, 2.0, -4.0)], &[&[0, 1, 2, 3]]),
        ),
        (
            "an upright face",
            mesh(&[(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, 0.0), (0.0, 4.0, 0.0)], &[&[0, 1, 2, 3]]),
        ),
        (
            "two faces",
            mesh(
                &[
                    (0.0, 0.0, 0.0),
                    (4.0, 0.0, 0.0),
                    (4.0, 0.0, -4.0),
                    (0.0, 0.0, -4.0),
                    (8.0, 2.0, 0.0),
                    (8.0, 2.0, -4.0),
                ],
                &[&[0, 1, 2, 3], &[1, 4, 5, 2]],
            ),
        ),
        ("a frame", frame),
        ("a tiny lot", tiny),
        ("a huge lot", huge),
        ("a lot far away", far),
        ("a spike", ground(&[(0.0, 0.0), (10.0, 0.0), (0.001, -0.001), (0.0, -5.0)])),
        ("straight corners", ground(&[(0.0, 0.0), (2.0, 0.0), (5.0, 0.0), (5.0, -3.0), (5.0, -5.0), (0.0, -5.0)])),
    ]
}

fn checked(rules: &str, program: &Program, name: &str, mesh: Mesh) -> ShapeTree {
    let limits = Limits { max_shapes: 400, max_vertices: 8_000, ..Limits::default() };
    let tree = derive(program, &start(mesh, 0), &NoAssets, &limits);
    for leaf in &tree.leaves {
        assert!(
            missing_vertices(&leaf.mesh).is_empty() && non_finite_vertices(&leaf.mesh).is_empty(),
            "{name}: {rules}"
        );
    }
    tree
}

#[test]
fn any_operation_with_any_number_on_any_shape() {
    for operation in OPERATIONS {
        let numbers = if operation.contains('#') { NUMBERS } else { &NUMBERS[..1] };
        for number in numbers {
            let rules = format!("Lot --> {}", operation.replace('#', number));
            let program = compiled(&rules);
            for (name, mesh) in shapes() {
                checked(&rules, &program, name, mesh);
            }
        }
    }
}

#[test]
fn any_operation_on_edges_points_and_bodies() {
    for before in [
        "comp(e) { 0 : X }",
        "comp(v) { 0 : X }",
        "extrude(3) X",
        "s(0, '1, '1) X",
        "s('1, '1, -3) X",
        "primitiveSphere() X",
    ] {
        for operation in OPERATIONS {
            let rules = format!("Lot --> {before}\nX --> {}", operation.replace('#', "1"));
            checked(&rules, &compiled(&rules), before, ground(SMALL));
        }
    }
}

/// What gives no pieces says why.
#[test]
fn nothing_is_lost_without_a_word() {
    let plain = compiled("Lot --> P.");
    for operation in OPERATIONS {
        let rules = format!("Lot --> {}", operation.replace('#', "(0/0)"));
        let program = compiled(&rules);
        for (name, mesh) in shapes() {
            let tree = checked(&rules, &program, name, mesh.clone());
            let was_there = !checked("", &plain, name, mesh).leaves.is_empty();
            assert!(!was_there || !tree.leaves.is_empty() || !tree.diagnostics.is_empty(), "{name}: {rules}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn operations_in_a_row(picks in prop::collection::vec((0..OPERATIONS.len(), 0..NUMBERS.len()), 1..5), shape in 0..15usize) {
        let mut rules = String::from("Lot --> R0\n");
        for (i, (operation, number)) in picks.iter().enumerate() {
            let body = OPERATIONS[*operation].replace('#', NUMBERS[*number]);
            rules += &format!("R{i} --> {}\n", body.replace("P.", &format!("R{}", i + 1)));
        }
        rules += &format!("R{} --> P.", picks.len());
        let (name, mesh) = shapes().swap_remove(shape);
        checked(&rules, &compiled(&rules), name, mesh);
    }

    #[test]
    fn tapers_are_closed_and_hold_a_third(radii in prop::collection::vec(2.0..20.0f64, 3..9), height in 0.1..30.0f64) {
        let n = radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
            (r * cos, -r * sin)
        };
        let lot: Vec<(f64, f64)> = radii.iter().enumerate().map(corner).collect();
        let area = areas(&derived("Lot --> A.", ground(&lot)), "A")[0];
        for height in [height, -height] {
            let tree = derived(&format!("Lot --> taper({height})"), ground(&lot));
            let mesh = &tree.leaves[0].mesh;
            prop_assert!(is_closed(mesh));
            prop_assert!((volume(mesh) - area * height.abs() / 3.0).abs() < 1e-6 * area * height.abs());
        }
    }
}
