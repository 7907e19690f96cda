//! Reference 10.1; compatibility notes, "Shape and faces", "Scope of a component face".

use super::*;

#[test]
fn the_initial_scope_hangs_back_from_the_first_edge() {
    let tree = run(
        r#"Lot --> print(initialShape.origin.px + " " + initialShape.origin.py + " " + initialShape.origin.pz + " " + initialShape.origin.ox + " " + initialShape.origin.oy + " " + initialShape.origin.oz + " " + geometry.area) NIL"#,
        LOT,
    );
    near(&numbers(&tree)[0], &[100.0, 0.0, 200.0, 0.0, 0.0, 0.0, 200.0]);
    let s = show("Show");
    near(&s.t, &[0.0, 0.0, -10.0]);
    near(&s.s, &[20.0, 0.0, 10.0]);
    near(&[s.p, s.o, s.r].concat(), &[0.0; 9]);
}

#[test]
fn an_extruded_lot_measures_as_the_reference_says() {
    let s = show("extrude(8) Show");
    near(&s.t, &[0.0, 0.0, -10.0]);
    near(&s.s, &[20.0, 8.0, 10.0]);
    near(&[s.r, s.p, s.o].concat(), &[0.0; 9]);
    let counts = r#"Lot --> extrude(8) print(geometry.nFaces + " " + geometry.nVertices + " " + geometry.nEdges + " " + geometry.volume + " " + geometry.area) NIL"#;
    near(&numbers(&run(counts, LOT))[0], &[6.0, 8.0, 12.0, 1600.0, 880.0]);
}

#[test]
fn extrusion_orders_vertices_and_faces_as_the_notes_say() {
    let tree = run("Lot --> extrude(8)", LOT);
    let faces: Vec<&[u32]> = tree.leaves[0].mesh.faces.iter().map(|f| f.outer.as_slice()).collect();
    assert_eq!(faces, [&[1, 0, 3, 2][..], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]]);
    let tops: Vec<DVec3> = tree.leaves[0].mesh.positions[4..].to_vec();
    assert_eq!(tops[0], DVec3::new(100.0, 8.0, 200.0));
}

#[test]
fn faces_of_the_block_have_facade_frames() {
    let front = show("extrude(8) comp(f) { front : Show }");
    near(&[front.p, front.o, front.t].concat(), &[0.0; 9]);
    near(&front.s, &[20.0, 8.0, 0.0]);
    let right = show("extrude(8) comp(f) { right : Show }");
    near(&[right.p, right.o, right.s].concat(), &[20.0, 0.0, 0.0, 0.0, 90.0, 0.0, 10.0, 8.0, 0.0]);
    let back = show("extrude(8) comp(f) { back : Show }");
    near(&[back.p, back.s].concat(), &[20.0, 0.0, -10.0, 20.0, 8.0, 0.0]);
    near(&back.o.map(f64::abs), &[180.0, 0.0, 180.0]);
    let left = show("extrude(8) comp(f) { left : Show }");
    near(&[left.p, left.o, left.s].concat(), &[0.0, 0.0, -10.0, 0.0, -90.0, 0.0, 10.0, 8.0, 0.0]);
    let top = show("extrude(8) comp(f) { top : Show }");
    near(&[top.p, top.o, top.s].concat(), &[0.0, 8.0, 0.0, -90.0, 0.0, 0.0, 20.0, 10.0, 0.0]);
    let raised = show("extrude(8) comp(f) { top : extrude(2) Show }");
    near(&[raised.r, raised.t, raised.s].concat(), &[90.0, 0.0, 0.0, 0.0, 10.0, 0.0, 20.0, 2.0, 10.0]);
}

#[test]
fn edges_have_their_frames() {
    let edge = show("comp(e) { 1 : Show }");
    near(&edge.s, &[10.0, 0.0, 0.0]);
    near(&edge.p, &[20.0, 0.0, 0.0]);
    let z_up = run(r#"Lot --> comp(e) { 1 : print(convert(y, scope, world, pos, 0, 0, 1)) NIL }"#, LOT);
    near(&numbers(&z_up)[0], &[1.0]);
    let face_edge = show("comp(fe) { front : Show }");
    near(&[face_edge.p, face_edge.o].concat(), &[0.0; 6]);
    near(&face_edge.s, &[20.0, 0.0, 0.0]);
}

#[test]
fn a_slanted_first_vertex_leaves_the_origin_in_the_corner_of_the_face() {
    // The first vertex of a parallelogram is not a corner of its bounding rectangle.
    let s = show_on("comp(f) { all : Show }", &[(0.0, 0.0), (4.0, 0.0), (3.0, -2.0), (-1.0, -2.0)]);
    near(&[s.t, s.s].concat(), &[-1.0, 0.0, 0.0, 5.0, 2.0, 0.0]);
}

#[test]
fn negative_extrusion_hangs_down_with_faces_outwards() {
    let s = show("extrude(-3) Show");
    near(&[s.t, s.s].concat(), &[0.0, 0.0, -10.0, 20.0, -3.0, 10.0]);
    let tree = run("Lot --> extrude(-3) comp(f) { all : Face. }", LOT);
    let lowest = |leaf: &crate::interpreter::tree::Leaf| leaf.mesh.bounds().map_or(0.0, |b| b.0.y);
    assert!(tree.leaves.iter().any(|leaf| lowest(leaf) == -3.0));
    let block = run("Lot --> extrude(-3)", LOT);
    assert!((crate::geometry::mesh_checks::volume(&block.leaves[0].mesh) - 600.0).abs() < 1e-9);
    let flat = run("Lot --> extrude(0.001)", LOT);
    assert_eq!(flat.leaves[0].mesh.faces.len(), 1);
}

#[test]
fn a_hole_gets_walls_and_counts_as_the_notes_say() {
    let outer = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
    let hole = [(3.0, 3.0), (3.0, 6.0), (6.0, 6.0), (6.0, 3.0)];
    let ring = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(&mut mesh, &Polygon { outer: ring(&outer), holes: vec![ring(&hole)] }, 0.0);
    let tree = derived(
        r#"Lot --> extrude(2) print(geometry.nFaces + " " + geometry.nHoles + " " + geometry.nVertices) NIL"#,
        mesh,
    );
    near(&numbers(&tree)[0], &[10.0, 2.0, 16.0]);
}
