//! Repair, booleans, triangles, canonical order and largest rectangles move with their input. In: random rings and
//! motions. Out: differences.

use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::geometry::boolean::{BooleanError, difference as less, intersection, symmetric_difference, union};
use crate::geometry::canonical::canonical_order;
use crate::geometry::convex_parts::convex_parts;
use crate::geometry::largest_rectangle::largest_upright;
use crate::geometry::polygon::{centroid, signed_area};
use crate::geometry::rectangle::least_around;
use crate::geometry::repair::Repaired;
use crate::geometry::triangulate::triangulate_polygon;

/// Rings that cross, touch and overlap, on a grid of half metres.
fn faulty() -> impl Strategy<Value = Vec<Ring>> {
    let point = (-30i32..30, -30i32..30).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)) / 2.0);
    prop::collection::vec(prop::collection::vec(point, 3..10), 1..4)
}

type Boolean = fn(&[Polygon], &[Polygon]) -> Result<Vec<Polygon>, BooleanError>;
const BOOLEANS: [Boolean; 4] = [union, intersection, less, symmetric_difference];

fn area(polygons: &[Polygon]) -> f64 {
    polygons.iter().map(Polygon::area).sum()
}

/// Every corner of one set is near one of the other.
fn corners_follow(a: &[Polygon], b: &[Polygon], motion: &Motion, tolerance: f64) -> bool {
    let points = |set: &[Polygon]| set.iter().flat_map(|p| p.rings()).flatten().copied().collect::<Vec<DVec2>>();
    let (moved, other): (Vec<DVec2>, Vec<DVec2>) = (points(a).iter().map(|&p| motion.point(p)).collect(), points(b));
    let found = |p: &DVec2, set: &[DVec2]| set.iter().any(|q| p.distance(*q) <= tolerance);
    moved.iter().all(|p| found(p, &other)) && other.iter().all(|p| found(p, &moved))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    /// The tolerances of repair are lengths: they scale along.
    #[test]
    fn repairs_follow_exact_motions(rings in faulty(), motion in exact(), weld in prop::sample::select(vec![0.0, 0.25])) {
        let options = Options { weld, min_area: 0.5 };
        let moved_options = Options { weld: weld * motion.scale, min_area: 0.5 * motion.scale.powi(2) };
        let moved: Vec<Ring> = rings.iter().map(|r| motion.ring(r)).collect();
        let (a, b) = (repair(&rings, &options), repair(&moved, &moved_options));
        prop_assert_eq!(a.verdict, b.verdict);
        let kinds = |r: &Repaired| r.notes.iter().map(std::mem::discriminant).collect::<Vec<_>>();
        prop_assert_eq!(kinds(&a), kinds(&b), "{:?} {:?}", a.notes, b.notes);
        // A crossing is rounded to the grid; where edges cross at a small angle the next one moves farther.
        let step = allowed(4e-8, 30.0, &motion);
        prop_assert_eq!(difference_of_loops(&motion.mesh(&sheet(&a.polygons)), &sheet(&b.polygons), step), None);
    }

    #[test]
    fn repairs_keep_their_area_under_any_motion(rings in faulty(), motion in any_motion()) {
        let moved: Vec<Ring> = rings.iter().map(|r| motion.ring(r)).collect();
        let (a, b) = (repair(&rings, &KERNEL), repair(&moved, &KERNEL));
        let step = allowed(4e-9, 30.0, &motion);
        let girth: f64 = rings.iter().map(|r| (0..r.len()).map(|i| r[i].distance(r[(i + 1) % r.len()])).sum::<f64>()).sum();
        let expected = a.area_after * motion.scale.powi(2);
        prop_assert!((expected - b.area_after).abs() <= step * girth * motion.scale, "{expected} {}", b.area_after);
    }

    #[test]
    fn booleans_follow_exact_motions(a in footprints(), b in footprints(), motion in exact(), by in prop::array::uniform2(-40i32..40)) {
        let by = Motion { shift: DVec2::new(f64::from(by[0]), f64::from(by[1])) / 2.0, ..STILL };
        let b = by.polygon(&b);
        let step = allowed(4e-9, 140.0, &motion);
        for combine in BOOLEANS {
            let own = combine(std::slice::from_ref(&a), std::slice::from_ref(&b)).expect("one");
            let moved = combine(&[motion.polygon(&a)], &[motion.polygon(&b)]).expect("two");
            let count = |set: &[Polygon]| (set.len(), set.iter().map(|p| p.holes.len()).sum::<usize>());
            prop_assert_eq!(count(&own), count(&moved));
            prop_assert!(corners_follow(&own, &moved, &motion, step), "{own:?}\n{moved:?}");
        }
    }

    #[test]
    fn booleans_keep_their_areas_under_any_motion(a in footprints(), b in footprints(), motion in any_motion(), by in prop::array::uniform2(-20.0..20.0f64)) {
        let b = Motion { shift: DVec2::from(by), ..STILL }.polygon(&b);
        let tolerance = 4000.0 * motion.scale * allowed(4e-9, 140.0, &motion);
        for combine in BOOLEANS {
            let own = area(&combine(std::slice::from_ref(&a), std::slice::from_ref(&b)).expect("one"));
            let moved = area(&combine(&[motion.polygon(&a)], &[motion.polygon(&b)]).expect("two"));
            prop_assert!((own * motion.scale.powi(2) - moved).abs() <= tolerance, "{own} {moved}");
        }
    }

    /// As many triangles, and as much covered; scaled by a power of two the very same ones.
    #[test]
    fn triangulations_follow(p in footprints(), motion in prop_oneof![exact(), any_motion()]) {
        let moved = motion.polygon(&p);
        let (a, b) = (triangulate_polygon(&p), triangulate_polygon(&moved));
        prop_assert_eq!(a.len(), b.len());
        let points: Vec<DVec2> = moved.rings().flatten().copied().collect();
        let covered: f64 = b.iter().map(|t| signed_area(&t.map(|i| points[i as usize]))).sum();
        prop_assert!((covered - moved.area()).abs() <= 1e-12 * extent(&moved).powi(2));
    }

    #[test]
    fn triangulations_scale(p in footprints(), power in -20i32..20) {
        let motion = Motion { scale: libm::ldexp(1.0, power), ..STILL };
        prop_assert_eq!(triangulate_polygon(&p), triangulate_polygon(&motion.polygon(&p)));
    }

    #[test]
    fn convex_parts_follow(p in footprints(), motion in exact()) {
        let area = |p: &Polygon| convex_parts(p, None).iter().flatten().map(|r| signed_area(r)).sum::<f64>();
        let (own, moved) = (area(&p) * motion.scale.powi(2), area(&motion.polygon(&p)));
        prop_assert!((own - moved).abs() <= 1e-9 * own, "{own} {moved}");
    }

    /// The first wall is the same wall, unless the outline has several that are alike.
    #[test]
    fn canonical_order_follows(p in footprints(), motion in prop_oneof![exact(), any_motion()]) {
        let length = |i: usize| p.outer[i].distance(p.outer[(i + 1) % p.outer.len()]);
        let longest = (0..p.outer.len()).map(length).fold(0.0, f64::max);
        let alike = (0..p.outer.len()).filter(|&i| length(i) > longest * 0.999).count();
        prop_assume!(alike == 1 && !is_broken(&p.outer));
        let (mut own, mut moved) = (p.clone(), motion.polygon(&p));
        let (first, second) = (canonical_order(&mut own)[0], canonical_order(&mut moved)[0]);
        prop_assert_eq!(motion.edge(&p, first), second);
    }

    #[test]
    fn largest_rectangles_follow_exact_motions(p in footprints(), motion in exact()) {
        let moved = motion.polygon(&p);
        let (a, b) = (largest_upright(&p, centroid(&p.outer)), largest_upright(&moved, centroid(&moved.outer)));
        prop_assert_eq!(a.is_some(), b.is_some());
        if let (Some(a), Some(b)) = (a, b) {
            let own = a.area() * motion.scale.powi(2);
            let rounding = allowed(1e-11, extent(&p), &motion) * extent(&moved);
            prop_assert!((own - b.area()).abs() <= 1e-9 * own + rounding, "{own} {}", b.area());
        }
    }

    /// The least rectangle turns along; a footprint that fits two as small may show either.
    #[test]
    fn least_rectangles_follow(p in houses(), motion in any_motion()) {
        let moved = motion.polygon(&p);
        let size = |p: &Polygon, d: DVec2| {
            let width = |d: DVec2| {
                let along = |q: &DVec2| (*q - p.outer[0]).dot(d);
                let (low, high) = p.outer.iter().map(along).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                high - low
            };
            width(d) * width(d.perp())
        };
        let (a, b) = (least_around(&p.outer).expect("one"), least_around(&moved.outer).expect("two"));
        let (own, other) = (size(&p, a) * motion.scale.powi(2), size(&moved, b));
        prop_assert!((own - other).abs() <= 3e-8 * own, "{own} {other}");
    }
}

const STILL: Motion = Motion { x_axis: DVec2::X, y_axis: DVec2::Y, scale: 1.0, shift: DVec2::ZERO };

/// Whether some corner turns by less than two degrees: then one wall may be two edges.
fn is_broken(ring: &Ring) -> bool {
    let n = ring.len();
    let edge = |i: usize| (ring[(i + 1) % n] - ring[i % n]).normalize_or_zero();
    (0..n).any(|i| edge(i).perp_dot(edge(i + 1)).abs() < 0.035)
}
