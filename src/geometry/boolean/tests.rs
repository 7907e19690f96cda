//! Area identities, kept corners, typed errors, and points that lie inside.

use super::*;
use crate::geometry::polygon_checks::{crossing_edges, reversed_rings};
use proptest::prelude::*;

fn rect(x: f64, y: f64, w: f64, h: f64) -> Polygon {
    let outer = vec![DVec2::new(x, y), DVec2::new(x + w, y), DVec2::new(x + w, y + h), DVec2::new(x, y + h)];
    Polygon { outer, holes: Vec::new() }
}

fn area(polygons: &[Polygon]) -> f64 {
    polygons.iter().map(Polygon::area).sum()
}

#[test]
fn neighbours_unite_without_a_joint() {
    let joined = union(&[rect(0.0, 0.0, 10.0, 5.0)], &[rect(10.0, 0.0, 10.0, 5.0)]).expect("sound");
    assert_eq!(joined, [rect(0.0, 0.0, 20.0, 5.0)]);
}

#[test]
fn straight_points_of_the_input_stay() {
    let mut lot = rect(0.0, 0.0, 10.0, 5.0);
    lot.outer.insert(1, DVec2::new(4.0, 0.0));
    let cut = difference(&[lot.clone()], &[rect(20.0, 0.0, 1.0, 1.0)]).expect("sound");
    assert_eq!(cut, [lot]);
}

#[test]
fn corners_keep_their_bits_and_the_first_corner() {
    let a = rect(0.1, 0.7, 1.0 / 3.0, 0.3);
    let cut = difference(std::slice::from_ref(&a), &[rect(0.3, 0.8, 1.0, 0.05)]).expect("sound");
    assert_eq!(cut[0].outer[0], a.outer[0]);
    for corner in &a.outer {
        assert!(cut[0].outer.contains(corner));
    }
}

#[test]
fn a_hole_is_cut_out_and_filled_again() {
    let (a, b) = (rect(0.0, 0.0, 10.0, 10.0), rect(2.0, 2.0, 3.0, 3.0));
    let ring = difference(std::slice::from_ref(&a), std::slice::from_ref(&b)).expect("sound");
    assert_eq!((ring.len(), ring[0].holes.len(), area(&ring)), (1, 1, 91.0));
    assert!(reversed_rings(&ring[0]).is_empty());
    assert_eq!(union(&ring, &[b]).expect("sound"), [a]);
}

#[test]
fn directions_of_the_input_do_not_matter() {
    let (mut a, mut b) = (rect(0.0, 0.0, 10.0, 10.0), rect(5.0, 5.0, 10.0, 10.0));
    a.outer.reverse();
    a.holes.push(rect(1.0, 1.0, 2.0, 2.0).outer);
    b.outer.reverse();
    assert_eq!(area(&union(&[a.clone()], &[b.clone()]).expect("sound")), 171.0);
    assert_eq!(area(&intersection(&[a], &[b]).expect("sound")), 25.0);
}

#[test]
fn errors_are_typed_and_nothing_is_nothing() {
    let nan = Polygon { outer: vec![DVec2::NAN; 3], holes: Vec::new() };
    assert_eq!(union(&[nan], &[]), Err(BooleanError::NotFinite));
    assert_eq!(union(&[rect(0.0, 0.0, 1e10, 1.0)], &[]), Err(BooleanError::TooLarge));
    assert_eq!(union(&[], &[]), Ok(Vec::new()));
    assert_eq!(union(&[Polygon { outer: vec![DVec2::ONE; 5], holes: Vec::new() }], &[]), Ok(Vec::new()));
    assert_eq!(
        engine::overlay(&[vec![[1 << 40, 0], [0, 0], [0, 1]]], &[], OverlayRule::Union),
        Err(engine::EngineFailed)
    );
}

