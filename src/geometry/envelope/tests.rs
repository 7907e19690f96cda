//! In: outlines with limits. Out: volumes, compared with prisms cut by planes.

use super::*;
use crate::geometry::mesh_checks::{is_closed, volume};
use proptest::prelude::*;

fn polygon(points: &[(f64, f64)]) -> Polygon {
    Polygon { outer: points.iter().map(|&(x, y)| DVec2::new(x, y)).collect(), holes: Vec::new() }
}

fn limits(list: &[(f64, f64)]) -> Vec<Limit> {
    list.iter().map(|&(base, angle)| Limit { base, angle }).collect()
}

#[track_caller]
fn checked(polygon: &Polygon, limits: &[Limit], height: f64) -> Envelope {
    let found = envelope(polygon, limits, height).expect("an envelope");
    assert!(is_closed(&found.mesh), "{limits:?} {height}: {found:?}");
    found
}

const SMALL: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, 6.0), (0.0, 6.0)];

#[test]
fn upright_walls_make_a_prism() {
    let found = checked(&polygon(SMALL), &[], 4.0);
    assert_eq!(found.parts.len(), 6);
    assert!((volume(&found.mesh) - 240.0).abs() < 1e-9);
}

#[test]
fn one_slope_cuts_a_wedge() {
    // From 4 m up at 45 degrees, sealed at 7 m: a wedge of 3 x 3 / 2 x 10 is missing.
    let found = checked(&polygon(SMALL), &limits(&[(4.0, 45.0)]), 7.0);
    assert!((volume(&found.mesh) - (420.0 - 45.0)).abs() < 1e-9, "{}", volume(&found.mesh));
    let sides = |edge| [Part::Side { edge, slope: false }, Part::Side { edge, slope: true }];
    assert!(sides(0).iter().all(|p| found.parts.contains(p)) && !found.parts.contains(&sides(1)[1]));
    assert_eq!((found.parts[0], found.parts[found.parts.len() - 1]), (Part::Bottom, Part::Top));
    assert_eq!(found.parts.len(), 7);
}

#[test]
fn slopes_may_close_below_the_top() {
    let found = checked(&polygon(SMALL), &limits(&[(1.0, 45.0); 4]), 100.0);
    assert!(!found.parts.contains(&Part::Top));
    // A hip roof of height 3 on 1 m of wall: 6 x 4 x 3 / 2 + 6 x 6 x 3 / 3.
    assert!((volume(&found.mesh) - (60.0 + 36.0 + 36.0)).abs() < 1e-9, "{}", volume(&found.mesh));
}

#[test]
fn level_slopes_end_the_body() {
    let found = checked(&polygon(SMALL), &limits(&[(2.0, 0.0)]), 9.0);
    assert!((volume(&found.mesh) - 120.0).abs() < 1e-9);
    assert!(envelope(&polygon(SMALL), &[], 0.0).is_err());
}

#[test]
fn courtyards_stay_open() {
    let mut ring = polygon(SMALL);
    ring.holes.push([(4.0, 2.0), (4.0, 4.0), (6.0, 4.0), (6.0, 2.0)].map(|(x, y)| DVec2::new(x, y)).to_vec());
    let found = checked(&ring, &limits(&[(3.0, 60.0), (2.0, 60.0), (3.0, 60.0), (1.0, 60.0)]), 5.0);
    let inner = |p: &&Part| matches!(p, Part::Side { edge: 4.., slope: false });
    assert_eq!(found.parts.iter().filter(inner).count(), 4);
    assert!(volume(&found.mesh) < 56.0 * 5.0);
}

/// The volume as a sum of level slices, each the outline clipped by every edge as far as it has moved: right for convex
/// polygons, to about 1e-5.
fn by_slices(polygon: &Polygon, limits: &[Limit], height: f64) -> f64 {
    const SLICES: usize = 400;
    let thick = height / SLICES as f64;
    let area = |z: f64| {
        let mut ring = polygon.outer.clone();
        for (i, limit) in limits.iter().enumerate().filter(|(_, limit)| limit.angle < 90.0 && limit.base < z) {
            let (a, b) = (polygon.outer[i], polygon.outer[(i + 1) % polygon.outer.len()]);
            let inward = (b - a).normalize().perp();
            let moved = (z - limit.base) / libm::tan(limit.angle.to_radians());
            let depth = |p: DVec2| (p - a).dot(inward) - moved;
            let sides = (0..ring.len()).map(|k| (ring[k], ring[(k + 1) % ring.len()]));
            let clipped = |(p, q): (DVec2, DVec2)| {
                let (s, t) = (depth(p), depth(q));
                let crossing = (s * t < 0.0).then(|| p.lerp(q, s / (s - t)));
                (s >= 0.0).then_some(p).into_iter().chain(crossing)
            };
            ring = sides.flat_map(clipped).collect();
        }
        if ring.len() < 3 { 0.0 } else { signed_area(&ring) }
    };
    (0..SLICES).map(|i| area((i as f64 + 0.5) * thick) * thick).sum()
}

