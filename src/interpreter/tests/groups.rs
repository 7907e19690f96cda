//! Groups and materials of inserted files: reference 4.1 (`g`, `m`), 4.11, 6.6.

use super::*;
use crate::interpreter::FileAssets;
use crate::interpreter::tree::ShapeTree;
use crate::source::Access;

/// A house of walls and a roof, a door of its own material, and a chimney without group and material.
const HOUSE: &str = "mtllib house.mtl
v 0 0 0\nv 4 0 0\nv 4 0 -2\nv 0 0 -2\nv 0 3 0\nv 4 3 0\nv 4 3 -2\nv 0 3 -2
v 1 3 -1\nv 2 3 -1\nv 2 5 -1
f 9 10 11
g walls
usemtl brick
f 1 2 6 5
f 3 4 8 7
usemtl wood
f 2 3 7 6
g roof
f 5 6 7 8
g walls
usemtl brick
f 4 1 5 8
";
const MATERIALS: &str = "newmtl brick\nKd 1 0 0\nnewmtl wood\nKd 0 0 1\n";

/// Derives rules beside the file `house.obj`.
fn beside_house(rules: &str) -> ShapeTree {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("the folder takes files");
    file("house.obj", HOUSE);
    file("house.mtl", MATERIALS);
    file("test.cga", rules);
    let access = Access::new(folder.path()).expect("the folder is there");
    let mut sources = SourceMap::default();
    let path = folder.path().join("test.cga");
    let (program, diagnostics) = crate::cga::compile(&path, &access, &mut sources, &CompileOptions::default());
    let messages: Vec<&str> = diagnostics.iter().map(|d| d.message.as_str()).collect();
    let program = program.unwrap_or_else(|| panic!("{rules}\n{messages:?}"));
    let tree = derive(&program, &start(ground(SMALL), 0), &FileAssets::new(access), &Limits::default());
    let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(messages.is_empty(), "{rules}\n{messages:?}");
    tree
}

const INSERT: &str = r#"Lot --> s(4, 5, 2) i("house.obj") "#;

#[test]
fn groups_and_materials_have_names() {
    let tree = beside_house(&format!("{INSERT} print(geometry.groups) print(geometry.materials) NIL"));
    assert_eq!(tree.prints, ["(3)[,walls,roof]", "(3)[,brick,wood]"]);
    let tree = run("Lot --> print(geometry.groups) print(geometry.materials) NIL", SMALL);
    assert_eq!(tree.prints, ["(1)[]", "(1)[]"], "one nameless group");
}

#[test]
fn groups_become_shapes_in_the_old_frame() {
    let rules = format!(
        r#"{INSERT} comp(g) {{ all : print(comp.index + " " + geometry.groups + " " + geometry.nFaces + " " + scope.sx + " " + scope.sy + " " + scope.ty + " " + scope.rx) G. }}"#
    );
    let tree = beside_house(&rules);
    assert_eq!(tree.prints, ["0 (1)[] 1 1 2 3 0", "1 (1)[walls] 4 4 3 0 0", "2 (1)[roof] 1 4 0 3 0"]);
}

#[test]
fn materials_become_shapes_with_their_material() {
    let rules = format!("{INSERT} comp(m) {{ all : print(geometry.materials + material.color.rgb) M. }}");
    let tree = beside_house(&rules);
    assert_eq!(
        tree.prints,
        ["(1)[]#FFFFFF", "(1)[brick]#FF0000", "(1)[wood]#0000FF"].map(|p| p.replace("#FFFFFF", "#ffffff"))
    );
    let colors: Vec<[f64; 3]> = tree.leaves.iter().map(|l| l.material.color).collect();
    assert_eq!(colors, [[1.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
}

#[test]
fn one_face_that_fits_is_enough() {
    let named = |component: &str, selectors: &str| {
        let tree = beside_house(&format!("{INSERT} comp({component}) {{ {selectors} }}"));
        // A leaf of two materials counts once.
        let mut leaves: Vec<_> = tree.leaves.iter().map(|l| (l.path.clone(), l.rule.to_string())).collect();
        leaves.dedup();
        leaves.into_iter().map(|(_, rule)| rule).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(named("g", "top : Top. | front : Front. | all : Rest."), "Top Front Front");
    assert_eq!(named("g", "back : Back. | !front : No. | 0 : Zero."), "Back No Zero");
    assert_eq!(named("m", "right && top : Wood. | geometry.nFaces == 3 : Brick."), "Wood Brick");
    assert_eq!(named("g", "all =: Part."), "Part Part", "walls and roof share edges");
    assert_eq!(named("g", "all = Whole."), "Whole");
}

#[test]
fn groups_survive_cuts() {
    let rules = format!(
        "{INSERT} split(x) {{ ~1 : P | ~1 : P }}\nP --> print(geometry.groups) comp(g) {{ all : print(geometry.nFaces) NIL }}"
    );
    let tree = beside_house(&rules);
    assert_eq!(tree.prints.iter().filter(|p| p.contains("walls")).count(), 2, "{:?}", tree.prints);
    let faces: f64 = tree.prints.iter().filter_map(|p| p.parse::<f64>().ok()).sum();
    assert!(faces >= 8.0);
}
