//! Closed forms of `cga-reference.md` §10.5 and the roof cases of `hard-cases/stages.json`.

mod stages;

use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::mesh_checks::{self, edges_run_twice_the_same_way, edges_used_more_than_twice, open_edges};
use crate::geometry::polygon::Polygon;

fn polygon(outer: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Polygon {
    let ring = |r: &[(f64, f64)]| r.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    Polygon { outer: ring(outer), holes: holes.iter().map(|h| ring(h)).collect() }
}

fn rectangle(w: f64, h: f64) -> Polygon {
    polygon(&[(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)], &[])
}

fn l_10() -> Polygon {
    polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (5.0, 5.0), (5.0, 10.0), (0.0, 10.0)], &[])
}

fn u_12() -> Polygon {
    polygon(
        &[(0.0, 0.0), (12.0, 0.0), (12.0, 10.0), (9.0, 10.0), (9.0, 4.0), (3.0, 4.0), (3.0, 10.0), (0.0, 10.0)],
        &[],
    )
}

/// Outline 12 x 12 around a courtyard of 4 x 4.
fn courtyard() -> Polygon {
    polygon(&[(0.0, 0.0), (12.0, 0.0), (12.0, 12.0), (0.0, 12.0)], &[&[(4.0, 8.0), (8.0, 8.0), (8.0, 4.0), (4.0, 4.0)]])
}

fn volume(roof: &Roof) -> f64 {
    mesh_checks::volume(&roof.mesh)
}

fn area(roof: &Roof, face: usize) -> f64 {
    roof.mesh.area(&roof.mesh.faces[face])
}

fn size(roof: &Roof) -> DVec3 {
    let (low, high) = roof.mesh.bounds().expect("a roof");
    high - low
}

/// Closed, every edge run once each way; faces in edge order after the bottom; each starts with its eave.
#[track_caller]
fn assert_sound(roof: &Roof, polygon: &Polygon) {
    assert_eq!(open_edges(&roof.mesh), [], "open edges");
    assert_eq!(edges_used_more_than_twice(&roof.mesh), []);
    assert_eq!(edges_run_twice_the_same_way(&roof.mesh), []);
    assert_eq!(roof.parts.len(), roof.mesh.faces.len());
    assert_eq!(roof.parts[0], RoofPart::Bottom);
    let points: Vec<DVec2> = polygon.rings().flatten().copied().collect();
    let mut before = 0;
    let one_plane = matches!(roof.parts[1..], [.., RoofPart::Side { .. }, RoofPart::Top { .. }]);
    let faces = roof.mesh.faces.len() - usize::from(one_plane);
    for (face, part) in roof.mesh.faces.iter().zip(&roof.parts).take(faces).skip(1) {
        let (RoofPart::Top { edge: Some(edge) } | RoofPart::Side { edge }) = *part else { continue };
        assert!(edge >= before, "faces out of order");
        before = edge;
        let start = roof.mesh.positions[face.outer[0] as usize];
        if start.y == 0.0 {
            assert_eq!(DVec2::new(start.x, -start.z), points[edge], "face of edge {edge} does not start with it");
        }
    }
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-6 * (1.0 + b.abs()), "{a} is not {b}");
}

#[test]
fn hip_on_a_rectangle() {
    let r = rectangle(10.0, 6.0);
    let roof = hip(&r, Slope::Angle(45.0), 0.0, false).unwrap();
    assert_sound(&roof, &r);
    assert_eq!(roof.mesh.faces.len(), 5);
    assert!((size(&roof) - DVec3::new(10.0, 3.0, 6.0)).length() < 1e-6);
    close(volume(&roof), 36.0 * (3.0 * 10.0 - 6.0) / 12.0);
    let wide = hip(&r, Slope::Angle(45.0), 1.0, false).unwrap();
    assert!((size(&wide) - DVec3::new(11.414213562, 3.707106781, 7.414213562)).length() < 1e-6);
    assert_eq!(wide.mesh.faces.iter().map(|f| f.outer.len()).collect::<Vec<_>>(), [4, 4, 3, 4, 3]);
    close(size(&hip(&r, Slope::Height(2.0), 0.0, false).unwrap()).y, 2.0);
}

