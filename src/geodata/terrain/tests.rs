//! Real rasters in real frames: seams, voids, half cells, speed of the control lattice against the full projections.

use std::path::Path;

use super::super::elevation::{self, Raster};
use super::*;

fn open(path: &str, area: Option<LonLatBox>) -> Option<Raster> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")).join(path);
    if path.exists() {
        return Some(elevation::read(&path.display().to_string(), &std::fs::read(&path).unwrap(), area, None).unwrap());
    }
    assert!(std::env::var_os("CI").is_none(), "{} is missing", path.display());
    eprintln!("skipped: {} is missing", path.display());
    None
}

const HALF: DVec2 = DVec2::splat(1000.0);

#[test]
fn no_elevation_is_flat_on_purpose() {
    let flat = Terrain::flat();
    assert_eq!((flat.height(DVec2::new(1e6, 2.0)), flat.spacing(), flat.is_flat()), (Some(0.0), None, true));
    assert!(flat.posts(-HALF, HALF).is_empty());
}

#[test]
fn heights_agree_with_the_file_in_its_own_projection() {
    let Some(raster) = open("dem/santa-rosa-ca-dem-30m.tif", None) else { return };
    let frame = LocalFrame::new(-122.7125, 38.4272).unwrap();
    let check = open("dem/santa-rosa-ca-dem-30m.tif", None).unwrap();
    let terrain = Terrain::from_rasters(frame, -HALF, HALF, vec![raster], Voids::Fill).unwrap();
    assert!((terrain.spacing().unwrap() - 30.0).abs() < 0.1);
    let mut worst = 0.0_f64;
    for i in 0..2000 {
        let plan = DVec2::new(f64::from(i * 7919 % 2000) - 1000.0, f64::from(i * 104_729 % 2000) - 1000.0);
        let (lon, lat) = frame.inverse(plan);
        worst = worst.max((terrain.height(plan).unwrap() - check.sample(lon, lat).unwrap()).abs());
    }
    assert!(worst < 1e-3, "{worst}");
    // UTM grid north is turned by half a degree here and its scale is 0.9996: about 4,440 posts in 4 km2.
    let posts = terrain.posts(-HALF, HALF);
    assert!((4400..4500).contains(&posts.len()), "{}", posts.len());
}

#[test]
fn voids_are_filled_and_counted_or_left_open() {
    let frame = LocalFrame::new(1.592, 42.539).unwrap();
    let half = DVec2::new(13_000.0, 11_000.0);
    let area = Terrain::area(&frame, -half, half);
    let Some(raster) = open("dem/andorra-dem-90m.tif", Some(area)) else { return };
    let voids = raster.voids();
    assert!(voids > 150, "{voids}");
    let open_voids = Terrain::from_rasters(
        frame,
        -half,
        half,
        vec![open("dem/andorra-dem-90m.tif", Some(area)).unwrap()],
        Voids::Open,
    )
    .unwrap();
    let filled = Terrain::from_rasters(frame, -half, half, vec![raster], Voids::Fill).unwrap();
    assert_eq!((filled.report().filled_from_neighbours, filled.report().open), (voids, 0));
    assert_eq!((open_voids.report().filled_from_neighbours, open_voids.report().open), (0, voids));
    let points = (0..260 * 220).map(|i| DVec2::new(f64::from(i % 260), f64::from(i / 260)) * 100.0 - half);
    let (mut holes, mut steepest) = (0, 0.0_f64);
    for p in points {
        let h = filled.height(p).expect("filled");
        holes += usize::from(open_voids.height(p).is_none());
        steepest = steepest.max((filled.height(p + DVec2::new(1.0, 0.0)).unwrap() - h).abs());
    }
    assert!(holes > 10 && steepest < 4.0, "{holes} holes, steepest {steepest}");
}

#[test]
fn adjacent_tiles_have_no_step_between_them() {
    // The same file cut in two along a column: together they must give the uncut surface.
    let frame = LocalFrame::new(-122.2275, 37.8255).unwrap();
    let Some(whole) = open("geotiff-variants/01-int16-strips-uncompressed.tif", None) else { return };
    let (width, height) = whole.size();
    let half = DVec2::splat(900.0);
    let cut = |from: usize, columns: usize| whole.cropped(from, 0, columns, height);
    let tiles = vec![cut(0, width / 2), cut(width / 2, width - width / 2)];
    let joined = Terrain::from_rasters(frame, -half, half, tiles, Voids::Fill).unwrap();
    let reversed = vec![cut(width / 2, width - width / 2), cut(0, width / 2)];
    let reversed = Terrain::from_rasters(frame, -half, half, reversed, Voids::Fill).unwrap();
    let posts = joined.posts(-half, half).len();
    let whole = Terrain::from_rasters(frame, -half, half, vec![whole], Voids::Fill).unwrap();
    assert_eq!(posts, whole.posts(-half, half).len());
    for i in 0..5000 {
        let p = DVec2::new(f64::from(i % 100) * 18.0, f64::from(i / 100) * 36.0) - half;
        let (a, b, c) = (whole.height(p).unwrap(), joined.height(p).unwrap(), reversed.height(p).unwrap());
        assert!((a - b).abs() < 1e-4 && (a - c).abs() < 1e-4, "{p}: {a}, {b}, {c}");
    }
}

