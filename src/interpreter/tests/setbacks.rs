//! Reference 4.5 beyond the table of 10.6: distances per edge, to an area, by texture side, along the perimeter.

use super::*;

#[track_caller]
fn check(body: &str, expected: &[(&str, &[f64])]) {
    let tree = run(&format!("Lot --> {body}"), SMALL);
    for (rule, wanted) in expected {
        let got = areas(&tree, rule);
        let same = got.len() == wanted.len() && got.iter().zip(*wanted).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(same, "{body}: {rule} {got:?}, not {wanted:?}");
    }
}

fn codes(rules: &str) -> Vec<&'static str> {
    derived(rules, ground(SMALL)).diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn a_distance_for_every_edge() {
    let per_edge = "setbackPerEdge(case comp.index == 0 : 2 else : 1)";
    check(&format!("{per_edge} {{ all = A. | remainder : B. }}"), &[("A", &[36.0]), ("B", &[24.0])]);
    check(&format!("{per_edge} {{ front : A. | remainder : B. }}"), &[("A", &[20.0]), ("B", &[40.0])]);
    check("setbackPerEdge(scope.sx / 10) { right : A. | remainder : B. }", &[("A", &[3.6]), ("B", &[56.4])]);
    check("setbackPerEdge(-1) { all : A. | remainder : B. }", &[("A", &[]), ("B", &[60.0])]);
    let rules = r#"Lot --> setbackPerEdge(f(comp.index, comp.total)) { all = A. }
f(i, n) = case print(i + " " + n) == "" : 0 else : 1"#;
    let mut lines = numbers(&run(rules, SMALL));
    lines.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!(lines, [[0.0, 4.0], [1.0, 4.0], [2.0, 4.0], [3.0, 4.0]]);
}

#[test]
fn a_remainder_of_the_wanted_area() {
    let d = 4.0 - 7.0f64.sqrt();
    let tree = run("Lot --> setbackToArea(24) { all = A. | remainder = B. }", SMALL);
    near(&[areas(&tree, "A")[0], areas(&tree, "B")[0]], &[36.0, 24.0]);
    let (low, high) = tree.leaves[1].mesh.bounds().expect("a remainder");
    near(&[low.x, high.x, low.z, high.z], &[d, 10.0 - d, d - 6.0, -d]);
    check("setbackToArea(24) { front = A. | remainder = B. }", &[("A", &[36.0]), ("B", &[24.0])]);
    check("setbackToArea(24, [2, 0, 0, 0]) { all = A. | remainder = B. }", &[("B", &[24.0])]);
    // Sides can give 0.5 only: the front gives the rest.
    let tree = run("Lot --> setbackToArea(24, [0], [9, 0.5, 0, 0.5]) { all = A. | remainder = B. }", SMALL);
    let (low, high) = tree.leaves[1].mesh.bounds().expect("a remainder");
    near(&[low.x, high.x, high.z], &[0.5, 9.5, 24.0 / 9.0 - 6.0]);
}

#[test]
fn areas_out_of_reach_are_told() {
    assert_eq!(codes("Lot --> setbackToArea(24, [3, 3, 3, 3]) { all = A. | remainder = B. }"), ["cga::setback-area"]);
    assert_eq!(
        codes("Lot --> setbackToArea(24, [0], [1, 1, 1, 1]) { all = A. | remainder = B. }"),
        ["cga::setback-area"]
    );
    assert_eq!(codes("Lot --> setbackToArea(-5) { all = A. | remainder = B. }"), ["cga::setback-area"]);
    assert_eq!(codes("Lot --> setbackToArea(99) { all = A. | remainder = B. }"), ["cga::setback-area"]);
    let tree = derived("Lot --> setbackToArea(24, [0], [1, 1, 1, 1]) { all = A. | remainder = B. }", ground(SMALL));
    near(&areas(&tree, "B"), &[32.0]);
    assert_eq!(codes("Lot --> comp(e) { 0 : setback(1) { all : A. | remainder : B. } }"), ["cga::no-face"]);
    assert_eq!(codes("Lot --> comp(e) { 0 : offset(1) A. }"), ["cga::no-face"]);
}

