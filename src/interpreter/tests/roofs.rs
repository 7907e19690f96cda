//! Reference 10.5; compatibility notes, "Roofs".

use super::*;

#[track_caller]
fn size(body: &str, expected: [f64; 3]) {
    near(&show_on(&format!("{body} Show"), SMALL).s, &expected);
}

fn faces(body: &str) -> usize {
    run(&format!("Lot --> {body}"), SMALL).leaves[0].mesh.faces.len()
}

#[test]
fn the_table_of_the_reference() {
    size("roofHip(45)", [10.0, 3.0, 6.0]);
    assert_eq!(faces("roofHip(45)"), 5);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    size("roofHip(45, 1)", [10.0 + 2.0 * half, 3.0 + half, 6.0 + 2.0 * half]);
    size("roofHip(byHeight, 2)", [10.0, 2.0, 6.0]);
    size("roofGable(30)", [10.0, 3.0 * libm::tan(30f64.to_radians()), 6.0]);
    assert_eq!(faces("roofGable(30)"), 5);
    size("roofPyramid(45)", [10.0, 3.0, 6.0]);
    assert_eq!(faces("roofPyramid(45)"), 5);
    size("roofShed(30)", [10.0, 6.0 * libm::tan(30f64.to_radians()), 6.0]);
    assert_eq!(faces("roofShed(30)"), 5);
    size("roofRidge(byAngle, 45)", [10.0, 3.0, 6.0]);
}

#[test]
fn roofs_stand_on_extruded_tops_and_are_closed() {
    for roof in ["roofHip(30)", "roofGable(30)", "roofPyramid(30)", "roofShed(20)"] {
        let tree = run(&format!("Lot --> extrude(5) comp(f) {{ top : {roof} Roof. }}"), SMALL);
        let mesh = &tree.leaves[0].mesh;
        assert!(crate::geometry::mesh_checks::is_closed(mesh), "{roof}");
        assert!(crate::geometry::mesh_checks::volume(mesh) > 0.0, "{roof}");
        assert_eq!(mesh.bounds().map(|b| b.0.y), Some(5.0), "{roof}");
        assert!(mesh.faces.iter().skip(1).any(|f| mesh.normal(f).y > 0.5), "{roof}");
    }
}

#[test]
fn a_wall_can_carry_a_roof_too() {
    let tree = run("Lot --> extrude(6) comp(f) { front : roofPyramid(45) A. }", SMALL);
    let (low, high) = tree.leaves[0].mesh.bounds().expect("a roof");
    near(&[low.z, high.z], &[0.0, 3.0]);
}

#[test]
fn gables_rise_over_the_ends() {
    let tree = run("Lot --> roofGable(40) comp(f) { vertical : Gable. | top : Plane. }", SMALL);
    assert_eq!((count(&tree, "Gable"), count(&tree, "Plane")), (2, 2));
    near(&areas(&tree, "Gable"), &[9.0 * libm::tan(40f64.to_radians()); 2]);
}

#[test]
fn a_steep_angle_is_refused_with_a_warning() {
    let tree = derived("Lot --> roofHip(95) A.", ground(SMALL));
    assert_eq!(tree.leaves[0].mesh.faces.len(), 1);
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::roof"]);
}
