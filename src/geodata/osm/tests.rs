//! Readers: all shared files with the counts of their `SOURCES.md`, damaged files, and small ones of every form.

use std::io::Write;

use super::*;
use crate::geodata::feature::ObjectKind;
use crate::geodata::testdata::shared;

fn read(bytes: &[u8]) -> Result<OsmData, MapError> {
    let mut builder = OsmBuilder::default();
    read_stream(bytes, "test", &mut builder)?;
    Ok(builder.finish())
}

fn message(bytes: &[u8]) -> String {
    read(bytes).expect_err("this must not be read").to_string()
}

const HOUSE: &str = r#"<?xml version="1.0"?>
<osm version="0.6">
 <note>made by &quot;hand&quot;</note>
 <bounds minlat="1" minlon="2" maxlat="3" maxlon="4"/>
 <node id="-1" lat="1.5" lon="2.5"><tag k="a" v="b"/></node>
 <node id="9000000000" lat="1.5000001" lon="2.6" user="x"/>
 <node id="3" lat="1.6" lon="2.6"/>
 <node id="4" action="delete" lat="1.6" lon="2.6"/>
 <way id="3"><center lat="1" lon="2"/><nd ref="-1"/><nd ref="9000000000"/><nd ref="3"/><nd ref="-1"/>
  <tag k="building" v="a &amp; b &#228;"/></way>
 <relation id="3"><member type="way" ref="3" role="outer"/><member type="node" ref="3" role=""/>
  <tag k="type" v="multipolygon"/></relation>
</osm>
"#;

#[test]
fn xml_gives_nodes_ways_relations_and_bounds() {
    let data = read(HOUSE.as_bytes()).unwrap();
    assert_eq!(data.node_count(), 3);
    assert_eq!(data.node(9_000_000_000), Some(Position { lon: 26_000_000, lat: 15_000_001 }));
    assert_eq!(data.bounds, Some(LonLatBox { west: 2.0, south: 1.0, east: 4.0, north: 3.0 }));
    let way = data.way(3).unwrap();
    assert_eq!((way.refs, way.tags.get("building")), ([-1, 9_000_000_000, 3, -1].as_slice(), Some("a & b ä")));
    let relation = data.relations().next().unwrap();
    let members: Vec<_> = relation.members().map(|m| (m.kind, m.id, m.role)).collect();
    assert_eq!(members, [(ObjectKind::Way, 3, "outer"), (ObjectKind::Node, 3, "")]);
}

#[test]
fn the_same_object_from_two_files_is_there_once_and_the_first_stays() {
    let mut builder = OsmBuilder::default();
    read_stream(HOUSE.as_bytes(), "one", &mut builder).unwrap();
    read_stream(HOUSE.replace("a &amp; b", "other").as_bytes(), "two", &mut builder).unwrap();
    let data = builder.finish();
    assert_eq!((data.node_count(), data.ways().len(), data.relations().len()), (3, 1, 1));
    assert_eq!(data.way(3).unwrap().tags.get("building"), Some("a & b ä"));
}

#[test]
fn overpass_inline_geometry_needs_no_nodes() {
    let text = r#"{"version":0.6,"elements":[
        {"type":"way","id":7,"geometry":[{"lat":1,"lon":2},{"lat":1,"lon":3},null],"tags":{"highway":"path"}},
        {"type":"way","id":8,"nodes":[5,6],"geometry":[{"lat":1,"lon":2},{"lat":1,"lon":3}]},
        {"type":"relation","id":1,"members":[
            {"type":"way","ref":9,"role":"outer","geometry":[{"lat":1,"lon":2},{"lat":1,"lon":3}]},
            {"type":"way","ref":8,"role":"inner","geometry":[{"lat":0,"lon":0}]}]},
        {"type":"way","id":10,"center":{"lat":1,"lon":2},"tags":{"building":"yes"}}]}"#;
    let data = read(text.as_bytes()).unwrap();
    let places = |id| -> Vec<_> { data.way(id).unwrap().refs.iter().map(|n| data.node(*n)).collect() };
    let at = |lon| Position::from_degrees(lon, 1.0);
    assert_eq!(places(7), [at(2.0), at(3.0), None]);
    assert_eq!((places(8), places(9)), (vec![at(2.0), at(3.0)], vec![at(2.0), at(3.0)]));
    assert!(places(10).is_empty());
}

