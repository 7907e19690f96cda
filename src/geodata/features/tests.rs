//! Features from real files: counts, windows, and hazards.

use std::path::PathBuf;

use super::*;
use crate::geodata::osm::read_files;
use crate::geodata::projection::LocalFrame;
use crate::geodata::testdata::shared;

fn run(files: &[&str], area: Option<LonLatBox>) -> Option<(Vec<Feature>, Ledger)> {
    let paths: Vec<PathBuf> = files.iter().map(|f| shared(f)).collect::<Option<_>>()?;
    let t = std::time::Instant::now();
    let data = read_files(&paths).unwrap();
    let t1 = t.elapsed();
    let t = std::time::Instant::now();
    let (lon, lat) = area.or(extent(&data)).unwrap().center();
    let frame = LocalFrame::new(lon, lat).unwrap();
    let project = |lon: f64, lat: f64| frame.forward(lon, lat).unwrap_or(DVec2::NAN);
    let mut ledger = Ledger::default();
    let features = extract(&data, area.map(Area::Box).as_ref(), &project, &mut ledger);
    println!("{files:?}: read {t1:?} ({} nodes, {} ways, {} relations) extract {:?}", data.node_count(), data.ways().len(), data.relations().len(), t.elapsed());
    let mut classes = std::collections::BTreeMap::new();
    for f in &features { *classes.entry(f.class).or_insert(0) += 1; }
    println!("   {classes:?} ok {} repaired {} skipped {}", ledger.ok, ledger.repaired, ledger.skipped);
    let mut why = std::collections::BTreeMap::new();
    for e in &ledger.entries {
        let text = format!("{:?}", e.outcome);
        let text: String = text.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }).collect();
        let text = text.replace("##", "#").replace("##", "#").replace("##", "#").replace("##", "#");
        let n = why.entry(text).or_insert((0, e.feature.clone()));
        n.0 += 1;
    }
    for (k, v) in why { println!("      {v:?} {k}"); }
    Some((features, ledger))
}

#[test]
fn survey() {
    for f in ["santa-rosa-ca.osm.gz", "santa-rosa-ca-roads.geojson", "piedmont-ca-buildings.overpass.json.gz", "piedmont-ca-roads.overpass.json.gz", "imperial-county-ca.osm.pbf", "west-oakland-ca.osm.bz2", "queens-village-ny.osm.pbf", "chicago-back-of-the-yards.osm", "munich-altstadt.osm.gz", "monaco.osm.pbf", "andorra.osm.pbf", "baltimore-harbor.osm.pbf"] {
        run(&[&format!("osm/{f}")], None);
    }
    for f in ["relation-clapham-common.overpass.json", "relation-inner-chain.overpass.json", "relation-inner-tagged-building.overpass.json", "relation-no-outer.overpass.json", "monaco-lz4.osm.pbf", "la-split-buildings.geojson.gz"] {
        run(&[&format!("hazards/{f}")], None);
    }
    run(&["osm/santa-rosa-ca.osm.gz", "osm/santa-rosa-ca-roads.geojson"], Some(LonLatBox { west: -122.7240, south: 38.4182, east: -122.7010, north: 38.4362 }));
}