#[test]
fn hip_of_extreme_angles() {
    let r = rectangle(20.0, 10.0);
    for (angle, height, surface) in [(0.1, 0.00872665512094, 200.000304618), (89.9, 2864.78606677, 114591.617204)] {
        let roof = hip(&r, Slope::Angle(angle), 0.0, false).unwrap();
        close(size(&roof).y, height);
        close((1..5).map(|f| area(&roof, f)).sum(), surface);
    }
    assert_eq!(size(&hip(&r, Slope::Angle(0.0), 0.0, false).unwrap()).y, 0.0);
    for angle in [90.0, -10.0, 179.0, f64::INFINITY] {
        assert_eq!(hip(&r, Slope::Angle(angle), 0.0, false), Err(RoofError::Angle(angle)));
        assert_eq!(gable(&r, Slope::Angle(angle), 0.0, 0.0, false, None), Err(RoofError::Angle(angle)));
    }
    assert!(matches!(hip(&r, Slope::Angle(f64::NAN), 0.0, false), Err(RoofError::Angle(_))));
    assert!(matches!(hip(&r, Slope::Height(f64::NAN), 0.0, false), Err(RoofError::Height(_))));
    assert!(matches!(hip(&r, Slope::Angle(30.0), -1.0, false), Err(RoofError::Overhang(_))));
}

#[test]
fn hip_around_a_courtyard() {
    let roof = hip(&courtyard(), Slope::Angle(45.0), 0.0, false).unwrap();
    assert_sound(&roof, &courtyard());
    assert_eq!(roof.mesh.faces.len(), 9);
    close(size(&roof).y, 2.0);
    let wide = hip(&courtyard(), Slope::Angle(45.0), 2f64.sqrt(), false).unwrap();
    assert!((size(&wide) - DVec3::new(14.0, 3.0, 14.0)).length() < 1e-6);
}

#[test]
fn overhang_of_facing_wings_meets_between_them() {
    let roof = hip(&u_12(), Slope::Angle(30.0), 3.5, false).unwrap();
    let out = 3.5 * libm::cos(30f64.to_radians());
    // The bay is 6 m wide: 3.03 m from both sides is too much.
    close(size(&roof).x, 12.0 + 2.0 * out);
    let plan: f64 = (1..roof.mesh.faces.len()).map(|f| area(&roof, f) * libm::cos(30f64.to_radians())).sum();
    close(plan, (12.0 + 2.0 * out) * (10.0 + 2.0 * out));
}

#[test]
fn overhang_at_a_sharp_corner_is_limited() {
    let needle = polygon(&[(0.0, 0.0), (100.0, 0.0), (100.0, 0.174532925)], &[]);
    let roof = hip(&needle, Slope::Angle(30.0), 1.0, false).unwrap();
    assert!(size(&roof).x < 100.0 + 5.0, "{}", size(&roof));
}

#[test]
fn gable_on_a_rectangle() {
    let r = rectangle(10.0, 6.0);
    let roof = gable(&r, Slope::Angle(30.0), 0.0, 0.0, false, None).unwrap();
    assert_sound(&roof, &r);
    assert_eq!(roof.parts[2..5].iter().filter(|p| matches!(p, RoofPart::Side { .. })).count(), 2);
    close(size(&roof).y, 1.7320508);
    let r = rectangle(20.0, 10.0);
    let roof = gable(&r, Slope::Angle(30.0), 0.0, 0.0, false, None).unwrap();
    close(volume(&roof), 288.675134595);
    close(area(&roof, 2), 14.4337567297);
}