#[test]
fn a_point_on_the_surface_is_inside() {
    let ring = difference(&[rect(0.0, 0.0, 10.0, 10.0)], &[rect(0.5, 0.5, 9.0, 9.0)]).expect("sound");
    let p = point_on_surface(&ring[0]).expect("has area");
    assert!(ring[0].contains(p));
    assert_eq!(point_on_surface(&rect(0.0, 0.0, 4.0, 2.0)), Some(DVec2::new(2.0, 1.0)));
    assert_eq!(point_on_surface(&rect(0.0, 0.0, 4.0, 0.0)), None);
    assert_eq!(point_on_surface(&Polygon::default()), None);
}

fn star(radii: &[f64], centre: DVec2) -> Polygon {
    let step = std::f64::consts::TAU / radii.len() as f64;
    let corner =
        |(i, r): (usize, &f64)| centre + DVec2::new(libm::cos(step * i as f64), libm::sin(step * i as f64)) * *r;
    Polygon { outer: radii.iter().enumerate().map(corner).collect(), holes: Vec::new() }
}

proptest! {
    #[test]
    fn area_identities(
        a in prop::collection::vec(1.0f64..10.0, 5..24),
        b in prop::collection::vec(1.0f64..10.0, 5..24),
        shift in prop::array::uniform2(-10.0f64..10.0),
        coarse in any::<bool>(),
    ) {
        let mut sets = [vec![star(&a, DVec2::ZERO)], vec![star(&b, DVec2::from(shift))]];
        if coarse {
            // Corners on corners and edges on edges.
            sets.iter_mut().flatten().flat_map(|p| &mut p.outer).for_each(|p| *p = p.round());
            for set in &mut sets {
                *set = union(set, &[]).expect("finite");
            }
        }
        let [a, b] = sets;
        let [u, i, d, e, x] = [union(&a, &b), intersection(&a, &b), difference(&a, &b), difference(&b, &a), symmetric_difference(&a, &b)]
            .map(|r| r.expect("finite"));
        let close = |p: f64, q: f64| (p - q).abs() < 4e-9 * 200.0 * 40.0;
        prop_assert!(close(area(&u) + area(&i), area(&a) + area(&b)));
        prop_assert!(close(area(&d), area(&a) - area(&i)));
        prop_assert!(close(area(&e), area(&b) - area(&i)));
        prop_assert!(close(area(&x), area(&u) - area(&i)));
        for polygon in u.iter().chain(&i).chain(&d).chain(&x) {
            prop_assert_eq!(reversed_rings(polygon), Vec::<usize>::new());
            if let Some(p) = point_on_surface(polygon) {
                prop_assert!(polygon.contains(p));
            }
            if coarse {
                continue;
            }
            prop_assert_eq!(crossing_edges(polygon), Vec::new());
        }
    }
}

/// The stage cases of `../shared/hard-cases/stages.json`, each by its name.
mod stages {
    use super::*;
    use crate::geometry::hard_cases::footprint;

    fn girth(p: &Polygon) -> f64 {
        p.rings().flat_map(|r| (0..r.len()).map(move |i| r[i].distance(r[(i + 1) % r.len()]))).sum()
    }

    fn turned(p: &Polygon, angle: f64, about: DVec2) -> Polygon {
        let turn = DVec2::new(libm::cos(angle), libm::sin(angle));
        let ring = |r: &Vec<DVec2>| r.iter().map(|&q| about + turn.rotate(q - about)).collect();
        Polygon { outer: ring(&p.outer), holes: p.holes.iter().map(ring).collect() }
    }

    #[test]
    fn bool_self() {
        let Some(star) = footprint("random_star_500") else { return };
        let a = std::slice::from_ref(&star);
        let (lo, hi) = star.bounds().expect("points");
        let tolerance = 4e-9 * girth(&star) * (hi - lo).max_element();
        for same in [union(a, a), intersection(a, a)] {
            assert!((area(&same.expect("sound")) - star.area()).abs() < tolerance);
        }
        assert_eq!(difference(a, a), Ok(Vec::new()));
    }

    #[test]
    fn bool_share_edge() {
        let (a, b) = ([rect(0.0, 0.0, 10.0, 10.0)], [rect(10.0, 0.0, 10.0, 10.0)]);
        let joined = union(&a, &b).expect("sound");
        assert_eq!((joined.len(), joined[0].outer.len(), area(&joined)), (1, 4, 200.0));
        assert_eq!(intersection(&a, &b), Ok(Vec::new()));
    }

