//! Reference 10.3: sizes of splits, through rules; what is too thin; `splitArea` (4.4).

use super::*;

/// Lengths and symbols of the pieces of `split(x) pattern` over `total` metres.
#[track_caller]
fn check(total: f64, pattern: &str, expected: &[(&str, f64)]) {
    let rules = format!("Lot --> split(x) {pattern}");
    let tree = run(&rules, &[(0.0, 0.0), (total, 0.0), (total, -1.0), (0.0, -1.0)]);
    let size = |leaf: &crate::interpreter::tree::Leaf| {
        let (low, high) = leaf.mesh.bounds().expect("a piece has points");
        high.x - low.x
    };
    let got: Vec<(&str, f64)> = tree.leaves.iter().map(|leaf| (&*leaf.rule, size(leaf))).collect();
    let same =
        got.len() == expected.len() && got.iter().zip(expected).all(|(g, e)| g.0 == e.0 && (g.1 - e.1).abs() < 1e-4);
    assert!(same, "{pattern} of {total}: {got:?}, not {expected:?}");
    let mut end = 0.0;
    for leaf in &tree.leaves {
        let (low, high) = leaf.mesh.bounds().expect("a piece has points");
        assert!((low.x - end).abs() < 1e-9, "{pattern}: pieces abut");
        end = high.x;
    }
}

#[test]
fn the_table_of_the_reference() {
    check(8.0, "{ '0.25 : A. | '0.125 : B. | '0.375 : C. }", &[("A", 2.0), ("B", 1.0), ("C", 3.0)]);
    check(12.0, "{ ~2 : A. | ~1 : B. | ~5 : C. }", &[("A", 3.0), ("B", 1.5), ("C", 7.5)]);
    check(9.0, "{ 2.5 : A. | ~4 : B. | 4 : C. }", &[("A", 2.5), ("B", 2.5), ("C", 4.0)]);
    check(9.0, "{ '0.6 : A. | '0.7 : B. | 1 : C. }", &[("A", 5.4), ("B", 3.6)]);
    check(6.0, "{ 2 : A. | 0 : B. | 2 : C. | 3 : E. }", &[("A", 2.0), ("C", 2.0), ("E", 2.0)]);
    check(10.0, "{ 3 : A. | 1 : B. }*", &[("A", 3.0), ("B", 1.0), ("A", 3.0), ("B", 1.0), ("A", 2.0)]);
    check(1.0, "{ '0.4 : A. }*", &[("A", 0.4), ("A", 0.4), ("A", 0.2)]);
    let ab = [("A", 0.25), ("B", 0.125), ("A", 0.25), ("B", 0.125), ("A", 0.25)];
    check(1.0, "{ '0.25 : A. | '0.125 : B. }*", &ab);
    check(7.0, "{ ~1.8 : G. }*", &[("G", 1.75); 4]);
    let (a, b) = (("A", 2.6), ("B", 5.2 / 3.0));
    check(13.0, "{ ~3 : A. | ~2 : B. }*", &[a, b, a, b, a, b]);
    let (p, q) = (("P", 1.0), ("Q", 5.6 / 3.0));
    check(9.6, "{ { 1 : P. | ~2.5 : Q. }* | 1 : P. }", &[p, q, p, q, p, q, p]);
    let (b, c) = (("B", 11.5 / 6.0), ("C", 0.5));
    check(
        15.0,
        "{ 1 : A. | { ~2 : B. | 0.5 : C. | ~2 : B. }* | 1 : A. }",
        &[("A", 1.0), b, c, b, b, c, b, b, c, b, ("A", 1.0)],
    );
    let mut fives = [("A", 14.0 / 13.5), ("B", 21.0 / 13.5)].repeat(5);
    fives.push(("A", 14.0 / 13.5));
    check(14.0, "{ { ~1 : A. | ~1.5 : B. }* | ~1 : A. }", &fives);
    let mut bays = vec![("P", 0.8)];
    bays.extend([("Y", 2.125), ("P", 0.3)].repeat(4));
    bays.push(("P", 0.5));
    check(11.0, "{ 0.8 : P. | { ~2.4 : Y. | 0.3 : P. }* | 0.5 : P. }", &bays);
    let mut floors = vec![("G", 4.2)];
    floors.extend([("F", 3.04); 5]);
    floors.push(("R", 0.6));
    check(20.0, "{ 4.2 : G. | { ~3.1 : F. }* | 0.6 : R. }", &floors);
    check(3.0, "{ ~4 : F. }*", &[("F", 3.0)]);
    check(2.0, "{ ~1 : A. | { ~5 : B. }* | ~1 : A. }", &[("A", 1.0), ("A", 1.0)]);
    check(10.0, "{ { 2 : A. }* | ~1 : B. }", &[("A", 2.0), ("A", 2.0), ("A", 2.0), ("A", 2.0), ("B", 2.0)]);
    check(12.0, "{ 13 : A. | ~1 : B. }", &[("A", 12.0)]);
    check(12.0, "{ '0.1 + 2 : A. }", &[("A", 12.0)]);
}