#[test]
fn gable_with_overhangs() {
    let roof = gable(&rectangle(10.0, 6.0), Slope::Angle(30.0), 1.0, 0.5, false, None).unwrap();
    assert!(
        (size(&roof) - DVec3::new(11.0, 1.7320508 + 0.5, 6.0 + 2.0 * 0.8660254)).length() < 1e-6,
        "{}",
        size(&roof)
    );
    let planes: Vec<f64> =
        (0..5).filter(|&f| matches!(roof.parts[f], RoofPart::Top { .. })).map(|f| area(&roof, f)).collect();
    // 11 m along the ridge, 3 / cos 30 + 1 m down the slope.
    assert_eq!(planes.len(), 2);
    planes.iter().for_each(|&a| close(a, 11.0 * (3.0 / 0.8660254038 + 1.0)));
    let only_ridge = gable(&rectangle(10.0, 6.0), Slope::Angle(30.0), 0.0, 0.5, false, None).unwrap();
    assert!((size(&only_ridge) - DVec3::new(11.0, 1.7320508, 6.0)).length() < 1e-6);
    let only_eaves = gable(&rectangle(10.0, 6.0), Slope::Angle(30.0), 1.0, 0.0, false, None).unwrap();
    assert!((size(&only_eaves) - DVec3::new(10.0, 2.2320508, 7.7320508)).length() < 1e-6);
}

#[test]
fn gable_of_a_square_and_by_index() {
    let square = rectangle(10.0, 10.0);
    let sides = |roof: &Roof| {
        let side = |p: &RoofPart| if let RoofPart::Side { edge } = p { Some(*edge) } else { None };
        roof.parts.iter().filter_map(side).collect::<Vec<_>>()
    };
    let roof = gable(&square, Slope::Angle(30.0), 0.0, 0.0, false, None).unwrap();
    assert_sound(&roof, &square);
    assert_eq!(sides(&roof), [1, 3]);
    close(volume(&roof), 144.337567297);
    for index in [0, 2, -2, 4] {
        let roof = gable(&rectangle(20.0, 10.0), Slope::Angle(30.0), 0.0, 0.0, false, Some(index)).unwrap();
        assert_eq!(sides(&roof), [0, 2]);
        close(size(&roof).y, 10.0 * libm::tan(30f64.to_radians()));
    }
    let pentagon = polygon(&[(0.0, 0.0), (10.0, 0.0), (13.0, 8.0), (5.0, 14.0), (-3.0, 8.0)], &[]);
    let roof = gable(&pentagon, Slope::Angle(30.0), 0.0, 0.0, false, Some(0)).unwrap();
    assert_sound(&roof, &pentagon);
    assert_eq!(sides(&roof), [0, 2]);
}

#[test]
fn gable_on_concave_outlines() {
    let roof = gable(&l_10(), Slope::Angle(40.0), 0.0, 0.0, false, Some(0)).unwrap();
    assert_sound(&roof, &l_10());
    assert_eq!(roof.warnings, [RoofWarning::IndexIgnored]);
    assert_eq!(roof.parts.iter().filter(|p| matches!(p, RoofPart::Side { .. })).count(), 2);
    let holed = gable(&courtyard(), Slope::Angle(40.0), 0.0, 0.0, false, None).unwrap();
    assert!(!holed.parts.iter().any(|p| matches!(p, RoofPart::Side { .. })));
    let wide = gable(&l_10(), Slope::Angle(40.0), 0.5, 0.5, false, None).unwrap();
    assert!(size(&wide).x > 10.3 && size(&wide).z > 10.3);
}

#[test]
fn pyramids() {
    let roof = pyramid(&rectangle(10.0, 6.0), Slope::Angle(45.0)).unwrap();
    assert_sound(&roof, &rectangle(10.0, 6.0));
    close(size(&roof).y, 3.0);
    let roof = pyramid(&l_10(), Slope::Height(3.0)).unwrap();
    close(volume(&roof), 75.0);
    assert!(roof.mesh.faces.iter().all(|f| roof.mesh.newell(f).is_finite() && roof.mesh.newell(f) != DVec3::ZERO));
    let roof = pyramid(&u_12(), Slope::Height(3.0)).unwrap();
    assert_eq!(roof.warnings, [RoofWarning::Overlapping]);
    close(volume(&roof), 84.0);
    assert_eq!(pyramid(&courtyard(), Slope::Height(3.0)).unwrap().warnings, [RoofWarning::HolesDropped]);
}

