//! The ground as a whole: a partition of the area, watertight, every layer with its visible area, within tolerance.

mod stages;

use std::collections::BTreeMap;
use std::sync::OnceLock;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use proptest::prelude::*;

use super::*;
use crate::geodata::elevation::{self, Raster};
use crate::geodata::projection::LocalFrame;
use crate::geodata::terrain::Voids;

/// Hills of 3" posts with a cliff and a pit, about 42.5 N, 1.5 E.
fn hills() -> &'static Terrain {
    static TERRAIN: OnceLock<Terrain> = OnceLock::new();
    TERRAIN.get_or_init(|| {
        let mut bytes = Vec::with_capacity(2 * 1201 * 1201);
        for row in 0..1201_i32 {
            for column in 0..1201_i32 {
                let wave = 40.0 * libm::sin(f64::from(column) / 3.0) * libm::cos(f64::from(row) / 4.0);
                let cliff = if (column + row) % 90 < 30 { 60.0 } else { 0.0 };
                bytes.extend(((200.0 + wave + cliff) as i16).to_be_bytes());
            }
        }
        let frame = LocalFrame::new(1.5, 42.5).unwrap();
        let half = DVec2::splat(1500.0);
        let area = Terrain::area(&frame, -half, half);
        let raster: Raster = elevation::read("N42E001.hgt", &bytes, Some(area), None).unwrap();
        Terrain::from_rasters(frame, -half, half, vec![raster], Voids::Fill).unwrap()
    })
}

fn square(centre: DVec2, half: f64) -> Polygon {
    let d = |x: f64, y: f64| centre + DVec2::new(x, y) * half;
    Polygon { outer: vec![d(-1.0, -1.0), d(1.0, -1.0), d(1.0, 1.0), d(-1.0, 1.0)], holes: Vec::new() }
}

fn layer(polygons: Vec<Polygon>, priority: i32) -> GroundLayer {
    GroundLayer { polygons, priority, payload: priority as u32 * 10, surface: Surface::Drape }
}

fn plan(p: DVec3) -> DVec2 {
    DVec2::new(p.x, -p.z)
}

/// Plan area of the triangles of each payload.
fn areas(mesh: &GroundMesh) -> BTreeMap<Option<u32>, f64> {
    let mut areas = BTreeMap::new();
    for (t, payload) in &mesh.triangles {
        let [a, b, c] = t.map(|i| plan(mesh.positions[i as usize]));
        let area = (b - a).perp_dot(c - a) / 2.0;
        assert!(area > 0.0, "a triangle of area {area} is turned over");
        *areas.entry(*payload).or_insert(0.0) += area;
    }
    areas
}

/// Every edge is used once in each direction, or once in all on the area's border.
fn assert_watertight(mesh: &GroundMesh, area: &Polygon) {
    let mut edges = BTreeMap::new();
    for (t, _) in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            assert_eq!(edges.insert((a, b), ()), None, "edge {a} {b} twice");
        }
    }
    let (lo, hi) = area.bounds().unwrap();
    for &(a, b) in edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))) {
        let (p, q) = (plan(mesh.positions[a as usize]), plan(mesh.positions[b as usize]));
        let on_side = |lo: f64, hi: f64, p: f64, q: f64| p == q && (p - lo).abs().min((p - hi).abs()) < 1e-3;
        assert!(on_side(lo.x, hi.x, p.x, q.x) || on_side(lo.y, hi.y, p.y, q.y), "open edge {p} {q}");
    }
    let mut plans: Vec<_> = mesh.positions.iter().map(|p| (p.x.to_bits(), p.z.to_bits())).collect();
    plans.sort_unstable();
    plans.dedup();
    assert_eq!(plans.len(), mesh.positions.len(), "two vertices at one place");
}

type Shapes = Vec<Vec<Vec<[f64; 2]>>>;

fn shapes(polygons: &[Polygon]) -> Shapes {
    polygons.iter().map(|p| p.rings().map(|r| r.iter().map(|v| v.to_array()).collect()).collect()).collect()
}

fn shapes_area(shapes: &Shapes) -> f64 {
    let ring = |r: &Vec<[f64; 2]>| {
        crate::geometry::polygon::signed_area(&r.iter().map(|&v| DVec2::from(v)).collect::<Vec<_>>())
    };
    shapes.iter().flatten().map(ring).sum::<f64>().abs()
}