#[test]
fn sides_in_texture_space() {
    // v grows from the back to the front.
    let mapped = |body: &str| format!("setupProjection(0, scope.xz, 1, 1) projectUV(0) {body}");
    let bounds = |body: &str| {
        let tree = run(&format!("Lot --> {}", mapped(body)), SMALL);
        let (low, high) = tree.leaves[0].mesh.bounds().expect("a strip");
        [low.x, high.x, low.z, high.z]
    };
    near(&bounds("setback(1, 0) { uv.bottom : A. }"), &[0.0, 10.0, -6.0, -5.0]);
    near(&bounds("setback(1, 0) { uv.top : A. }"), &[0.0, 10.0, -1.0, 0.0]);
    near(&bounds("setback(1) { uv.left : A. }"), &[0.0, 1.0, -6.0, 0.0]);
    near(&bounds("setback(1) { uv.right && geometry.area < 1 : A. }"), &[9.0, 10.0, -6.0, 0.0]);
    near(&bounds("setback(1) { uv.uMin : A. }"), &[0.0, 1.0, -6.0, 0.0]);
    near(&bounds("setback(1) { uv.uMax : A. }"), &[9.0, 10.0, -6.0, 0.0]);
    near(&bounds("setback(1) { uv.vMin : A. }"), &[0.0, 10.0, -6.0, -5.0]);
    near(&bounds("setback(1) { uv.vMax : A. }"), &[0.0, 10.0, -1.0, 0.0]);
    assert_eq!(codes("Lot --> setback(1) { uv.left : A. | remainder : B. }"), ["cga::no-uv"]);
}

#[test]
fn first_edges() {
    let first = |body: &str| {
        let tree = run(&format!("Lot --> {body}"), SMALL);
        let mesh = &tree.leaves[0].mesh;
        let (a, b) = mesh.faces[0].edges().next().expect("an edge");
        [mesh.positions[a as usize], mesh.positions[b as usize]].map(|p| (p.x, p.z))
    };
    assert_eq!(first("setback(1) { all = NIL | remainder : A. }"), [(1.0, -1.0), (9.0, -1.0)]);
    assert_eq!(first("setback(1) { left = NIL | remainder : A. }"), [(1.0, 0.0), (10.0, 0.0)]);
    assert_eq!(first("setback(1) { right : A. }"), [(10.0, 0.0), (10.0, -6.0)]);
    let section = "splitAndSetbackPerimeter(12) { 2 : 1 : A. | ~1 : 0 : NIL } { remainder : NIL }";
    assert_eq!(first(section), [(10.0, -2.0), (10.0, -4.0)]);
}

#[test]
fn strips_go_round_holes_that_stay() {
    let tree = run("Lot --> setback(2) { all : Ring }\nRing --> setback(3) { 0 : A. | remainder : B. }", SMALL);
    let sum = areas(&tree, "A").iter().sum::<f64>() + areas(&tree, "B").iter().sum::<f64>();
    near(&[sum], &[48.0]);
    near(&areas(&tree, "A"), &[30.0 - 6.0]);
}

#[test]
fn sections_of_the_perimeter() {
    let check = |rest: &str, expected: &[(&str, &[f64])]| check(&format!("splitAndSetbackPerimeter{rest}"), expected);
    check("(0) { 10 : 1 : A. | ~1 : 0 : NIL } { remainder : R. }", &[("A", &[10.0]), ("R", &[50.0])]);
    check("(10) { 6 : 2 : A. | ~1 : 0 : NIL } { remainder : R. }", &[("A", &[12.0]), ("R", &[48.0])]);
    check(
        "(0, 1, [true, true, true, true]) { 6 : 2 : A. | ~1 : 0 : NIL } { remainder : R. }",
        &[("A", &[12.0]), ("R", &[48.0])],
    );
    check("(-2) { 4 : 1 : A. | ~1 : 0 : NIL } { remainder : R. }", &[("A", &[3.0]), ("R", &[57.0])]);
    check("('0.5) { '0.25 : 1 : A. | ~1 : 0 : NIL } { remainder : R. }", &[("A", &[8.0]), ("R", &[52.0])]);
    check("(0) { ~8 : 1 : A. }* { remainder : R. }", &[("R", &[32.0])]);
    // The deeper section has the corner.
    check(
        "(0) { 10 : 1 : A. | 6 : 3 : B. | ~1 : 0 : NIL } { remainder : R. }",
        &[("A", &[7.0]), ("B", &[18.0]), ("R", &[35.0])],
    );
    check(
        "(0, 1, [false, true, false, true]) { 6 : 1 : A. | ~1 : 2 : B. } { remainder : R. }",
        &[("A", &[6.0]), ("B", &[12.0]), ("R", &[42.0])],
    );
    check("(0) { { 4 : 1 : A. | ~2 : split.index / 2 : B. }* | 1 : 0 : NIL } { remainder : NIL }", &[]);
    check("(0) { ~1 : 9 : A. } { remainder : R. }", &[("A", &[60.0]), ("R", &[])]);
}

