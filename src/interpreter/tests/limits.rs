//! What must stop, stops: quickly, with an error that names the rules.

use super::*;
use crate::diagnostics::Severity;

#[track_caller]
fn stops(rules: &str, code: &str) -> ShapeTree {
    let limits = Limits { max_shapes: 20_000, max_vertices: 100_000, ..Limits::default() };
    let tree = derive(&compiled(rules), &start(ground(LOT), 0), &NoAssets, &limits);
    let errors: Vec<_> = tree.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
    assert_eq!(errors.iter().map(|d| d.code).collect::<Vec<_>>(), [code], "{rules}");
    tree
}

#[test]
fn endless_recursion_names_its_rules() {
    let tree = stops("Lot --> Wall\nWall --> t(1,0,0) Tile\nTile --> Wall", "cga::limit-depth");
    let error = tree.diagnostics.iter().next().expect("an error");
    assert!(error.help.as_deref().is_some_and(|h| h.starts_with("rules: Lot > Wall > Tile > … > ")), "{error:?}");
}

#[test]
fn recursion_that_doubles_stops_at_the_depth() {
    stops("Lot --> A\nA --> A A", "cga::limit-depth");
}

#[test]
fn a_billion_pieces_are_refused_before_they_are_made() {
    stops("Lot --> split(x) { ~0.01 : split(z) { ~0.01 : A. }* }*", "cga::limit-shapes");
    stops("Lot --> split(x) { 0.0001 : A. }*", "cga::limit-shapes");
}

#[test]
fn geometry_that_grows_stops() {
    stops("Lot --> extrude(1) Lot", "cga::limit-vertices");
}

#[test]
fn functions_without_end_stop() {
    stops("f(x) = case x > 1e9 : 0 else : f(x + 1)\nLot --> extrude(f(0))", "cga::limit-calls");
}

#[test]
fn texts_and_arrays_without_end_stop() {
    stops("g(s, n) = case n < 1 : s else : g(s + s, n - 1)\nLot --> print(g(\"abcdefgh\", 60)) A.", "cga::limit-text");
    stops("Lot --> print(size([1:1e9])) A.", "cga::limit-array");
}

#[test]
fn leaves_made_before_the_stop_are_kept() {
    let tree = stops("Lot --> First. B\nB --> C\nC --> B", "cga::limit-depth");
    assert_eq!(count(&tree, "First"), 1);
}

#[test]
fn strange_start_shapes_are_survived() {
    let program = compiled("Lot --> extrude(3) comp(f) { all : split(x) { ~1 : roofHip(30) A. }* }");
    let line: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)];
    let point: &[(f64, f64)] = &[(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)];
    let bow: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)];
    let clockwise: &[(f64, f64)] = &[(0.0, 0.0), (0.0, -4.0), (4.0, -4.0), (4.0, 0.0)];
    let wild: &[(f64, f64)] = &[(f64::NAN, 0.0), (1.0, f64::INFINITY), (2.0, 0.0)];
    let huge: &[(f64, f64)] = &[(1e300, 0.0), (1e301, 1e300), (0.0, -1e300)];
    for corners in [&[], line, point, bow, clockwise, wild, huge] {
        derive(&program, &start(ground(corners), 0), &NoAssets, &Limits::default());
    }
    derive(&program, &start(Mesh::default(), 0), &NoAssets, &Limits::default());
}

#[test]
fn a_start_rule_that_is_not_there_is_an_error() {
    let mut start = start(ground(LOT), 0);
    start.start_rule = Some("Nothing".into());
    let tree = derive(&compiled("Lot --> A."), &start, &NoAssets, &Limits::default());
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::no-start-rule"]);
}
