//! The stage cases of splits, recursion and roof angles in `../shared/hard-cases/stages.json`, each by its name
//! (`tests/it/stage_cases.rs` holds them against the file; those of bare sizes and polygons stand beside their code).

use std::thread;

use super::*;
use crate::diagnostics::{Diagnostic, Severity};

/// A lot of this length along x and 1 m deep.
fn strip(length: f64) -> Mesh {
    ground(&[(0.0, 0.0), (length, 0.0), (length, -1.0), (0.0, -1.0)])
}

/// From and to along x of every leaf: its rule, its ends.
fn pieces(tree: &ShapeTree) -> Vec<(&str, f64, f64)> {
    let ends = |mesh: &Mesh| mesh.bounds().map_or((0.0, 0.0), |(low, high)| (low.x, high.x));
    tree.leaves.iter().map(|l| (&*l.rule, ends(&l.mesh).0, ends(&l.mesh).1)).collect()
}

#[track_caller]
fn split(length: f64, pattern: &str) -> ShapeTree {
    let tree = derived(&format!("Lot --> split(x) {pattern}"), strip(length));
    assert!(tree.leaves.iter().flat_map(|l| &l.mesh.positions).all(|p| p.is_finite()));
    tree
}

/// The pieces of a split must have these sizes and fill the strip to its end, bit for bit.
#[track_caller]
fn check(length: f64, pattern: &str, expected: &[(&str, f64)], tolerance: f64) {
    let tree = split(length, pattern);
    let got = pieces(&tree);
    assert_eq!(got.len(), expected.len(), "{got:?}");
    let mut at = 0.0;
    for ((rule, from, to), (name, size)) in got.iter().zip(expected) {
        assert!(rule == name && *from == at && (to - from - size).abs() <= tolerance, "{got:?}");
        at = *to;
    }
    assert_eq!(at, length, "the last piece ends where the scope ends");
}

fn messages(tree: &ShapeTree) -> Vec<&Diagnostic> {
    tree.diagnostics.iter().collect()
}

/// What a message points at.
fn at<'a>(text: &'a str, told: &Diagnostic) -> &'a str {
    &text[told.span.start as usize..told.span.end as usize]
}

#[test]
fn split_basic() {
    check(10.0, "{ 1 : A. | ~1 : B. | 1 : C. }", &[("A", 1.0), ("B", 8.0), ("C", 1.0)], 0.0);
}

#[test]
fn split_leftover_1e_12() {
    let tree = split(3.000000000001, "{ 1 : A. }*");
    let got = pieces(&tree);
    assert_eq!((got.len(), got[2].2), (3, 3.000000000001));
}

#[test]
fn split_leftover_real() {
    // The remainder is shared out or left over; sizes and gaps add up.
    let tree = split(3.01, "{ 1 : A. }*");
    let got = pieces(&tree);
    let sum: f64 = got.iter().map(|p| p.2 - p.1).sum();
    assert!((sum - 3.01).abs() < 1e-12 && got.last().is_some_and(|p| p.2 == 3.01), "{got:?}");
}

#[test]
fn split_overfull() {
    check(10.0, "{ 8 : A. | 8 : B. | ~1 : C. }", &[("A", 8.0), ("B", 2.0)], 0.0);
}

#[test]
fn split_zero() {
    check(10.0, "{ 0 : A. | ~1 : B. }", &[("B", 10.0)], 0.0);
}

#[test]
fn split_zero_float() {
    let tree = split(10.0, "{ ~0 : A. | ~0 : B. }");
    let sizes: Vec<f64> = pieces(&tree).iter().map(|p| p.2 - p.1).collect();
    assert!(sizes.is_empty() || sizes == [5.0, 5.0], "{sizes:?}");
}

#[test]
fn split_negative() {
    check(10.0, "{ -1 : A. | ~1 : B. }", &[("B", 10.0)], 0.0);
    let tree = split(10.0, "{ -1 : A. | ~1 : B. }");
    assert!(messages(&tree).iter().all(|d| d.severity == Severity::Warning) && !messages(&tree).is_empty());
}

#[test]
fn split_nan() {
    let tree = split(10.0, "{ 0/0 : A. | ~1 : B. }");
    assert_eq!(pieces(&tree), [("B", 0.0, 10.0)]);
    let told = messages(&tree);
    assert!(!told.is_empty(), "NaN is told");
    let text = "Lot --> split(x) { 0/0 : A. | ~1 : B. }";
    assert!(told.iter().any(|d| at(text, d).contains("0/0") || at(text, d).contains("split")), "{told:?}");
}

