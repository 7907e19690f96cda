//! `convexify`, `rectify`, `reduceGeometry`, `cleanupGeometry` and `envelope` (reference 4.8, 4.12).

use super::*;
use crate::geometry::mesh_checks::{is_closed, volume};

/// An L on the ground.
const L: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)];

fn codes(rules: &str, corners: &[(f64, f64)]) -> Vec<&'static str> {
    derived(rules, ground(corners)).diagnostics.iter().map(|d| d.code).collect()
}

/// (faces, vertices) of the first leaf.
fn counts(tree: &ShapeTree) -> (usize, usize) {
    (tree.leaves[0].mesh.faces.len(), tree.leaves[0].mesh.positions.len())
}

#[test]
fn concave_faces_fall_in_convex_ones() {
    let tree = run("Lot --> convexify comp(f) { all : print(geometry.isConcave) A. }", L);
    assert_eq!(tree.prints, ["false", "false"]);
    near(&[areas(&tree, "A").iter().sum()], &[64.0]);
    let whole = run("Lot --> convexify() A.", L);
    assert_eq!(counts(&whole), (2, 6));
    assert_eq!(whole.leaves[0].mesh.faces[0].outer[..2], [0, 1], "the first edge stays first");
    assert_eq!(counts(&run("Lot --> convexify(3) A.", L)), (1, 6));
    assert_eq!(counts(&run("Lot --> convexify A.", SMALL)), (1, 4));
    let ring = run("Lot --> setback(1) { all : convexify A. }", SMALL);
    assert!(ring.leaves[0].mesh.faces.iter().all(|f| f.holes.is_empty()));
    near(&areas(&ring, "A"), &[28.0]);
    let mapped = run("Lot --> setupProjection(0, scope.xz, 1, 1) projectUV(0) convexify A.", L);
    let mesh = &mapped.leaves[0].mesh;
    for face in &mesh.faces {
        for (v, uv) in face.corners().zip(face.uv(0).expect("parts keep the set")) {
            let p = mesh.positions[v as usize];
            near(&[uv.x, uv.y], &[p.x, p.z + 10.0]);
        }
    }
}

#[test]
fn edges_near_an_axis_are_made_parallel_to_it() {
    let skew = [(0.0, 0.0), (10.0, 0.0), (10.2, -6.0), (5.0, -6.3), (-0.1, -5.9)];
    let tree = run("Lot --> rectify(10) A.", &skew);
    let mesh = &tree.leaves[0].mesh;
    for (a, b) in mesh.faces[0].edges() {
        let d = mesh.positions[b as usize] - mesh.positions[a as usize];
        assert!(d.x.abs() < 1e-9 || d.z.abs() < 1e-9, "{d}");
    }
    assert_eq!(counts(&run("Lot --> rectify(0) A.", &skew)), (1, 5));
    near(&areas(&run("Lot --> rectify(0) A.", &skew), "A"), &areas(&run("Lot --> A.", &skew), "A"));
    // The slope of the roof edge stays: it is farther off than 20 degrees.
    let house = [(0.0, 0.0), (8.0, 0.1), (8.0, -5.0), (4.0, -8.0), (0.0, -5.0)];
    let mesh = &run("Lot --> rectify(20) A.", &house).leaves[0].mesh.clone();
    assert!((mesh.positions[3] - mesh.positions[2]).z < -2.9);
    assert_eq!(codes("Lot --> rectify(60) A.", SMALL), ["cga::rectify"]);
    assert_eq!(codes("Lot --> extrude(2) rectify(10) A.", SMALL), ["cga::rectify"]);
}

#[test]
fn fewer_vertices() {
    let tree = run("Lot --> primitiveSphere(16, 12, 2) A.\n", SMALL);
    let all = tree.leaves[0].mesh.positions.len();
    let half = run("Lot --> primitiveSphere(16, 12, 2) reduceGeometry(0.5) A.", SMALL);
    let mesh = &half.leaves[0].mesh;
    let rest = mesh.positions.len() as f64 / all as f64;
    assert!((rest - 0.5).abs() < 0.02, "{rest}");
    let (a, b) = (volume(mesh), volume(&tree.leaves[0].mesh));
    assert!(is_closed(mesh) && (a - b).abs() < 0.2 * b, "{a} {b}");
    assert_eq!(counts(&run("Lot --> extrude(3) reduceGeometry(0) A.", SMALL)), (6, 8));
    assert_eq!(codes("Lot --> extrude(3) reduceGeometry(1.5) A.", SMALL), ["cga::reduce"]);
}