#[test]
fn geojson_properties_become_tags() {
    let text = r#"{"type":"FeatureCollection","features":[
        {"type":"Feature","id":1,"properties":{"highway":["residential","service"],"oneway":true,"lanes":2,
            "name":null,"@user":"somebody"},"geometry":{"type":"LineString","coordinates":[[1,2],[3,4,99]]}},
        {"type":"Feature","properties":null,"geometry":null},
        {"type":"Feature","properties":{"tags":{"building":"yes"}},"geometry":{"type":"MultiPolygon","coordinates":
            [[[[0,0],[1,0],[1,1],[0,0]]],[[[2,0],[3,0],[3,1],[2,0]]]]}}]}"#;
    let data = read(text.as_bytes()).unwrap();
    let shapes: Vec<_> = data.shapes().collect();
    assert_eq!(shapes.iter().map(|s| s.id).collect::<Vec<_>>(), [1, 2]);
    let tags: Vec<_> = shapes[0].tags.iter().collect();
    assert_eq!(tags, [("highway", "residential;service"), ("oneway", "yes"), ("lanes", "2")]);
    assert!(matches!(shapes[1].geometry, ShapeGeometry::Polygons(p) if p.len() == 2));
    assert_eq!(shapes[1].tags.get("building"), Some("yes"));
    let single = r#"{"geometry":{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,0]]]},
        "properties":{"building":"yes"},"type":"Feature"}"#;
    assert_eq!(read(single.as_bytes()).unwrap().shapes().len(), 1);
}

#[test]
fn every_refusal_names_the_file_and_the_place() {
    let cases: [(&str, &str); 16] = [
        ("", "found an empty file"),
        ("PK\x03\x04", "found a zip archive"),
        ("hello", "found something else"),
        ("<gpx/>", "line 1: <gpx> instead of <osm>"),
        ("<osm version=\"0.5\"/>", "line 1: OSM version 0.5"),
        ("<osm/>", "version"),
        ("<!DOCTYPE x [<!ENTITY a \"b\">]><osm version=\"0.6\"/>", "not allowed"),
        ("<osm version=\"0.6\">\n<node id=\"1\" lat=\"91\" lon=\"0\"/></osm>", "line 2: node 1 has no valid lat"),
        ("<osm version=\"0.6\">\n\n<way id=\"x\"/></osm>", "line 3: a way with id `x`"),
        ("<osm version=\"0.6\"><way id=\"1\"></node></osm>", "line 1"),
        ("<osm version=\"0.6\"><relation id=\"1\"><member ref=\"1\"/></relation></osm>", "member of type"),
        ("<osm version=\"0.6\"><remark>runtime error: timed out</remark></osm>", "not complete"),
        ("{\"elements\":[\n{\"type\":\"node\",\"id\":1}]}", "line 2, column 23: node 1 has no position"),
        ("{\"elements\":[],\"remark\":\"runtime error\"}", "not complete: runtime error"),
        ("{\"a\":1}", "neither `elements`"),
        (
            "{\"features\":[{\"type\":\"Feature\",\"properties\":{},\"geometry\":\
             {\"type\":\"LineString\",\"coordinates\":[[500000,4000000],[1,1]]}}]}",
            "not a longitude and latitude",
        ),
    ];
    for (text, expected) in cases {
        let message = message(text.as_bytes());
        assert!(message.starts_with("test: ") && message.contains(expected), "{text:?}: {message}");
    }
    let crs = r#"{"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32610"}},"features":[]}"#;
    assert!(message(crs.as_bytes()).contains("EPSG::32610"));
    let missing = read_files(&["/nowhere/map.osm".into()], &|_| {}).unwrap_err();
    assert!(matches!(&missing, MapError::Io { file, .. } if file == "/nowhere/map.osm"));
}

fn gz(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

fn bz2(bytes: &[u8]) -> Vec<u8> {
    let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

/// Cuts at every length of small inputs: never a panic, never a part of the data.
#[test]
fn cut_files_are_refused() {
    let overpass = r#"{"elements":[{"type":"node","id":1,"lat":1,"lon":2},{"type":"way","id":1,"nodes":[1]}]}"#;
    let geojson = r#"{"features":[{"type":"Feature","properties":{"a":1},"geometry":
        {"type":"LineString","coordinates":[[1,2],[3,4]]}}],"type":"FeatureCollection"}"#;
    let whole = [HOUSE.trim_end(), overpass, geojson].map(|text| text.as_bytes().to_vec());
    for bytes in whole.iter().cloned().chain(whole.iter().map(|b| gz(b))).chain(whole.iter().map(|b| bz2(b))) {
        assert!(read(&bytes).is_ok());
        for length in 0..bytes.len() {
            assert!(read(&bytes[..length]).is_err(), "{length} of {}", bytes.len());
        }
    }
    assert!(matches!(read(&HOUSE.as_bytes()[..HOUSE.len() - 20]), Err(MapError::Truncated { .. })));
    assert!(matches!(read(&gz(HOUSE.as_bytes())[..60]), Err(MapError::Truncated { .. })));
}