#[test]
fn split_relative_thirds() {
    let expected = [("A", 7.0 * 0.3333333), ("B", 7.0 * 0.3333333), ("C", 7.0 * 0.3333334)];
    check(7.0, "{ '0.3333333 : A. | '0.3333333 : B. | '0.3333334 : C. }", &expected, 1e-15 * 7.0);
}

#[test]
fn split_flat_axis() {
    let tree = derived("Lot --> split(y) { 1 : A. }*", ground(&[(0.0, 0.0), (10.0, 0.0), (10.0, -4.0), (0.0, -4.0)]));
    assert!(tree.leaves.len() <= 1, "{}", tree.leaves.len());
    assert!(tree.leaves.iter().flat_map(|l| &l.mesh.positions).all(|p| p.is_finite()));
}

#[test]
fn split_tiny_scope() {
    assert!(split(1e-9, "{ 1 : A. }*").leaves.len() <= 1);
}

#[test]
fn split_nested_repeat() {
    let tree = split(17.3, "{ 1 : A. | { ~2 : B. | 0.5 : C. }* | 1 : D. }");
    let got = pieces(&tree);
    let sizes = |rule: &str| got.iter().filter(|p| p.0 == rule).map(|p| p.2 - p.1).collect::<Vec<f64>>();
    let (b, c) = (sizes("B"), sizes("C"));
    // 15.3 m of groups of nominally 2.5 m: six of them.
    assert_eq!((sizes("A").len(), b.len(), c.len(), sizes("D").len()), (1, 6, 6, 1));
    assert!(b.iter().all(|x| (x - b[0]).abs() < 1e-14) && c.iter().all(|x| (x - 0.5).abs() < 1e-14), "{b:?} {c:?}");
    assert!((got.iter().map(|p| p.2 - p.1).sum::<f64>() - 17.3).abs() < 1e-12);
    assert_eq!(got[13].2, 17.3);
}

fn with_depth(max_depth: u32) -> Limits {
    Limits { max_depth, ..Limits::default() }
}

#[test]
fn recursion_direct() {
    let tree = derived("Lot --> A\nA --> A", strip(10.0));
    let error = messages(&tree).into_iter().find(|d| d.severity == Severity::Error).expect("an error");
    assert_eq!(error.code, "cga::limit-depth");
    assert!(error.help.as_deref().is_some_and(|h| h.contains("Lot > A > A")), "{error:?}");
}

#[test]
fn recursion_float() {
    let tree = derived("Lot --> A\nA --> split(x) { ~1 : A | 0.1 : B. }", strip(10.0));
    let area: f64 = tree.leaves.iter().flat_map(|l| l.mesh.faces.iter().map(|f| l.mesh.area(f))).sum();
    let stopped = messages(&tree).iter().any(|d| d.code == "cga::limit-depth");
    assert!((area - 10.0).abs() < 1e-8 || stopped, "{area} {:?}", messages(&tree));
    // What was split off before it ended is all there: 100 pieces of 0.1 m.
    assert!((area - 10.0).abs() < 1e-8, "{area}");
}

#[test]
fn recursion_1e5() {
    let rules = compiled("Lot --> A(100000)\nA(n) --> case n > 0 : A(n - 1) else : B.");
    let tree = derive(&rules, &start(strip(10.0), 0), &NoAssets, &with_depth(200_000));
    assert_eq!((tree.leaves.len(), messages(&tree).len()), (1, 0), "{:?}", messages(&tree));
}

#[test]
fn random_threads() {
    let rules = compiled("Lot --> split(x) { 0.001 : A }*\nA --> 50% : B. else : C.");
    let choices = |seed: u64| -> Vec<String> {
        let tree = derive(&rules, &start(strip(10.0), seed), &NoAssets, &Limits::default());
        tree.leaves.iter().map(|l| l.rule.to_string()).collect()
    };
    let alone: Vec<Vec<String>> = (0..8).map(choices).collect();
    assert_eq!(alone[0].len(), 10_000);
    assert_ne!(alone[0], alone[1]);
    for threads in [2, 8] {
        let together: Vec<Vec<String>> = thread::scope(|scope| {
            let share =
                |t: u64| move || (0..8).filter(|s| s % threads == t).map(|s| (s, choices(s))).collect::<Vec<_>>();
            let running: Vec<_> = (0..threads).map(|t| scope.spawn(share(t))).collect();
            let mut all: Vec<_> = running.into_iter().flat_map(|r| r.join().expect("it ends")).collect();
            all.sort_by_key(|(seed, _)| *seed);
            all.into_iter().map(|(_, c)| c).collect()
        });
        assert_eq!(together, alone, "{threads} threads");
    }
}