#[test]
fn sections_know_their_number() {
    let rules = r#"Lot --> splitAndSetbackPerimeter(0) { ~8 : 0.5 + split.index / 4 : P }* { remainder : NIL }
P --> print(split.index + " " + split.total + " " + scope.sy) NIL"#;
    let lines = numbers(&run(rules, SMALL));
    assert_eq!(lines, [[0.0, 4.0, 0.0], [1.0, 4.0, 0.0], [2.0, 4.0, 0.0], [3.0, 4.0, 0.0]]);
    assert_eq!(
        codes("Lot --> comp(e) { 0 : splitAndSetbackPerimeter(0) { 1 : 1 : A. } { remainder : B. } }"),
        ["cga::no-face"]
    );
}

#[test]
fn edges_of_sections_are_named() {
    let edges = "comp(e) { isTagged(\"setback.front\") : F. | isTagged(\"setback.back\") : B. | \
        isTagged(\"setback.side\") : S. | isTagged(\"setback.remainder\") : R. }";
    let counts = |rules: &str| {
        let tree = run(&format!("Lot --> splitAndSetbackPerimeter(12) {{ {rules}"), SMALL);
        ["F", "B", "S", "R"].map(|rule| count(&tree, rule))
    };
    assert_eq!(counts(&format!("2 : 1 : {edges} | ~1 : 0 : NIL }} {{ remainder : NIL }}")), [1, 1, 2, 0]);
    // Two short pieces of the right side are left beside the section.
    assert_eq!(counts(&format!("2 : 1 : NIL | ~1 : 0 : NIL }} {{ remainder : {edges} }}")), [0, 1, 2, 5]);
}

#[test]
fn rectangles_inside() {
    let tree =
        run("Lot --> innerRectangle(scope) { shape : A. | remainder : B. }", &[(0.0, 0.0), (8.0, 0.0), (0.0, -6.0)]);
    near(&[areas(&tree, "A")[0], areas(&tree, "B").iter().sum()], &[12.0, 12.0]);
    let mut sources = crate::source::SourceMap::default();
    let options = crate::cga::CompileOptions::default();
    let (program, diagnostics) = crate::cga::compile_text("t.cga", "Lot --> innerRect A.", &mut sources, &options);
    assert_eq!(diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::deprecated"]);
    let triangle = ground(&[(0.0, 0.0), (8.0, 0.0), (0.0, -6.0)]);
    let tree = derive(&program.expect("a warning only"), &start(triangle, 0), &NoAssets, &Limits::default());
    near(&areas(&tree, "A"), &[12.0]);
}

#[test]
fn faces_that_are_not_flat_keep_their_heights() {
    let mut mesh = ground(SMALL);
    mesh.positions[2].y = 1.0;
    let tree = derived("Lot --> setback(1) { all = A. | remainder : B. }", mesh.clone());
    assert!(tree.diagnostics.is_empty());
    for corner in &mesh.positions {
        assert!(tree.leaves[0].mesh.positions.contains(corner), "{corner}");
    }
    let heights: Vec<f64> = tree.leaves[1].mesh.positions.iter().map(|p| p.y).collect();
    assert!(heights.iter().all(|y| (-0.01..1.0).contains(y)) && heights.iter().any(|y| *y > 0.5), "{heights:?}");
}
