//! Corner normals: reference 4.10, 4.12.

use super::*;
use crate::interpreter::obj::to_obj;

/// All corner normals of a leaf's faces beside those of the faces themselves.
fn leans(tree: &ShapeTree) -> Vec<(DVec3, DVec3)> {
    let of_face = |mesh: &Mesh, f: &crate::geometry::Face| -> Vec<(DVec3, DVec3)> {
        f.normals.iter().map(|&n| (n, mesh.normal(f))).collect()
    };
    tree.leaves.iter().flat_map(|l| l.mesh.faces.iter().flat_map(|f| of_face(&l.mesh, f)).collect::<Vec<_>>()).collect()
}

#[test]
fn modes() {
    // A roof of 40 degrees: its planes differ by 80 degrees, planes and pediments by 90, planes and bottom by 140.
    let roof = |operation: &str| run(&format!("Lot --> roofGable(40) {operation}"), SMALL);
    for (operation, corners) in [
        ("setNormals(hard)", 0),
        ("setNormals(auto)", 0),
        ("softenNormals(79)", 0),
        ("softenNormals(81)", 8),
        ("setNormals(soft)", 4 + 3 + 4 + 3 + 4),
        ("softenNormals(180)", 4 + 3 + 4 + 3 + 4),
        ("setNormals(soft) setNormals(hard)", 0),
        ("setNormals(soft) softenNormals(0)", 0),
    ] {
        assert_eq!(leans(&roof(operation)).len(), corners, "{operation}");
    }
    // Along the ridge the planes meet upright; at the eaves they look as they lie.
    let tree = roof("softenNormals(81)");
    let upright = leans(&tree).iter().filter(|(n, _)| n.distance(DVec3::Y) < 1e-9).count();
    let own = leans(&tree).iter().filter(|(n, f)| n.distance(*f) < 1e-9).count();
    assert_eq!((upright, own), (4, 4));
    let tree = derived("Lot --> softenNormals(200) A.", ground(SMALL));
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::normal-angle"]);
}

#[test]
fn conform_turns_faces_outwards() {
    let volume = |operation: &str| {
        let rules =
            format!("Lot --> extrude(3) reverseNormals() {operation} comp(f) {{ top : Top. | bottom : Bottom. }}");
        let tree = run(&rules, SMALL);
        let heights = |rule: &str| tree.leaves.iter().find(|l| &*l.rule == rule).map(|l| l.mesh.positions[0].y);
        (heights("Top"), heights("Bottom"))
    };
    assert_eq!(volume(""), (Some(0.0), Some(3.0)));
    assert_eq!(volume("setNormals(conform)"), (Some(3.0), Some(0.0)));
}

#[test]
fn normals_go_through_cuts_components_scaling_and_setbacks() {
    let soft = "Lot --> extrude(4) setNormals(soft) ";
    // In the middle of a wall of a softened block normals lean less than at its corners.
    let cut = run(&format!("{soft} comp(f) {{ front : split(x) {{ ~1 : A. | ~1 : A. }} }}"), SMALL);
    let middle: Vec<_> = leans(&cut).into_iter().filter(|(n, _)| n.x.abs() < 1e-9).collect();
    assert_eq!((leans(&cut).len(), middle.len()), (8, 4));
    assert!(middle.iter().all(|(n, face)| (n.length() - 1.0).abs() < 1e-12 && n.dot(*face) > 0.7));
    let inner = run(&format!("{soft} comp(f) {{ front : setback(1) {{ all : NIL | remainder : A. }} }}"), SMALL);
    for (corner, face) in leans(&inner) {
        assert!(corner.dot(face) > 1.0 / 3f64.sqrt() + 0.01, "further in they lean less");
    }
    assert_eq!(leans(&inner).len(), 4);
    // Scaled by -1 the block is inside out, and its normals look inwards with it.
    let mirrored = run(&format!("{soft} s(-10, '1, '1) A."), SMALL);
    assert!(leans(&mirrored).iter().all(|(n, face)| n.dot(*face) > 0.5));
    let turned = run(&format!("{soft} r(0, 90, 0) reverseNormals() A."), SMALL);
    assert!(leans(&turned).len() == 24 && leans(&turned).iter().all(|(n, face)| n.dot(*face) > 0.5));
    // A flattened sphere's normals stay across its surface.
    let flat = run("Lot --> s(10, 1, 10) primitiveSphere(64, 64)", SMALL);
    let mesh = &flat.leaves[0].mesh;
    let (low, high) = mesh.bounds().expect("a sphere has extent");
    for (v, n) in mesh.faces.iter().flat_map(|f| f.corners().zip(&f.normals)) {
        let across = (mesh.positions[v as usize] - (low + high) / 2.0) / ((high - low) * (high - low));
        assert!(n.distance(across.normalize()) < 0.01, "{n}");
    }
}

#[test]
fn round_primitives_are_smooth() {
    for (rules, smooth, flat) in [
        ("primitiveCylinder(12)", 12, 2),
        ("primitiveCone(12)", 12, 1),
        ("primitiveSphere(12, 6)", 72, 0),
        ("primitiveCube()", 0, 6),
        ("primitiveQuad()", 0, 1),
        ("primitiveDisk(12)", 0, 1),
    ] {
        let tree = run(&format!("Lot --> s('1, 5, '1) {rules}"), SMALL);
        let faces = &tree.leaves[0].mesh.faces;
        let count = faces.iter().filter(|f| !f.normals.is_empty()).count();
        assert_eq!((count, faces.len() - count), (smooth, flat), "{rules}");
        assert!(leans(&tree).iter().all(|(n, face)| n.dot(*face) > 0.8), "{rules}");
    }
}

#[test]
fn files_have_normals() {
    let text = to_obj(&run("Lot --> extrude(1) setNormals(soft)", SMALL));
    assert_eq!(text.lines().filter(|l| l.starts_with("vn ")).count(), 24);
    assert!(text.lines().filter(|l| l.starts_with("f ")).all(|l| l.contains("//")));
    assert!(!to_obj(&run("Lot --> extrude(1)", SMALL)).contains("vn"));
}
