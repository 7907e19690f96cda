//! Invariants of `../shared/numerics.md` §11: the faces partition the polygon, lie in their planes, close up, and follow
//! rigid motions; the named hard footprints against their exact references.

use std::collections::BTreeMap;

use glam::DVec2;
use proptest::prelude::*;
use serde_json::Value;

use super::{Node, Skeleton, SkeletonError, skeleton, wavefront};
use crate::geometry::hard_cases;
use crate::geometry::polygon::{Polygon, signed_area};
use crate::geometry::repair::{Options, repair};

fn points(s: &Skeleton, ring: &[u32], origin: DVec2) -> Vec<DVec2> {
    ring.iter().map(|&n| s.nodes[n as usize].position - origin).collect()
}

fn edges(p: &Polygon) -> Vec<(DVec2, DVec2)> {
    p.rings().flat_map(|r| (0..r.len()).map(|i| (r[i], r[(i + 1) % r.len()])).collect::<Vec<_>>()).collect()
}

fn extent(p: &Polygon) -> f64 {
    p.bounds().map_or(0.0, |(low, high)| (high - low).max_element())
}

/// What is wrong with a skeleton, if anything.
fn complaint(p: &Polygon, s: &Skeleton, weights: Option<&[f64]>) -> Option<String> {
    let (size, edges, origin) = (extent(p), edges(p), p.outer[0]);
    let perimeter: f64 = edges.iter().map(|(a, b)| a.distance(*b)).sum();
    let mut area = 0.0;
    let mut runs: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for face in &s.faces {
        let (start, end) = edges[face.edge];
        let own = signed_area(&points(s, &face.boundary, origin));
        if own < -1e-9 * size * size {
            return Some(format!("face {} is clockwise: {own}", face.edge));
        }
        area += own + face.holes.iter().map(|h| signed_area(&points(s, h, origin))).sum::<f64>();
        if points(s, &face.boundary[..2], DVec2::ZERO) != [start, end] {
            return Some(format!("face {} does not start with its edge", face.edge));
        }
        let normal = (end - start).normalize().perp();
        let weight = weights.map_or(1.0, |w| w[face.edge]);
        for &n in &face.boundary {
            let Node { position, time } = s.nodes[n as usize];
            if (normal.dot(position - start) - weight * time).abs() > 2e-7 * size {
                return Some(format!("node {n} is not in the plane of face {}", face.edge));
            }
        }
        let ring = &face.boundary;
        (0..ring.len()).for_each(|k| *runs.entry((ring[k], ring[(k + 1) % ring.len()])).or_default() += 1);
    }
    area += s.tops.iter().map(|t| signed_area(&points(s, t, origin))).sum::<f64>();
    if (area - p.area()).abs() > 1e-8 * perimeter * size {
        return Some(format!("faces cover {area} of {}", p.area()));
    }
    let on_eaves = |n: u32| s.nodes[n as usize].time == 0.0;
    let open = |&(&(a, b), &count): &(&(u32, u32), &usize)| {
        count != 1 || !(runs.contains_key(&(b, a)) || on_eaves(a) && on_eaves(b))
    };
    if weights.is_none() && runs.iter().any(|run| open(&run)) {
        return Some("faces do not close up".into());
    }
    None
}

/// Volume under the roof of slope 1, and area of the outline at a distance: by fans, as the skeleton's faces are flat.
fn volume(s: &Skeleton) -> f64 {
    let fan = |ring: &[u32]| {
        let o = s.nodes[ring[0] as usize];
        let corner = |k: usize| s.nodes[ring[k] as usize];
        let piece = |k: usize| {
            let (p, q) = (corner(k), corner(k + 1));
            let area = (p.position - o.position).perp_dot(q.position - o.position) / 2.0;
            area * (o.time + p.time + q.time) / 3.0
        };
        (1..ring.len() - 1).map(piece).sum::<f64>()
    };
    s.faces.iter().map(|f| fan(&f.boundary)).sum()
}

