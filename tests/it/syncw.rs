//! The seed paper's set-up on the real places, small: it loads, derives everything, and labels what it changed.

use crate::workshop::{Workshop, has_adapter, shared};

struct Place {
    name: &'static str,
    maps: &'static [&'static str],
    elevation: &'static str,
    window: &'static str,
    /// Buildings whose centre of gravity lies in the window.
    buildings: u64,
}

const PLACES: &[Place] = &[
    Place {
        name: "santa-rosa",
        maps: &["osm/santa-rosa-ca.osm.gz"],
        elevation: "dem/santa-rosa-ca-dem-30m.tif",
        window: "-122.7240,38.4182,-122.7010,38.4362",
        buildings: 4110,
    },
    Place {
        name: "piedmont",
        maps: &["osm/piedmont-ca-buildings.overpass.json.gz", "osm/piedmont-ca-roads.overpass.json.gz"],
        elevation: "dem/piedmont-oakland-ca-dem-30m.tif",
        window: "-122.2473,37.8143,-122.2245,37.8323",
        buildings: 3771,
    },
];

#[test]
fn the_real_places_run_through_the_recipe() {
    let Some(_) = shared("") else { return };
    if !has_adapter() {
        return;
    }
    let recipe = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/syncw/syncw.render");
    let shop = Workshop::new();
    for place in PLACES {
        let file = |name: &str| shared(name).expect("the folder is there").display().to_string();
        let map = format!("map={}", place.maps.iter().map(|m| file(m)).collect::<Vec<_>>().join(","));
        let elevation = format!("elevation={}", file(place.elevation));
        let window = format!("window={}", place.window);
        let mut args = vec!["render", recipe, "-o", place.name, "--quiet"];
        for set in [map.as_str(), &elevation, &window, "side=96px", "inclined=1"] {
            args.extend(["--set", set]);
        }
        shop.run(&args).expect(0);
        let manifest = std::fs::read(shop.path(&format!("{}/manifest.json", place.name))).expect("written");
        let manifest: serde_json::Value = serde_json::from_slice(&manifest).expect("JSON");
        let scene = &manifest["scenes"][0];
        let candidates = scene["changes"][0]["candidates"].as_u64().expect("a number");
        assert!(candidates.abs_diff(place.buildings) <= place.buildings / 50, "{}: {candidates}", place.name);
        let changed = scene["changes"][0]["changed"].as_array().expect("a list").len() as f64;
        let share = changed / candidates as f64;
        assert!((0.295..=0.505).contains(&share), "{}: {share} changed", place.name);
        assert_eq!(manifest["views"].as_array().expect("a list").len(), 2);
        let failed = scene["ledger"]["entries"].as_array().expect("a list").iter();
        let failed: Vec<_> =
            failed.filter(|e| e["detail"].as_str().is_some_and(|d| d.contains("rules failed"))).collect();
        assert!(failed.is_empty(), "{}: {failed:?}", place.name);
        assert!(scene["terrain_error_m"].as_f64().expect("a number") <= 0.5, "{}", place.name);
    }
}
