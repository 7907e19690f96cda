//! Reference 4.1: every kind of component, their frames and partitions.

use super::*;

#[test]
fn corners_of_faces_have_frames_between_their_edges() {
    // Corner 1 of the lot: in along +x, out along -z.
    let s = show("comp(fv) { 1 : Show }");
    near(&s.p, &[20.0, 0.0, 0.0]);
    near(&[s.t, s.s, s.r].concat(), &[0.0; 9]);
    // x halves the corner: (1, 0, -1); z points outwards: (1, 0, 1); y is the face's normal.
    let axes = run(
        r#"Lot --> comp(fv) { 1 : t(1, 0, 0) P t(-1, 1, 0) P t(0, -1, 1) P }
P --> print(convert(x, scope, world, pos, 0, 0, 0) + " " + convert(y, scope, world, pos, 0, 0, 0) + " " + convert(z, scope, world, pos, 0, 0, 0)) NIL"#,
        LOT,
    );
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let lines = numbers(&axes);
    near(&lines[0], &[120.0 + half, 0.0, 200.0 - half]);
    near(&lines[1], &[120.0, 1.0, 200.0]);
    near(&lines[2], &[120.0 + half, 0.0, 200.0 + half]);
}

#[test]
fn vertices_keep_the_parents_x() {
    let s = show("rotateScope(0, 30, 0) comp(v) { 0 : Show }");
    near(&[s.p, s.o].concat(), &[0.0, 0.0, 0.0, -90.0, 30.0, 0.0]);
}

#[test]
fn holes_become_faces_in_the_frame_of_their_loop() {
    let rules = r#"Lot --> setback(2) { all = Ring }
Ring --> comp(h) { all : print(geometry.area + " " + geometry.nHoles + " " + comp.total) Hole. }"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["96 0 1"]);
    assert!(tree.leaves[0].mesh.newell(&tree.leaves[0].mesh.faces[0]).y > 0.0, "it looks where its face looks");
}