#[test]
fn the_examples_of_the_reference() {
    let rules = "Facade --> split(y) { 4.2 : Ground. | { ~3.1 : Floor }* | 0.6 : Parapet. }\n\
        Floor --> split(x) { 0.8 : Pier. | { ~2.4 : Bay. | 0.3 : Pier. }* | 0.5 : Pier. }\n\
        @StartRule\nLot --> extrude(20) comp(f) { 2 : Facade }";
    let tree = run(rules, LOT);
    assert_eq!((count(&tree, "Ground"), count(&tree, "Parapet")), (1, 1));
    // (20 - 0.8 - 0.5) / 2.7 is 6.93: seven bays on each of five floors.
    assert_eq!((count(&tree, "Bay"), count(&tree, "Pier")), (5 * 7, 5 * 9));
    near(&[areas(&tree, "Ground")[0], areas(&tree, "Parapet")[0]], &[84.0, 12.0]);
}

#[test]
fn what_is_too_thin_is_told() {
    let codes =
        |rules: &str| -> Vec<&'static str> { derived(rules, ground(LOT)).diagnostics.iter().map(|d| d.code).collect() };
    assert_eq!(codes("Lot --> split(x) { 0.0000005 : A. | ~1 : B. }"), ["cga::split-size"]);
    assert_eq!(codes("Lot --> split(x) { '0.00000001 : A. | ~1 : B. }"), ["cga::split-size"]);
    assert_eq!(codes("Lot --> split(y) { ~1 : A. }"), ["cga::split-flat"]);
    assert!(codes("Lot --> split(x) { 20 : A. | ~1 : B. | 0 : C. }").is_empty());
    // No size is negative: it is 0, and said (`split-negative` of the stage cases).
    assert_eq!(codes("Lot --> split(x) { 20 : A. | -3 : D. }"), ["cga::split-size"]);
    let tree = derived("Lot --> split(x) { 2 : A. | 0 : B. | 2 : C. | -1 : D. | ~1 : E. }", ground(LOT));
    near(&[areas(&tree, "A")[0], areas(&tree, "C")[0], areas(&tree, "E")[0]], &[20.0, 20.0, 160.0]);
    assert_eq!((count(&tree, "B"), count(&tree, "D")), (0, 0));
    let tree = derived("Lot --> split(x) { 0.0000005 : A. | ~1 : B. }", ground(LOT));
    assert_eq!((count(&tree, "A"), areas(&tree, "B")), (0, vec![200.0]));
}

#[test]
fn areas_are_what_was_asked_for() {
    let tree = run("Lot --> splitArea(x) { 15 : A. | ~1 : B. }", SMALL);
    near(&[areas(&tree, "A")[0], areas(&tree, "B")[0]], &[15.0, 45.0]);
    assert!((tree.leaves[0].mesh.bounds().expect("a face").1.x - 2.5).abs() < 1e-9);
    let triangle = [(0.0, 0.0), (10.0, 0.0), (0.0, -10.0)];
    near(&areas(&run("Lot --> splitArea(x) { '0.4 : A. }*", &triangle), "A"), &[20.0, 20.0, 10.0]);
    near(&areas(&run("Lot --> splitArea(z) { ~10 : A. }*", &triangle), "A"), &[10.0; 5]);
    let u = [(0.0, 0.0), (9.0, 0.0), (9.0, -6.0), (6.0, -6.0), (6.0, -2.0), (3.0, -2.0), (3.0, -6.0), (0.0, -6.0)];
    near(&areas(&run("Lot --> splitArea(z) { 12 : A. | ~1 : A. }", &u), "A"), &[12.0, 30.0]);
    let shown = show_on("splitArea(x, noAdjust) { 20 : NIL | ~1 : Show }", &triangle);
    let x = 10.0 - 60.0f64.sqrt();
    near(&[shown.t, shown.s].concat(), &[x, 0.0, -10.0, 10.0 - x, 0.0, 10.0]);
    let rules = r#"Lot --> splitArea(x) { ~20 : print(split.index + " " + split.total + " " + geometry.area) NIL }*"#;
    assert_eq!(numbers(&run(rules, SMALL)).len(), 3);
}

#[test]
fn area_of_bodies_and_nothing() {
    let codes =
        |rules: &str| -> Vec<&'static str> { derived(rules, ground(LOT)).diagnostics.iter().map(|d| d.code).collect() };
    assert_eq!(codes("Lot --> extrude(2) splitArea(x) { ~1 : A. }"), ["cga::split-area"]);
    assert_eq!(codes("Lot --> splitArea(y) { ~1 : A. }"), ["cga::split-flat"]);
    assert_eq!(codes("Lot --> comp(e) { 0 : splitArea(x) { ~1 : A. } }"), ["cga::split-flat"]);
}