fn height(s: &Skeleton) -> f64 {
    s.nodes.iter().fold(0.0, |m, n| f64::max(m, n.time))
}

fn area_at(p: &Polygon, distance: f64) -> f64 {
    let s = wavefront(p, None, distance).expect("a wavefront");
    s.tops.iter().map(|t| signed_area(&points(&s, t, p.outer[0]))).sum()
}

/// Differences from the exact reference of a case, if it has one.
fn differences(p: &Value, polygons: &[Polygon], skeletons: &[Skeleton]) -> Vec<String> {
    let mut found = Vec::new();
    let mut compare = |what: &str, got: f64, want: f64, tolerance: f64| {
        if (got - want).abs() > tolerance {
            found.push(format!("{what} {got}, reference {want} +- {tolerance}"));
        }
    };
    let number = |v: &Value| v.as_f64().expect("a number");
    let top = skeletons.iter().map(height).fold(0.0, f64::max);
    let Some(r) = p.get("ref") else { return found };
    compare("height", top, number(&r["hip_height"]), number(&r["tol_height"]));
    compare("volume", skeletons.iter().map(volume).sum(), number(&r["hip_volume"]), number(&r["tol_volume"]));
    for (share, want) in r["offset_area"].as_object().into_iter().flatten() {
        let distance = share.parse::<f64>().expect("a share") * number(&r["hip_height"]);
        let got = polygons.iter().map(|p| area_at(p, distance)).sum();
        compare(&format!("offset {share}"), got, number(want), number(&r["tol_offset_area"]));
    }
    found
}

