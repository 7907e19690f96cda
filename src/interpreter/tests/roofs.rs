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

#[test]
fn roofs_of_the_map_by_name() {
    for name in ["gabled", "Hipped", "half_hipped", "pyramidal", "cone", "mansard", "gambrel", "dome", "onion", "round"]
    {
        let tree = run(&format!("Lot --> roofShape(\"{name}\", byHeight, 3) Roof."), SMALL);
        let mesh = &tree.leaves[0].mesh;
        assert_eq!(crate::geometry::mesh_checks::defects(mesh, &[]), [], "{name}");
        assert_eq!(mesh.bounds().map(|(low, high)| (low.y, high.y)), Some((0.0, 3.0)), "{name}");
        assert_eq!(tree.diagnostics.iter().count(), 0, "{name}");
    }
    assert_eq!(faces("roofShape(\"skillion\", byAngle, 20) A."), 5);
    assert_eq!(faces("roofShape(\"flat\", byHeight, 0) A."), 1);
    size("roofShape(\"hipped\", byAngle, 45)", [10.0, 3.0, 6.0]);
    // From eaves to ridge on bent roofs.
    size("roofShape(\"dome\", byAngle, 45)", [10.0, 3.0, 6.0]);
}

#[test]
fn directions_are_clockwise_from_north() {
    // Downhill to the north (-z): high in the south.
    let tree = run("Lot --> roofShape(\"skillion\", byHeight, 2, 0) A.", SMALL);
    assert!(tree.leaves[0].mesh.positions.iter().filter(|p| p.y > 1.9).all(|p| p.z == 0.0));
    let tree = run("Lot --> roofShape(\"skillion\", byHeight, 2, 90) A.", SMALL);
    assert!(tree.leaves[0].mesh.positions.iter().filter(|p| p.y > 1.9).all(|p| p.x == 0.0));
    let pediments = |how: &str| {
        let tree = run(
            &format!("Lot --> roofShape(\"gabled\", byHeight, 2{how}) comp(f) {{ vertical : Gable. | all : NIL }}"),
            SMALL,
        );
        areas(&tree, "Gable")
    };
    for how in ["", ", 180", ", 3", ", along"] {
        near(&pediments(how), &[6.0; 2]);
    }
    for how in [", 90", ", -80", ", across"] {
        near(&pediments(how), &[10.0; 2]);
    }
}

#[test]
fn an_unknown_roof_is_flat_and_the_meant_one_is_named() {
    let tree = derived("Lot --> roofShape(\"gabeld\", byHeight, 2) A.", ground(SMALL));
    assert_eq!(tree.leaves[0].mesh.faces.len(), 1);
    let said: Vec<_> = tree.diagnostics.iter().map(|d| (d.code, d.message.clone())).collect();
    assert_eq!(said.len(), 1);
    assert_eq!(said[0].0, "cga::roof-shape");
    assert!(said[0].1.contains("did you mean \"gabled\"?"), "{}", said[0].1);
}

#[test]
fn a_roof_that_cannot_stand_falls_back_to_a_hip() {
    const CEE: &[(f64, f64)] =
        &[(0.0, 0.0), (10.0, 0.0), (10.0, -1.0), (1.0, -1.0), (1.0, -7.0), (10.0, -7.0), (10.0, -8.0), (0.0, -8.0)];
    for name in ["onion", "pyramidal"] {
        let tree = derived(&format!("Lot --> roofShape(\"{name}\", byHeight, 3) A."), ground(CEE));
        let mesh = &tree.leaves[0].mesh;
        assert_eq!(crate::geometry::mesh_checks::defects(mesh, &[]), [], "{name}");
        assert_eq!(mesh.bounds().map(|b| b.1.y), Some(3.0), "{name}");
        let said: Vec<_> = tree.diagnostics.iter().map(|d| d.message.clone()).collect();
        assert!(said[0].starts_with("a hip roof stands in; the "), "{said:?}");
        assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["cga::roof-fallback"]);
    }
}
