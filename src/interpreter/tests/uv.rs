//! Texture coordinates: reference 4.14, 10.7, A29.

use proptest::prelude::*;

use super::*;

/// Least and greatest u, then v, of a set over all leaves.
fn range(tree: &ShapeTree, set: u8) -> Option<[f64; 4]> {
    let faces = tree.leaves.iter().flat_map(|l| &l.mesh.faces);
    let all: Vec<DVec2> = faces.filter_map(|f| f.uv(set)).flatten().copied().collect();
    let low = all.iter().copied().reduce(DVec2::min)?;
    let high = all.iter().copied().reduce(DVec2::max)?;
    Some([low.x, high.x, low.y, high.y])
}

/// The facade of a house of 4 x 5 m and 3 m height, its lower left corner at (0, 0, 0).
#[track_caller]
fn facade(operations: &str) -> ShapeTree {
    let rules = format!("Lot --> extrude(3) comp(f) {{ front : {operations} A. }}");
    run(&rules, &[(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)])
}

#[track_caller]
fn ranges(operations: &str, set: u8, expected: [f64; 4]) {
    near(&range(&facade(operations), set).expect("the leaf has uvs"), &expected);
}

#[test]
fn projections_of_every_form() {
    for (setup, expected) in [
        ("scope.xy, 2, 1.5", [0.0, 2.0, 0.0, 2.0]),
        ("scope.xy, ~1.5, '0.5", [0.0, 3.0, 0.0, 2.0]),
        ("scope.xy, '1, '1", [0.0, 1.0, 0.0, 1.0]),
        ("scope.xy, -2, 1.5", [-2.0, 0.0, 0.0, 2.0]),
        ("scope.xy, ~-1.5, '-0.5", [-3.0, 0.0, -2.0, 0.0]),
        ("scope.yx, 1, 1", [0.0, 3.0, 0.0, 4.0]),
        ("scope.xy, 1, 1, 1, '0.5", [1.0, 5.0, 1.5, 4.5]),
        ("scope.xy, 2, 1, -1, 0, 0", [-0.5, 1.5, 0.0, 3.0]),
        ("world.xy, 2, 3", [0.0, 2.0, 0.0, 1.0]),
        ("world.xy, '0.5, ~1.4", [0.0, 2.0, 0.0, 2.0]),
        // The facade lies at z = 0 of the world.
        ("world.xz, 1, 1", [0.0, 4.0, 0.0, 0.0]),
    ] {
        ranges(&format!("setupProjection(0, {setup}) projectUV(0)"), 0, expected);
    }
}

#[test]
fn the_third_axis_runs_into_u() {
    // A box 4 x 3 x 5 projected on xy of its front: with a factor of 1 the side at x = 4 goes on where the front ends,
    // and its depth z runs from 0 at the front to -5 at the back.
    let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)];
    for (factor, least) in [("1", -5.0), ("0", 0.0), ("-1", 0.0)] {
        let seven = format!("setupProjection(0, world.xy, 1, 1, 0, 0, {factor})");
        let five = format!("setupProjection(0, world.xy, 1, 1, {factor})");
        for setup in [seven, five] {
            let tree = derived(&format!("Lot --> extrude(3) {setup} projectUV(0) A."), ground(&corners));
            let range = range(&tree, 0).expect("there are uvs");
            assert!((range[0] - least).abs() < 1e-9, "{setup}: {range:?}");
        }
    }
    ranges("setupProjection(0, world.xy, 2, 1, 1, 0, 5) projectUV(0)", 0, [0.5, 2.5, 0.0, 3.0]);
}

