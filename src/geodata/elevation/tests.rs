//! Real elevation files against known values, and damaged ones against their errors.

use std::path::PathBuf;

use super::*;

/// The shared inputs; without them tests are skipped, in CI they fail.
fn shared(folder: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")).join(folder);
    if path.is_dir() {
        return Some(path);
    }
    assert!(std::env::var_os("CI").is_none(), "{} is missing", path.display());
    eprintln!("skipped: {} is missing", path.display());
    None
}

fn open(folder: &std::path::Path, file: &str, crs: Option<&str>) -> Result<Raster, ElevationError> {
    read(file, &std::fs::read(folder.join(file)).unwrap(), None, crs)
}

#[test]
fn every_geotiff_variant_decodes_to_its_listed_values() {
    let Some(folder) = shared("geotiff-variants") else { return };
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let expected: serde_json::Map<String, serde_json::Value> = serde_json::from_str(&text).unwrap();
    let mut failures = Vec::new();
    for (file, facts) in &expected {
        let crs = facts["crs"].as_str();
        let raster = match (open(&folder, file, None), file.as_str()) {
            (Err(e), "28-int16-no-crs.tif") => {
                assert!(matches!(e.problem, ElevationProblem::NoCrs), "{e}");
                open(&folder, file, Some("EPSG:4326")).unwrap()
            }
            (Err(e), "23-float32-lerc.tif") => {
                assert_eq!(
                    e.to_string(),
                    "23-float32-lerc.tif: LERC compression is not supported; `gdal_translate -co COMPRESS=DEFLATE` \
                     converts the file"
                );
                continue;
            }
            (Err(e), "30-truncated.tif") => {
                assert!(e.to_string().starts_with("30-truncated.tif: "), "{e}");
                continue;
            }
            (Err(e), _) => {
                failures.push(format!("{e}"));
                continue;
            }
            (Ok(raster), _) => raster,
        };
        let size = (facts["width"].as_u64().unwrap() as usize, facts["height"].as_u64().unwrap() as usize);
        if raster.size() != size {
            failures.push(format!("{file}: size {:?}", raster.size()));
        }
        if let Some(crs) = crs.filter(|&c| c != "EPSG:9707" && c != raster.crs()) {
            failures.push(format!("{file}: crs {} is not {crs}", raster.crs()));
        }
        for point in facts["points"].as_array().unwrap() {
            let cell = raster.cell(point["lon"].as_f64().unwrap(), point["lat"].as_f64().unwrap());
            let right = match point["cell_value_m"].as_f64() {
                // Listed to a thousandth.
                Some(value) => cell.is_some_and(|c| (c - value).abs() < 0.000_51),
                None => cell.is_none(),
            };
            if !right {
                failures.push(format!("{file}: {point} but {cell:?}"));
            }
        }
    }
    assert_eq!(expected.len(), 31);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn same_numbers_give_the_same_surface_however_they_are_stored() {
    let Some(folder) = shared("geotiff-variants") else { return };
    let plain = open(&folder, "01-int16-strips-uncompressed.tif", None).unwrap();
    for file in ["14-int16-pixel-is-point.tif", "26-int16-south-up.tif", "25-two-band-pixel-interleaved.tif"] {
        let other = open(&folder, file, None).unwrap();
        for i in 0..50 {
            let (lon, lat) = (-122.241 + 0.0006 * f64::from(i), 37.812 + 0.0005 * f64::from(i));
            let (a, b) = (plain.sample(lon, lat).unwrap(), other.sample(lon, lat).unwrap());
            assert!((a - b).abs() < 1e-6, "{file} at {lon}, {lat}: {a} and {b}");
        }
    }
}

#[test]
fn a_window_of_a_tiled_and_of_a_rotated_file_gives_the_same_heights() {
    let Some(folder) = shared("geotiff-variants") else { return };
    let area = LonLatBox { west: -122.2295, south: 37.8225, east: -122.2265, north: 37.8255 };
    for file in [
        "04-float32-tiled-deflate-pred3.tif",
        "27-float32-rotated15deg-utm10n.tif",
        "19-float32-nad83-albers-epsg3310.tif",
    ] {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        let (whole, part) = (read(file, &bytes, None, None).unwrap(), read(file, &bytes, Some(area), None).unwrap());
        assert!(part.size().0 * part.size().1 < 1500, "{file}: {:?}", part.size());
        for i in 0..20 {
            let (lon, lat) = (area.west + 0.00015 * f64::from(i), area.south + 0.00015 * f64::from(i));
            let (a, b) = (whole.sample(lon, lat).unwrap(), part.sample(lon, lat).unwrap());
            assert!((a - b).abs() < 1e-6, "{file}: {a} is not {b}");
        }
    }
}

#[test]
fn a_projection_on_a_sphere_lies_where_its_utm_copy_lies() {
    let Some(folder) = shared("dem") else { return };
    let sphere = open(&folder, "santa-rosa-ca-dem-30m-lcc-sphere.tif", None).unwrap();
    let utm = open(&folder, "santa-rosa-ca-dem-30m.tif", None).unwrap();
    let (mut sum, mut count) = (0.0, 0);
    for i in 0..40 {
        for j in 0..40 {
            let (lon, lat) = (-122.724 + 0.023 * f64::from(i) / 40.0, 38.4182 + 0.018 * f64::from(j) / 40.0);
            if let (Some(a), Some(b)) = (sphere.sample(lon, lat), utm.sample(lon, lat)) {
                sum += (a - b).abs();
                count += 1;
            }
        }
    }
    assert!(count > 1000 && sum / f64::from(count) < 0.5, "mean difference {} m of {count}", sum / f64::from(count));
}

#[test]
fn real_files_hold_the_stated_heights_and_voids() {
    let Some(folder) = shared("dem") else { return };
    let hgt = open(&folder, "N42E001.hgt.zip", None).unwrap();
    assert_eq!((hgt.size(), hgt.voids()), ((1201, 1201), 7652));
    let andorra = open(&folder, "andorra-dem-90m.tif", None).unwrap();
    assert_eq!((andorra.size(), andorra.voids()), ((529, 349), 704));
    // The crop was cut from the tile without resampling: half a cell of shift would show at once.
    for i in 0..100 {
        let (lon, lat) = (1.44 + 0.003 * f64::from(i), 42.44 + 0.002 * f64::from(i));
        match (hgt.sample(lon, lat), andorra.sample(lon, lat)) {
            (Some(a), Some(b)) => assert!((a - b).abs() < 1e-3, "{lon} {lat}: {a} and {b}"),
            (a, b) => assert_eq!(a.is_none(), b.is_none()),
        }
    }
    let ventura = open(&folder, "ventura-ca-dem-30m.tif", None).unwrap();
    assert_eq!((ventura.size(), ventura.implausible()), ((531, 382), 178));
    let francisco = open(&folder, "san-francisco-dem-30m-float32.tif", None).unwrap();
    assert_eq!((francisco.size(), francisco.voids()), ((600, 475), 0));
    for file in [
        "chicago-dem-30m.tif",
        "monaco-dem-90m.tif",
        "piedmont-oakland-ca-dem-30m.tif",
        "queens-village-ny-dem-90m.tif",
    ] {
        assert!(open(&folder, file, None).is_ok_and(|r| r.voids() < r.size().0 * r.size().1 / 100), "{file}");
    }
}

#[test]
fn damaged_files_are_errors_and_never_panics() {
    assert!(matches!(read("a", b"", None, None).unwrap_err().problem, ElevationProblem::UnknownFormat));
    assert!(matches!(read("N42E001.hgt", b"xx", None, None).unwrap_err().problem, ElevationProblem::HgtSize(2)));
    assert!(matches!(read("a.zip", b"PK\x03\x04", None, None).unwrap_err().problem, ElevationProblem::Zip(_)));
    assert!(matches!(read("a.gz", b"\x1f\x8b\x08", None, None).unwrap_err().problem, ElevationProblem::Gzip(_)));
    let Some(folder) = shared("geotiff-variants") else { return };
    let mut state = 1_u32;
    for file in ["02-int16-tiled-deflate-pred2.tif", "05-float32-strips-lzw-pred3.tif", "06-float32-bigtiff-tiled.tif"]
    {
        let good = std::fs::read(folder.join(file)).unwrap();
        for length in (0..good.len()).step_by(good.len() / 40) {
            assert!(read(file, &good[..length], None, None).is_err(), "{file} cut to {length}");
        }
        for _ in 0..300 {
            let mut bad = good.clone();
            for _ in 0..3 {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let at = if state & 1 == 0 { (state >> 8) as usize % 600 } else { (state >> 8) as usize % bad.len() };
                bad[at] ^= (state >> 3) as u8 | 1;
            }
            // Either outcome is right; the point is that it returns.
            let _ = read(file, &bad, None, None).map(|r| r.voids());
        }
    }
}
