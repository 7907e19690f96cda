//! Reference 4.3; compatibility notes, "Split". The table of sizes is tested beside the sizes themselves.

use super::*;

#[test]
fn floors_count_from_below() {
    let rules = r#"Lot --> extrude(18) split(y) { ~4 : F }*
F --> print(split.index + " " + split.total + " " + scope.sy + " " + scope.elevation) NIL"#;
    let lines = numbers(&run(rules, LOT));
    assert_eq!(lines.len(), 5);
    near(&lines[0], &[0.0, 5.0, 3.6, 0.0]);
    near(&lines[4], &[4.0, 5.0, 3.6, 14.4]);
}

#[test]
fn z_starts_at_the_back() {
    let tree = run("Lot --> split(z) { 3 : Back. | ~1 : Front. }", LOT);
    assert_eq!(areas(&tree, "Back"), [60.0]);
    let (low, _) = tree.leaves[0].mesh.bounds().expect("a face");
    assert_eq!((&*tree.leaves[0].rule, low.z), ("Back", 190.0));
}

#[test]
fn pieces_fit_or_keep_the_slab() {
    let triangle = [(0.0, 0.0), (10.0, 0.0), (0.0, -10.0)];
    let fitted = show_on("split(x) { 5 : NIL | ~1 : Show }", &triangle);
    near(&[fitted.t, fitted.s].concat(), &[5.0, 0.0, -5.0, 5.0, 0.0, 5.0]);
    let slab = show_on("split(x, noAdjust) { 5 : NIL | ~1 : Show }", &triangle);
    near(&[slab.t, slab.s].concat(), &[5.0, 0.0, -10.0, 5.0, 0.0, 10.0]);
}

#[test]
fn closed_blocks_stay_closed() {
    let tree = run("Lot --> extrude(8) split(x) { 3 : A. | ~1 : B. | '0.25 : C. }", LOT);
    let volumes: Vec<f64> = tree.leaves.iter().map(|l| crate::geometry::mesh_checks::volume(&l.mesh)).collect();
    near(&volumes, &[240.0, 960.0, 400.0]);
    assert!(tree.leaves.iter().all(|l| crate::geometry::mesh_checks::is_closed(&l.mesh)));
}

#[test]
fn the_shape_goes_on_after_its_pieces() {
    let tree = run("Lot --> split(x) { 5 : A. | ~1 : NIL } extrude(2) B.", LOT);
    assert_eq!((count(&tree, "A"), count(&tree, "B")), (1, 1));
    assert_eq!(tree.leaves[1].mesh.faces.len(), 6);
}

#[test]
fn edges_are_split_too() {
    let tree = run(r#"Lot --> comp(e) { 0 : split(x) { ~6 : print(scope.sx) A. }* }"#, LOT);
    near(&numbers(&tree).concat(), &[20.0 / 3.0; 3]);
}

#[test]
fn nested_patterns_number_all_pieces() {
    let rules = r#"Lot --> split(x) { 1 : P | { ~3 : P | 0.5 : P }* | 1 : P }
P --> print(split.index + " " + split.total) NIL"#;
    let lines = numbers(&run(rules, LOT));
    assert_eq!(lines.len(), 12);
    assert!(lines.iter().enumerate().all(|(i, l)| l == &[i as f64, 12.0]));
}
