//! The stage cases of roofs, offsets and closed meshes in `../shared/hard-cases/stages.json`, each by its name
//! (`tests/it/stage_cases.rs` holds them against the file).

use std::collections::BTreeMap;

use super::*;
use crate::geometry::hard_cases::{features, footprint, rings};
use crate::geometry::mesh_checks::{is_closed, non_planar_faces, self_intersections};
use crate::geometry::offset::{MITRE_LIMIT, Offset, offset, setback};
use crate::geometry::polygon::signed_area;
use crate::geometry::repair::{Options, repair};
use crate::geometry::skeleton::skeleton;
use crate::geometry::triangulate::triangles;

#[track_caller]
fn within(got: f64, expected: f64, relative: f64) {
    assert!((got - expected).abs() <= relative * expected.abs(), "{got} is not {expected}");
}

fn hip_of(name: &str, angle: f64) -> Option<Roof> {
    Some(hip(&footprint(name)?, Slope::Angle(angle), 0.0, false).expect("a roof"))
}

/// Surface of all faces but the bottom.
fn surface(roof: &Roof) -> f64 {
    (1..roof.mesh.faces.len()).map(|f| area(roof, f)).sum()
}

/// Plan areas of the roof planes, those that lean over negative.
fn plan_areas(roof: &Roof) -> Vec<f64> {
    let tops = roof.mesh.faces.iter().zip(&roof.parts).filter(|(_, part)| matches!(part, RoofPart::Top { .. }));
    tops.map(|(face, _)| roof.mesh.area_vector(face).y / 2.0).collect()
}

/// A whole building: floor, walls of 10 m, roof; corners at one place are one.
fn building(polygon: &Polygon, roof: &Roof) -> Mesh {
    let mut mesh = Mesh::default();
    for (p, q) in polygon.rings().flat_map(|r| (0..r.len()).map(move |i| (r[i], r[(i + 1) % r.len()]))) {
        let first = mesh.positions.len() as u32;
        let corner = |p: DVec2, y: f64| DVec3::new(p.x, y, -p.y);
        mesh.positions.extend([corner(p, 0.0), corner(q, 0.0), corner(q, 10.0), corner(p, 10.0)]);
        mesh.faces.push(crate::geometry::Face::new((first..first + 4).collect::<Vec<u32>>()));
    }
    for (face, part) in roof.mesh.faces.iter().zip(&roof.parts) {
        let lift = if *part == RoofPart::Bottom { DVec3::ZERO } else { DVec3::Y * 10.0 };
        let mut face = face.clone();
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(face.corners().map(|v| roof.mesh.positions[v as usize] + lift));
        face.loops_mut().flatten().zip(first..).for_each(|(v, number)| *v = number);
        mesh.faces.push(face);
    }
    mesh.welded()
}

/// V - E + F of the triangulated mesh.
fn euler(mesh: &Mesh) -> i64 {
    let mut vertices: BTreeMap<[u64; 3], ()> = BTreeMap::new();
    let mut edges = BTreeMap::new();
    let mut count = 0;
    for (_, corners) in triangles(mesh) {
        let keys = corners.map(|p| p.to_array().map(f64::to_bits));
        count += 1;
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            vertices.insert(keys[a], ());
            edges.insert((keys[a].min(keys[b]), keys[a].max(keys[b])), ());
        }
    }
    vertices.len() as i64 - edges.len() as i64 + count
}

#[test]
fn roof_hip_45() {
    let Some(roof) = hip_of("square_10", 45.0) else { return };
    assert_eq!(roof.mesh.faces.len(), 1 + 4);
    within(size(&roof).y, 5.0, 1e-7);
    within(volume(&roof), 500.0 / 3.0, 1e-7);
}

#[test]
fn roof_hip_0_1() {
    let Some(roof) = hip_of("rect_20x10", 0.1) else { return };
    within(size(&roof).y, 0.00872665512094, 1e-7);
    within(surface(&roof), 200.000304618, 1e-7);
}

#[test]
fn roof_hip_89_9() {
    let Some(roof) = hip_of("rect_20x10", 89.9) else { return };
    within(size(&roof).y, 2864.78606677, 1e-6);
    within(surface(&roof), 114591.617204, 1e-6);
}