#[test]
fn hard_footprints() {
    let Some(features) = hard_cases::features() else { return };
    let mut wrong = Vec::new();
    for feature in &features {
        let p = &feature["properties"];
        let name = p["name"].as_str().expect("a name");
        // The largest take seconds in a debug build; the slow suite has them.
        if p["expect"] == "rejected" || p["vertices"].as_u64().is_some_and(|n| n > 1000) {
            continue;
        }
        let polygons = repair(&hard_cases::rings(feature), &Options { weld: 0.0, min_area: 0.0 }).polygons;
        let skeletons: Vec<Skeleton> = match polygons.iter().map(|p| skeleton(p, None)).collect() {
            Ok(skeletons) => skeletons,
            Err(error) => {
                wrong.push(format!("{name}: {error}"));
                continue;
            }
        };
        let bad = polygons.iter().zip(&skeletons).filter_map(|(p, s)| complaint(p, s, None));
        wrong.extend(bad.chain(differences(p, &polygons, &skeletons)).map(|c| format!("{name}: {c}")));
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

/// Enough vertices for slabs of time, in every class that differs there: spikes crowded about a middle, teeth on a bar,
/// stairs, a ring that ends in one point, and a courtyard.
fn large_outlines() -> Vec<Polygon> {
    let polar = |turn: f64, radius: f64| DVec2::from(libm::sincos(turn * std::f64::consts::TAU)).perp() * -radius;
    let noise = |k: usize| (k * k * 7919 % 1009) as f64 / 1009.0;
    let star = |n: usize, r: f64| -> Vec<DVec2> {
        (0..n).map(|k| polar((k as f64 + noise(k)) / n as f64, r * (0.3 + 0.7 * noise(k + 5)))).collect()
    };
    let mut comb = vec![DVec2::ZERO, DVec2::new(201.0, 0.0)];
    for tooth in (0..101).rev() {
        let (x, top) = (2.0 * f64::from(tooth), 9.0 + 3.0 * noise(tooth as usize));
        comb.extend([DVec2::new(x + 1.0, top), DVec2::new(x, top)]);
        if tooth > 0 {
            comb.extend([DVec2::new(x, 1.0), DVec2::new(x - 1.0, 1.0)]);
        }
    }
    let mut stairs = vec![DVec2::ZERO, DVec2::new(150.0, -60.0)];
    for step in (0..150).rev() {
        let height = 3.0 + (noise(step) * 40.0).round() / 2.0;
        stairs.extend([DVec2::new(step as f64 + 1.0, height), DVec2::new(step as f64, height)]);
    }
    let ring = (0..300).map(|k| polar(f64::from(k) / 300.0, 50.0)).collect();
    let hole = star(240, 20.0).into_iter().rev().collect();
    let alone = |outer| Polygon { outer, holes: vec![] };
    vec![
        alone(star(500, 80.0)),
        alone(comb),
        alone(stairs),
        alone(ring),
        Polygon { outer: star(9, 200.0), holes: vec![hole] },
    ]
}

#[test]
fn large_outlines_are_partitioned() {
    for (k, raw) in large_outlines().into_iter().enumerate() {
        let rings: Vec<_> = raw.rings().cloned().collect();
        for p in repair(&rings, &Options { weld: 0.0, min_area: 0.0 }).polygons {
            let s = skeleton(&p, None).unwrap_or_else(|e| panic!("{k}: {e}"));
            assert_eq!(complaint(&p, &s, None), None, "{k}");
            let count: usize = p.rings().map(Vec::len).sum();
            let weights: Vec<f64> = (0..count).map(|e| [1.0, 0.6, 0.3][e % 3]).collect();
            let weighted = skeleton(&p, Some(&weights)).unwrap_or_else(|e| panic!("{k}, weighted: {e}"));
            assert_eq!(complaint(&p, &weighted, Some(&weights)), None, "{k}, weighted");
            // What is left at a distance is the same whether the run stops there or not.
            let time = 0.1 * height(&s);
            let left = area_at(&p, time);
            assert!((left - area_above(&s, time)).abs() < 1e-6 * p.area(), "{k}, stopped: {left}");
        }
    }
}

/// Area of the parts of the faces that are swept after a time.
fn area_above(s: &Skeleton, time: f64) -> f64 {
    let above = |face: &super::SkeletonFace| {
        let corners: Vec<Node> = face.boundary.iter().map(|&n| s.nodes[n as usize]).collect();
        let mut ring = Vec::new();
        for (k, p) in corners.iter().enumerate() {
            let q = corners[(k + 1) % corners.len()];
            if p.time >= time {
                ring.push(p.position);
            }
            if (p.time >= time) != (q.time >= time) {
                ring.push(p.position.lerp(q.position, (time - p.time) / (q.time - p.time)));
            }
        }
        signed_area(&ring)
    };
    s.faces.iter().map(above).sum()
}

#[test]
fn one_face_per_edge_around_collinear_courtyards() {
    let Some(p) = hard_cases::footprint("courtyards_9") else { return };
    let faces: Vec<usize> = skeleton(&p, None).expect("a skeleton").faces.iter().map(|f| f.edge).collect();
    assert_eq!(faces, (0..40).collect::<Vec<_>>());
}

#[test]
fn typed_errors() {
    let ring = |r: &[(f64, f64)]| Polygon { outer: r.iter().map(|&p| p.into()).collect(), holes: vec![] };
    let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let bad = |p: &Polygon, w: Option<&[f64]>| skeleton(p, w).expect_err("an error");
    assert_eq!(bad(&ring(&[(0.0, 0.0), (1.0, 0.0)]), None), SkeletonError::TooFewPoints);
    assert_eq!(bad(&ring(&[(0.0, 0.0), (1.0, 0.0), (f64::NAN, 1.0)]), None), SkeletonError::NotFinite);
    assert_eq!(bad(&ring(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)]), None), SkeletonError::NotSimple);
    assert_eq!(bad(&square, Some(&[1.0; 3])), SkeletonError::WeightCount { given: 3, edges: 4 });
    assert_eq!(bad(&square, Some(&[1.0, -1.0, 1.0, 1.0])), SkeletonError::Weight { edge: 1, weight: -1.0 });
    assert_eq!(wavefront(&square, None, -1.0), Err(SkeletonError::Distance(-1.0)));
}

