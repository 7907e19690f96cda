//! Meshes without defects: every shipped rule over a window of every real map, through `mansard build --validate`.

use crate::workshop::{Workshop, shared};

/// Map below `osm/`, elevation below `dem/`, window west, south, east, north: 200 to 400 m of the densest part.
const PLACES: &[(&str, &str, [f64; 4])] = &[
    ("munich-altstadt.osm.gz", "", [11.5735, 48.1365, 11.5785, 48.1395]),
    ("monaco.osm.pbf", "monaco-dem-90m.tif", [7.4180, 43.7290, 7.4230, 43.7325]),
    ("santa-rosa-ca.osm.gz", "santa-rosa-ca-dem-30m.tif", [-122.7150, 38.4270, -122.7110, 38.4300]),
    (
        "piedmont-ca-buildings.overpass.json.gz",
        "piedmont-oakland-ca-dem-30m.tif",
        [-122.2360, 37.8220, -122.2320, 37.8250],
    ),
    ("queens-village-ny.osm.pbf", "queens-village-ny-dem-90m.tif", [-73.7470, 40.7020, -73.7440, 40.7045]),
    ("imperial-county-ca.osm.pbf", "", [-115.5600, 32.7790, -115.5550, 32.7830]),
    ("west-oakland-ca.osm.bz2", "piedmont-oakland-ca-dem-30m.tif", [-122.3080, 37.8090, -122.2980, 37.8150]),
    ("chicago-back-of-the-yards.osm", "chicago-dem-30m.tif", [-87.6630, 41.8030, -87.6590, 41.8060]),
    ("andorra.osm.pbf", "andorra-dem-90m.tif", [1.5270, 42.5070, 1.5330, 42.5110]),
    ("baltimore-harbor.osm.pbf", "", [-76.6050, 39.2760, -76.5980, 39.2810]),
];

/// One scene per rule file for buildings; streets and land cover are in the first.
fn recipe(map: &str, elevation: &str, [west, south, east, north]: [f64; 4]) -> String {
    let mut text = String::from("version 1\n");
    for rule in ["building", "residential", "industrial", "damage"] {
        text += &format!("scene {rule} {{\n  seed 5\n  map \"{map}\"\n");
        if !elevation.is_empty() {
            text += &format!("  elevation \"{elevation}\"\n");
        }
        text += &format!("  area bbox {west}, {south}, {east}, {north}\n");
        text += &format!("  rules \"mansard:{rule}.cga\" for building\n");
        if rule == "building" {
            text += "  rules \"mansard:street.cga\" for highway\n";
            text += "  rules \"mansard:landcover.cga\" for landuse, natural, leisure, water\n";
        }
        text += "}\n";
    }
    text
}

/// What `validation.json` of a scene says is wrong, feature by feature.
fn wrong(shop: &Workshop, file: &str) -> (usize, usize, Vec<String>) {
    let text = std::fs::read_to_string(shop.path(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
    let found: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let features = found["features"].as_array().expect("a list");
    let closed = features.iter().filter_map(|f| f["closed_bodies"].as_u64()).sum::<u64>() as usize;
    let bad = features.iter().filter(|f| f.get("defects").is_some());
    (features.len(), closed, bad.map(|f| format!("{file}: {} {}", f["feature"], f["defects"])).collect())
}

#[test]
fn every_shipped_rule_makes_sound_meshes_on_every_real_map() {
    let mut problems = Vec::new();
    for (map, elevation, window) in PLACES {
        let Some(folder) = shared("") else { return };
        let shop = Workshop::new();
        let map = folder.join("osm").join(map);
        let dem = folder.join("dem").join(elevation);
        let dem = if elevation.is_empty() { String::new() } else { dem.display().to_string() };
        shop.write("r.render", recipe(&map.display().to_string(), &dem, *window));
        let allow = folder.display().to_string();
        let run = shop.run(&["build", "r.render", "-o", "s.glb", "--validate", "--allow", &allow]);
        let mut here = Vec::new();
        for rule in ["building", "residential", "industrial", "damage"] {
            let (features, closed, bad) = wrong(&shop, &format!("s-{rule}.validation.json"));
            assert!(features > 10, "{}: {rule} sees {features} features", map.display());
            assert!(
                closed > features / 3 || rule == "damage" || rule == "building",
                "{}: {rule} {closed}",
                map.display()
            );
            here.extend(bad.into_iter().map(|b| format!("{} {b}", map.display())));
        }
        assert_eq!(run.code, i32::from(!here.is_empty()), "{}\n{}", map.display(), run.stderr);
        problems.extend(here);
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn an_open_body_fails_validation_and_is_named() {
    let shop = Workshop::new();
    shop.town(20);
    shop.write(
        "hole.cga",
        "version \"2025.1\"\n@StartRule\nLot --> extrude(5) comp(f) { 2 : NIL | all : Face }\nFace --> color(1, 1, 1)\n",
    );
    shop.write("r.render", "version 1\nscene town { seed 1 map \"town.osm\" rules \"hole.cga\" for building }\n");
    let run = shop.run(&["build", "r.render", "-o", "s.glb", "--validate"]).expect(1);
    run.says(&["open edge", "0 ok, 0 repaired, 0 fell back, 53 skipped, 20 invalid", "invalid: open edge (4) (20)"]);
    let (features, closed, bad) = wrong(&shop, "s.validation.json");
    assert_eq!((features, closed, bad.len()), (20, 0, 20));
    assert!(bad[0].contains("\"open edge\":4"), "{}", bad[0]);
    shop.write(
        "hole.cga",
        "version \"2025.1\"\n@StartRule\nLot --> extrude(5) comp(f) { all : Face }\nFace --> color(1, 1, 1)\n",
    );
    shop.run(&["build", "r.render", "-o", "s.glb", "--validate"]).expect(0);
    assert_eq!(wrong(&shop, "s.validation.json"), (20, 20, vec![]));
}