#[test]
fn roof_gable_rect() {
    let Some(p) = footprint("rect_20x10") else { return };
    let roof = gable(&p, Slope::Angle(30.0), 0.0, 0.0, false, None).unwrap();
    assert_sound(&roof, &p);
    within(volume(&roof), 288.675134595, 1e-7);
    let sides: Vec<usize> = (0..5).filter(|&f| matches!(roof.parts[f], RoofPart::Side { .. })).collect();
    assert_eq!(sides.len(), 2);
    sides.iter().for_each(|&f| within(area(&roof, f), 14.4337567297, 1e-7));
}

#[test]
fn roof_gable_square() {
    let Some(square) = footprint("square_10") else { return };
    for step in 0..12 {
        let turn = DVec2::from_angle(f64::from(step) * 0.31);
        let p = Polygon { outer: square.outer.iter().map(|&q| turn.rotate(q)).collect(), holes: Vec::new() };
        let roof = gable(&p, Slope::Angle(30.0), 0.0, 0.0, false, None).unwrap();
        within(volume(&roof), 144.337567297, 1e-7);
        let sides = roof.parts.iter().filter(|p| matches!(p, RoofPart::Side { .. })).collect::<Vec<_>>();
        assert_eq!(sides, [&RoofPart::Side { edge: 1 }, &RoofPart::Side { edge: 3 }], "turned by {step}");
    }
}

#[test]
fn roof_gable_l() {
    let Some(p) = footprint("L_10") else { return };
    let roof = gable(&p, Slope::Angle(40.0), 0.0, 0.0, false, None).unwrap();
    assert_sound(&roof, &p);
    let areas = plan_areas(&roof);
    assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
    within(areas.iter().sum(), 75.0, 1e-7);
}

#[test]
fn roof_pyramid_l() {
    let Some(p) = footprint("L_10") else { return };
    let roof = pyramid(&p, Slope::Height(3.0)).unwrap();
    let mut areas = plan_areas(&roof);
    areas.sort_by(f64::total_cmp);
    for (got, expected) in areas.iter().zip([0.0, 0.0, 12.5, 12.5, 25.0, 25.0]) {
        assert!((got - expected).abs() <= 75e-9, "{areas:?}");
    }
    within(volume(&roof), 75.0, 1e-9);
    assert!(roof.mesh.faces.iter().all(|f| (roof.mesh.normal(f).length() - 1.0).abs() < 1e-12));
}

#[test]
fn roof_pyramid_u() {
    let Some(p) = footprint("U_12") else { return };
    let roof = pyramid(&p, Slope::Height(3.0)).unwrap();
    assert_eq!((roof.warnings.as_slice(), plan_areas(&roof).len()), (&[RoofWarning::Overlapping][..], 8));
    within(volume(&roof), 84.0, 1e-9);
    assert!(roof.mesh.positions.iter().all(|p| p.is_finite()));
}

#[test]
fn roof_pyramid_dart() {
    let Some(p) = footprint("dart") else { return };
    let roof = pyramid(&p, Slope::Height(2.0)).unwrap();
    let areas = plan_areas(&roof);
    assert!(areas.len() == 4 && areas.iter().all(|&a| a > 0.0), "{areas:?}");
    within(areas.iter().sum(), 96.0, 1e-9);
    within(volume(&roof), 64.0, 1e-9);
}

#[test]
fn roof_shed() {
    let Some(p) = footprint("rect_20x10") else { return };
    let roof = shed(&p, Slope::Angle(30.0), 0).unwrap();
    within(volume(&roof), 577.35026919, 1e-9);
    assert!(is_closed(&roof.mesh) && non_planar_faces(&roof.mesh, 1e-9).is_empty());
}

#[test]
fn roof_shed_edge_short() {
    let Some(p) = footprint("chamfer_1mm") else { return };
    let edge = (0..p.outer.len()).min_by(|&i, &j| {
        let length = |i: usize| p.outer[i].distance(p.outer[(i + 1) % p.outer.len()]);
        length(i).total_cmp(&length(j))
    });
    let edge = edge.expect("an edge");
    let along = p.outer[(edge + 1) % p.outer.len()] - p.outer[edge];
    assert!(along.length() < 2e-3, "{along}");
    let roof = shed(&p, Slope::Angle(30.0), edge as i64).unwrap();
    let top = roof.parts.iter().position(|p| matches!(p, RoofPart::Top { .. })).expect("a plane");
    let normal = roof.mesh.normal(&roof.mesh.faces[top]);
    let (sin, cos) = libm::sincos(30f64.to_radians());
    let inward = along.normalize().perp();
    assert!(normal.angle_between(DVec3::new(-inward.x * sin, cos, inward.y * sin)) < 1e-6, "{normal}");
    assert!(is_closed(&roof.mesh));
}

