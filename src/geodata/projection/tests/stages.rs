//! The stage cases of georeferencing in `../shared/hard-cases/stages.json`, each by its name (`tests/it/stage_cases.rs`
//! holds them against the file).

use super::*;

const LATITUDES: [f64; 9] = [0.0, 30.0, 45.0, 52.0, 60.0, 70.0, 80.0, 85.0, 89.0];

#[test]
fn geo_2km() {
    for lat in LATITUDES {
        let frame = LocalFrame::new(13.0, lat).unwrap();
        for corner in [(1000.0, 1000.0), (-1000.0, 1000.0), (1000.0, -1000.0), (-1000.0, -1000.0), (1000.0, 0.0)] {
            let plan = DVec2::from(corner);
            let enu = tangent_plane((13.0, lat), frame.inverse(plan));
            // The tangent plane keeps azimuths; of the geodesic's 1.4 km it is short by 1.2e-5 m.
            assert!((enu - plan).length() < 1e-4, "{lat}: {enu}");
        }
    }
}

#[test]
fn geo_antimeridian() {
    let ring = [(179.9995, -16.8), (-179.9995, -16.8), (-179.9995, -16.799), (179.9995, -16.799)];
    let frame = LocalFrame::new(ring[0].0, ring[0].1).unwrap();
    let plan = ring.map(|(lon, lat)| frame.forward(lon, lat).unwrap());
    assert!((plan[0].distance(plan[1]) - 106.6).abs() < 1.066, "{plan:?}");
    let area = crate::geometry::polygon::signed_area(&plan);
    assert!((area - 11_791.0).abs() < 118.0, "{area}");
}

#[test]
fn geo_pole() {
    let frame = LocalFrame::new(10.0, 89.995).unwrap();
    for (x, y) in [(500.0, 0.0), (-300.0, 400.0), (0.0, 500.0), (200.0, -450.0), (1.0, 558.0)] {
        let place = frame.inverse(DVec2::new(x, y));
        let chord = (ecef(place.0, place.1) - ecef(10.0, 89.995)).length();
        assert!((chord - libm::hypot(x, y)).abs() < 1e-3, "{x} {y}: {chord}");
        assert!((frame.forward(place.0, place.1).unwrap() - DVec2::new(x, y)).length() < 1e-6);
    }
}

#[test]
fn geo_exact_pole() {
    assert_eq!(LocalFrame::new(0.0, 90.0), Err(ProjectionError::Pole { lat: 90.0 }));
    assert_eq!(LocalFrame::new(0.0, -90.0), Err(ProjectionError::Pole { lat: -90.0 }));
}

#[test]
fn geo_null_island() {
    let frame = LocalFrame::new(0.0, 0.0).unwrap();
    let place = frame.inverse(DVec2::new(700.0, -900.0));
    assert!((tangent_plane((0.0, 0.0), place) - DVec2::new(700.0, -900.0)).length() < 1e-4);
}

#[test]
fn geo_180() {
    for centre in [179.99, -179.99, 180.0, -180.0] {
        let frame = LocalFrame::new(centre, 10.0).unwrap();
        let (a, b) = (frame.forward(180.0, 10.0).unwrap(), frame.forward(-180.0, 10.0).unwrap());
        assert!((a.x - b.x).abs() < 1e-9, "{centre}: {a} {b}");
    }
}

#[test]
fn geo_roundtrip() {
    // A linear congruential sequence (Knuth's MMIX): the same points on every run.
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 2000.0 - 1000.0
    };
    for lat in LATITUDES {
        let frame = LocalFrame::new(-71.0, lat).unwrap();
        for _ in 0..100_000 / LATITUDES.len() {
            let (lon, lat) = frame.inverse(DVec2::new(next(), next()));
            let back = frame.inverse(frame.forward(lon, lat).unwrap());
            // A degree of longitude shrinks with the parallel: at 89 degrees 1e-9 of it is 2 micrometres.
            let worst = ((back.0 - lon) * cos(lat.to_radians())).abs().max((back.1 - lat).abs());
            assert!(worst < 1e-9, "{lon} {lat}: {back:?}");
        }
    }
}

/// Steps of OSM's own resolution, 1e-7 degrees, stay apart at any longitude.
#[test]
fn geo_f32() {
    let frame = LocalFrame::new(139.0, 35.0).unwrap();
    for k in 0..100 {
        let at = |k: i32| frame.forward(139.0 + f64::from(k) * 1e-7, 35.0).unwrap().x;
        let step = at(k + 1) - at(k);
        assert!((step - 0.009_13).abs() < 1e-4, "{step}");
    }
}

#[test]
fn geo_axis_order() {
    // (longitude, latitude) throughout: what is exchanged and impossible is refused.
    assert!(LocalFrame::new(13.4, 52.5).is_ok());
    assert_eq!(LocalFrame::new(35.0, 139.0), Err(ProjectionError::NotAPlace { lon: 35.0, lat: 139.0 }));
    let frame = LocalFrame::new(139.0, 35.0).unwrap();
    assert!(matches!(frame.forward(35.0, 139.0), Err(ProjectionError::NotAPlace { .. })));
}

/// Grid north of the local frame is true north at its centre, whatever the UTM zone: azimuths of the sun need no turn.
#[test]
fn geo_convergence() {
    let frame = LocalFrame::new(12.0, 45.0).unwrap();
    let north = frame.forward(12.0, 45.01).unwrap();
    assert!(atan2(north.x, north.y).to_degrees().abs() < 0.01);
    for x in [-1000.0, 1000.0] {
        let (lon, lat) = frame.inverse(DVec2::new(x, 0.0));
        let north = frame.forward(lon, lat + 0.001).unwrap() - DVec2::new(x, 0.0);
        assert!(atan2(north.x, north.y).to_degrees().abs() < 0.01, "{x}: {north}");
    }
}

#[test]
fn geo_webmercator() {
    let frame = LocalFrame::new(10.0, 60.0).unwrap();
    // 20.04 m of Web Mercator at 60 degrees are about 10 m on the ground.
    let degrees = 20.0 / 111_319.490_793;
    let east = frame.forward(10.0 + degrees, 60.0).unwrap().x;
    let ground = (ecef(10.0 + degrees, 60.0) - ecef(10.0, 60.0)).length();
    assert!((east - ground).abs() < 1e-4 * ground && (east - 10.0).abs() < 0.04, "{east} {ground}");
}