/// 0 gives a flat roof, what has no tangent a message at the operation; never a vertex at infinity.
#[track_caller]
fn roof_of_angle(angle: &str, accepted: bool) {
    let rules = format!("Lot --> roofHip({angle}) R.");
    let tree = derived(&rules, ground(LOT));
    let positions: Vec<DVec3> = tree.leaves.iter().flat_map(|l| l.mesh.positions.clone()).collect();
    assert!(positions.iter().all(|p| p.is_finite() && p.y == 0.0), "{positions:?}");
    let told = messages(&tree);
    assert_eq!(told.is_empty(), accepted, "{told:?}");
    if !accepted {
        assert!(told.iter().any(|d| d.code == "cga::roof" && at(&rules, d).starts_with("roofHip")), "{told:?}");
    }
}

#[test]
fn roof_angle_0() {
    roof_of_angle("0", true);
}

#[test]
fn roof_angle_90() {
    roof_of_angle("90", false);
}

#[test]
fn roof_angle_minus_10() {
    roof_of_angle("-10", false);
}

/// NaN is 0, with a message, as the compatibility notes have it of `setback`.
#[test]
fn roof_angle_nan() {
    let rules = "Lot --> roofHip(0/0) R.";
    let tree = derived(rules, ground(LOT));
    assert!(tree.leaves.iter().flat_map(|l| &l.mesh.positions).all(|p| p.is_finite() && p.y == 0.0));
    let told = messages(&tree);
    assert!(told.len() == 1 && told[0].code == "cga::not-finite" && at(rules, told[0]) == "roofHip(0/0)", "{told:?}");
    assert!(hip_of(f64::NAN).is_err());
}

fn hip_of(angle: f64) -> Result<crate::geometry::roof::Roof, crate::geometry::roof::RoofError> {
    let outer = LOT.iter().map(|&(x, z)| DVec2::new(x, -z)).collect();
    crate::geometry::roof::hip(
        &Polygon { outer, holes: Vec::new() },
        crate::geometry::roof::Slope::Angle(angle),
        0.0,
        false,
    )
}

#[test]
fn roof_angle_179() {
    roof_of_angle("179", false);
}

#[test]
fn facade_detail_below_the_limit_stays_as_it_is() {
    // A facade of 10 x 3 m: walls around windows of 1 x 1 m in four panes, each with a sill that reaches out.
    let rules = compiled(
        "Lot --> extrude(3) comp(f) { side : Facade | all : NIL }\n\
         Facade --> split(x) { ~2 : Tile }*\n\
         Tile --> split(x) { ~1 : Wall. | 1 : split(y) { ~1 : Wall. | 1 : Window | ~1 : Wall. } | ~1 : Wall. }\n\
         Window --> color(\"#808080\") split(x) { ~0.5 : split(y) { ~0.5 : Pane }* }*\n\
         Pane --> extrude(0.1) Glass.",
    );
    let start = start(ground(SMALL), 0);
    let at = |detail: f64| derive(&rules, &start, &NoAssets, &Limits { detail, ..Limits::default() });
    let named = |tree: &ShapeTree, name: &str| tree.leaves.iter().filter(|leaf| &*leaf.rule == name).count();
    let all = at(0.0);
    let windows = named(&all, "Glass") / 4;
    assert!(windows >= 12 && named(&all, "Window") == 0);
    // Panes stay flat; then windows are not divided; walls are there throughout.
    assert_eq!([named(&at(0.6), "Pane"), named(&at(0.6), "Glass")], [4 * windows, 0]);
    assert_eq!([named(&at(1.1), "Window"), named(&at(1.1), "Pane")], [windows, 0]);
    for detail in [0.0, 0.4, 0.6, 1.1] {
        assert_eq!(named(&at(detail), "Wall"), named(&all, "Wall"), "{detail}");
    }
    // What lies flat is no facade, however small.
    let flat = compiled("Lot --> comp(f) { all : Small }\nSmall --> extrude(5) Tower.");
    let tree = derive(&flat, &start, &NoAssets, &Limits { detail: 100.0, ..Limits::default() });
    assert_eq!(named(&tree, "Tower"), 1);
}
