//! Reference 4.16: inlining and boolean operations.

use super::*;
use crate::geometry::mesh_checks::{is_closed, surface_area, volume};

/// The only leaf of a rule file.
#[track_caller]
fn single(rules: &str) -> crate::interpreter::tree::Leaf {
    let mut tree = run(rules, LOT);
    assert_eq!(tree.leaves.len(), 1, "{rules}");
    tree.leaves.remove(0)
}

/// Volume of the closed leaf of `Lot --> extrude(8) body`.
#[track_caller]
fn closed(body: &str, rest: &str) -> f64 {
    let leaf = single(&format!("Lot --> extrude(8) {body}\n{rest}"));
    assert!(is_closed(&leaf.mesh), "{body}: open");
    volume(&leaf.mesh)
}

#[test]
fn inline_merges_what_its_rules_end_in() {
    let rules = "Lot --> extrude(8) inline(append) Halves Out.
Halves --> split(x) { ~1 : Half | ~3 : NIL | ~1 : Half }
Half --> t(0,1,0) Deep
Deep --> H.";
    let leaf = single(rules);
    assert_eq!((&*leaf.rule, leaf.mesh.faces.len()), ("Out", 12));
    near(&[volume(&leaf.mesh), leaf.mesh.bounds().expect("two blocks").1.y], &[640.0, 9.0]);
    let s = show("extrude(8) inline { split(x) { ~1 : H. | ~1 : t(0,2,0) H. } } Show");
    near(&[s.t, s.s, s.p].concat(), &[0.0, 0.0, -10.0, 20.0, 10.0, 10.0, 0.0, 0.0, 0.0]);
    // One shape is taken as it is, pivot and all; none leaves nothing.
    let s = show("extrude(8) inline comp(f) { right : W. } Show");
    near(&[s.p, s.s].concat(), &[20.0, 0.0, 0.0, 10.0, 8.0, 0.0]);
    let tree = run("Lot --> extrude(8) inline { NIL } print(geometry.nFaces + \" \" + scope.sx) A.", LOT);
    assert_eq!((tree.prints[0].as_str(), tree.leaves.len()), ("0 0", 0));
}