/// Outlines around the origin: random distances at random angles, rounded to a grid of few steps to make ties.
fn outline() -> impl Strategy<Value = Polygon> {
    let corners = prop::collection::vec((0.0..1.0f64, 0.2..1.0f64), 3..24);
    (corners, prop::sample::select(vec![4, 7, 10, 14, 40])).prop_filter_map("no polygon", |(mut corners, bits)| {
        corners.sort_by(|p, q| p.0.total_cmp(&q.0));
        let unit = libm::ldexp(100.0, -bits);
        let corner = |(turn, r): (f64, f64)| {
            let (sin, cos) = libm::sincos(turn * std::f64::consts::TAU);
            (DVec2::new(cos, sin) * r * 50.0 / unit).round() * unit
        };
        let ring = corners.into_iter().map(corner).collect();
        repair(&[ring], &Options { weld: 0.0, min_area: 1.0 }).polygons.into_iter().next()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn faces_partition_the_polygon(p in outline()) {
        let s = skeleton(&p, None).expect("a skeleton");
        prop_assert_eq!(complaint(&p, &s, None), None);
    }

    #[test]
    fn weighted_faces_partition_the_polygon(p in outline(), seed in prop::collection::vec(0.0..1.2f64, 24)) {
        let weight = |k: usize| if seed[k % 24] < 0.2 { 0.0 } else { seed[k % 24] };
        let weights: Vec<f64> = (0..p.outer.len()).map(weight).collect();
        let s = skeleton(&p, Some(&weights)).expect("a skeleton");
        prop_assert_eq!(complaint(&p, &s, Some(&weights)), None);
    }

    #[test]
    fn stopping_keeps_the_partition(p in outline(), share in 0.0..1.0f64) {
        let full = skeleton(&p, None).expect("a skeleton");
        let s = wavefront(&p, None, share * height(&full)).expect("a wavefront");
        prop_assert_eq!(complaint(&p, &s, None).filter(|c| !c.contains("close up")), None);
    }

    #[test]
    fn scale_by_a_power_of_two_changes_no_topology(p in outline(), k in -20i32..20) {
        let factor = libm::ldexp(1.0, k);
        let scaled = Polygon { outer: p.outer.iter().map(|&q| q * factor).collect(), holes: vec![] };
        let (s, t) = (skeleton(&p, None).expect("one"), skeleton(&scaled, None).expect("two"));
        prop_assert_eq!(&s.faces, &t.faces);
        for (a, b) in s.nodes.iter().zip(&t.nodes) {
            prop_assert_eq!((a.position * factor, a.time * factor), (b.position, b.time));
        }
    }

    #[test]
    fn motions_keep_the_volume(p in outline(), start in 0usize..24, far in -1e6..1e6f64) {
        let want = volume(&skeleton(&p, None).expect("a skeleton"));
        let tolerance = 1e-6 * want + 1e-5;
        let mut shifted = p.clone();
        shifted.outer.rotate_left(start % p.outer.len());
        prop_assert!((volume(&skeleton(&shifted, None).expect("shifted")) - want).abs() < tolerance);
        let mirrored = Polygon { outer: p.outer.iter().rev().map(|q| DVec2::new(-q.x, q.y)).collect(), holes: vec![] };
        prop_assert!((volume(&skeleton(&mirrored, None).expect("mirrored")) - want).abs() < tolerance);
        // By whole metres, and only where that rounds no corner: needles magnify rounding without bound.
        let moved = DVec2::new(far.round(), -far.round());
        let translated = Polygon { outer: p.outer.iter().map(|&q| q + moved).collect(), holes: vec![] };
        prop_assume!(translated.outer.iter().zip(&p.outer).all(|(t, &q)| *t - moved == q));
        prop_assert!((volume(&skeleton(&translated, None).expect("translated")) - want).abs() < tolerance);
    }
}
