//! Reference 4.2 and 4.16.5: shapes taken apart, edited, and put together again.

use super::*;
use crate::geometry::mesh_checks::{is_closed, volume};

#[track_caller]
fn single(rules: &str) -> crate::interpreter::tree::Leaf {
    let mut tree = run(rules, LOT);
    assert_eq!(tree.leaves.len(), 1, "{rules}");
    tree.leaves.remove(0)
}

/// Closed volume, faces and vertices of the block after `body`.
#[track_caller]
fn block(body: &str) -> (f64, usize, usize) {
    let leaf = single(&format!("Lot --> extrude(8) {body} Out."));
    assert!(is_closed(&leaf.mesh), "{body}: open");
    (volume(&leaf.mesh), leaf.mesh.faces.len(), leaf.mesh.positions.len())
}

#[test]
fn a_vertex_is_pulled_and_its_faces_follow() {
    let leaf = single("Lot --> modify(v) { 0 : t(0,0,1) Corner. } Out.");
    assert_eq!((&*leaf.rule, leaf.mesh.faces.len(), leaf.mesh.positions.len()), ("Out", 1, 4));
    let heights: Vec<f64> = leaf.mesh.positions.iter().map(|p| p.y).collect();
    assert_eq!(heights, [1.0, 0.0, 0.0, 0.0]);
    // Along the mean of three normals.
    let (_, faces, vertices) = block("modify(v) { 0 : t(0,0,1) Corner. }");
    assert_eq!((faces, vertices), (6, 8));
}

#[test]
fn offsets_of_copies_add_up() {
    let raised =
        single("Lot --> extrude(8) inline(recompose) comp(f) { all : translate(rel, world, 0, 0.5, 0) F. } Out.");
    let bounds = raised.mesh.bounds().expect("a block");
    assert_eq!((bounds.0.y, bounds.1.y), (1.5, 9.5));
    let (grown, faces, vertices) = block("inline(recompose) comp(f) { all : t(0,0,0.5) F. }");
    near(&[grown], &[21.0 * 9.0 * 11.0]);
    assert_eq!((faces, vertices), (6, 8));
}

#[test]
fn faces_that_move_take_their_neighbours_along() {
    let (taller, faces, vertices) = block("modify(f) { top : t(0,0,2) Roof } ");
    near(&[taller], &[2000.0]);
    assert_eq!((faces, vertices), (6, 8));
    // Smaller, about its middle: a frustum.
    let (frustum, ..) = block("modify(f) { top : s('0.5,'0.5,'1) center(xy) F. }");
    near(&[frustum], &[8.0 / 3.0 * (200.0 + 50.0 + 100.0)]);
    // Rules are derived to their end first.
    let deep = run("Lot --> extrude(8) modify(f) { top : A } Out.\nA --> t(0,0,1) B\nB --> t(0,0,1) C.", LOT);
    near(&[volume(&deep.leaves[0].mesh)], &[2000.0]);
    assert_eq!(deep.leaves.len(), 1);
}

#[test]
fn an_edge_is_moved_with_its_faces() {
    let tree = single("Lot --> extrude(8) modify(e) { top : translate(rel, world, 0, 1, 0) E. } Out.");
    // Each top corner ends two of the four edges that look up, at 45 degrees.
    assert!(is_closed(&tree.mesh));
    let say = "Lot --> extrude(8) modify(e) { 0 : translate(rel, world, 0, -1, 0) E. } print(scope.sy) NIL";
    near(&numbers(&run(say, LOT))[0], &[9.0]);
}

#[test]
fn parts_cut_on_a_shared_edge_stay_joined() {
    let (same, faces, vertices) = block("modify(f) { front : split(x) { 5 : A. | ~1 : B. } }");
    near(&[same], &[1600.0]);
    assert_eq!((faces, vertices), (7, 10));
    // Both sides of the edge between top and front are cut at the same place: one vertex.
    let (_, faces, vertices) = block(
        "modify(f) { front | top : split(x) { ~1 : A. | ~1 : B. } }".replace("front | top", "front || top").as_str(),
    );
    assert_eq!((faces, vertices), (8, 11));
    // Cut again: a quarter of the edge is a place on the edge.
    let twice = "modify(f) { front : split(x) { ~1 : split(x) { ~1 : A. | ~1 : A. } | ~1 : B. } | top : split(x) { 5 : A. | ~1 : B. } }";
    let (_, faces, vertices) = block(twice);
    assert_eq!((faces, vertices), (9, 13));
}

#[test]
fn a_joint_moves_with_the_edge_of_its_neighbour() {
    // The top is raised; the joint that the front put on their edge rises with it.
    let (raised, faces, _) = block("modify(f) { front : split(x) { 5 : A. | ~1 : B. } | top : t(0,0,2) T. }");
    near(&[raised], &[2000.0]);
    assert_eq!(faces, 7);
}

#[test]
fn discarded_parts_move_vertices_and_leave_no_face() {
    let leaf = single("Lot --> extrude(8) modify(f) { top : t(0,0,2) NIL } Out.");
    assert_eq!((leaf.mesh.faces.len(), leaf.mesh.bounds().expect("walls").1.y), (5, 10.0));
    // Without the untouched rest.
    let only = single("Lot --> extrude(8) inline(recompose) comp(f) { front : F. | top : F. } Out.");
    assert_eq!((only.mesh.faces.len(), only.mesh.positions.len()), (2, 6));
    assert!(run("Lot --> extrude(8) inline(recompose) comp(v) { all : V. } Out.", LOT).leaves.is_empty());
}

#[test]
fn materials_of_edited_faces_are_written_to_them() {
    let rules = "Lot --> color(0,0,1) extrude(8) modify(f) { top : color(1,0,0) T. } Out.";
    let tree = run(rules, LOT);
    let faces: Vec<([f64; 3], usize)> = tree.leaves.iter().map(|l| (l.material.color, l.mesh.faces.len())).collect();
    assert_eq!(faces, [([1.0, 0.0, 0.0], 1), ([0.0, 0.0, 1.0], 5)]);
}
