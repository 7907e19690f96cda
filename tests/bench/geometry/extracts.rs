//! Buildings of real maps. In: the shared OpenStreetMap extracts. Out: the rings of every building, as mapped.

use std::path::{Path, PathBuf};

use glam::DVec2;
use mansard::geodata::feature::{FeatureClass, ObjectKind, Outline};
use mansard::geodata::ledger::Ledger;
use mansard::geodata::map::{OsmData, extent, extract, read_map};
use mansard::geodata::projection::LocalFrame;
use mansard::geometry::Ring;

/// The extracts that hold buildings: names and files.
pub fn files() -> Vec<(String, PathBuf)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/osm");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        eprintln!("skipped: {} is missing", folder.display());
        return Vec::new();
    };
    let paths = entries.map(|e| e.expect("the folder can be listed").path());
    let name = |p: &PathBuf| p.file_name().expect("a file").to_string_lossy().into_owned();
    let mut files: Vec<(String, PathBuf)> = paths.map(|p| (name(&p), p)).filter(|(n, _)| !n.contains("road")).collect();
    files.sort();
    files
}

/// Name and rings of every building and building part: closed ways as they are mapped, relations as they are assembled.
pub fn buildings(path: &Path) -> Vec<(String, Vec<Ring>)> {
    let data = read_map(&[path.to_owned()], &|_| {}).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let area = extent(&data).expect("the extract has ways");
    let (lon, lat) = area.center();
    let frame = LocalFrame::new(lon, lat).expect("no extract lies at a pole");
    let project = |lon: f64, lat: f64| frame.forward(lon, lat).expect("near the centre");
    let mut found = ways(&data, &project);
    for feature in extract(&data, None, &project, &mut Ledger::default()) {
        let building = matches!(feature.class, FeatureClass::Building | FeatureClass::BuildingPart);
        if let (true, ObjectKind::Relation, Outline::Area(p)) = (building, feature.id.kind, &feature.outline) {
            found.push((feature.id.to_string(), p.rings().cloned().collect()));
        }
    }
    found
}

fn ways(data: &OsmData, project: &dyn Fn(f64, f64) -> DVec2) -> Vec<(String, Vec<Ring>)> {
    let is_building = |key: &str, way: &mansard::geodata::osm::Way| way.tags.get(key).is_some_and(|v| v != "no");
    let mut found = Vec::new();
    for way in data.ways() {
        let closed = way.refs.len() > 3 && way.refs.first() == way.refs.last();
        if closed && (is_building("building", &way) || is_building("building:part", &way)) {
            // The last reference repeats the first: that is how OpenStreetMap closes a way.
            let nodes = way.refs[1..].iter().filter_map(|&id| data.node(id)).map(|p| p.degrees());
            found.push((format!("way/{}", way.id), vec![nodes.map(|(lon, lat)| project(lon, lat)).collect()]));
        }
    }
    found
}