/// Corners on a circle of 9 m, moved along it by the sizes.
fn on_circle(sizes: &[(f64, f64)]) -> Polygon {
    let corner = |(i, size): (usize, &(f64, f64))| {
        let turn = (i as f64 + 0.3 * size.0 / 6.0) / sizes.len() as f64;
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * turn);
        DVec2::new(9.0 * cos, 9.0 * sin)
    };
    Polygon { outer: sizes.iter().enumerate().map(corner).collect(), holes: Vec::new() }
}

/// A slope of 20 degrees from 4.6 m up, whose wall its steep neighbours have taken away below that height: it still cuts
/// the body further up. Found by proptest.
#[test]
fn slopes_come_back_where_their_wall_is_gone() {
    let sizes = [
        (0.0, 74.6500371413395),
        (0.06413203050192748, 32.83734750185314),
        (4.618070524865037, 20.0),
        (0.0, 87.24641616430182),
        (0.0, 86.06142852085938),
        (0.0, 64.55361458782589),
    ];
    let (polygon, limits, height) = (on_circle(&sizes), limits(&sizes), 10.866791636277812);
    let found = checked(&polygon, &limits, height);
    assert!((volume(&found.mesh) - 820.1257476656428).abs() < 1e-3, "{}", volume(&found.mesh));
    assert!(found.parts.contains(&Part::Side { edge: 2, slope: true }));
    assert!((by_slices(&polygon, &limits, height) / 820.1257476656428 - 1.0).abs() < 1e-4);
}

/// Every slope begins along its edge of the outline, and high limits cost no precision.
#[test]
fn slopes_begin_along_the_outline() {
    let found = checked(&polygon(SMALL), &limits(&[(1.0, 45.0), (2.0, 60.0), (1.0, 45.0), (2.0, 60.0)]), 1e7);
    let parts: Vec<Part> = found.parts.clone();
    assert!(parts.is_sorted() && parts.len() == 9, "{parts:?}");
    for (face, part) in found.mesh.faces.iter().zip(parts) {
        let Part::Side { edge, .. } = part else { continue };
        let at = |i: usize| found.mesh.positions[face.outer[i] as usize];
        let (a, b) = (SMALL[edge], SMALL[(edge + 1) % 4]);
        let along = DVec3::new(b.0 - a.0, 0.0, a.1 - b.1);
        assert!((at(1) - at(0)).cross(along).length() < 1e-9 && (at(1) - at(0)).dot(along) > 0.0, "{part:?}");
    }
    let expected = by_slices(&polygon(SMALL), &limits(&[(1.0, 45.0), (2.0, 60.0), (1.0, 45.0), (2.0, 60.0)]), 9.0);
    assert!((volume(&found.mesh) / expected - 1.0).abs() < 1e-4, "{} {expected}", volume(&found.mesh));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn convex_envelopes_lie_under_all_slopes(n in 3usize..7, sizes in prop::collection::vec((0.0..6.0f64, 20.0..90.0f64), 7), height in 1.0..12.0f64) {
        let (polygon, limits) = (on_circle(&sizes[..n]), limits(&sizes[..n]));
        let found = envelope(&polygon, &limits, height).expect("an envelope");
        prop_assert!(is_closed(&found.mesh));
        let expected = by_slices(&polygon, &limits, height);
        prop_assert!((volume(&found.mesh) / expected - 1.0).abs() < 1e-4, "{} {expected}", volume(&found.mesh));
    }

    #[test]
    fn concave_envelopes_are_closed_and_small(radii in prop::collection::vec(2.0..9.0f64, 4..9), sizes in prop::collection::vec((0.0..5.0f64, 15.0..110.0f64), 9), height in 0.5..15.0f64) {
        let n = radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
            DVec2::new(r * cos, r * sin)
        };
        let star = Polygon { outer: radii.iter().enumerate().map(corner).collect(), holes: Vec::new() };
        let found = envelope(&star, &limits(&sizes[..radii.len()]), height).expect("an envelope");
        prop_assert!(is_closed(&found.mesh), "{found:?}");
        let v = volume(&found.mesh);
        prop_assert!(v > 0.0 && v <= star.area() * height * (1.0 + 1e-9), "{v}");
        prop_assert!(found.mesh.positions.iter().all(|p| p.y >= 0.0 && p.y <= height));
    }
}
