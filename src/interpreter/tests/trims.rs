//! Reference 3.8, 4.10, 4.11, 4.12: trim planes, what is inserted, and geometry put back.

use super::*;
use crate::geometry::mesh_checks::{is_closed, volume};
use crate::interpreter::assets::{Asset, AssetError, Assets};
use crate::interpreter::form::Form;

/// Volume of the only leaf, which must be closed.
#[track_caller]
fn closed_volume(rules: &str, corners: &[(f64, f64)]) -> f64 {
    let tree = run(rules, corners);
    let [leaf] = tree.leaves.as_slice() else { panic!("{rules}: {} leaves", tree.leaves.len()) };
    assert!(is_closed(&leaf.mesh.welded()), "{rules}: open");
    volume(&leaf.mesh)
}

/// A slab 1 m thick that sticks out 2 m on every side of the front of a 20 x 8 x 10 block.
fn slab(before: &str, inside: &str) -> String {
    format!("Lot --> extrude(8) {before} comp(f) {{ front : {inside} t(-2,-2,0) s(24,12,1) primitiveCube A. }}")
}

#[test]
fn inserts_are_mitred_at_the_corners_of_the_block() {
    near(&[closed_volume(&slab("", ""), LOT)], &[12.0 * 21.0]);
    near(&[closed_volume(&slab("set(trim.vertical, false)", ""), LOT)], &[12.0 * 24.0]);
    let both = 160.0 + 28.0 + 4.0 / 3.0;
    near(&[closed_volume(&slab("set(trim.horizontal, true)", ""), LOT)], &[both]);
    near(&[closed_volume(&slab("", "set(trim.horizontal, true)"), LOT)], &[both]);
    let horizontal = "set(trim.horizontal, true) set(trim.vertical, false)";
    near(&[closed_volume(&slab(horizontal, ""), LOT)], &[24.0 * 9.0]);
    // The planes stay where they are when the face moves and is split.
    let split = "Lot --> extrude(8) comp(f) { front : split(x) { ~1 : A | ~1 : NIL } }
A --> t(-2,0,0) s('1,'1,1) primitiveCube()";
    near(&[closed_volume(split, LOT)], &[8.0 * (8.0 + 0.5)]);
}

#[test]
fn trim_cuts_what_was_not_inserted_and_fits_the_scope() {
    let rules = "Lot --> extrude(8) comp(f) { front : s(30,'1,'1) Wide trim() Cut }
Wide --> print(scope.sx + \" \" + geometry.area + \" \" + trim.vertical) NIL
Cut --> print(scope.sx + \" \" + geometry.area + \" \" + trim.horizontal) NIL";
    assert_eq!(run(rules, LOT).prints, ["30 240 true", "20 160 false"]);
}

/// Extruded by 8, the corner at (4, -4) is concave.
const L: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)];

#[test]
fn concave_edges_cut_only_along_themselves() {
    // The slab on the wall from (10, -4) to (4, -4) goes on 2 m into the block, and 1 m above and below the edge.
    let slab = "Lot --> extrude(8) comp(f) { 4 : t(0,-1,0) s(8,10,1) primitiveCube A. }";
    near(&[closed_volume(slab, L)], &[5.5 * 8.0 + 8.0 * 2.0]);
}

#[test]
fn a_face_is_not_cut_where_it_goes_on_behind_its_own_plane() {
    let top = "Lot --> extrude(8) set(trim.horizontal, true) comp(f) { top : s('1,'1,1) primitiveCube A. }";
    near(&[closed_volume(top, L)], &[64.0 + 1.0 / 3.0]);
}

#[test]
fn only_single_faces_of_a_split_get_planes() {
    let together = "Lot --> extrude(8) comp(f) { front = t(-2,0,0) s(24,'1,1) primitiveCube A. }";
    near(&[closed_volume(together, LOT)], &[8.0 * 24.0]);
    let reset = "Lot --> extrude(8) comp(f) { front : resetGeometry() t(0,0,0) s(30,5,'1) primitiveCube A. }";
    near(&[closed_volume(reset, LOT)], &[30.0 * 5.0 * 10.0]);
}

#[test]
fn an_insert_that_was_cut_is_no_instance() {
    let rules = "Lot --> extrude(8) comp(f) { front : s('1,'1,1) Say set(trim.vertical, false) t(-2,0,0) s(24,'1,1) Say
  set(trim.vertical, true) Say }
