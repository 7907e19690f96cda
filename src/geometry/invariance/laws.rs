//! What must hold for any footprint (`../shared/numerics.md` section 11; `docs/numerics.md` lists which test holds what): faces
//! partition it, bodies close, volumes have their closed forms, and any rings at all get an answer. In: random
//! polygons. Out: what is broken.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::geometry::boolean::{intersection, union};
use crate::geometry::largest_rectangle::largest_upright;
use crate::geometry::mesh_checks::volume;
use crate::geometry::offset::{offset, setback};
use crate::geometry::polygon::signed_area;
use crate::geometry::roof::{self, Facing, Roof, RoofPart, RoofShape, Slope};
use crate::geometry::skeleton::skeleton;
use crate::geometry::triangulate::{triangles, triangulate_polygon};

fn girth(p: &Polygon) -> f64 {
    p.rings().flat_map(|r| (0..r.len()).map(move |i| r[i].distance(r[(i + 1) % r.len()]))).sum()
}

/// The hip roof on walls of 5 m, as loose faces.
fn building(p: &Polygon, roof: &Roof) -> Mesh {
    let mut mesh = Mesh::default();
    let mut add = |corners: Vec<Vec<DVec3>>| {
        let mut loops = corners.iter().map(|ring| {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(ring);
            (first..mesh.positions.len() as u32).collect::<Vec<u32>>()
        });
        let outer = loops.next().expect("an outline");
        let face = Face::with_holes(outer, loops.collect::<Vec<_>>());
        mesh.faces.push(face);
    };
    for (a, b) in p.rings().flat_map(|r| (0..r.len()).map(move |i| (r[i], r[(i + 1) % r.len()]))) {
        let at = |p: DVec2, y: f64| DVec3::new(p.x, y, -p.y);
        add(vec![vec![at(a, 0.0), at(b, 0.0), at(b, 5.0), at(a, 5.0)]]);
    }
    for (face, part) in roof.mesh.faces.iter().zip(&roof.parts) {
        let lift = DVec3::Y * if *part == RoofPart::Bottom { 0.0 } else { 5.0 };
        let ring = |ring: &[u32]| ring.iter().map(|&v| roof.mesh.positions[v as usize] + lift).collect();
        add(face.loops().map(ring).collect());
    }
    mesh
}

type Key = [u64; 3];