#[test]
fn the_first_raster_wins_and_a_coarser_one_fills_its_voids() {
    let frame = LocalFrame::new(-122.2375, 37.831).unwrap();
    let half = DVec2::splat(300.0);
    let Some(holed) = open("geotiff-variants/10-int16-nodata-minus32768-voids.tif", None) else { return };
    let whole = open("geotiff-variants/12-float64-strips.tif", None).unwrap();
    let voids = holed.voids();
    let expected = whole.sample(-122.2375, 37.831).unwrap();
    let terrain = Terrain::from_rasters(frame, -half, half, vec![holed, whole], Voids::Fill).unwrap();
    assert_eq!(terrain.report().filled_from_other_raster, voids);
    assert!((terrain.height(DVec2::ZERO).unwrap() - expected).abs() < 1e-3);
}

#[test]
fn least_and_greatest_under_an_outline() {
    let frame = LocalFrame::new(1.592, 42.539).unwrap();
    let Some(raster) = open("dem/andorra-dem-90m.tif", None) else { return };
    let terrain = Terrain::from_rasters(frame, -HALF, HALF, vec![raster], Voids::Fill).unwrap();
    let square = |size: f64| Polygon {
        outer: vec![DVec2::ZERO, DVec2::new(size, 0.0), DVec2::splat(size), DVec2::new(0.0, size)],
        holes: Vec::new(),
    };
    let (least, greatest) = terrain.extremes_under(&square(400.0)).unwrap();
    let mut seen = (f64::MAX, f64::MIN);
    for i in 0..=100 {
        for j in 0..=100 {
            let h = terrain.height(DVec2::new(f64::from(i), f64::from(j)) * 4.0).unwrap();
            seen = (seen.0.min(h), seen.1.max(h));
        }
    }
    assert!((-1e-6..0.5).contains(&(seen.0 - least)), "{least} {seen:?}");
    assert!((-1e-6..0.5).contains(&(greatest - seen.1)), "{greatest} {seen:?}");
    let (a, b) = terrain.extremes_under(&square(1e-3)).unwrap();
    assert!(b - a < 0.01 && (a - terrain.height(DVec2::ZERO).unwrap()).abs() < 0.01);
}

#[test]
fn between_bends_the_ground_is_a_parabola() {
    let frame = LocalFrame::new(1.592, 42.539).unwrap();
    let Some(raster) = open("dem/andorra-dem-90m.tif", None) else { return };
    let terrain = Terrain::from_rasters(frame, -HALF, HALF, vec![raster], Voids::Fill).unwrap();
    let (a, b) = (DVec2::new(-700.0, 321.0), DVec2::new(650.0, -400.0));
    let bends = terrain.bends(a, b);
    assert!(bends.len() > 30 && bends.is_sorted());
    let stops: Vec<f64> = [&[0.0][..], &bends, &[1.0]].concat();
    let height = |t: f64| terrain.height(a.lerp(b, t)).unwrap();
    for w in stops.chunks(2).map(|c| c[0]).collect::<Vec<_>>().windows(2) {
        let at = |f: f64| height(w[0] + (w[1] - w[0]) * f);
        // Third difference of a parabola; the control lattice bends it by millimetres.
        let third = at(0.98) - 3.0 * at(0.66) + 3.0 * at(0.34) - at(0.02);
        assert!(third.abs() < 0.01, "{third} between {w:?}");
    }
    assert!(terrain.bends(a, a).is_empty() || terrain.bends(a, a) == [0.5]);
    assert!(Terrain::flat().bends(a, b).is_empty());
}

#[test]
fn a_scene_outside_every_file_is_an_error_that_names_them() {
    let Some(raster) = open("dem/monaco-dem-90m.tif", None) else { return };
    let frame = LocalFrame::new(10.0, 50.0).unwrap();
    let error = Terrain::from_rasters(frame, -HALF, HALF, vec![raster], Voids::Fill).unwrap_err();
    assert!(error.to_string().ends_with("monaco-dem-90m.tif"), "{error}");
    assert!(Terrain::from_rasters(frame, -HALF, HALF, vec![], Voids::Fill).is_err());
}