#[test]
fn materials_that_differ_are_written_to_the_faces() {
    let rules = "Lot --> color(0,0,1) extrude(8) inline { split(x) { ~1 : color(1,0,0) H. | ~1 : H. } } Out.";
    let colors = |rules: &str| -> Vec<[f64; 3]> { run(rules, LOT).leaves.iter().map(|l| l.material.color).collect() };
    assert_eq!(colors(rules), [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(colors(&rules.replace("Out.", "color(0,1,0) Out.")), [[0.0, 1.0, 0.0]; 2]);
    let same = rules.replace("~1 : H.", "~1 : color(1,0,0) H.");
    assert_eq!(colors(&same), [[1.0, 0.0, 0.0]]);
}

#[test]
fn attributes_that_all_pieces_agree_on_are_taken_over() {
    let rules = "attr a = 1\nattr b = 1
Lot --> inline { split(x) { ~1 : set(a, 2) set(b, 5) H. | ~1 : set(a, 2) set(b, 6) H. } } print(a + \" \" + b) Out.";
    assert_eq!(run(rules, LOT).prints, ["2 1"]);
}

#[test]
fn unify_leaves_no_walls_inside() {
    let three = "{ split(x) { ~1 : H. | ~1 : s('1.5,'1,'1) H. } [ t(30,0,0) H. ] }";
    let body = format!("inline(unify) {three} Out.");
    near(&[closed(&body, "")], &[800.0 + 1200.0 + 1600.0]);
    let leaf = single(&format!("Lot --> extrude(8) {body}"));
    // 25 m in one piece and, 5 m away, 20 m, both 10 m deep and 8 m high.
    let box_area = |length: f64| 2.0 * (length * 10.0 + length * 8.0 + 80.0);
    near(&[surface_area(&leaf.mesh)], &[box_area(25.0) + box_area(20.0)]);
    let appended = single(&format!("Lot --> extrude(8) inline {three} Out."));
    assert_eq!(appended.mesh.faces.len(), 18);
}

#[test]
fn booleans_of_blocks() {
    let tower = "Tower --> t(15,0,0) s(10,'2,'1) T.";
    near(&[closed("union { Mass. | Tower } Out.", tower)], &[1600.0 + 1600.0 - 400.0]);
    near(&[closed("subtract { Mass. | Tower } Out.", tower)], &[1200.0]);
    near(&[closed("subtract { Tower | Mass. } Out.", tower)], &[1200.0]);
    near(&[closed("intersect { Mass. | Tower } Out.", tower)], &[400.0]);
    // The scope is fitted; operands may be implicit leaves.
    let s = show("extrude(8) subtract { A. | t('0.5,0,0) } Show");
    near(&[s.t, s.s].concat(), &[0.0, 0.0, -10.0, 10.0, 8.0, 10.0]);
    // Two pieces in an operand that overlap count once.
    let pair = "Pair --> [ s('0.5,'1,'1) P. ] t('0.25,0,0) s('0.5,'1,'1) P.";
    near(&[closed("intersect { Mass. | Pair } Out.", pair)], &[1200.0]);
    near(&[closed("subtract { Mass. | NIL } Out.", "")], &[1600.0]);
    assert!(run("Lot --> extrude(8) intersect { Mass. | NIL } Out.", LOT).leaves.is_empty());
}

#[test]
fn the_old_forms_take_the_current_shape() {
    let rules =
        |operation: &str| format!("Lot --> extrude(8) {operation} Tower Out.\nTower --> t(15,0,0) s(10,'2,'1) T.");
    for (operation, expected) in
        [("subtract", 1200.0), ("subtract(swap)", 1200.0), ("union", 2800.0), ("intersect", 400.0)]
    {
        let tree = derived(&rules(operation), ground(LOT));
        near(&[volume(&tree.leaves[0].mesh)], &[expected]);
        let low = tree.leaves[0].mesh.bounds().expect("a block").0.x;
        assert_eq!(low, if operation == "subtract(swap)" || operation == "intersect" { 115.0 } else { 100.0 });
    }
    let mut sources = SourceMap::default();
    let (_, diagnostics) = compile_text("a.cga", &rules("subtract(swap)"), &mut sources, &CompileOptions::default());
    assert!(diagnostics.iter().any(|d| d.code == "cga::deprecated"));
}

#[test]
fn every_face_of_a_boolean_is_found_once() {
    for operation in ["union", "subtract", "intersect"] {
        let rules = format!(
            "Lot --> extrude(8) {operation} {{ Mass. | t(15,4,5) H. }} print(geometry.nFaces) print(geometry.area)
  comp(f) {{ all : print(geometry.area) F. }}"
        );
        let tree = run(&rules, LOT);
        let lines: Vec<f64> = numbers(&tree).into_iter().flatten().collect();
        assert_eq!(lines[0] as usize, lines.len() - 2);
        near(&[lines[2..].iter().sum()], &[lines[1]]);
        assert_eq!(count(&tree, "F"), lines.len() - 2);
    }
}

#[test]
fn tags_tell_the_operands_and_the_cut() {
    let rules = "Lot --> extrude(8) tag(\"mass\") subtract { Mass. | t(5,4,0) s(10,'1,'1) deleteTags(\"mass\") tag(\"hole\") } Look
Look --> comp(f) { isTagged(\"bool.B\") && isTagged(\"hole\") = B. | isTagged(\"bool.A\") && isTagged(\"mass\") = A. | all = Other. }
  comp(e) { isTagged(\"bool.cut\") : Cut. } print(geometry.nFaces) NIL";
    let tree = run(rules, LOT);
    near(&areas(&tree, "B"), &[10.0 * 10.0 + 2.0 * 4.0 * 10.0]);
    near(&areas(&tree, "A"), &[200.0 + 2.0 * 80.0 + 2.0 * (160.0 - 40.0) + 100.0]);
    assert_eq!((count(&tree, "Other"), count(&tree, "Cut")), (0, 8));
    // A plane through a block cuts its four sides.
    let plane = "Lot --> Plane\nPlane --> t(0,4,0) subtract { P. | t(5,-4,2) s(10,'1,5) extrude(8) } comp(f) { isTagged(\"bool.A\") = Cut. }";
    near(&areas(&run(plane, LOT), "Cut"), &[150.0]);
}

#[test]
fn cut_edges_are_tagged() {
    let rules = "Lot --> extrude(8) subtract { Mass. | t(5,4,2) s(10,'1,5) } Count
Count --> print(size(comp(e) { isTagged(\"bool.cut\") : 1 })) print(sum(comp(e) { isTagged(\"bool.cut\") : scope.sx })) NIL";
    let lines: Vec<f64> = numbers(&run(rules, LOT)).into_iter().flatten().collect();
    near(&lines[1..], &[30.0]);
}

#[test]
fn flat_shapes_keep_their_edges() {
    let areas_of = |operation: &str| {
        let rules = format!("Lot --> {operation} {{ A. | t(10,0,5) B. }} comp(f) {{ all : F. }}");
        areas(&run(&rules, LOT), "F")
    };
    assert_eq!(areas_of("union"), [150.0, 50.0, 150.0]);
    assert_eq!(areas_of("subtract"), [150.0]);
    assert_eq!(areas_of("intersect"), [50.0]);
    let both = "Lot --> union { A. | t(10,0,5) B. } comp(f) { isTagged(\"bool.A\") && isTagged(\"bool.B\") : F. }";
    assert_eq!(areas(&run(both, LOT), "F"), [50.0]);
}

#[test]
fn the_material_of_the_first_operand_wins_where_they_lie_on_each_other() {
    let rules = "Lot --> union { color(1,0,0) A. | color(0,0,1) t(10,0,0) B. } Out.";
    let tree = run(rules, LOT);
    let parts: Vec<([f64; 3], f64)> = tree.leaves.iter().map(|l| (l.material.color, surface_area(&l.mesh))).collect();
    assert_eq!(parts, [([1.0, 0.0, 0.0], 200.0), ([0.0, 0.0, 1.0], 100.0)]);
}

#[test]
fn operands_draw_their_own_numbers() {
    let rules = |first: &str| {
        format!(
            "Lot --> extrude(8) union {{ {first} | Second }} Third\nFirst --> print(rand) A.
Second --> t(100,0,0) B\nB --> report(\"inside\", 1) print(rand) C.\nThird --> print(rand) D."
        )
    };
    let with = run(&rules("First"), LOT);
    let without = run(&rules("A."), LOT);
    assert_eq!(with.prints[1..], without.prints[..]);
    assert_ne!(with.prints[0], with.prints[1]);
    assert_eq!(with.reports.len(), 1);
}

#[test]
fn inlining_without_end_stops() {
    for rules in ["Lot --> extrude(8) inline Lot", "Lot --> union { A. | Lot }", "Lot --> inline { A }\nA --> A A"] {
        let limits = Limits { max_shapes: 20_000, ..Limits::default() };
        let tree = derive(&compiled(rules), &start(ground(LOT), 0), &NoAssets, &limits);
        assert!(tree.diagnostics.iter().any(|d| d.code.starts_with("cga::limit")), "{rules}");
    }
}