/// The area of the polygons' union inside the area, by another library.
fn covered(area: &Polygon, polygons: &[Polygon]) -> f64 {
    let union = shapes(polygons).overlay(&Shapes::new(), OverlayRule::Subject, FillRule::NonZero);
    shapes_area(&union.overlay(&shapes(std::slice::from_ref(area)), OverlayRule::Intersect, FillRule::NonZero))
}

/// A star-shaped polygon, which is always simple.
fn star(centre: DVec2, radii: &[f64]) -> Polygon {
    let n = radii.len() as f64;
    let at = |(i, r): (usize, &f64)| {
        let angle = std::f64::consts::TAU * i as f64 / n;
        centre + DVec2::new(libm::cos(angle), libm::sin(angle)) * *r
    };
    Polygon { outer: radii.iter().enumerate().map(at).collect(), holes: Vec::new() }
}

prop_compose! {
    fn stars()(parts in prop::collection::vec(
        (-350.0..350.0_f64, -350.0..350.0_f64, prop::collection::vec(2.0..120.0_f64, 3..9)), 0..6
    )) -> Vec<Polygon> {
        parts.into_iter().map(|(x, y, radii)| star(DVec2::new(x, y), &radii)).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_layer_keeps_its_visible_area(low in stars(), middle in stars(), high in stars()) {
        let area = square(DVec2::ZERO, 300.0);
        let layers = [layer(low, 1), layer(high, 3), layer(middle, 2)];
        let mesh = build_ground(&area, hills(), 2.0, &layers).unwrap();
        assert_watertight(&mesh, &area);
        let got = areas(&mesh);
        prop_assert!((got.values().sum::<f64>() - area.area()).abs() < 1e-3);
        let stacked = |from: i32| -> Vec<Polygon> {
            layers.iter().filter(|l| l.priority >= from).flat_map(|l| l.polygons.clone()).collect()
        };
        for priority in 1..=3 {
            let visible = covered(&area, &stacked(priority)) - covered(&area, &stacked(priority + 1));
            let seen = got.get(&Some(priority as u32 * 10)).copied().unwrap_or(0.0);
            // A millimetre along all borders.
            prop_assert!((seen - visible).abs() < 3.0, "priority {priority}: {seen} m2, not {visible} m2");
        }
    }
}

#[test]
fn bare_flat_ground_is_two_triangles() {
    let mesh = build_ground(&square(DVec2::ZERO, 500.0), &Terrain::flat(), 0.5, &[]).unwrap();
    assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.worst_error_m), (4, 2, 0.0));
    assert!(mesh.normals().iter().all(|n| *n == Vec3::Y));
}

#[test]
fn the_error_is_measured_at_every_post_and_met() {
    let area = square(DVec2::ZERO, 700.0);
    let layers = [layer(vec![square(DVec2::new(100.0, 50.0), 300.0)], 1)];
    let mut sizes = Vec::new();
    for tolerance in [20.0, 5.0, 0.5] {
        let mesh = build_ground(&area, hills(), tolerance, &layers).unwrap();
        assert!(mesh.worst_error_m <= tolerance, "{} at {tolerance}", mesh.worst_error_m);
        let mut worst = 0.0_f64;
        for post in hills().posts(DVec2::splat(-699.0), DVec2::splat(699.0)) {
            let height = height_on(&mesh, post);
            worst = worst.max((height - hills().height(post).unwrap()).abs());
        }
        // Posts lie up to half a millimetre beside the lattice, on slopes up to 1.
        assert!((worst - mesh.worst_error_m) < 2e-3, "{worst} at a post, {} reported", mesh.worst_error_m);
        sizes.push(mesh.triangles.len());
    }
    assert!(sizes[0] < sizes[1] && sizes[1] < sizes[2], "{sizes:?}");
}

/// Height of the mesh at a place, by looking at all triangles.
fn height_on(mesh: &GroundMesh, p: DVec2) -> f64 {
    let at = mesh.triangles.iter().find_map(|(t, _)| {
        let corners = t.map(|i| mesh.positions[i as usize]);
        let [a, b, c] = corners.map(plan);
        let area = (b - a).perp_dot(c - a);
        let weights = [(b - p).perp_dot(c - p) / area, (c - p).perp_dot(a - p) / area, (a - p).perp_dot(b - p) / area];
        let inside = weights.iter().all(|&w| w >= -1e-9);
        inside.then(|| weights.iter().zip(corners).map(|(w, c)| w * c.y).sum::<f64>())
    });
    at.expect("the mesh covers the area")
}