#[test]
fn no_seam_starts_again_in_parts() {
    let rules = "setupProjection(0, scope.xy, 2, 1.5) split(x) { ~1 : projectUV(0) L. | ~1 : t(0, 0, 0) projectUV(0) R. } [ NIL ]";
    let tree = run(
        &format!("Lot --> extrude(3) comp(f) {{ front : {rules} }}"),
        &[(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)],
    );
    let of = |rule: &str| {
        let own = ShapeTree {
            leaves: tree.leaves.iter().filter(|l| &*l.rule == rule).cloned().collect(),
            ..ShapeTree::default()
        };
        range(&own, 0).expect("uvs")
    };
    near(&of("L"), &[0.0, 1.0, 0.0, 2.0]);
    near(&of("R"), &[1.0, 2.0, 0.0, 2.0]);
}

#[test]
fn every_set_is_its_own() {
    let all: String =
        (0..10).map(|set| format!("setupProjection({set}, scope.xy, {}, 1) projectUV({set}) ", set + 1)).collect();
    let tree = facade(&all);
    for set in 0..10u8 {
        near(&range(&tree, set).expect("uvs"), &[0.0, 4.0 / (f64::from(set) + 1.0), 0.0, 3.0]);
    }
    let odd = facade(&format!("{all} deleteUV(3) deleteUV(3) translateUV(4, 1, 1) copyUV(4, 9)"));
    assert_eq!(range(&odd, 3), None);
    near(&range(&odd, 9).expect("uvs"), &[1.0, 1.8, 1.0, 4.0]);
    near(&range(&odd, 5).expect("uvs"), &[0.0, 4.0 / 6.0, 0.0, 3.0]);
}

#[test]
fn wrong_sets_and_missing_coordinates_are_told() {
    for (operation, code) in [
        ("projectUV(10)", "cga::uv-set"),
        ("setupProjection(0.5, scope.xy, 1, 1)", "cga::uv-set"),
        ("deleteUV(-1)", "cga::uv-set"),
        ("tileUV(12, 1, 1)", "cga::uv-set"),
        ("projectUV(1)", "cga::no-projection"),
        ("setupProjection(0, scope.xy, 0, 1)", "cga::tile-size"),
        ("translateUV(0, 1, 1)", "cga::no-uv"),
        ("scaleUV(0, 1, 1)", "cga::no-uv"),
        ("rotateUV(0, 1)", "cga::no-uv"),
        ("normalizeUV(0, u, separatePerFace)", "cga::no-uv"),
        ("tileUV(0, 1, 1)", "cga::no-uv"),
        ("copyUV(0, 1)", "cga::no-uv"),
    ] {
        let tree = derived(&format!("Lot --> {operation} A."), ground(SMALL));
        let codes: Vec<_> = tree.diagnostics.iter().map(|d| d.code).collect();
        assert_eq!((codes, tree.leaves.len()), (vec![code], 1), "{operation}");
    }
    assert!(derived("Lot --> deleteUV(0) A.", ground(SMALL)).diagnostics.is_empty());
}

