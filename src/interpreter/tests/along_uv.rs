//! `insertAlongUV`: reference 4.11.

use super::*;
use crate::geometry::mesh_checks::volume;

/// A 10 x 6 lot with texture set 0 of tiles of `tile` metres, and an asset along it.
fn along(tile: &str, insert: &str) -> ShapeTree {
    run(&format!("Lot --> setupProjection(0, scope.xz, {tile}) projectUV(0) scaleUV(0, 1, -1) {insert}"), SMALL)
}

fn extent(tree: &ShapeTree) -> [f64; 6] {
    let (low, high) = tree.leaves[0].mesh.bounds().expect("there is geometry");
    [low.x, high.x, low.y, high.y, low.z, high.z]
}

fn area_up(mesh: &Mesh) -> f64 {
    mesh.faces.iter().filter(|f| mesh.normal(f).y > 0.9).map(|f| mesh.area(f)).sum()
}

#[test]
fn assets_repeat_along_u_and_cover_one_unit_of_v() {
    // z runs to the back, so v = -z/6 + 0 from 0 at the back to -1: shifted to 0..1.
    let tree = along("2, 6", "translateUV(0, 0, 1) insertAlongUV(0, \"builtin:cube\", 0.5) A.");
    let mesh = &tree.leaves[0].mesh;
    near(&extent(&tree), &[0.0, 10.0, 0.0, 0.5, -6.0, 0.0]);
    assert!((volume(mesh) - 30.0).abs() < 1e-9, "five closed boxes");
    assert!((area_up(mesh) - 60.0).abs() < 1e-9);
    assert_eq!(mesh.faces.len(), 30);
    assert!(mesh.faces.iter().all(|f| f.normals.is_empty() && f.uv(0).is_some()));
}

#[test]
fn tiles_are_cut_at_the_faces() {
    // Two and a half tiles.
    let tree = along("4, 6", "translateUV(0, 0, 1) insertAlongUV(0, \"builtin:cube\", 0.5) A.");
    near(&extent(&tree), &[0.0, 10.0, 0.0, 0.5, -6.0, 0.0]);
    assert!((area_up(&tree.leaves[0].mesh) - 60.0).abs() < 1e-9);
    assert_eq!(tree.leaves[0].mesh.faces.len(), 17, "the cut side is open");
    // Only v from 0 to 1 is covered: a third of the depth.
    let tree = along("4, 2", "translateUV(0, 0, 2) insertAlongUV(0, \"builtin:cube\", 0.5) A.");
    assert!((area_up(&tree.leaves[0].mesh) - 20.0).abs() < 1e-9);
    // A triangle is covered exactly.
    let rules = "Lot --> setupProjection(0, scope.xz, 3, -6) projectUV(0) translateUV(0, 0.3, 1) insertAlongUV(0, \"builtin:cube\", 0.5) A.";
    let tree = run(rules, &[(0.0, 0.0), (10.0, 0.0), (4.0, -6.0)]);
    assert!((area_up(&tree.leaves[0].mesh) - 30.0).abs() < 1e-9);
}

#[test]
fn heights() {
    let insert =
        |args: &str| along("2, 6", &format!("translateUV(0, 0, 1) insertAlongUV(0, \"builtin:cube\", {args}) A."));
    near(&extent(&insert("-0.5"))[2..4], &[-0.5, 0.0]);
    assert!((volume(&insert("-0.5").leaves[0].mesh) - 30.0).abs() < 1e-9, "still looks outwards");
    near(&extent(&insert("0"))[2..4], &[0.0, 0.0]);
    near(&extent(&insert("2, scope.y, keepPosition"))[2..4], &[0.0, 2.0]);
    near(&extent(&insert("2, vertex.normal, alignPosition"))[2..4], &[0.0, 2.0]);
    // Around a block, along the normals of its vertices the pieces meet at the corners.
    let rules = r#"Lot --> extrude(3) comp(f) { side = Walls | all : NIL }
Walls --> setupProjection(0, world.xy, 1, 3) projectUV(0) insertAlongUV(0, "builtin:cube", 1, vertex.normal, alignPosition) A."#;
    let tree = run(rules, SMALL);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let [low, high, ..] = extent(&tree);
    near(&[low, high], &[-half, 10.0 + half]);
}

#[test]
fn mirrored_textures_still_look_outwards() {
    let tree = along("2, 6", "scaleUV(0, -1, 1) translateUV(0, 0, 1) insertAlongUV(0, \"builtin:cube\", 0.5) A.");
    assert!((volume(&tree.leaves[0].mesh) - 30.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_covered_is_told() {
    let codes = |rules: &str| {
        let tree = derived(rules, ground(SMALL));
        (tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), tree.leaves.len())
    };
    assert_eq!(codes("Lot --> insertAlongUV(0, \"builtin:cube\", 1) A."), (vec!["cga::no-uv"], 1));
    let project = "Lot --> setupProjection(0, scope.xz, 2, -6) projectUV(0)";
    assert_eq!(codes(&format!("{project} insertAlongUV(0, \"builtin:cube\", 1) A.")), (vec!["cga::no-uv"], 0));
    assert_eq!(codes(&format!("{project} insertAlongUV(11, \"builtin:cube\", 1) A.")).0, ["cga::uv-set"]);
    let missing = codes(&format!("{project} translateUV(0, 0, 1) insertAlongUV(0, \"no.obj\", 1) A."));
    assert_eq!(missing, (vec!["cga::missing-asset"], 1));
    let many = codes(
        "Lot --> setupProjection(0, scope.xz, 0.0000001, -6) projectUV(0) translateUV(0, 0, 1) insertAlongUV(0, \"builtin:cube\", 1) A.",
    );
    assert_eq!(many.0, ["cga::limit-vertices"]);
}