    #[test]
    fn bool_gap_1e_9() {
        let gap = 1e-9;
        let joined = union(&[rect(0.0, 0.0, 10.0, 10.0)], &[rect(10.0 + gap, 0.0, 10.0 - gap, 10.0)]).expect("sound");
        assert_eq!((joined.len(), joined[0].outer.len()), (1, 4));
        assert!((area(&joined) - 200.0).abs() < 1e-6);
    }

    #[test]
    fn bool_rotated_1e_9() {
        let Some(plus) = footprint("plus_30") else { return };
        let (a, b) = ([plus.clone()], [turned(&plus, 1e-9, DVec2::splat(15.0))]);
        for (result, expected) in
            [(union(&a, &b), 500.0), (intersection(&a, &b), 500.0), (symmetric_difference(&a, &b), 0.0)]
        {
            let result = result.expect("sound");
            assert!((area(&result) - expected).abs() < 1e-6);
            assert!(result.iter().all(|p| p.area() > 1e-9));
        }
    }

    #[test]
    fn bool_identity() {
        let (Some(a), Some(b)) = (footprint("star_12_sharp"), footprint("gear_24")) else { return };
        let (a, b) = ([a], [b]);
        let of = |r: Result<Vec<Polygon>, BooleanError>| area(&r.expect("sound"));
        let both = of(intersection(&a, &b));
        assert!((area(&a) + area(&b) - of(union(&a, &b)) - both).abs() < 1e-7 * area(&a));
        assert!((area(&a) - of(difference(&a, &b)) - both).abs() < 1e-7 * area(&a));
    }

    #[test]
    fn bool_checker() {
        let all: Vec<(i32, Polygon)> =
            (0..10_000).map(|k| (k % 100 + k / 100, rect(f64::from(k % 100), f64::from(k / 100), 1.0, 1.0))).collect();
        let half =
            |parity: i32| -> Vec<Polygon> { all.iter().filter(|c| c.0 % 2 == parity).map(|c| c.1.clone()).collect() };
        assert_eq!(union(&half(0), &half(1)), Ok(vec![rect(0.0, 0.0, 100.0, 100.0)]));
    }

    #[test]
    fn bool_utm() {
        let Some(bays) = footprint("bays_utm") else { return };
        let moved =
            |p: &Polygon, by: DVec2| Polygon { outer: p.outer.iter().map(|&q| q + by).collect(), holes: Vec::new() };
        let local = moved(&bays, -bays.outer[0]);
        let shift = DVec2::new(0.5, 0.25);
        let far = union(std::slice::from_ref(&bays), &[moved(&bays, shift)]).expect("sound");
        let near = union(std::slice::from_ref(&local), &[moved(&local, shift)]).expect("sound");
        assert!((area(&far) - area(&near)).abs() < 1e-6);
    }

    #[test]
    fn bool_order() {
        let side = |k: usize| (k * 7919 % 101) as f64;
        let all: Vec<Polygon> =
            (0..200).map(|k| turned(&rect(side(k), side(k + 50), 9.0, 4.0), k as f64, DVec2::splat(50.0))).collect();
        let reference = area(&union(&all, &[]).expect("sound"));
        for order in 0..20 {
            // 199 is prime, so every stride visits all of the first 199.
            let shuffled: Vec<Polygon> =
                (0..200).map(|k| if k < 199 { k * (3 + order) % 199 } else { k }).map(|k| all[k].clone()).collect();
            let joined = union(&shuffled, &[]).expect("sound");
            assert!((area(&joined) - reference).abs() < 1e-6);
        }
        let mut one_by_one: Vec<Polygon> = Vec::new();
        for p in &all[..50] {
            one_by_one = union(&one_by_one, std::slice::from_ref(p)).expect("sound");
        }
        let at_once = area(&union(&all[..50], &[]).expect("sound"));
        assert!((area(&one_by_one) - at_once).abs() < 1e-4, "{} {at_once}", area(&one_by_one));
    }
}