#[test]
fn sheds() {
    let r = rectangle(20.0, 10.0);
    let roof = shed(&r, Slope::Angle(30.0), 0).unwrap();
    assert_sound(&roof, &r);
    close(volume(&roof), 577.35026919);
    assert_eq!(roof.mesh.faces.iter().map(|f| f.outer.len()).collect::<Vec<_>>(), [4, 3, 4, 3, 4]);
    close(size(&shed(&rectangle(10.0, 6.0), Slope::Angle(30.0), 0).unwrap()).y, 3.4641016);
    close(volume(&shed(&r, Slope::Angle(-30.0), 0).unwrap()), 577.35026919);
    close(size(&shed(&u_12(), Slope::Height(2.0), 5).unwrap()).y, 2.0);
    assert_sound(&shed(&courtyard(), Slope::Angle(10.0), -1).unwrap(), &courtyard());
    assert_eq!(shed(&r, Slope::Angle(-90.0), 0), Err(RoofError::Angle(-90.0)));
    let south = skillion(&r, Slope::Height(1.0), DVec2::NEG_Y).unwrap();
    assert_eq!(south, shed(&r, Slope::Height(1.0), 0).unwrap());
}

#[test]
fn ridges() {
    let r = rectangle(10.0, 6.0);
    let roof = ridge(&r, Slope::Angle(45.0), DVec2::X).unwrap();
    assert_sound(&roof, &r);
    close(size(&roof).y, 3.0);
    close(volume(&roof), 90.0);
    let holed = ridge(&courtyard(), Slope::Height(2.0), DVec2::new(1.0, 0.3)).unwrap();
    assert_sound(&holed, &courtyard());
    close(size(&holed).y, 2.0);
    let u = ridge(&u_12(), Slope::Angle(30.0), DVec2::X).unwrap();
    assert_sound(&u, &u_12());
    assert!(matches!(ridge(&r, Slope::Angle(45.0), DVec2::ZERO), Err(RoofError::Direction(_))));
}

#[test]
fn bent_roofs() {
    // Volume of a mansard: steep part to 1 m, flat beyond, from the level sets of the skeleton.
    let l = l_10();
    let (steep, flat) = (libm::tan(70f64.to_radians()), libm::tan(20f64.to_radians()));
    let roof = mansard(&l, 70.0, 20.0, 1.0).unwrap();
    assert_sound(&roof, &l);
    // The L at distance t: area 75 - 40 t + 4 t^2 (perimeter 40, five convex corners, one reflex), to t = 2.5.
    let level = |t: f64| 75.0 * t - 20.0 * t * t + 4.0 / 3.0 * t * t * t;
    close(volume(&roof), steep * level(1.0) + flat * (level(2.5) - level(1.0)));
    let r = rectangle(10.0, 6.0);
    for roof in [
        gambrel(&r, 60.0, 30.0, 1.0),
        dome(&r, 4.0, 6),
        round(&r, 3.0, 8),
        half_hipped(&r, Slope::Angle(40.0), 0.5),
        dome(&courtyard(), 1.0, 4),
        half_hipped(&l, Slope::Height(3.0), 0.3),
    ] {
        let roof = roof.unwrap();
        assert_eq!((open_edges(&roof.mesh), edges_run_twice_the_same_way(&roof.mesh)), (vec![], vec![]));
        assert!(volume(&roof) > 0.0);
    }
    close(size(&dome(&r, 4.0, 6).unwrap()).y, 4.0);
    let half = half_hipped(&r, Slope::Angle(45.0), 0.0).unwrap();
    close(volume(&half), volume(&hip(&r, Slope::Angle(45.0), 0.0, false).unwrap()));
    let full = half_hipped(&r, Slope::Angle(45.0), 1.0).unwrap();
    assert_eq!(full, gable(&r, Slope::Angle(45.0), 0.0, 0.0, false, None).unwrap());
}

