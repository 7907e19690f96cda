//! Programs that the fuzz target `evaluate` found (docs/fuzzing.md), one test each.

use super::*;

#[track_caller]
fn codes(tree: &ShapeTree) -> Vec<&'static str> {
    tree.diagnostics.iter().map(|d| d.code).collect()
}

/// Cells of vertices beyond what an i64 counts.
#[test]
fn cleanup_far_out_does_not_overflow() {
    let tree = run("Lot --> s('1e29, '1, '1e29) cleanupGeometry(all, 0.5) A.", SMALL);
    let mesh = &tree.leaves[0].mesh;
    assert_eq!((mesh.faces.len(), mesh.positions.len()), (1, 4));
    assert!(mesh.positions.iter().any(|p| p.x > 0.9e30) && mesh.positions.iter().all(|p| p.is_finite()));
}

/// An index that no array reaches.
#[test]
fn elements_at_infinity_pass_the_limit() {
    for call in ["setElems(stringArray(), 0, 1 / 0, \"a\")", "setElems([1, 2], 1e300, 0, 3)", "setElems([1], 1e300, 3)"]
    {
        let tree = derived(&format!("attr a = {call}\nLot --> print(a) A."), ground(SMALL));
        assert_eq!(codes(&tree), ["cga::limit-array"], "{call}");
    }
}

/// Copies of a part were united with it one by one, and parts that could not be united made all later unions fail, in
/// four tries each.
#[test]
fn copies_are_united_in_time() {
    let rules = "Lot --> extrude(3) roofHip(30) union {
        t('0.5, 0, '7) inline { roofShed(byHeight, 0) Leaf. Leaf. Leaf. } Leaf. Leaf. Leaf. | Leaf. } A.";
    let tree = run(rules, SMALL);
    assert_eq!(tree.leaves.len(), 1);
    let once =
        "Lot --> extrude(3) roofHip(30) union { t('0.5, 0, '7) inline { roofShed(byHeight, 0) Leaf. } | Leaf. } A.";
    assert_eq!(tree.leaves[0].mesh, run(once, SMALL).leaves[0].mesh);
}

/// Roofs of a thousandth of a degree: their lines cross each other ever anew.
#[test]
fn nearly_flat_roofs_are_united_in_time() {
    let rules = "Lot --> extrude(3) roofHip(30) inline { mirrorScope(true, true, false) }
        inline { union { Leaf. | roofRidge(byAngle, 0.001) } } A.";
    let tree = derived(rules, ground(SMALL));
    assert_eq!((tree.leaves.len(), codes(&tree)), (1, vec!["cga::boolean"]));
}