/// The overhang is measured down the plane: this much of it is 3.5 m in plan.
#[test]
fn roof_overhang_u() {
    let Some(p) = footprint("U_12") else { return };
    let roof = hip(&p, Slope::Angle(30.0), 3.5 / libm::cos(30f64.to_radians()), false).unwrap();
    let eaves = offset(&p, 3.5).unwrap().inside;
    assert_eq!((eaves.len(), eaves[0].holes.len()), (1, 0));
    let (low, high) = eaves[0].bounds().expect("an outline");
    let (a, b) = roof.mesh.bounds().expect("a roof");
    for (got, expected) in [(a.x, low.x), (b.x, high.x), (-b.z, low.y), (-a.z, high.y)] {
        assert!((got - expected).abs() < 1e-6, "{got} is not {expected}");
    }
    assert!((plan_areas(&roof).iter().sum::<f64>() - eaves[0].area()).abs() < 1e-6 * eaves[0].area());
    assert_eq!(self_intersections(&roof.mesh, 1e-6), []);
}

#[test]
fn roof_overhang_spike() {
    let Some(p) = footprint("sharp_0.1deg") else { return };
    let roof = hip(&p, Slope::Angle(30.0), 1.0, false).unwrap();
    let (low, high) = p.bounds().expect("an outline");
    let grown = (size(&roof).x - (high - low).x).max(size(&roof).z - (high - low).y);
    assert!(grown <= 2.0 * MITRE_LIMIT + 1e-6, "{grown}");
}

#[test]
fn roof_courtyard_closed() {
    let Some(p) = footprint("annulus_square") else { return };
    let mesh = building(&p, &hip(&p, Slope::Angle(45.0), 0.0, false).unwrap());
    assert!(is_closed(&mesh));
    assert_eq!(euler(&mesh), 0);
}

#[test]
fn roof_many_courtyards() {
    let Some(p) = footprint("courtyards_64") else { return };
    assert_eq!(p.holes.len(), 64);
    let mesh = building(&p, &hip(&p, Slope::Angle(45.0), 0.0, false).unwrap());
    assert!(is_closed(&mesh));
    assert_eq!(euler(&mesh), 2 - 2 * 64);
}

#[track_caller]
fn assert_borders(o: &Offset, expected: &[f64]) {
    assert!(o.inside.is_empty(), "{:?}", o.inside);
    let areas: Vec<f64> = o.borders.iter().map(|b| signed_area(&b.ring)).collect();
    assert_eq!(areas.len(), expected.len());
    areas.iter().zip(expected).for_each(|(&a, &e)| within(a, e, 1e-9));
}

#[test]
fn offset_exact_inradius() {
    let Some(p) = footprint("square_10") else { return };
    assert_borders(&offset(&p, -5.0).unwrap(), &[25.0; 4]);
}

#[test]
fn offset_beyond() {
    let Some(p) = footprint("plus_30") else { return };
    let o = offset(&p, -7.0).unwrap();
    assert!(o.inside.is_empty());
    within(o.borders.iter().map(|b| signed_area(&b.ring)).sum(), 500.0, 1e-9);
}

#[test]
fn offset_just_before() {
    let Some(p) = footprint("plus_30") else { return };
    let o = offset(&p, -4.9999999).unwrap();
    assert_eq!((o.inside.len(), o.inside[0].outer.len()), (1, 12));
    assert!((o.inside[0].area() - 8.0e-6).abs() < 1e-6, "{}", o.inside[0].area());
}

/// Plan area of the roof of slope 1 above a height, from its faces.
fn area_above(p: &Polygon, level: f64) -> f64 {
    let s = skeleton(p, None).expect("a skeleton");
    let mut sum = 0.0;
    for face in &s.faces {
        let ring = &face.boundary;
        let mut above = Vec::new();
        for k in 0..ring.len() {
            let (a, b) = (s.nodes[ring[k] as usize], s.nodes[ring[(k + 1) % ring.len()] as usize]);
            if a.time >= level {
                above.push(a.position);
            }
            if (a.time >= level) != (b.time >= level) {
                above.push(a.position.lerp(b.position, (level - a.time) / (b.time - a.time)));
            }
        }
        sum += signed_area(&above);
    }
    sum
}