#[test]
fn clean_up_merges_and_dissolves() {
    // Two halves of a lot, apart by 1 mm, and a straight corner on the far side.
    let positions = [
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, -6.0),
        (0.0, -6.0),
        (5.001, 0.0),
        (10.0, 0.0),
        (10.0, -6.0),
        (7.0, -6.0),
        (5.001, -6.0),
    ];
    let mut mesh =
        Mesh { positions: positions.iter().map(|&(x, z)| DVec3::new(x, 0.0, z)).collect(), ..Mesh::default() };
    mesh.faces.push(crate::geometry::Face::new(vec![0, 1, 2, 3]));
    mesh.faces.push(crate::geometry::Face::new(vec![4, 5, 6, 7, 8]));
    let cleaned = |what: &str| counts(&derived(&format!("Lot --> cleanupGeometry({what}) A."), mesh.clone()));
    assert_eq!(cleaned("all, 0"), (2, 8));
    assert_eq!(cleaned("vertices, 0"), (2, 8));
    assert_eq!(cleaned("vertices, 0.002"), (2, 6));
    assert_eq!(cleaned("edges, 0.002"), (1, 7));
    assert_eq!(cleaned("faces, 0.002"), (2, 7));
    // The straight corner of the first edge stays with it.
    assert_eq!(cleaned("all, 0.002"), (1, 5));
    let doubled =
        Mesh { faces: vec![mesh.faces[0].clone(), crate::geometry::Face::new(vec![3, 2, 1, 0])], ..mesh.clone() };
    assert_eq!(counts(&derived("Lot --> cleanupGeometry(faces, 0) A.", doubled)), (1, 4));
    let tree = derived("Lot --> cleanupGeometry(all, 0.002) A.", mesh);
    assert_eq!(tree.leaves[0].mesh.positions[0], DVec3::ZERO, "the first edge stays first");
    near(&areas(&tree, "A"), &[60.0]);
}

/// A fin of 0.1 m, whose two sides fall together: way/241820131 in Queens Village had its roof refused for it.
#[test]
fn cleanup_leaves_no_way_there_and_back() {
    let fin = [(0.0, 0.0), (10.0, 0.0), (10.0, -6.0), (5.1, -6.0), (5.1, -8.0), (5.0, -8.0), (5.0, -6.0), (0.0, -6.0)];
    let tree = run("Lot --> cleanupGeometry(vertices, 0.2) A.", &fin);
    assert_eq!(counts(&tree), (1, 4));
    near(&areas(&tree, "A"), &[60.0]);
    let roof = run("Lot --> cleanupGeometry(vertices, 0.2) roofGable(30) A.", &fin);
    near(&[volume(&roof.leaves[0].mesh)], &[10.0 * 6.0 * 3.0 * libm::tan(30f64.to_radians()) / 2.0]);
}

/// way/177621195 in Baltimore: an arm 6 cm wide whose end became a point, so that its sides changed places.
#[test]
fn cleanup_turns_no_thin_arm_over() {
    let arm = [
        (0.0, 0.0),
        (13.7368, -0.6984),
        (13.5214, -4.895),
        (7.7402, -4.6068),
        (7.6023, -7.4711),
        (10.6051, -7.6263),
        (10.5965, -7.6819),
        (-0.3532, -7.0387),
    ];
    let tree = run("Lot --> cleanupGeometry(vertices, 0.2) A.", &arm);
    assert_eq!(counts(&tree), (1, 8));
    let roof = run("Lot --> cleanupGeometry(vertices, 0.2) roofHip(30) A.", &arm);
    assert!(is_closed(&roof.leaves[0].mesh) && volume(&roof.leaves[0].mesh) > 50.0);
}

#[test]
fn envelopes_of_every_signature() {
    let volume_of = |call: &str| {
        let tree = run(&format!("Lot --> {call} A."), SMALL);
        assert!(is_closed(&tree.leaves[0].mesh), "{call}");
        volume(&tree.leaves[0].mesh)
    };
    near(&[volume_of("envelope(normal, 7, 4, 45)")], &[420.0 - 45.0]);
    near(&[volume_of("envelope(world.up, 7, 4, 45)")], &[420.0 - 45.0]);
    near(&[volume_of("envelope(normal, 7, 4, 45, 4, 45)")], &[420.0 - 90.0]);
    near(&[volume_of("envelope(normal, 7, 4, 45, 4, 45, 7, 45)")], &[420.0 - 90.0]);
    near(&[volume_of("envelope(normal, 100, 1, 45, 1, 45, 1, 45)")], &[60.0 + 72.0]);
    near(&[volume_of("envelope(normal, 100, 1, 45, 1, 45, 1, 45, 1, 45)")], &[60.0 + 72.0]);
    // Only right: 10 - 3 long at the top.
    near(&[volume_of("envelope(normal, 7, 0, 90, 0, 90, 4, 45, 0, 90)")], &[420.0 - 27.0]);
    near(&[volume_of("envelope(normal, 7, [4], [45])")], &[420.0 - 45.0]);
    near(&[volume_of("envelope(normal, 7, [0, 4, 0, 4], [90, 45, 90, 45])")], &[420.0 - 54.0]);
    let shown = show_on("envelope(normal, 7, 4, 45) Show", SMALL);
    near(&[shown.t, shown.s].concat(), &[0.0, 0.0, -6.0, 10.0, 7.0, 6.0]);
}