#[test]
fn editing() {
    let uv = "setupProjection(0, scope.xy, 1, 1) projectUV(0) ";
    for (operation, expected) in [
        ("translateUV(0, 1, -1)", [1.0, 5.0, -1.0, 2.0]),
        ("scaleUV(0, 2, 0.5)", [0.0, 8.0, 0.0, 1.5]),
        ("scaleUV(0, -1, 1)", [-4.0, 0.0, 0.0, 3.0]),
        ("rotateUV(0, 90)", [-3.0, 0.0, 0.0, 4.0]),
        ("rotateUV(0, -90)", [0.0, 3.0, -4.0, 0.0]),
        ("normalizeUV(0, uv, collectiveAllFaces)", [0.0, 1.0, 0.0, 1.0]),
        ("normalizeUV(0, uvUniform, separatePerFace)", [0.0, 1.0, 0.0, 0.75]),
        ("translateUV(0, 2, 2) normalizeUV(0, u, separatePerFace)", [0.0, 1.0, 2.0, 5.0]),
        ("translateUV(0, 2, 2) normalizeUV(0, v, collectiveAllFaces)", [2.0, 6.0, 0.0, 1.0]),
        ("tileUV(0, 2, ~2)", [0.0, 2.0, 0.0, 2.0]),
        ("tileUV(0, '0.25, '1)", [0.0, 4.0, 0.0, 1.0]),
        ("tileUV(0, -2, 3)", [-2.0, 0.0, 0.0, 1.0]),
        ("translateUV(0, 5, 5) tileUV(0, 0, 1)", [5.0, 9.0, 0.0, 3.0]),
        ("scaleUV(0, 7, 0.1) tileUV(0, 2, 1.5)", [0.0, 2.0, 0.0, 2.0]),
    ] {
        ranges(&format!("{uv}{operation}"), 0, expected);
    }
    // One factor for all faces, or one per face.
    let faces = |kind: &str| {
        let rules = format!(
            "Lot --> extrude(3) setupProjection(0, world.xy, 1, 1) projectUV(0) normalizeUV(0, u, {kind}) comp(f) {{ front : F. | right : R. }}"
        );
        let tree = run(&rules, SMALL);
        let us = |i: usize| {
            tree.leaves[i].mesh.faces[0].uv(0).expect("uvs").iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max)
        };
        (us(0), us(1))
    };
    assert_eq!(faces("collectiveAllFaces"), (1.0, 1.0));
    assert_eq!(faces("separatePerFace"), (1.0, 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever the projection was, after `tileUV(set, w, h)` a step of w metres along the facade is a step of 1 in u.
    #[test]
    fn tiles_have_the_size_that_was_asked_for(
        wall in 2.0..30.0f64, height in 2.0..12.0f64, w in 0.2..4.0f64, h in 0.2..4.0f64,
        first in (0.1..9.0f64, 0.1..9.0f64), scale in (0.1..5.0f64, 0.1..5.0f64),
    ) {
        let rules = format!(
            "Lot --> extrude({height}) comp(f) {{ front : setupProjection(4, scope.xy, {}, {}) projectUV(4) scaleUV(4, {}, {}) tileUV(4, {w}, {h}) A. }}",
            first.0, first.1, scale.0, scale.1
        );
        let tree = derived(&rules, ground(&[(0.0, 0.0), (wall, 0.0), (wall, -5.0), (0.0, -5.0)]));
        prop_assert!(tree.diagnostics.is_empty());
        let mesh = &tree.leaves[0].mesh;
        let face = &mesh.faces[0];
        for (v, uv) in face.corners().zip(face.uv(4).expect("uvs")) {
            let p = mesh.positions[v as usize];
            prop_assert!((uv.x * w - p.x).abs() < 1e-6 && (uv.y * h - p.y).abs() < 1e-6, "{p} {uv}");
        }
    }

    /// Parts project to what the whole projected to.
    #[test]
    fn projections_do_not_depend_on_where_they_are_used(size in 0.3..5.0f64, tile in 0.3..3.0f64, factor in -1.0..1.0f64) {
        let whole = format!("setupProjection(2, scope.xz, {tile}, '0.7, 0.3, '0.1, {factor})");
        let rules = format!("Lot --> extrude(4) {whole} split(x) {{ ~{size} : comp(f) {{ all : t(0, 0, 0) projectUV(2) A. }} }}*");
        let early = format!("Lot --> extrude(4) {whole} projectUV(2) A.");
        let of = |rules: &str| {
            let tree = derived(rules, ground(SMALL));
            let leaves = tree.leaves;
            leaves.into_iter().flat_map(|l| l.mesh.faces.iter().flat_map(|f| {
                let uv = f.uv(2).expect("uvs").to_vec();
                f.corners().zip(uv).map(|(v, uv)| (l.mesh.positions[v as usize], uv)).collect::<Vec<_>>()
            }).collect::<Vec<_>>()).collect::<Vec<(DVec3, DVec2)>>()
        };
        let reference = of(&early);
        for (p, uv) in of(&rules) {
            for (q, expected) in reference.iter().filter(|(q, _)| q.distance(p) < 1e-9) {
                prop_assert!(uv.distance(*expected) < 1e-6, "{p} {q} {uv} {expected}");
            }
        }
    }
}
