//! Reference 4.13: scattered points.

use super::*;

#[track_caller]
fn points(body: &str, corners: &[(f64, f64)], seed: u64) -> Vec<DVec3> {
    let rules = format!("Lot --> {body}");
    let tree = derive(&compiled(&rules), &start(ground(corners), seed), &NoAssets, &Limits::default());
    assert_eq!(tree.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [""; 0], "{rules}");
    assert!(tree.leaves.iter().all(|l| l.mesh.positions.len() == 1 && l.mesh.faces.is_empty()), "{rules}");
    tree.leaves.iter().map(|l| l.mesh.positions[0]).collect()
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// An L on the ground: x 0..10, z -10..0, without the quarter beyond (4, -4).
const L: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)];

fn in_l(p: &DVec3) -> bool {
    p.y == 0.0 && p.x >= 0.0 && p.z <= 0.0 && p.x <= 10.0 && p.z >= -10.0 && (p.x <= 4.0 || p.z >= -4.0)
}

#[test]
fn surface_points_lie_on_the_surface_evenly() {
    let found = points("scatter(surface, 2000, uniform) { A. }", L, 1);
    assert_eq!(found.len(), 2000);
    assert!(found.iter().all(in_l));
    let share = found.iter().filter(|p| p.x <= 4.0 && p.z >= -4.0).count() as f64 / 2000.0;
    assert!((share - 16.0 / 64.0).abs() < 0.03, "{share}");
}

#[test]
fn points_depend_on_the_seed_alone() {
    let few = points("scatter(surface, 20, uniform) { A. }", L, 1);
    assert_eq!(few, points("scatter(surface, 20, uniform) { A. }", L, 1));
    assert_eq!(few[..], points("scatter(surface, 90, uniform) { A. }", L, 1)[..20]);
    assert_ne!(few, points("scatter(surface, 20, uniform) { A. }", L, 2));
    let twice = points("scatter(surface, 20, uniform) { A. } scatter(surface, 20, uniform) { A. }", L, 1);
    assert_ne!(twice[..20], twice[20..]);
}

#[test]
fn gaussian_points_gather_around_their_mean() {
    let middle = points("scatter(surface, 500, gaussian) { A. }", SMALL, 3);
    assert!(mean(&middle).distance(DVec3::new(5.0, 0.0, -3.0)) < 0.3, "{}", mean(&middle));
    let deviation = (middle.iter().map(|p| (p.x - 5.0) * (p.x - 5.0)).sum::<f64>() / 500.0).sqrt();
    assert!((deviation - 1.6).abs() < 0.2, "{deviation}");
    let corner = points("scatter(surface, 200, gaussian, front, 0.5) { A. }", L, 3);
    assert!(corner.iter().all(in_l));
    assert!((mean(&corner).x - 5.0).abs() < 0.2 && mean(&corner).z > -0.6, "{}", mean(&corner));
    let narrow = points("scatter(scope, 50, gaussian, right, '0.01) { A. }", SMALL, 3);
    assert!(narrow.iter().all(|p| p.x > 9.4 && p.x <= 10.0 && (p.z + 3.0).abs() < 0.4), "{narrow:?}");
    // The mean lies outside the L: the points are brought to its border.
    let outside = points(
        "scatter(surface, 10, gaussian, back, 0.001) { A. }",
        &[(0.0, 0.0), (10.0, 0.0), (10.0, -10.0), (8.0, -10.0), (8.0, -4.0), (4.0, -4.0), (4.0, -10.0), (0.0, -10.0)],
        3,
    );
    assert!(outside.iter().all(|p| (p.x - 4.0).abs() < 1e-9 && p.z < -9.9), "{outside:?}");
}

#[test]
fn volume_points_lie_inside() {
    let found = points("extrude(3) scatter(volume, 500, uniform) { A. }", L, 5);
    assert!(found.iter().all(|p| in_l(&DVec3::new(p.x, 0.0, p.z)) && p.y > 0.0 && p.y < 3.0));
    assert!((mean(&found).y - 1.5).abs() < 0.15);
    let found = points("extrude(3) scatter(volume, 100, gaussian, top, 0.3) { A. }", L, 5);
    assert!(found.iter().all(|p| in_l(&DVec3::new(p.x, 0.0, p.z)) && p.y > 1.5 && p.y <= 3.0));
    let found = points("s('1, 5, '1) scatter(scope, 200, uniform) { A. }", L, 5);
    assert!(found.iter().any(|p| !in_l(&DVec3::new(p.x, 0.0, p.z))) && found.iter().all(|p| p.y >= 0.0 && p.y <= 5.0));
}

#[test]
fn surface_points_stand_on_it() {
    let rules = r#"Lot --> extrude(4) scatter(surface, 40, uniform) {
        print(scope.sx + " " + scope.sy + " " + scope.sz + " " + geometry.nVertices) s(0.2, 1, 0.2) primitiveCube() A. }"#;
    let tree = run(rules, SMALL);
    numbers(&tree).iter().for_each(|line| near(line, &[0.0, 0.0, 0.0, 1.0]));
    let body = |p: &DVec3| p.x > 0.0 && p.x < 10.0 && p.y > 0.0 && p.y < 4.0 && p.z < 0.0 && p.z > -6.0;
    for leaf in &tree.leaves {
        let (low, high) = leaf.mesh.bounds().expect("a box");
        near(&[(high - low).max_element()], &[1.0]);
        assert!(!body(&((low + high) / 2.0)), "the boxes stand outwards");
    }
}

#[test]
fn what_cannot_be_scattered_is_told() {
    let codes = |body: &str| -> (usize, Vec<&'static str>) {
        let tree = derived(&format!("Lot --> {body}"), ground(SMALL));
        (tree.leaves.len(), tree.diagnostics.iter().map(|d| d.code).collect())
    };
    assert_eq!(codes("scatter(surface, 0, uniform) { A. }"), (0, vec!["cga::scatter-count"]));
    assert_eq!(codes("scatter(surface, -5, uniform) { A. }"), (0, vec!["cga::scatter-count"]));
    assert_eq!(codes("scatter(surface, 2.6, uniform) { A. }"), (3, vec![]));
    assert_eq!(codes("scatter(volume, 3, uniform) { A. }"), (3, vec!["cga::scatter-open"]));
    assert_eq!(codes("comp(e) { 0 : scatter(surface, 3, uniform) { A. } }"), (0, vec!["cga::scatter-empty"]));
    assert_eq!(codes("scatter(surface, 1e12, uniform) { A. }"), (0, vec!["cga::limit-shapes"]));
}

#[test]
fn points_are_of_a_group_of_their_own() {
    let tree = run("Lot --> scatter(surface, 2, uniform) { print(geometry.groups) comp(g) { all : A. } }", SMALL);
    assert_eq!(
        (&*tree.prints, count(&tree, "A")),
        (&["(1)[builtin:point]".to_owned(), "(1)[builtin:point]".into()][..], 2)
    );
    assert!(tree.leaves.iter().all(|leaf| leaf.mesh.positions.len() == 1), "{:?}", tree.leaves);
}
