//! Reference 4.3.5: splits in texture space.

use super::*;

/// The lot with set 0 running 0..4 along x and 0..2 from the front to the back.
const MAPPED: &str = "Lot --> setupProjection(0, scope.xz, 5, -5, 0, -10) projectUV(0) Mapped\n";

#[track_caller]
fn pieces(split: &str) -> ShapeTree {
    run(&format!("{MAPPED}Mapped --> {split}"), LOT)
}

#[test]
fn in_texture_units_and_in_metres() {
    near(&areas(&pieces("split(u, uvSpace, 0) { 1 : A. | ~1 : A. | '0.25 : A. }"), "A"), &[50.0, 100.0, 50.0]);
    near(&areas(&pieces("split(u, unitSpace, 0) { 6 : A. | ~1 : A. }"), "A"), &[60.0, 140.0]);
    near(&areas(&pieces("split(v, unitSpace, 0) { 3 : A. | ~1 : B. }"), "A"), &[60.0]);
    near(&areas(&pieces("split(v, uvSpace, 0) { { ~0.5 : A. }* }"), "A"), &[50.0; 4]);
    let front = pieces("split(v, uvSpace, 0) { 0.5 : A. }");
    near(&[front.leaves[0].mesh.bounds().expect("a face").0.z], &[197.5]);
}

#[test]
fn the_example_of_the_reference() {
    let tree = pieces("split(u, unitSpace, 0) { 6 : Lane. | ~1 : NIL }*");
    // s(n) = (20 - 6 n) / n: n = 3 gives 2/3, the nearest to 1.
    near(&areas(&tree, "Lane"), &[60.0; 3]);
}

#[test]
fn pieces_are_numbered_fitted_and_keep_their_coordinates() {
    let rules = r#"split(u, uvSpace, 0) { 1 : P }*"#.to_owned()
        + "\nP --> print(split.index + \" \" + split.total + \" \" + scope.sx + \" \" + geometry.uMin(0) + \" \" + geometry.uMax(0)) NIL";
    let lines = numbers(&pieces(&rules));
    assert_eq!(lines.len(), 4);
    near(&lines[2], &[2.0, 4.0, 5.0, 2.0, 3.0]);
}

#[test]
fn around_the_corner_of_a_folded_surface() {
    // Three walls in a row, u runs around them in metres.
    let rules = "Lot --> extrude(4) comp(f) { 2 : W(0) | 3 : W(20) | 4 : W(30) }\n\
        W(from) --> setupProjection(0, scope.xy, 1, 1, from, 0) projectUV(0) split(u, uvSpace, 0) { ~4 : A. | ~1 : B. }*";
    let tree = run(rules, LOT);
    let sum: f64 = tree.leaves.iter().flat_map(|l| l.mesh.faces.iter().map(|f| l.mesh.area(f))).sum();
    near(&[sum], &[50.0 * 4.0]);
    let whole = run(
        "Lot --> extrude(4) setupProjection(0, scope.xy, 1, 1, 0, 0, 1) projectUV(0) split(u, uvSpace, 0) { ~1 : A. }*",
        SMALL,
    );
    // u = x + z: all six faces are cut and nothing is lost or capped.
    let sum: f64 = whole.leaves.iter().flat_map(|l| l.mesh.faces.iter().map(|f| l.mesh.area(f))).sum();
    near(&[sum], &[2.0 * 60.0 + 32.0 * 4.0]);
    assert_eq!(whole.leaves.len(), 16);
}

#[test]
fn without_coordinates_there_are_no_pieces() {
    let codes = |rules: &str| -> Vec<&'static str> {
        let tree = derived(rules, ground(LOT));
        assert!(tree.leaves.is_empty(), "{rules}");
        tree.diagnostics.iter().map(|d| d.code).collect()
    };
    assert_eq!(codes("Lot --> split(u, uvSpace, 0) { ~1 : A. }"), ["cga::no-uv"]);
    assert_eq!(codes("Lot --> split(u, uvSpace, 11) { ~1 : A. }"), ["cga::uv-set"]);
    assert_eq!(
        codes("Lot --> setupProjection(0, scope.xy, 1, 1) projectUV(0) split(v, uvSpace, 0) { ~1 : A. }"),
        ["cga::split-flat"]
    );
}