#[test]
fn offset_split() {
    let Some(p) = footprint("hourglass") else { return };
    let o = offset(&p, -1.9).unwrap();
    assert_eq!(o.inside.len(), 2);
    within(o.inside.iter().map(Polygon::area).sum(), area_above(&p, 1.9), 1e-6);
}

#[test]
fn setback_mixed() {
    let Some(p) = footprint("rect_20x10") else { return };
    let o = setback(&p, &[3.0, 0.0, 1.0, 0.0]).unwrap();
    assert_eq!((o.inside.len(), o.borders.len()), (1, 2));
    within(o.inside[0].area(), 120.0, 1e-9);
    let (low, high) = o.inside[0].bounds().expect("an outline");
    assert!((high - low - DVec2::new(20.0, 6.0)).length() < 1e-8);
    within(signed_area(&o.borders[0].ring), 60.0, 1e-9);
    within(signed_area(&o.borders[1].ring), 20.0, 1e-9);
}

/// The integral of the slope of the profile over the level sets, by Simpson's rule: exact, they are quadratic.
#[test]
fn mansard() {
    let Some(p) = footprint("L_10") else { return };
    let roof = super::mansard(&p, 70.0, 20.0, 1.0).unwrap();
    assert!(is_closed(&roof.mesh));
    let piece = |from: f64, to: f64, degrees: f64| {
        let sum = area_above(&p, from) + 4.0 * area_above(&p, (from + to) / 2.0) + area_above(&p, to);
        libm::tan(degrees.to_radians()) * sum * (to - from) / 6.0
    };
    within(volume(&roof), piece(0.0, 1.0, 70.0) + piece(1.0, 2.5, 20.0), 1e-6);
}

/// Every edge in two faces that run it opposite ways, also in 32 bits; in rings that touch the corners meet in one wall edge.
#[test]
fn watertight() {
    for feature in features().unwrap_or_default() {
        let about = &feature["properties"];
        // The largest take seconds in a debug build; the benches have them.
        if about["expect"] == "rejected" || about["vertices"].as_u64().is_some_and(|n| n > 400) {
            continue;
        }
        let name = &about["name"];
        for p in repair(&rings(&feature), &Options { weld: 0.0, min_area: 0.0 }).polygons {
            let roof = hip(&p, Slope::Angle(45.0), 0.0, false).unwrap();
            let mesh = building(&p, &roof);
            let loose = unpaired(&mesh);
            assert!(loose == 0, "{name}: {loose} edges");
            let (low, high) = p.bounds().expect("an outline");
            let expected = p.area() * 10.0 + volume(&roof);
            let got = mesh_checks::volume(&mesh);
            assert!(
                (got - expected).abs() <= 1e-6 * expected + 1e-8 * (high - low).length_squared(),
                "{name}: {got} {expected}"
            );
            let narrow = |p: &DVec3| (*p - mesh.positions[0]).as_vec3().as_dvec3();
            let narrow = Mesh { positions: mesh.positions.iter().map(narrow).collect(), faces: mesh.faces.clone() };
            let loose = unpaired_triangles(&mesh, &narrow);
            assert!(loose == 0, "{name}: {loose} edges in 32 bits");
        }
    }
}

/// Edges not run as often forth as back.
fn unpaired(mesh: &Mesh) -> usize {
    let edges = mesh.faces.iter().flat_map(|f| f.edges());
    count_unpaired(edges.map(|(a, b)| (u64::from(a), u64::from(b))))
}

/// The same for the triangles of a mesh whose corners were rounded and then made one where they are equal.
fn unpaired_triangles(mesh: &Mesh, rounded: &Mesh) -> usize {
    let welded = rounded.welded();
    let place: Vec<u32> = (0..mesh.faces.len()).flat_map(|f| welded.faces[f].corners().collect::<Vec<_>>()).collect();
    let mut first = 0;
    let mut edges = Vec::new();
    for face in &mesh.faces {
        for t in crate::geometry::triangulate::triangulate_face(mesh, face) {
            let [a, b, c] = t.map(|k| u64::from(place[first + k as usize]));
            edges.extend([(a, b), (b, c), (c, a)].into_iter().filter(|(a, b)| a != b));
        }
        first += face.corners().count();
    }
    count_unpaired(edges.into_iter())
}

fn count_unpaired(edges: impl Iterator<Item = (u64, u64)>) -> usize {
    let mut runs: BTreeMap<(u64, u64), i64> = BTreeMap::new();
    for (a, b) in edges {
        *runs.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
    }
    runs.values().filter(|&&n| n != 0).count()
}
