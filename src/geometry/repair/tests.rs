//! The named hard footprints, and properties of any input at all.

use super::*;
use crate::geometry::hard_cases;
use crate::geometry::polygon_checks::{crossing_edges, reversed_rings};
use proptest::prelude::*;
use serde_json::Value;

fn ring(points: &[(f64, f64)]) -> Ring {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

const KERNEL: Options = Options { weld: 0.0, min_area: 0.0 };

fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Ok => "ok",
        Verdict::Repaired => "repaired",
        Verdict::Rejected(_) => "rejected",
    }
}

/// What is wrong with the answer to one case, if anything.
fn complaint(feature: &Value, options: &Options) -> Option<String> {
    let p = &feature["properties"];
    let got = repair(&hard_cases::rings(feature), options);
    let verdict = verdict_name(got.verdict);
    let also = p["also_accept"].as_array().into_iter().flatten().filter_map(Value::as_str);
    if !also.chain(p["expect"].as_str()).any(|v| v == verdict) {
        return Some(format!("verdict {verdict}, {:?} {:?}", got.verdict, got.notes));
    }
    if verdict == "rejected" {
        return (!got.polygons.is_empty()).then(|| "rejected with polygons".into());
    }
    let (area, tolerance) = (p["area"].as_f64()?, p["tol_area"].as_f64()?);
    if (got.area_after - area).abs() > tolerance {
        return Some(format!("area {} instead of {area}", got.area_after));
    }
    let parts = p["parts"].as_u64()?..=p["parts_max"].as_u64().or(p["parts"].as_u64())?;
    if !parts.contains(&(got.polygons.len() as u64)) {
        return Some(format!("{} parts", got.polygons.len()));
    }
    let holes: usize = got.polygons.iter().map(|p| p.holes.len()).sum();
    if p["holes"].as_u64().is_some_and(|n| n != holes as u64) {
        return Some(format!("{holes} holes"));
    }
    let unsound = got.polygons.iter().any(|p| !crossing_edges(p).is_empty() || !reversed_rings(p).is_empty());
    unsound.then(|| "crossing edges or wrong direction".into())
}

#[test]
fn named_hard_footprints() {
    let Some(features) = hard_cases::features() else { return };
    assert!(features.len() >= 126);
    let mut wrong = Vec::new();
    for feature in &features {
        let name = feature["properties"]["name"].as_str().expect("a name");
        // Buildings of millimetres are no mapped data: they are for the kernel alone.
        let mapped = feature["properties"]["area"].as_f64().is_none_or(|a| a >= 0.01);
        for options in [KERNEL, Options::default()].iter().take(if mapped { 2 } else { 1 }) {
            wrong.extend(complaint(feature, options).map(|c| format!("{name}, weld {}: {c}", options.weld)));
        }
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

fn square(at: f64, side: f64) -> Ring {
    ring(&[(at, at), (at + side, at), (at + side, at + side), (at, at + side)])
}

#[test]
fn a_sound_footprint_comes_back_as_it_was() {
    let mut outer = square(0.0, 10.0);
    outer.insert(3, DVec2::new(7.0, 10.0));
    outer.rotate_left(2);
    let mut hole = square(3.0, 2.0);
    hole.reverse();
    let got = repair(&[outer.clone(), hole.clone()], &Options::default());
    assert_eq!((got.verdict, got.notes), (Verdict::Ok, Vec::new()));
    assert_eq!(got.polygons, [Polygon { outer, holes: vec![hole] }]);
    assert_eq!((got.area_before, got.area_after), (96.0, 96.0));
}

#[test]
fn a_clockwise_outline_keeps_its_first_edge() {
    let mut outer = square(0.0, 10.0);
    outer.reverse();
    let got = repair(std::slice::from_ref(&outer), &Options::default());
    assert_eq!((got.verdict, got.notes), (Verdict::Ok, vec![Note::OutlineReversed]));
    assert_eq!(got.polygons[0].outer[..2], [outer[1], outer[0]]);
}

#[test]
fn every_repair_is_noted() {
    let mut outer = square(0.0, 10.0);
    outer.insert(1, DVec2::new(0.0, 0.0005));
    let hole = square(9.0, 3.0);
    let line = ring(&[(1.0, 1.0), (2.0, 2.0)]);
    let got = repair(&[outer, hole, line], &Options::default());
    let expected =
        [Note::DoubledPointsRemoved(1), Note::EmptyHolesDropped(1), Note::HolesReversed(1), Note::CrossingsResolved];
    assert_eq!((got.verdict, got.notes.as_slice()), (Verdict::Repaired, &expected[..]));
    assert_eq!(got.area_after, 99.0);
    assert_eq!(got.polygons[0].outer[0], DVec2::ZERO);
}

#[test]
fn a_spike_leaves_no_point_in_the_wall_but_breaks_stay() {
    let outer =
        ring(&[(0.0, 0.0), (4.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 10.0), (5.0, 17.0), (5.0, 10.0), (0.0, 10.0)]);
    let got = repair(&[outer], &Options::default());
    assert_eq!(got.polygons[0].outer, ring(&[(0.0, 0.0), (4.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]));
}

/// relation/2360164 of Munich: an outline that goes out and back along a line that its own corner lies on, but for a few
/// grid steps, kept a fin of no width.
#[test]
fn a_spike_that_rounding_keeps_open_goes_too() {
    let (start, tip, side) = (DVec2::new(8.0, 4.0), DVec2::new(11.0, 10.0), DVec2::new(-2.0, 1.0));
    for steps in -6..=6 {
        let base = start.lerp(tip, 0.3) + side * f64::from(steps) * 1e-9;
        let outline = vec![DVec2::ZERO, start, tip, base, DVec2::new(1.0, 7.0)];
        let got = repair(&[outline], &Options::default());
        assert_eq!(got.polygons.len(), 1, "{steps}");
        let outer = &got.polygons[0].outer;
        assert!(outer.len() == 4 && !outer.contains(&tip), "{steps}: {outer:?}");
    }
}

#[test]
fn small_parts_are_dropped_and_the_reason_is_given() {
    let bow = ring(&[(0.0, 0.0), (10.05, 10.05), (10.05, 10.0), (0.05, 0.0)]);
    let got = repair(&[bow], &Options { weld: 0.0, min_area: 0.6 });
    assert_eq!(got.verdict, Verdict::Rejected(Rejection::BelowLeastArea));
    let reasons = [
        (vec![], Rejection::TooFewPoints),
        (vec![Ring::new()], Rejection::TooFewPoints),
        (vec![ring(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)])], Rejection::TooFewPoints),
        (vec![ring(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])], Rejection::NoArea),
        (vec![square(0.0, 1.0), square(-1.0, 3.0)], Rejection::HolesCoverOutline),
        (vec![square(0.0, 1.1e9)], Rejection::TooLarge),
        (vec![square(0.0, 1.0), square(0.5, 1e12)], Rejection::TooLarge),
        (vec![square(0.0, 1.0), square(f64::NAN, 1.0)], Rejection::NotFinite),
    ];
    for (rings, why) in reasons {
        let got = repair(&rings, &Options::default());
        assert_eq!((got.verdict, got.polygons.len()), (Verdict::Rejected(why), 0));
    }
}