#[test]
fn even_ridges() {
    // Wings of different width: ridges at 2 and 3 become 2.5.
    let t = polygon(
        &[(0.0, 0.0), (20.0, 0.0), (20.0, 6.0), (10.0, 6.0), (10.0, 16.0), (6.0, 16.0), (6.0, 6.0), (0.0, 6.0)],
        &[],
    );
    let roof = hip(&t, Slope::Angle(45.0), 0.0, true).unwrap();
    assert_sound(&roof, &t);
    let mut heights: Vec<f64> = roof.mesh.positions.iter().map(|p| p.y).filter(|&h| h > 0.0).collect();
    heights.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    assert_eq!(heights.len(), 1, "{heights:?}");
}

#[test]
fn an_onion_bulges_and_ends_in_a_point() {
    let tower = rectangle(4.0, 4.0);
    let roof = onion(&tower, Slope::Height(6.0)).unwrap();
    assert_sound(&roof, &tower);
    assert_eq!(mesh_checks::defects(&roof.mesh, &[]), []);
    assert!((size(&roof) - DVec3::new(4.72, 6.0, 4.72)).length() < 1e-9, "{}", size(&roof));
    let skewed = polygon(&[(0.0, 0.0), (5.0, 1.0), (4.0, 5.0), (-1.0, 3.0)], &[]);
    assert_eq!(mesh_checks::defects(&onion(&skewed, Slope::Angle(70.0)).unwrap().mesh, &[]), []);
    assert_eq!(onion(&u_12(), Slope::Height(6.0)), Err(RoofError::HiddenEdge));
    assert_eq!(onion(&courtyard(), Slope::Height(6.0)).unwrap().warnings, [RoofWarning::HolesDropped]);
}

#[test]
fn a_saltbox_has_its_ridge_off_the_middle() {
    let r = rectangle(10.0, 6.0);
    let roof = saltbox(&r, Slope::Height(4.0), DVec2::NEG_Y).unwrap();
    assert_sound(&roof, &r);
    // Cross-section: 4 m up over 4 m, 2 m down over the other 2 m.
    close(volume(&roof), 10.0 * (4.0 * 4.0 / 2.0 + 2.0 * (4.0 + 2.0) / 2.0));
    for shape in [u_12(), courtyard(), l_10()] {
        let roof = saltbox(&shape, Slope::Angle(30.0), DVec2::new(1.0, 0.4)).unwrap();
        assert_eq!(mesh_checks::defects(&roof.mesh, &[]), []);
    }
}

#[test]
fn every_roof_shape_of_the_map_is_sound_on_every_outline() {
    for kind in RoofShape::ALL {
        assert_eq!(RoofShape::from_name(kind.name()), Some(kind));
        for shape in [rectangle(10.0, 6.0), rectangle(8.0, 8.0), l_10(), u_12(), courtyard()] {
            for facing in [Facing::Natural, Facing::Downhill(DVec2::new(0.9, 0.1)), Facing::Along, Facing::Across] {
                for slope in [Slope::Height(3.0), Slope::Angle(35.0), Slope::Height(0.0)] {
                    let first = kind.build(&shape, slope, facing);
                    let made = sound(&shape, slope, &[], (kind.name(), first)).unwrap();
                    let hidden = matches!(kind, RoofShape::Onion | RoofShape::Pyramidal) && !made.steps.is_empty();
                    assert!(made.steps.is_empty() || hidden, "{kind:?} {facing:?} {slope:?}: {:?}", made.steps);
                    let Some(roof) = made.roof else { continue };
                    assert_eq!(mesh_checks::defects(&roof.mesh, &[]), [], "{kind:?} {facing:?} {slope:?}");
                    if slope == Slope::Height(3.0) {
                        close(size(&roof).y, 3.0);
                    }
                }
            }
        }
    }
    assert_eq!(RoofShape::from_name("Half_Hipped"), Some(RoofShape::HalfHipped));
    assert_eq!(RoofShape::from_name("lean_to"), Some(RoofShape::Skillion));
    assert_eq!(RoofShape::from_name("gable d"), None);
}