/// Vertices, edges with (forth - back), and the number of triangles; corners in 32 bits where that is asked for.
fn counts(mesh: &Mesh, is_narrow: bool) -> (usize, BTreeMap<(Key, Key), i64>, usize) {
    let origin = mesh.positions[0];
    let key = |p: DVec3| -> Key {
        let p = if is_narrow { (p - origin).as_vec3().as_dvec3() } else { p };
        (p + DVec3::ZERO).to_array().map(f64::to_bits)
    };
    let (mut vertices, mut edges, mut count) = (BTreeMap::new(), BTreeMap::new(), 0);
    for (_, corners) in triangles(mesh) {
        let [a, b, c] = corners.map(key);
        count += 1;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            vertices.insert(from, ());
            if from != to {
                *edges.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
    }
    (vertices.len(), edges, count)
}

/// A polygon with an inscribed circle of this radius, by the directions of its normals.
fn tangential(radius: f64, turns: &[f64]) -> Option<Polygon> {
    let mut angles: Vec<f64> = turns.iter().map(|t| t * TAU).collect();
    angles.sort_by(f64::total_cmp);
    let n = angles.len();
    let gap = |i: usize| (angles[(i + 1) % n] - angles[i]).rem_euclid(TAU);
    if (0..n).any(|i| !(0.1..2.6).contains(&gap(i))) {
        return None;
    }
    let corner = |i: usize| DVec2::from_angle(angles[i] + gap(i) / 2.0) * (radius / libm::cos(gap(i) / 2.0));
    Some(Polygon { outer: (0..n).map(corner).collect(), holes: Vec::new() })
}

fn hip(p: &Polygon) -> Roof {
    roof::hip(p, Slope::Angle(45.0), 0.0, false).expect("a roof")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Signed areas prove nothing: the faces united have the area of the footprint, and so have they one by one.
    #[test]
    fn faces_cover_the_footprint_once(p in footprints()) {
        let s = skeleton(&p, None).expect("a skeleton");
        let ring = |ring: &Vec<u32>| ring.iter().map(|&n| s.nodes[n as usize].position).collect::<Ring>();
        let faces: Vec<Polygon> = s.faces.iter()
            .map(|f| Polygon { outer: ring(&f.boundary), holes: f.holes.iter().map(ring).collect() })
            .collect();
        let tolerance = 1e-8 * girth(&p) * extent(&p);
        prop_assert!(faces.iter().all(|f| signed_area(&f.outer) > -tolerance));
        let covered: f64 = union(&faces, &[]).expect("sound").iter().map(Polygon::area).sum();
        let each: f64 = faces.iter().map(Polygon::area).sum();
        prop_assert!((covered - p.area()).abs() < tolerance, "{covered} of {}", p.area());
        prop_assert!((each - covered).abs() < tolerance, "{each} in faces, {covered} covered");
    }

    /// Time only goes forward: what is left inside lies in what was left before, and is less.
    #[test]
    fn levels_lie_within_each_other(p in footprints(), shares in prop::array::uniform2(0.0..1.0f64)) {
        let top = skeleton(&p, None).expect("a skeleton").nodes.iter().fold(0.0, |m, n| f64::max(m, n.time));
        let (near, far) = (shares[0].min(shares[1]) * top, shares[0].max(shares[1]) * top);
        let [outer, inner] = [near, far].map(|d| offset(&p, -d).expect("an offset").inside);
        let area = |set: &[Polygon]| set.iter().map(Polygon::area).sum::<f64>();
        let tolerance = 1e-8 * girth(&p) * extent(&p);
        let common = area(&intersection(&outer, &inner).expect("sound"));
        prop_assert!((common - area(&inner)).abs() < tolerance, "{common} of {}", area(&inner));
        prop_assert!(area(&inner) <= area(&outer) + tolerance && area(&outer) <= p.area() + tolerance);
    }

    /// Every edge as often forth as back, V - E + F = 2 - 2 h, volume = area x height + roof; closed in 32 bits too.
    #[test]
    fn buildings_are_closed_and_have_their_volume(p in separate()) {
        let roof = hip(&p);
        let mesh = building(&p, &roof);
        let (v, edges, f) = counts(&mesh, false);
        prop_assert!(edges.values().all(|&n| n == 0));
        prop_assert_eq!(v as i64 - edges.len() as i64 + f as i64, 2 - 2 * p.holes.len() as i64);
        let expected = p.area() * 5.0 + volume(&roof.mesh);
        prop_assert!((volume(&mesh) - expected).abs() <= 1e-8 * girth(&p) * extent(&p));
        prop_assert!(counts(&mesh, true).1.values().all(|&n| n == 0), "open in 32 bits");
    }

    #[test]
    fn volumes_have_their_closed_forms(
        sides in prop::array::uniform2(1.0..60.0f64), n in 3usize..40, radius in 1.0..30.0f64,
        turns in prop::collection::vec(0.0..1.0f64, 3..12), motion in any_motion(),
    ) {
        let (long, wide) = (sides[0].max(sides[1]), sides[0].min(sides[1]));
        let corners = [(0.0, 0.0), (long, 0.0), (long, wide), (0.0, wide)].map(DVec2::from).to_vec();
        let rectangle = Polygon { outer: corners, holes: Vec::new() };
        let regular: Vec<f64> = (0..n).map(|k| k as f64 / n as f64).collect();
        let mut cases = vec![(rectangle, wide * wide * (3.0 * long - wide) / 12.0, wide / 2.0)];
        for p in [tangential(radius, &regular), tangential(radius, &turns)].into_iter().flatten() {
            let expected = p.area() * radius / 3.0;
            cases.push((p, expected, radius));
        }
        for (p, expected, height) in cases {
            let moved = motion.polygon(&p);
            let got = hip(&moved).mesh;
            let scale = motion.scale.powi(3);
            let tolerance = allowed(1e-7, extent(&p), &motion);
            prop_assert!((volume(&got) - expected * scale).abs() <= tolerance * extent(&moved).powi(2), "{} {expected}", volume(&got));
            let top = got.positions.iter().fold(0.0, |m, p| f64::max(m, p.y));
            prop_assert!((top - height * motion.scale).abs() <= 1e3 * tolerance, "{top} {height}");
        }
    }

    /// Rings that passed no door: not finite, huge, doubled, crossing. An answer or a typed error, never a panic or NaN.
    #[test]
    fn any_rings_are_answered(
        rings in prop::collection::vec(prop::collection::vec((any_coordinate(), any_coordinate()), 0..12), 1..4),
        distance in any_coordinate(), angle in any_coordinate(), shape in 0..RoofShape::ALL.len(),
    ) {
        let mut rings: Vec<Ring> = rings.into_iter().map(|r| r.into_iter().map(DVec2::from).collect()).collect();
        let outer = rings.remove(0);
        let (low, high) = outer.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &q| (l.min(q), h.max(q)));
        // The grid lies over the outline.
        rings.retain(|r| r.iter().all(|q| q.cmpge(low).all() && q.cmple(high).all()));
        let p = Polygon { outer, holes: rings };
        let plain = |p: &Polygon| p.rings().flatten().all(|q| q.is_finite());
        if let Ok(s) = skeleton(&p, None) {
            prop_assert!(s.nodes.iter().all(|n| n.position.is_finite() && n.time.is_finite()));
        }
        for result in [offset(&p, distance), setback(&p, &[distance])].into_iter().flatten() {
            prop_assert!(result.inside.iter().all(plain));
        }
        for slope in [Slope::Angle(angle), Slope::Height(distance)] {
            if let Ok(Some(made)) = RoofShape::ALL[shape].build(&p, slope, Facing::Natural) {
                prop_assert!(!plain(&p) || made.mesh.positions.iter().all(|q| q.is_finite()), "{made:?}");
            }
        }
        triangulate_polygon(&p);
        if plain(&p) {
            largest_upright(&p, DVec2::ZERO);
        }
        for result in [union(std::slice::from_ref(&p), &[]), intersection(std::slice::from_ref(&p), std::slice::from_ref(&p))].into_iter().flatten() {
            prop_assert!(result.iter().all(plain));
        }
    }
}

fn any_coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => (-8i32..8).prop_map(f64::from),
        4 => -10.0..10.0f64,
        1 => prop::sample::select(vec![f64::NAN, f64::INFINITY, 1e300, -1e12, 1e-300, 1e8, 5e-8, -90.0, 89.999]),
    ]
}