#[test]
fn long_borders_bend_with_the_ground() {
    let road = Polygon {
        outer: vec![DVec2::new(-690.0, -3.0), DVec2::new(690.0, -3.0), DVec2::new(690.0, 3.0), DVec2::new(-690.0, 3.0)],
        holes: Vec::new(),
    };
    let mesh = build_ground(&square(DVec2::ZERO, 700.0), hills(), 1.0, &[layer(vec![road], 1)]).unwrap();
    for i in 0..1380 {
        let p = DVec2::new(f64::from(i) - 690.0, if i % 2 == 0 { 3.0 } else { -3.0 });
        let off = (height_on(&mesh, p) - hills().height(p).unwrap()).abs();
        assert!(off < 1.1, "{off} at {p}");
    }
}

#[test]
fn lakes_are_level_and_roads_over_them_win() {
    let area = square(DVec2::ZERO, 400.0);
    let lake = GroundLayer { surface: Surface::Level, ..layer(vec![square(DVec2::new(30.0, 20.0), 150.0)], 1) };
    let mesh =
        build_ground(&area, hills(), 0.5, &[lake, layer(vec![square(DVec2::new(30.0, 20.0), 20.0)], 2)]).unwrap();
    assert_watertight(&mesh, &area);
    let mut heights: Vec<f64> = Vec::new();
    for (t, _) in mesh.triangles.iter().filter(|(_, payload)| *payload == Some(10)) {
        heights.extend(t.map(|i| mesh.positions[i as usize].y));
    }
    assert!(!heights.is_empty() && heights.iter().all(|h| *h == heights[0]));
    let got = areas(&mesh);
    assert!((got[&Some(10)] - (90_000.0 - 1600.0)).abs() < 1.0 && (got[&Some(20)] - 1600.0).abs() < 0.2, "{got:?}");
}

#[test]
fn the_same_input_gives_the_same_bits_and_ring_starts_do_not_matter() {
    let area = square(DVec2::ZERO, 300.0);
    let polygons: Vec<Polygon> = (0..20)
        .map(|i| {
            star(DVec2::new(f64::from(i) * 20.0 - 200.0, f64::from(i * 37 % 300) - 150.0), &[30.0, 50.0, 41.0, 18.0])
        })
        .collect();
    let turned: Vec<Polygon> = polygons
        .iter()
        .map(|p| {
            let mut p = p.clone();
            p.outer.rotate_left(2);
            p
        })
        .collect();
    let build = |p: &[Polygon]| build_ground(&area, hills(), 0.5, &[layer(p.to_vec(), 1)]).unwrap();
    assert_eq!(build(&polygons), build(&polygons));
    assert_eq!(build(&polygons), build(&turned));
}

#[test]
fn nasty_input_is_survived_or_refused() {
    let area = square(DVec2::ZERO, 100.0);
    let build = |p: Polygon| build_ground(&area, hills(), 0.5, &[layer(vec![p], 1)]);
    let line = |points: &[[f64; 2]]| Polygon { outer: points.iter().map(|&p| p.into()).collect(), holes: Vec::new() };
    for polygon in [
        line(&[]),
        line(&[[1.0, 1.0]]),
        line(&[[1.0, 1.0], [50.0, 1.0]]),
        line(&[[0.0, 0.0], [50.0, 50.0], [50.0, 0.0], [0.0, 50.0]]),
        line(&[[-900_000.0, 0.0], [900_000.0, 0.001], [900_000.0, 0.002]]),
        line(&[[0.0, 0.0], [1e-9, 0.0], [0.0, 1e-9]]),
        square(DVec2::ZERO, 100.0),
        square(DVec2::new(100.0, 100.0), 100.0),
        square(DVec2::new(5000.0, 0.0), 10.0),
    ] {
        let mesh = build(polygon.clone()).unwrap_or_else(|e| panic!("{polygon:?}: {e}"));
        assert_watertight(&mesh, &area);
        assert!((areas(&mesh).values().sum::<f64>() - 40_000.0).abs() < 1e-6, "{polygon:?}");
    }
    assert_eq!(build(square(DVec2::NAN, 1.0)), Err(GroundError::Coordinate));
    assert_eq!(build(line(&[[0.0, f64::NAN], [9.0, 0.0], [0.0, 9.0]])), Err(GroundError::Coordinate));
    assert_eq!(build(square(DVec2::new(2e6, 0.0), 1.0)), Err(GroundError::Coordinate));
    assert_eq!(build_ground(&Polygon::default(), hills(), 0.5, &[]), Err(GroundError::EmptyArea));
    assert_eq!(build_ground(&area, hills(), 0.0, &[]), Err(GroundError::Tolerance(0.0)));
}