#[test]
fn more_bands_come_nearer_to_the_barrel() {
    let r = rectangle(10.0, 6.0);
    let barrel = |bands| RoofShape::Round.banded(&r, Slope::Height(3.0), Facing::Natural, bands).unwrap().unwrap();
    let volumes = [1, 2, 4, 8, 16, 32].map(|bands| volume(&barrel(bands)));
    // One band is a gable; half a cylinder of radius 3 is what they tend to.
    close(volumes[0], 90.0);
    let exact = 10.0 * std::f64::consts::PI * 9.0 / 2.0;
    let missing = volumes.map(|volume| exact - volume);
    assert!(missing.windows(2).all(|w| w[1] > 0.0 && w[1] < 0.35 * w[0]), "{missing:?}");
    assert_eq!(
        volume(&barrel(8)),
        volume(&RoofShape::Round.build(&r, Slope::Height(3.0), Facing::Natural).unwrap().unwrap())
    );
}

#[test]
fn ridges_run_across_the_direction_that_the_map_gives() {
    let r = rectangle(10.0, 6.0);
    let ends = |facing: Facing| {
        let roof = RoofShape::Gabled.build(&r, Slope::Height(2.0), facing).unwrap().unwrap();
        let side = |p: &RoofPart| if let RoofPart::Side { edge } = p { Some(*edge) } else { None };
        roof.parts.iter().filter_map(side).collect::<Vec<_>>()
    };
    assert_eq!(ends(Facing::Natural), [1, 3]);
    assert_eq!(ends(Facing::Along), [1, 3]);
    assert_eq!(ends(Facing::Across), [0, 2]);
    // Looking east: the ridge runs north, and ends over the long edges.
    assert_eq!(ends(Facing::Downhill(DVec2::new(1.0, 0.2))), [0, 2]);
    assert_eq!(ends(Facing::Downhill(DVec2::new(0.2, -1.0))), [1, 3]);
    // On a concave outline one ridge runs over everything.
    let roof = RoofShape::Gabled.build(&u_12(), Slope::Height(2.0), Facing::Downhill(DVec2::X)).unwrap().unwrap();
    assert!(roof.mesh.positions.iter().filter(|p| p.y == 2.0).all(|p| (p.x - 6.0).abs() < 1e-9));
}

#[test]
fn a_roof_with_a_defect_falls_back_step_by_step() {
    let broken = |polygon: &Polygon| {
        let mut roof = hip(polygon, Slope::Height(3.0), 0.0, false).unwrap();
        roof.mesh.faces.pop();
        roof.parts.pop();
        Ok(Some(roof))
    };
    let r = rectangle(10.0, 6.0);
    let made = sound(&r, Slope::Height(3.0), &[], ("the broken roof", broken(&r))).unwrap();
    assert_eq!(made.roof, hip(&r, Slope::Height(3.0), 0.0, false).ok());
    let step = FellBack { from: "the broken roof", why: "open edge (3)".into(), to: "a hip roof" };
    assert_eq!(made.steps, [step]);
    let tower = sound(&u_12(), Slope::Height(3.0), &[], ("the onion", onion(&u_12(), Slope::Height(3.0)).map(Some)));
    assert_eq!(tower.unwrap().steps.len(), 1);
    // A bow-tie has no skeleton: its rectangle carries the roof.
    let bow = polygon(&[(0.0, 0.0), (10.0, 6.0), (10.0, 0.0), (0.0, 6.0)], &[]);
    let made =
        sound(&bow, Slope::Height(3.0), &[], ("a hip roof", hip(&bow, Slope::Height(3.0), 0.0, false).map(Some)));
    let made = made.unwrap();
    assert_eq!(made.steps.last().map(|s| s.to), Some("a hip roof over the bounding rectangle"), "{:?}", made.steps);
    close(size(made.roof.as_ref().unwrap()).x, 10.0);
    let line = polygon(&[(0.0, 0.0), (10.0, 0.0), (5.0, 0.0)], &[]);
    let made =
        sound(&line, Slope::Height(3.0), &[], ("a hip roof", hip(&line, Slope::Height(3.0), 0.0, false).map(Some)));
    assert_eq!(made.unwrap().roof, None);
    let steep = sound(&r, Slope::Angle(95.0), &[], ("a hip roof", hip(&r, Slope::Angle(95.0), 0.0, false).map(Some)));
    assert_eq!(steep, Err(RoofError::Angle(95.0)));
}