Say --> primitiveCube print(geometry.isInstanced) NIL";
    assert_eq!(run(rules, LOT).prints, ["true", "true", "false"]);
}

#[test]
fn resetting_gives_back_the_initial_shape() {
    let rules = "Lot --> color(1, 0, 0) extrude(8) comp(f) { right : t(3,0,0) s('2,'1,'1) resetGeometry() Show Red. }";
    let tree = run(&format!("{rules}{SHOW}"), LOT);
    near(&numbers(&tree)[0], &[0.0, 0.0, -10.0, 0.0, 0.0, 0.0, 20.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let red = &tree.leaves[0];
    assert_eq!((red.mesh.positions.clone(), red.material.color), (ground(LOT).positions, [1.0, 0.0, 0.0]));
}

#[test]
fn holes_are_filled_with_the_vertices_they_had() {
    let mut mesh = ground(SMALL);
    for (x, z) in [(2.0, -2.0), (2.0, -4.0), (4.0, -4.0), (4.0, -2.0)] {
        mesh.positions.push(DVec3::new(x, 0.0, z));
    }
    mesh.faces[0].holes.push(vec![4, 5, 6, 7].into());
    let say = "print(geometry.area + \" \" + geometry.nHoles + \" \" + geometry.nVertices)";
    let tree = derived(&format!("Lot --> {say} deleteHoles() {say} NIL"), mesh);
    assert_eq!(tree.prints, ["56 1 8", "60 0 4"]);
}

#[test]
fn primitives_with_dimensions_stand_in_the_middle() {
    #[track_caller]
    fn scope(body: &str, t: [f64; 3], s: [f64; 3]) {
        let shown = show(&format!("extrude(8) {body} Show"));
        near(&[shown.t, shown.s].concat(), &[t, s].concat());
    }
    scope("primitiveCube(4,3,2)", [8.0, 0.0, -6.0], [4.0, 3.0, 2.0]);
    scope("primitiveQuad(4,2)", [8.0, 0.0, -6.0], [4.0, 0.0, 2.0]);
    scope(
        "primitiveCylinder(4,1,5)",
        [10.0 - 0.5f64.sqrt(), 0.0, -5.0 - 0.5f64.sqrt()],
        [2f64.sqrt(), 5.0, 2f64.sqrt()],
    );
    scope("primitiveCone(4,1,5)", [10.0 - 0.5f64.sqrt(), 0.0, -5.0 - 0.5f64.sqrt()], [2f64.sqrt(), 5.0, 2f64.sqrt()]);
    scope("primitiveDisk(4,1)", [10.0 - 0.5f64.sqrt(), 0.0, -5.0 - 0.5f64.sqrt()], [2f64.sqrt(), 0.0, 2f64.sqrt()]);
    scope("primitiveSphere(4,4,1)", [10.0 - 0.5f64.sqrt(), 0.0, -5.0 - 0.5f64.sqrt()], [2f64.sqrt(), 2.0, 2f64.sqrt()]);
    scope("primitiveSphere(8,4)", [0.0, 0.0, -10.0], [20.0, 8.0, 10.0]);
    // On a facade quads and disks stand in its plane, in the middle.
    let shown = show("extrude(8) comp(f) { front : primitiveQuad(4,2) Show }");
    near(&[shown.t, shown.s].concat(), &[8.0, 3.0, 0.0, 4.0, 2.0, 0.0]);
    let shown = show("extrude(8) comp(f) { right : primitiveDisk(4,1) Show }");
    near(&shown.s, &[2f64.sqrt(), 2f64.sqrt(), 0.0]);
}

#[test]
fn closed_primitives_have_their_volume() {
    let n = 8.0f64;
    let disk = n / 2.0 * libm::sin(std::f64::consts::TAU / n);
    near(&[closed_volume("Lot --> primitiveCylinder(8,2,5) A.", LOT)], &[disk * 4.0 * 5.0]);
    near(&[closed_volume("Lot --> primitiveCone(8,2,6) A.", LOT)], &[disk * 4.0 * 2.0]);
    near(&[closed_volume("Lot --> primitiveCube(3,4,5) A.", LOT)], &[60.0]);
    // An octahedron of radius 1.
    near(&[closed_volume("Lot --> primitiveSphere(4,2,1) A.", LOT)], &[4.0 / 3.0]);
    // The zero rule for flat scopes (compatibility notes).
    near(&[closed_volume("Lot --> primitiveCube A.", LOT)], &[20.0 * 10.0 * 15.0]);
    let many = derived("Lot --> primitiveDisk(1e7) A.", ground(LOT));
    assert_eq!(many.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::too-many-parts"]);
    assert_eq!(many.leaves[0].mesh.faces[0].outer.len(), 1024);
}

/// A box of 2 x 4 x 6 from (1, 1, 1), with a doubled corner, under any name but `missing`.
struct OneBox;

impl Assets for OneBox {
    fn locate(&self, _: &std::path::Path, name: &str) -> Option<Arc<str>> {
        Some(name.into())
    }

    fn load(&self, _: &std::path::Path, name: &str) -> Result<Arc<Asset>, AssetError> {
        if name == "missing.obj" {
            return Err(AssetError::NotFound(name.into()));
        }
        let corner = |i: usize| {
            DVec3::new(1.0 + 2.0 * (i & 1) as f64, 1.0 + 4.0 * (i >> 1 & 1) as f64, 1.0 + 6.0 * (i >> 2) as f64)
        };
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let mut mesh = Mesh { positions: (0..8).map(corner).collect(), faces: Vec::new() };
        mesh.faces.extend(quads.map(|q| crate::geometry::Face::new(q.to_vec())));
        mesh.positions.push(corner(6) + DVec3::new(0.0, 0.0, -1e-9));
        mesh.faces[0].outer.insert(3, 8);
        mesh.faces[3].outer.insert(1, 8);
        Ok(Arc::new(Asset::new(Form { instanced: true, ..Form::from_mesh(mesh) })))
    }
}

#[track_caller]
fn inserted(body: &str) -> (Vec<f64>, usize, Vec<&'static str>) {
    let show = SHOW.replace("NIL", "print(geometry.nVertices) NIL");
    let tree =
        derive(&compiled(&format!("Lot --> {body} Show\n{show}")), &start(ground(LOT), 0), &OneBox, &Limits::default());
    let lines = numbers(&tree);
    let codes = tree.diagnostics.iter().map(|d| d.code).collect();
    ([&lines[0][..3], &lines[0][6..9]].concat(), lines[1][0] as usize, codes)
}

#[test]
fn assets_fill_the_scope_by_the_rules_for_zero_sizes() {
    let scope = |body: &str| inserted(body).0;
    near(&scope("extrude(8) i(\"box.obj\")"), &[0.0, 0.0, -10.0, 20.0, 8.0, 10.0]);
    near(&scope("i(\"box.obj\")"), &[0.0, 0.0, -10.0, 20.0, 4.0 * (10.0 + 10.0 / 6.0) / 2.0, 10.0]);
    near(&scope("s(4,0,0) i(\"box.obj\")"), &[0.0, 2.0, -8.0, 4.0, 8.0, 12.0]);
    near(&scope("s(0,0,0) i(\"box.obj\")"), &[1.0, 1.0, -9.0, 2.0, 4.0, 6.0]);
    near(&scope("s(0,0,0) i(\"box.obj\", zUp)"), &[1.0, 1.0, -15.0, 2.0, 6.0, 4.0]);
}

#[test]
fn assets_keep_their_size_where_asked() {
    let scope = |body: &str| inserted(body).0;
    near(&scope("extrude(8) i(\"box.obj\", yUp, alignSizeAndPosition)"), &[0.0, 0.0, -10.0, 20.0, 8.0, 10.0]);
    near(&scope("extrude(8) i(\"box.obj\", yUp, keepSizeAndPosition)"), &[1.0, 1.0, -9.0, 2.0, 4.0, 6.0]);
    near(&scope("extrude(8) i(\"box.obj\", yUp, keepSizeAlignPosition)"), &[9.0, 0.0, -8.0, 2.0, 4.0, 6.0]);
}

#[test]
fn short_edges_of_assets_go_unless_they_are_kept() {
    assert_eq!(inserted("i(\"box.obj\")").1, 8);
    assert_eq!(inserted("i(\"box.obj\", yUp, alignSizeAndPosition, numericalCleanup)").1, 8);
    assert_eq!(inserted("i(\"box.obj\", yUp, alignSizeAndPosition, noCleanup)").1, 9);
}

#[test]
fn a_box_stands_in_for_a_missing_asset() {
    let (scope, vertices, codes) = inserted("extrude(8) i(\"missing.obj\")");
    near(&scope, &[0.0, 0.0, -10.0, 20.0, 8.0, 10.0]);
    assert_eq!((vertices, codes), (8, vec!["cga::missing-asset"]));
}
