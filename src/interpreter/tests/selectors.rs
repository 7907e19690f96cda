//! Reference 4.0.7, 4.1, 10.4.

use super::*;

#[test]
fn every_side_of_a_block_once() {
    let tree = run(
        "Lot --> extrude(8) comp(f) { top : T. | bottom : B. | front : F. | back : K. | left : L. | right : R. }",
        LOT,
    );
    for rule in ["T", "B", "F", "K", "L", "R"] {
        assert_eq!(count(&tree, rule), 1, "{rule}");
    }
    for (selector, n) in [
        ("side", 4),
        ("vertical", 4),
        ("horizontal", 2),
        ("all", 6),
        ("object.side", 4),
        ("world.up", 1),
        ("border", 0),
        ("inside", 6),
        ("7", 0),
        ("1", 1),
    ] {
        let tree = run(&format!("Lot --> extrude(8) comp(f) {{ {selector} : A. }}"), LOT);
        assert_eq!(count(&tree, "A"), n, "{selector}");
    }
}

#[test]
fn selectors_take_turns_and_number_their_shapes() {
    let rules = r#"Lot --> extrude(8) comp(f) { left : A | vertical : A | horizontal = A }
A --> print(comp.sel + " " + comp.index + " " + comp.total + " " + geometry.nFaces) NIL"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["left 0 1 1", "vertical 0 3 1", "vertical 1 3 1", "vertical 2 3 1", "horizontal 0 1 2"]);
}

#[test]
fn conditions_see_the_component() {
    let tree = run(
        "Lot --> extrude(8) comp(f) { geometry.area > 100 && !top && !bottom : Wide. | comp.index == 1 : Second. }",
        LOT,
    );
    assert_eq!((count(&tree, "Wide"), count(&tree, "Second")), (2, 1));
    assert_eq!(areas(&tree, "Second"), [200.0]);
}

#[test]
fn connected_faces_come_together() {
    let tree = run("Lot --> extrude(8) comp(f) { side =: Walls. | all =: Flats. }", LOT);
    assert_eq!((count(&tree, "Walls"), count(&tree, "Flats")), (1, 2));
}

#[test]
fn axes_can_stay() {
    let s = show("extrude(8) comp(f, noAlign) { right : Show }");
    near(&[s.p, s.o, s.t, s.s].concat(), &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 20.0, 0.0, -10.0, 0.0, 8.0, 10.0]);
}

#[test]
fn roof_edges_have_names() {
    let rules = "Lot --> roofHip(45) comp(f) { bottom : NIL | all = Roof }
Roof --> comp(e) { eave : Eave. | hip : Hip. | valley : Valley. | ridge : Ridge. }";
    let tree = run(rules, SMALL);
    let counts = ["Eave", "Hip", "Valley", "Ridge"].map(|r| count(&tree, r));
    assert_eq!(counts, [4, 4, 0, 1]);
    let l = run(rules, &[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)]);
    assert_eq!((count(&l, "Eave"), count(&l, "Valley")), (6, 1));
}

#[test]
fn the_comp_function_gives_one_value_per_component() {
    let rules = r#"attr walls = sum(comp(fe) { front : 1 | left : 10 })
Lot --> extrude(8) print(walls) print(comp(f) { top : geometry.area | side : comp.index }) print(comp(f) { horizontal = geometry.area }) NIL"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["11", "(6)[0,200,0,1,2,3]", "(6)[400,400,0,0,0,0]"]);
}