#[test]
fn envelopes_name_their_faces() {
    let names = "envelope.bottom envelope.side.base envelope.side.slope envelope.side.inner envelope.top";
    let selectors: Vec<String> = names
        .split(' ')
        .map(|n| format!("isTagged(\"{n}\") : {}.", n.replace("envelope", "E").replace('.', "_")))
        .collect();
    let rules = format!("Lot --> envelope(normal, 7, 4, 45) comp(f) {{ {} }}", selectors.join(" | "));
    let tree = run(&rules, SMALL);
    let of = |name: &str| count(&tree, name);
    assert_eq!((of("E_bottom"), of("E_side_base"), of("E_side_slope"), of("E_top")), (1, 4, 1, 1));
    let slope = tree.leaves.iter().find(|l| &*l.rule == "E_side_slope").expect("a slope");
    let (a, b) = slope.mesh.faces[0].edges().next().expect("an edge");
    let ends = [a, b].map(|v| slope.mesh.positions[v as usize]);
    let expected = [DVec3::new(0.0, 4.0, 0.0), DVec3::new(10.0, 4.0, 0.0)];
    assert!(ends.iter().zip(expected).all(|(p, q)| p.distance(q) < 1e-12), "slopes start with the edge: {ends:?}");
    let taper =
        run("Lot --> taper(2) comp(f) { isTagged(\"taper.bottom\") : B. | isTagged(\"taper.side\") : S. }", SMALL);
    assert_eq!((count(&taper, "B"), count(&taper, "S")), (1, 4));
}

#[test]
fn envelopes_on_slopes_and_without_room() {
    // The lot rises by 2 m to the back.
    let mut mesh = ground(SMALL);
    (mesh.positions[2].y, mesh.positions[3].y) = (2.0, 2.0);
    let tree = derived("Lot --> envelope(world.up, 7, 7, 45) A.", mesh);
    assert!(tree.diagnostics.is_empty() && is_closed(&tree.leaves[0].mesh));
    near(&[volume(&tree.leaves[0].mesh)], &[420.0 - 60.0]);
    assert_eq!(codes("Lot --> envelope(normal, 0, 4, 45) A.", SMALL), ["cga::envelope"]);
    assert_eq!(codes("Lot --> envelope(normal, -3, 4, 45) A.", SMALL), ["cga::envelope"]);
    assert_eq!(codes("Lot --> envelope(normal, 7, 4, 120) A.", SMALL), ["cga::envelope"]);
    assert_eq!(codes("Lot --> envelope(normal, 7, 0, 0) A.", SMALL), ["cga::envelope"]);
    assert_eq!(codes("Lot --> comp(e) { 0 : envelope(normal, 7, 4, 45) A. }", SMALL), ["cga::no-face"]);
    assert_eq!(
        codes("Lot --> extrude(2) comp(f) { front : envelope(world.up, 7, 4, 45) A. }", SMALL),
        ["cga::envelope"]
    );
}

/// Sides have the tags of the edge they stand on, their upright edges those of the vertex (reference 4.15.4).
#[test]
fn envelope_sides_have_the_tags_of_their_edges() {
    for (direction, turn) in [("normal", ""), ("world.up", "reverseNormals "), ("world.up", "")] {
        let rules = format!(
            "Lot --> {turn}tag(\"lot\") tag(\"rim\", edges) tag(\"post\", vertices) envelope({direction}, 7, 4, 45)
               comp(f) {{ geometry.hasTags(\"rim\", faces) && !geometry.hasTags(\"lot\", faces) : Side | geometry.hasTags(\"lot\", faces) : Other. }}
             Side --> print(geometry.hasTags(\"post\", edges)) S."
        );
        let tree = derived(&rules, ground(SMALL));
        assert_eq!((count(&tree, "S"), count(&tree, "Other")), (5, 2), "{direction} {turn}: {:?}", tree.diagnostics);
        // The slope does not begin at a vertex.
        assert_eq!(tree.prints.iter().filter(|p| *p == "true").count(), 4, "{direction} {turn}");
    }
}

/// Found on Munich's relation/2379713: a wall that hardly bends was straightened through the courtyard beside it.
#[test]
fn straight_corners_stay_where_a_hole_is_beside_them() {
    let ring = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    let outer = [(0.0, 40.0), (0.0, 0.0), (30.0, -0.4), (60.0, 0.0), (60.0, 40.0), (30.0, 40.4)];
    for (hole, corners) in [
        ([(29.0, -0.3), (29.0, 5.0), (31.0, 5.0), (31.0, -0.3)], 5),
        ([(29.0, 0.3), (29.0, 5.0), (31.0, 5.0), (31.0, 0.3)], 4),
    ] {
        let mut mesh = Mesh::default();
        PlaneFrame::PLAN.push_face(&mut mesh, &Polygon { outer: ring(&outer), holes: vec![ring(&hole)] }, 0.0);
        let tree = derived("Lot --> cleanupGeometry(vertices, 0.2) A.", mesh);
        let face = &tree.leaves[0].mesh.faces[0];
        assert_eq!(face.outer.len(), corners);
        let polygon = PlaneFrame::PLAN.face_to_plan(&tree.leaves[0].mesh, face);
        assert_eq!(crate::geometry::polygon_checks::crossing_edges(&polygon), []);
    }
}