/// Found by the fuzz target `evaluate`: an outline that touches itself has two vertices at one place.
#[test]
fn a_ridge_over_an_outline_that_touches_itself() {
    let outer = [(0, 0), (4, 0), (5, 3), (6, 0), (10, 0), (10, 6), (6, 6), (5, 3), (4, 6), (0, 6)];
    let outer = outer.map(|(x, y)| DVec2::new(f64::from(x), f64::from(y))).to_vec();
    let roof = ridge(&Polygon { outer, holes: Vec::new() }, Slope::Angle(45.0), DVec2::X).unwrap();
    assert!((volume(&roof) - 84.0).abs() < 1e-9, "{}", volume(&roof));
}

/// The triangles of every face are as large as the face.
#[track_caller]
fn assert_triangles_fill(roof: &Roof) {
    let triangles: Vec<f64> = crate::geometry::triangulate::triangles(&roof.mesh)
        .map(|(_, [a, b, c])| (b - a).cross(c - a).length() / 2.0)
        .collect();
    let surface: f64 = roof.mesh.faces.iter().map(|f| roof.mesh.area(f)).sum();
    close(triangles.iter().sum(), surface);
    assert!(mesh_checks::faces_not_triangulated(&roof.mesh).is_empty());
}

/// Found by `tests/bench/geometry`: corners a few grid steps apart at an apex fold a face by a rounding.
#[test]
fn faces_folded_by_a_rounding_at_an_apex_are_covered() {
    for n in [17, 48, 64] {
        let corner = |k: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / n as f64);
            DVec2::new(cos, sin) * 10.0
        };
        let ring: Vec<DVec2> = (0..n).map(corner).collect();
        let outline = crate::geometry::repair::repair(&[ring], &Default::default()).polygons.remove(0);
        assert_triangles_fill(&hip(&outline, Slope::Angle(45.0), 0.0, false).unwrap());
    }
}

/// Found by `tests/bench/geometry`: on a turned plan a ridge ends beside a valley, within the rounding.
#[test]
fn a_ridge_that_ends_on_a_valley_is_covered() {
    let u = polygon(
        &[
            (1878.8381361996232, 1611.2236489156026),
            (1886.1570868061656, 1604.4094753032712),
            (1889.9048822929478, 1608.4348981368696),
            (1882.5859316864053, 1615.2490717492008),
            (1883.9487664088715, 1616.7128618705094),
            (1876.6298158023292, 1623.5270354828406),
            (1868.112098786915, 1614.3783472246625),
            (1875.4310493934574, 1607.5641736123312),
        ],
        &[],
    );
    let outline = crate::geometry::repair::repair(&[u.outer], &Default::default()).polygons.remove(0);
    assert_triangles_fill(&hip(&outline, Slope::Angle(45.0), 0.0, false).unwrap());
}

/// Found by `tests/bench/geometry`: where rings touch, a face ran through both corners at the same place.
#[test]
fn rings_that_touch_in_a_corner_double_no_corner() {
    let p = polygon(
        &[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)],
        &[
            &[(5.0, 5.0), (5.0, 10.0), (10.0, 10.0), (10.0, 5.0)],
            &[(10.0, 10.0), (10.0, 15.0), (15.0, 15.0), (15.0, 10.0)],
        ],
    );
    let roof = hip(&p, Slope::Angle(45.0), 0.0, false).unwrap();
    assert!(mesh_checks::doubled_corners(&roof.mesh).is_empty());
    assert_eq!(open_edges(&roof.mesh), []);
    assert_eq!(edges_run_twice_the_same_way(&roof.mesh), []);
}

