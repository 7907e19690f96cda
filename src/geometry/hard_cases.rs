//! The named hard footprints of `../shared/hard-cases`, for tests. In: a name. Out: its rings.

use glam::DVec2;
use serde_json::Value;

use super::{Polygon, Ring};

const FOOTPRINTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/hard-cases/footprints.geojson");

/// All features; `None`, with a word on stderr, if the folder is not there (in CI that is a failure).
pub fn features() -> Option<Vec<Value>> {
    let Ok(text) = std::fs::read_to_string(FOOTPRINTS) else {
        assert!(std::env::var_os("CI").is_none(), "{FOOTPRINTS} is missing");
        eprintln!("skipped: {FOOTPRINTS} is missing");
        return None;
    };
    let mut file: Value = serde_json::from_str(&text).expect("JSON");
    Some(std::mem::take(file["features"].as_array_mut().expect("features")))
}

/// The rings of a feature, with the one closing point of GeoJSON taken off and `replace` applied.
pub fn rings(feature: &Value) -> Vec<Ring> {
    let number = |v: &Value| v.as_f64().expect("a coordinate");
    let point = |v: &Value| DVec2::new(number(&v[0]), number(&v[1]));
    let coordinates = feature["geometry"]["coordinates"].as_array().expect("rings");
    let ring = |r: &Value| r.as_array().expect("a ring").iter().map(point).collect();
    let mut rings: Vec<Ring> = coordinates.iter().map(ring).collect();
    for r in &mut rings {
        r.pop();
    }
    for change in feature["properties"]["replace"].as_array().into_iter().flatten() {
        let at = |i: usize| change[i].as_u64().expect("an index") as usize;
        rings[at(0)][at(1)][at(2)] = change[3].as_str().expect("a value").parse().expect("NaN or Infinity");
    }
    rings
}

/// All footprints that may be used as they are, by name.
pub fn valid_footprints() -> Option<Vec<(String, Polygon)>> {
    let valid = |f: &&Value| f["properties"]["expect"] == "ok";
    let name = |f: &Value| f["properties"]["name"].as_str().expect("a name").to_owned();
    let polygon = |f: &Value| {
        let mut rings = rings(f).into_iter();
        Polygon { outer: rings.next().expect("an outline"), holes: rings.collect() }
    };
    Some(features()?.iter().filter(valid).map(|f| (name(f), polygon(f))).collect())
}

/// One valid footprint by name.
pub fn footprint(name: &str) -> Option<Polygon> {
    let all = valid_footprints()?;
    Some(all.into_iter().find(|(n, _)| n == name).expect("a name from the file").1)
}
