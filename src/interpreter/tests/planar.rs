//! Reference 10.6; compatibility notes, "offset, setback, shapeL/U/O, innerRectangle".

use super::*;

#[track_caller]
fn check(body: &str, rule: &str, expected: &[f64]) {
    let tree = run(&format!("Lot --> {body}"), SMALL);
    let got = areas(&tree, rule);
    let same = got.len() == expected.len() && got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(same, "{body}: {rule} {got:?}, not {expected:?}");
}

#[test]
fn offsets() {
    check("offset(-1) comp(f) { inside : A. | border : B. }", "A", &[32.0]);
    check("offset(-1) comp(f) { inside : A. | border : B. }", "B", &[9.0, 5.0, 9.0, 5.0]);
    check("offset(1, inside) A.", "A", &[96.0]);
    check("offset(1, border) A.", "A", &[36.0]);
    check("offset(-3, inside) A.", "A", &[60.0]);
    check("offset(0) A.", "A", &[60.0]);
    let tree = run("Lot --> offset(1, border) comp(f) { all : A. }", SMALL);
    assert!(tree.leaves.iter().all(|l| l.mesh.normal(&l.mesh.faces[0]).y == -1.0));
}

#[test]
fn setbacks() {
    let both = |body: &str, a: &[f64], b: &[f64]| {
        check(body, "A", a);
        check(body, "B", b);
    };
    both("setback(2) { front : A. | remainder : B. }", &[20.0], &[40.0]);
    both("setback(1) { all = A. | remainder : B. }", &[28.0], &[32.0]);
    both("setback(1) { all : A. | remainder : B. }", &[28.0], &[32.0]);
    both("setback([2,0,1]) { all = A. | remainder : B. }", &[30.0], &[30.0]);
    both("setback([2,0,1]) { all : A. | remainder : B. }", &[20.0, 10.0], &[30.0]);
    both("setback(0) { all : A. | remainder : B. }", &[], &[60.0]);
    both("setback(5) { all : A. | remainder : B. }", &[60.0], &[]);
    both("setback(1) { 0 : A. | 1 : C. | remainder : B. }", &[9.5], &[45.0]);
    both("setback(comp(fe) { front : 2 | back : 1 }) { all : A. | remainder : B. }", &[20.0, 10.0], &[30.0]);
}

#[test]
fn a_ring_of_setbacks_is_one_face_with_a_hole() {
    let tree = run("Lot --> setback(1) { all : A. }", SMALL);
    assert_eq!((tree.leaves.len(), tree.leaves[0].mesh.faces[0].holes.len()), (1, 1));
    let mesh = &tree.leaves[0].mesh;
    assert_eq!(mesh.positions[mesh.faces[0].outer[0] as usize], DVec3::ZERO);
}

#[test]
fn wings() {
    check("shapeL(2,3) { shape : A. | remainder : B. }", "A", &[32.0]);
    check("shapeL(2,3) { shape : A. | remainder : B. }", "B", &[28.0]);
    check("shapeU(2,1,3) { shape : A. | remainder : B. }", "A", &[36.0]);
    check("shapeU(2,1,3) { shape : A. | remainder : B. }", "B", &[24.0]);
    check("shapeO(1,1,1,1) { remainder : B. }", "B", &[32.0]);
    check("shapeO(4,4,4,4) { shape : A. | remainder : B. }", "A", &[60.0]);
    check("shapeO(4,4,4,4) { shape : A. | remainder : B. }", "B", &[]);
}

#[test]
fn a_list_too_short_warns_and_sets_nothing_back() {
    let tree = derived("Lot --> setback([float(listItem(\"1;\", 7))]) { all : A. | remainder : B. }", ground(SMALL));
    assert_eq!(areas(&tree, "B"), [60.0]);
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::not-finite"]);
}

#[test]
fn inner_rectangles() {
    check("innerRectangle(scope) { shape : A. | remainder : B. }", "A", &[60.0]);
    check("innerRectangle(scope) { shape : A. | remainder : B. }", "B", &[]);
    let l = [(0.0, 0.0), (50.0, 0.0), (50.0, -22.0), (24.0, -22.0), (24.0, -46.0), (0.0, -46.0)];
    let tree = run("Lot --> innerRectangle(edge) { shape : A. | remainder : B. }", &l);
    near(&areas(&tree, "A"), &[24.0 * 46.0]);
    near(&areas(&tree, "B"), &[26.0 * 22.0]);
}

#[test]
fn uvs_follow_into_the_strips() {
    let rules = "Lot --> setupProjection(0, scope.xz, 1, 1) projectUV(0) setback(2) { front : A. }";
    let tree = run(rules, SMALL);
    let uv = tree.leaves[0].mesh.faces[0].uv(0).expect("the strip keeps the set");
    let range = |f: fn(&DVec2) -> f64| (uv.iter().map(f).fold(9e9, f64::min), uv.iter().map(f).fold(-9e9, f64::max));
    let ((u0, u1), (v0, v1)) = (range(|p| p.x), range(|p| p.y));
    near(&[u0, u1, v0, v1], &[0.0, 10.0, 4.0, 6.0]);
}
