//! `taper`, `footprint` and `alignScopeToGeometryBBox` (reference 4.7, 4.8).

use super::*;
use crate::geometry::mesh_checks::{is_closed, volume};

#[test]
fn tapers_are_pyramids_over_the_centroid() {
    let tree = run("Lot --> taper(4)", SMALL);
    let mesh = &tree.leaves[0].mesh;
    assert_eq!((mesh.faces.len(), is_closed(mesh)), (5, true));
    near(&[volume(mesh)], &[80.0]);
    assert_eq!(mesh.positions[4], DVec3::new(5.0, 4.0, -3.0));
    assert!(mesh.faces[1].outer[..] == [0, 1, 4], "sides start with the polygon's edge");
    near(&[mesh.normal(&mesh.faces[0]).y], &[-1.0]);
    let l = [(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)];
    let mesh = &run("Lot --> taper(3)", &l).leaves[0].mesh.clone();
    assert!(is_closed(mesh));
    near(&[volume(mesh)], &[64.0]);
}

#[test]
fn tapers_down_have_a_negative_height() {
    let shown = show_on("taper(-4) Show", SMALL);
    near(&[shown.t, shown.s].concat(), &[0.0, 0.0, -6.0, 10.0, -4.0, 6.0]);
    let mesh = &run("Lot --> taper(-4)", SMALL).leaves[0].mesh.clone();
    near(&[volume(mesh)], &[80.0]);
    let tree = run("Lot --> taper(0.0005)", SMALL);
    assert_eq!(tree.leaves[0].mesh.faces.len(), 1);
}

#[test]
fn tapers_keep_texture_coordinates() {
    let rules = "Lot --> setupProjection(0, scope.xz, 1, 1) projectUV(0) taper(2)";
    let mesh = &run(rules, SMALL).leaves[0].mesh.clone();
    let uv = mesh.faces[1].uv(0).expect("sides keep the set");
    near(&uv.iter().flat_map(|p| [p.x, p.y]).collect::<Vec<_>>(), &[0.0, 6.0, 10.0, 6.0, 5.0, 3.0]);
}

#[test]
fn footprints_are_outlines_from_above() {
    let tree = run("Lot --> extrude(8) footprint()", LOT);
    let mesh = &tree.leaves[0].mesh;
    near(&areas(&tree, "Lot"), &[200.0]);
    assert_eq!((mesh.faces.len(), mesh.normal(&mesh.faces[0])), (1, DVec3::Y));
    assert!(mesh.positions.iter().all(|p| p.y == 0.0));
    let shown = show("extrude(8) footprint() Show");
    near(&shown.s, &[20.0, 0.0, 10.0]);
    // A roof with overhang covers more than its walls.
    let tree = run("Lot --> extrude(3) comp(f) { top : roofHip(45, 1) A. }", SMALL);
    near(
        &[areas(&run("Lot --> roofHip(45, 1) footprint() A.", SMALL), "A")[0]],
        &[(10.0 + 2.0f64.sqrt()) * (6.0 + 2.0f64.sqrt())],
    );
    assert_eq!(tree.leaves.len(), 1);
    // A ring: the hole stays.
    let ring = run("Lot --> setback(1) { all : extrude(2) footprint() A. }", SMALL);
    near(&areas(&ring, "A"), &[28.0]);
    assert_eq!(ring.leaves[0].mesh.faces[0].holes.len(), 1);
    let codes: Vec<_> =
        derived("Lot --> extrude(2) comp(f) { side : alignScopeToAxes(y) footprint() A. }", ground(SMALL))
            .diagnostics
            .iter()
            .map(|d| d.code)
            .collect();
    assert_eq!(codes, ["cga::footprint"]);
}

#[test]
fn the_least_box_is_found_and_the_longer_side_comes_first() {
    let (sin, cos) = libm::sincos(0.4);
    let turned: Vec<(f64, f64)> = [(0.0, 0.0), (3.0, 0.0), (3.0, 8.0), (0.0, 8.0)]
        .map(|(x, y)| (x * cos - y * sin, -(x * sin + y * cos)))
        .to_vec();
    let tree = run(&format!("Lot --> alignScopeToAxes() alignScopeToGeometryBBox(zx) Show\n{SHOW}"), &turned);
    let line = &numbers(&tree)[0];
    near(&line[0..6], &[0.0; 6]);
    near(&line[6..9], &[3.0, 0.0, 8.0]);
    let tree = run(&format!("Lot --> alignScopeToAxes() alignScopeToGeometryBBox(xz) Show\n{SHOW}"), &turned);
    near(&numbers(&tree)[0][6..9], &[8.0, 0.0, 3.0]);
    let shown = show("extrude(3) alignScopeToGeometryBBox(xz) Show");
    near(&[shown.s, shown.p, shown.o].concat(), &[20.0, 3.0, 10.0, 0.0, 0.0, -10.0, 0.0, 0.0, 0.0]);
    let codes: Vec<_> = derived("Lot --> comp(v) { 0 : alignScopeToGeometryBBox(xy) A. }", ground(SMALL))
        .diagnostics
        .iter()
        .map(|d| d.code)
        .collect();
    assert_eq!(codes, ["cga::no-extent"]);
}