#[test]
fn a_cut_or_damaged_pbf_is_refused_with_its_blob() {
    let Some(path) = shared("osm/monaco.osm.pbf") else { return };
    let bytes = std::fs::read(path).unwrap();
    for length in [1, 3, 4, 10, 60, 200, 5_000, 100_000, bytes.len() - 1] {
        let error = read(&bytes[..length]).unwrap_err();
        assert!(!matches!(error, MapError::Io { .. }), "{length}: {error}");
    }
    let error = read(&bytes[..100_000]).unwrap_err();
    assert!(matches!(error, MapError::Truncated { place: MapPlace::Blob { .. }, .. }), "{error}");
    for at in (0..400).chain((400..bytes.len()).step_by(19_973)) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x55;
        // Either the damage is found, or it hit a part that carries no data; what counts is that nothing panics.
        if let Err(error) = read(&damaged) {
            assert!(error.to_string().starts_with("test: "), "{error}");
        }
    }
}

/// (file, ways and multipolygon relations with `building`, ways and relations with `building:part`, `highway` ways),
/// from `SOURCES.md`, which counts 141 parts in Munich without its two relations.
const COUNTS: [(&str, usize, usize, usize, usize); 10] = [
    ("santa-rosa-ca.osm.gz", 15_379, 10, 0, 1_629),
    ("piedmont-ca-buildings.overpass.json.gz", 4_700, 1, 0, 0),
    ("imperial-county-ca.osm.pbf", 10_019, 80, 0, 15_713),
    ("west-oakland-ca.osm.bz2", 323, 3, 0, 516),
    ("queens-village-ny.osm.pbf", 50_821, 15, 0, 1_956),
    ("chicago-back-of-the-yards.osm", 1_796, 0, 0, 268),
    ("munich-altstadt.osm.gz", 476, 10, 143, 741),
    ("monaco.osm.pbf", 1_183, 24, 14, 2_379),
    ("andorra.osm.pbf", 4_894, 12, 0, 4_764),
    ("baltimore-harbor.osm.pbf", 1_731, 7, 0, 3_844),
];

fn counts(data: &OsmData) -> (usize, usize, usize, usize) {
    let ways = |key: &str| data.ways().filter(|way| way.tags.get(key).is_some_and(|value| value != "no")).count();
    let relations = |key: &str| {
        let multipolygons = data.relations().filter(|r| r.tags.get("type") == Some("multipolygon"));
        multipolygons.filter(|r| r.tags.get(key).is_some()).count()
    };
    let (building, part) = ("building", "building:part");
    (ways(building), relations(building), ways(part) + relations(part), ways("highway"))
}

#[test]
fn the_shared_files_hold_what_their_sources_say() {
    for (file, ways, relations, parts, highways) in COUNTS {
        let Some(path) = shared(&format!("osm/{file}")) else { return };
        let start = std::time::Instant::now();
        let data = read_files(&[path], &|_| {}).unwrap();
        println!("{file}: {} nodes, {} ways in {:?}", data.node_count(), data.ways().len(), start.elapsed());
        let found = counts(&data);
        assert_eq!((found.0, found.1, found.3), (ways, relations, highways), "{file}");
        assert!(parts == 0 || found.2 == parts, "{file}: {} parts", found.2);
    }
}

#[test]
fn lz4_blobs_hold_the_same_as_zlib_blobs() {
    let (Some(zlib), Some(lz4)) = (shared("osm/monaco.osm.pbf"), shared("hazards/monaco-lz4.osm.pbf")) else { return };
    let (zlib, lz4) = (read_files(&[zlib], &|_| {}).unwrap(), read_files(&[lz4], &|_| {}).unwrap());
    assert_eq!(zlib.node_count(), lz4.node_count());
    assert_eq!(counts(&zlib), counts(&lz4));
    assert!(
        zlib.ways().zip(lz4.ways()).all(|(a, b)| a.id == b.id && a.refs == b.refs && a.tags.iter().eq(b.tags.iter()))
    );
}

/// The XML cases of osm-testdata: those named must be read, all others refused.
#[test]
fn osm_testdata_xml() {
    const READ: [&str; 10] = ["100", "106", "120", "123", "124", "125", "140", "141", "142", "200"];
    let Some(path) = shared("hazards/osm-testdata.zip") else { return };
    let mut archive = zip::ZipArchive::new(std::fs::File::open(path).unwrap()).unwrap();
    let names: Vec<String> = archive.file_names().map(|name| name.unwrap().into_owned()).collect();
    let (mut seen, mut wrong) = (0, Vec::new());
    for name in names.iter().filter(|n| n.contains("/xml/data/") && n.contains("/data.osm")) {
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut archive.by_name(name).unwrap(), &mut bytes).unwrap();
        let case = name.split("/xml/data/").nth(1).unwrap();
        let fine = READ.iter().any(|number| case.starts_with(number));
        let done = read(&bytes);
        println!("{case}: {:?}", done.as_ref().map(|d| d.node_count()).map_err(|e| e.to_string()));
        wrong.extend((done.is_ok() != fine).then(|| case.to_owned()));
        seen += 1;
    }
    assert!(seen > 20 && wrong.is_empty(), "{seen} {wrong:?}");
}
