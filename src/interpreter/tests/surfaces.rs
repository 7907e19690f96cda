//! Colours, textures, assets: reference 4.10, 4.11, 4.14, 10.7.

use super::*;
use crate::interpreter::tree::Leaf;

/// Least and greatest u, then v.
fn ranges(leaf: &Leaf) -> [f64; 4] {
    let all: Vec<DVec2> = leaf.mesh.faces.iter().filter_map(|f| f.uv(0)).flatten().copied().collect();
    let low = all.iter().copied().reduce(DVec2::min).expect("the leaf has uvs");
    let high = all.iter().copied().reduce(DVec2::max).expect("the leaf has uvs");
    [low.x, high.x, low.y, high.y]
}

#[track_caller]
fn projected(setup: &str, expected: [f64; 4]) {
    let rules =
        format!("Lot --> extrude(3) comp(f) {{ front : setupProjection(0, scope.xy, {setup}) projectUV(0) A. }}");
    let tree = run(&rules, &[(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)]);
    near(&ranges(&tree.leaves[0]), &expected);
}

#[test]
fn projections() {
    projected("2, 1.5", [0.0, 2.0, 0.0, 2.0]);
    projected("~1.5, '0.5", [0.0, 3.0, 0.0, 2.0]);
    projected("'1, '1", [0.0, 1.0, 0.0, 1.0]);
    projected("-2, 1.5", [-2.0, 0.0, 0.0, 2.0]);
    projected("1, 1, 1, '0.5", [1.0, 5.0, 1.5, 4.5]);
}

#[test]
fn a_projection_stays_where_it_was_set_up() {
    let rules =
        "Lot --> extrude(3) comp(f) { front : setupProjection(0, scope.xy, 2, 1.5) split(x) { ~1 : A | ~1 : A } }
A --> projectUV(0) B.";
    let tree = run(rules, &[(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)]);
    near(&ranges(&tree.leaves[0]), &[0.0, 1.0, 0.0, 2.0]);
    near(&ranges(&tree.leaves[1]), &[1.0, 2.0, 0.0, 2.0]);
}

#[test]
fn editing_coordinates() {
    let cases = [
        ("translateUV(0, 1, -1)", [1.0, 5.0, -1.0, 2.0]),
        ("scaleUV(0, 2, 0.5)", [0.0, 8.0, 0.0, 1.5]),
        ("rotateUV(0, 90)", [-3.0, 0.0, 0.0, 4.0]),
        ("normalizeUV(0, uv, collectiveAllFaces)", [0.0, 1.0, 0.0, 1.0]),
        ("normalizeUV(0, uvUniform, separatePerFace)", [0.0, 1.0, 0.0, 0.75]),
        ("tileUV(0, 2, ~2)", [0.0, 2.0, 0.0, 2.0]),
        ("copyUV(0, 1) deleteUV(0) copyUV(1, 0)", [0.0, 4.0, 0.0, 3.0]),
    ];
    for (operation, expected) in cases {
        let rules = format!(
            "Lot --> extrude(3) comp(f) {{ front : setupProjection(0, scope.xy, 1, 1) projectUV(0) {operation} A. }}"
        );
        let tree = run(&rules, &[(0.0, 0.0), (4.0, 0.0), (4.0, -5.0), (0.0, -5.0)]);
        near(&ranges(&tree.leaves[0]), &expected);
    }
}

#[test]
fn colours_and_materials() {
    let rules = r##"Lot --> color("#ff8000") A. color("#00000080") A. color(0, 0.5, 2) set(material.roughness, 0.25) texture("brick.jpg") A. print(material.color.b) print(material.colormap) resetMaterial A."##;
    let tree = run(rules, LOT);
    let m: Vec<_> = tree.leaves.iter().map(|l| &l.material).collect();
    assert_eq!((m[0].color, m[0].opacity), ([1.0, 128.0 / 255.0, 0.0], 1.0));
    assert_eq!((m[1].color, m[1].opacity), ([0.0; 3], 128.0 / 255.0));
    assert_eq!((m[2].color, m[2].roughness, m[2].colormap.as_deref()), ([0.0, 0.5, 1.0], 0.25, Some("brick.jpg")));
    assert_eq!((m[3].color, m[3].colormap.as_deref()), ([1.0; 3], None));
    assert_eq!(tree.prints, ["1", "brick.jpg"]);
    let bad = derived("Lot --> color(\"red\") A.", ground(LOT));
    assert_eq!(bad.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::bad-color"]);
}

#[test]
fn equal_materials_are_shared() {
    let tree = run("Lot --> split(x) { ~1 : color(\"#123456\") A. }*", LOT);
    assert!(tree.leaves.iter().all(|l| Arc::ptr_eq(&l.material, &tree.leaves[0].material)));
}

#[test]
fn cubes_fill_the_scope() {
    let s = show("primitiveCube() Show");
    near(&[s.t, s.s].concat(), &[0.0, 0.0, -10.0, 20.0, 15.0, 10.0]);
    let s = show("i(\"builtin:cube\") Show");
    near(&s.s, &[20.0, 15.0, 10.0]);
    let s = show("primitiveCube(2, 3, 4) Show");
    near(&[s.t, s.s].concat(), &[9.0, 0.0, -7.0, 2.0, 3.0, 4.0]);
    let tree = run("Lot --> s('1, 4, '1) primitiveCube()", LOT);
    assert!((crate::geometry::mesh_checks::volume(&tree.leaves[0].mesh) - 800.0).abs() < 1e-9);
    near(&ranges(&tree.leaves[0]), &[0.0, 1.0, 0.0, 1.0]);
    let front = run("Lot --> s('1, 4, '1) primitiveCube() comp(f) { 5 : print(comp.sel) A. | front : B. }", LOT);
    assert_eq!((count(&front, "A"), count(&front, "B")), (1, 0), "face 5 is the front");
}

#[test]
fn a_missing_asset_is_a_box_and_a_warning() {
    let tree = derived("Lot --> extrude(8) i(\"tree.obj\")", ground(LOT));
    assert_eq!(tree.leaves[0].mesh.faces.len(), 6);
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::missing-asset"]);
}