#[test]
fn a_hole_far_beyond_the_outline_is_clipped() {
    let slot = ring(&[(4.0, -1e8), (6.0, -1e8), (6.0, 1e8), (4.0, 1e8)]);
    let got = repair(&[square(0.0, 10.0), slot], &Options::default());
    assert_eq!((got.polygons.len(), got.area_after), (2, 80.0));
}

/// A corner beyond the box along both axes: the cuts along one may not move what the other cuts.
#[test]
fn a_hole_across_a_corner_of_the_box_keeps_its_lines() {
    let outline = ring(&[(5.5, 0.0), (0.0, 0.0), (0.0, 0.5)]);
    let hole = ring(&[(2.5, 0.5), (0.0, 0.0), (-3.5, -6.5)]);
    let got = repair(&[outline, hole], &KERNEL);
    // By hand: the hole takes the quadrilateral (0, 0), (29/14, 0), (385/166, 24/83), (55/32, 11/32).
    let taken = (29.0 / 14.0 * (24.0 / 83.0) + 385.0 / 166.0 * (11.0 / 32.0) - 55.0 / 32.0 * (24.0 / 83.0)) / 2.0;
    assert!((got.area_after - (1.375 - taken)).abs() < 1e-7, "{}", got.area_after);
}

fn any_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => (-8i32..8).prop_map(f64::from),
        4 => -10.0f64..10.0,
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, -1e12, 1e-300, 1e8, 5e-8]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn any_input_gets_a_typed_answer(
        rings in prop::collection::vec(prop::collection::vec((any_coordinate(), any_coordinate()), 0..14), 0..4),
        weld in prop::sample::select(vec![0.0, 1e-3]),
    ) {
        let rings: Vec<Ring> = rings.iter().map(|r| ring(r)).collect();
        let got = repair(&rings, &Options { weld, min_area: 0.01 });
        prop_assert_eq!(matches!(got.verdict, Verdict::Rejected(_)), got.polygons.is_empty());
        let changed = got.notes.iter().any(Note::is_repair);
        prop_assert_eq!(got.verdict == Verdict::Ok, !changed && !got.polygons.is_empty());
        for polygon in &got.polygons {
            prop_assert!(polygon.rings().flatten().all(|p| p.is_finite()));
            prop_assert_eq!(crossing_edges(polygon), Vec::new());
            prop_assert_eq!(reversed_rings(polygon), Vec::<usize>::new());
        }
    }

    /// What came out goes in again unchanged, but for parts that touch in points.
    #[test]
    fn repairing_twice_is_repairing_once(outline in prop::collection::vec((-8i32..8, -8i32..8), 3..14)) {
        let outline: Ring = outline.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
        for polygon in repair(&[outline], &KERNEL).polygons {
            let rings: Vec<Ring> = polygon.rings().cloned().collect();
            let again = repair(&rings, &KERNEL);
            prop_assert!((again.area_after - polygon.area()).abs() < 1e-6);
        }
    }

    #[test]
    fn start_and_scale_do_not_change_the_result(outline in prop::collection::vec((-8i32..8, -8i32..8), 3..10), shift in 0usize..10, power in -12i32..12) {
        let outline: Ring = outline.iter().map(|&(x, y)| DVec2::new(f64::from(x), f64::from(y))).collect();
        let scale = libm::ldexp(1.0, power);
        let mut moved: Ring = outline.iter().map(|p| *p * scale).collect();
        moved.rotate_left(shift % outline.len());
        let (a, b) = (repair(&[outline], &KERNEL), repair(&[moved], &KERNEL));
        prop_assert_eq!(a.polygons.len(), b.polygons.len());
        prop_assert!((a.area_after * scale * scale - b.area_after).abs() <= 1e-6 * scale * scale);
    }
}
