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
