//! Reference 10.2 and 4.7.

use super::*;

const BLOCK: &str = "extrude(8) ";

#[track_caller]
fn scope(body: &str, t: [f64; 3], s: [f64; 3]) {
    let shown = show(&format!("{BLOCK}{body} Show"));
    near(&[shown.t, shown.s].concat(), &[t, s].concat());
}

#[test]
fn moving_turning_scaling() {
    let size = [20.0, 8.0, 10.0];
    scope("t(1,0,0)", [1.0, 0.0, -10.0], size);
    scope("t('0.5,0,'-0.5)", [10.0, 0.0, -15.0], size);
    scope("r(0,90,0) t(1,0,0)", [0.0, 0.0, -11.0], size);
    scope("r(scopeCenter,0,90,0)", [5.0, 0.0, 5.0], size);
    scope("s('0.5,'1,'0.5) center(xz)", [5.0, 0.0, -7.5], [10.0, 8.0, 5.0]);
    scope("s('1,'1,-2)", [0.0, 0.0, -10.0], [20.0, 8.0, -2.0]);
    scope("translate(rel, world, 0, 3, 0)", [0.0, 3.0, -10.0], size);
    scope("translate(abs, world, 100, 3, 200)", [0.0, 3.0, 0.0], size);
    scope("set(scope.sx, 4) set(scope.ty, 1)", [0.0, 1.0, -10.0], [4.0, 8.0, 10.0]);
    scope("[ t(5,5,5) s(1,1,1) A. ]", [0.0, 0.0, -10.0], size);
}

#[test]
fn rotating_in_a_named_system() {
    let turned = |body: &str, r: [f64; 3]| near(&show(&format!("{BLOCK}{body} Show")).r, &r);
    turned("rotate(rel, pivot, 0, 90, 0)", [0.0, 90.0, 0.0]);
    turned("rotate(rel, scope, 0, 30, 0) rotate(rel, world, 0, 30, 0)", [0.0, 60.0, 0.0]);
    turned("r(0, 40, 0) rotate(abs, world, 0, 10, 0)", [0.0, 10.0, 0.0]);
    turned("r(0, 40, 0) rotate(abs, pivot, 0, 0, 0)", [0.0, 0.0, 0.0]);
    // After a quarter turn about y, the world's x is the scope's own z.
    turned("r(0, 90, 0) rotate(rel, world, 90, 0, 0)", [90.0, 0.0, 90.0]);
    let tree = run("Lot --> extrude(8) r(0, 90, 0) rotate(rel, world, 90, 0, 0)", LOT);
    let axes = tree.leaves[0].mesh.bounds().expect("a block");
    near(&(axes.1 - axes.0).to_array(), &[10.0, 20.0, 8.0]);
}

#[test]
fn geometry_follows_the_scope() {
    let tree = run("Lot --> extrude(8) s('0.5,'1,-2) t(1,0,0)", LOT);
    let (low, high) = tree.leaves[0].mesh.bounds().expect("a block");
    assert_eq!((low, high), (DVec3::new(101.0, 0.0, 188.0), DVec3::new(111.0, 8.0, 190.0)));
    let volume = crate::geometry::mesh_checks::volume(&tree.leaves[0].mesh);
    assert!((volume + 160.0).abs() < 1e-9, "a mirrored block points inwards: {volume}");
}

#[test]
fn a_size_of_zero_flattens_and_comes_back() {
    let tree = run("Lot --> extrude(8) s('1,0,'1) s('1,4,'1)", LOT);
    assert_eq!(tree.leaves[0].mesh.bounds().map(|b| b.1.y), Some(4.0));
    let depth = run("Lot --> extrude(8) comp(f) { front : s('1,'1,0.3) A. }", LOT);
    let bounds = depth.leaves[0].mesh.bounds().expect("a face");
    assert_eq!(bounds.0.z, bounds.1.z);
}

#[test]
fn pivots() {
    let s = show("extrude(8) setPivot(xyz,1) Show");
    near(&[s.p, s.t, s.r, s.s].concat(), &[20.0, 0.0, -10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 8.0, 20.0]);
    near(&s.o, &[0.0, -90.0, 0.0]);
    let s = show("extrude(8) alignScopeToAxes() Show");
    near(&[s.p, s.t, s.s].concat(), &[0.0, 0.0, -10.0, 0.0, 0.0, 0.0, 20.0, 8.0, 10.0]);
}

#[test]
fn aligning_to_the_longest_edge() {
    // The longest edge is the second one; x runs along it.
    let corners = [(0.0, 0.0), (3.0, 0.0), (3.0, -9.0), (0.0, -9.0)];
    let s = show_on("alignScopeToGeometry(yUp, any, longest) Show", &corners);
    near(&[s.s, s.p, s.o].concat(), &[9.0, 0.0, 3.0, 3.0, 0.0, 0.0, 0.0, 90.0, 0.0]);
    let s = show_on("alignScopeToGeometry(zUp, 0, 0) Show", &corners);
    near(&[s.s, s.p].concat(), &[3.0, 9.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn turning_only_the_scope_keeps_the_geometry() {
    let before = run("Lot --> extrude(8)", LOT);
    let after = run("Lot --> extrude(8) rotateScope(-90,30,0) alignScopeToAxes(y) setPivot(zxy,6)", LOT);
    assert_eq!(before.leaves[0].mesh.positions, after.leaves[0].mesh.positions);
    let s = show("rotateScope(-90,0,0) Show");
    near(&s.s, &[20.0, 10.0, 0.0]);
}

#[test]
fn mirroring() {
    let tree = run("Lot --> extrude(8) comp(f) { front : mirror(true,false,false) A. }", LOT);
    let mesh = &tree.leaves[0].mesh;
    assert_eq!(mesh.normal(&mesh.faces[0]).z, 1.0);
    let s = show("extrude(8) mirrorScope(true,false,true) Show");
    near(&[s.t, s.s].concat(), &[20.0, 0.0, 0.0, -20.0, 8.0, -10.0]);
}