/// Gables with an overhang of 0.45 m all around: no defect but the free edges of the overhang.
#[track_caller]
fn assert_overhanging_gables_are_plane(outer: &[(f64, f64)]) {
    let roof = gable(&polygon(outer, &[]), Slope::Angle(30.0), 0.45, 0.45, false, None).unwrap();
    assert_eq!(mesh_checks::defects(&roof.mesh, &[mesh_checks::Defect::OpenEdge]), []);
    assert!(roof.parts.iter().any(|p| matches!(p, RoofPart::Side { .. })));
}

/// way/-14226 of Santa Rosa: the strip before the pediment of the jog meets the eave beside it at another height.
#[test]
fn a_pediment_whose_overhang_meets_another_eave_stays_flush() {
    assert_overhanging_gables_are_plane(&[
        (11.4641, 5.0642),
        (6.1263, 17.1404),
        (-5.3378, 12.0651),
        (-2.4811, 5.6052),
        (-5.0393, 4.4724),
        (-2.9951, -0.1338),
        (-1.5806, 0.4881),
        (-1.1438, -0.4998),
        (0.0, 0.0),
    ]);
}

/// From way/-13838 of Santa Rosa: the eaves of a slot beside a wall that stands still.
#[test]
fn an_eave_in_a_slot_ends_at_the_line_of_a_wall_without_overhang() {
    assert_overhanging_gables_are_plane(&[
        (2.4802, -6.0164),
        (4.8990, -5.0172),
        (5.3444, -6.0940),
        (4.7331, -6.3382),
        (5.6937, -8.6693),
        (6.6281, -8.2807),
        (6.8901, -8.9245),
        (6.4185, -9.1244),
        (8.7066, -14.6745),
        (16.8711, -9.0352),
        (8.9243, 3.6745),
        (0.0, 0.0),
    ]);
}

/// way/283252471 of Queens Village: the end of a front that goes straight on got a pediment without height.
#[test]
fn a_front_that_goes_straight_on_has_no_pediment_at_its_end() {
    let outline = [(0.0, 0.0), (0.6926, 0.000127), (6.4363, 0.001186), (6.4270, 4.7208), (-0.0009, 4.7085)];
    let roof = gable(&polygon(&outline, &[]), Slope::Angle(30.0), 0.45, 0.45, false, None).unwrap();
    let lowest = roof.mesh.faces.iter().zip(&roof.parts).filter(|(_, p)| matches!(p, RoofPart::Side { .. }));
    assert!(lowest.clone().count() > 0 && lowest.clone().all(|(f, _)| roof.mesh.area(f) > 0.1));
    assert_eq!(mesh_checks::defects(&roof.mesh, &[mesh_checks::Defect::OpenEdge]), []);
}

/// way/686911321 of Monaco, a church whose ridge runs across: half hips from both ends overlapped.
#[test]
fn half_hips_leave_some_of_a_short_ridge() {
    let wide = rectangle(10.0, 24.0);
    for (facing, fraction) in [(Facing::Across, 0.5), (Facing::Across, 0.2), (Facing::Along, 0.5)] {
        let roof = RoofShape::HalfHipped.build(&wide, Slope::Height(3.0), facing).unwrap().expect("a roof");
        assert_eq!(mesh_checks::defects(&roof.mesh, &[]), [], "{facing:?}");
        assert!((size(&roof).y - 3.0).abs() < 1e-9);
        let short = half_hipped(&rectangle(24.0, 10.0), Slope::Height(3.0), fraction).unwrap();
        assert_eq!(mesh_checks::defects(&short.mesh, &[]), [], "{fraction}");
    }
}

/// Found by `any_rings_are_answered`.
#[test]
fn an_outline_without_points_has_no_roof() {
    for shape in RoofShape::ALL.into_iter().filter(|s| *s != RoofShape::Flat) {
        let made = shape.build(&Polygon::default(), Slope::Angle(40.0), Facing::Natural);
        assert_eq!(made, Err(RoofError::Skeleton(SkeletonError::TooFewPoints)), "{shape:?}");
    }
}
