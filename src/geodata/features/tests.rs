//! Features from real files: counts, windows and hazards, and from small towns written here.

use std::path::PathBuf;

use super::*;
use crate::geodata::osm::{OsmBuilder, read_files, read_stream};
use crate::geodata::projection::LocalFrame;
use crate::geodata::testdata::shared;
use crate::geometry::Polygon;

fn make(data: &OsmData, area: Option<LonLatBox>) -> (Vec<Feature>, Ledger) {
    let (lon, lat) = area.or(extent(data)).expect("every test map has a place").center();
    let frame = LocalFrame::new(lon, lat).unwrap();
    let project = |lon: f64, lat: f64| frame.forward(lon, lat).unwrap_or(DVec2::NAN);
    let mut ledger = Ledger::default();
    let features = extract(data, area.map(Area::Box).as_ref(), &project, &mut ledger);
    assert!(features.is_sorted_by(|a, b| a.id < b.id), "sorted, every id once");
    assert_eq!(ledger.ok + ledger.repaired, features.len(), "every feature has its record");
    (features, ledger)
}

fn run(files: &[&str], area: Option<LonLatBox>) -> Option<(Vec<Feature>, Ledger)> {
    let paths: Vec<PathBuf> = files.iter().map(|file| shared(file)).collect::<Option<_>>()?;
    let data = read_files(&paths, &|_| {}).unwrap();
    let start = std::time::Instant::now();
    let made = make(&data, area);
    println!("{files:?}: {} features, {} skipped in {:?}", made.0.len(), made.1.skipped, start.elapsed());
    Some(made)
}

fn count(features: &[Feature], class: FeatureClass) -> usize {
    features.iter().filter(|f| f.class == class).count()
}

fn area(feature: &Feature) -> f64 {
    match &feature.outline {
        Outline::Area(polygon) => polygon.area(),
        Outline::Line(_) => 0.0,
    }
}

const SANTA_ROSA: LonLatBox = LonLatBox { west: -122.7240, south: 38.4182, east: -122.7010, north: 38.4362 };

/// `SOURCES.md` counts 4,108 ways by the mean of their vertices; by centre of gravity, with the one relation and
/// without two footprints that are there twice, it is 4,110 buildings.
#[test]
fn the_santa_rosa_window_has_its_buildings() {
    let Some((features, ledger)) = run(&["osm/santa-rosa-ca.osm.gz"], Some(SANTA_ROSA)) else { return };
    assert_eq!(count(&features, FeatureClass::Building), 4_110);
    assert_eq!(
        ledger
            .entries
            .iter()
            .filter(|e| matches!(&e.outcome, Outcome::Skipped(w) if w.contains("same footprint")))
            .count(),
        2
    );
    let data = read_files(&[shared("osm/santa-rosa-ca.osm.gz").unwrap()], &|_| {}).unwrap();
    let mean_inside = |refs: &[i64]| {
        let corners = &refs[1..];
        let places: Vec<(f64, f64)> = corners.iter().filter_map(|id| data.node(*id)).map(Position::degrees).collect();
        let mean = |pick: fn(&(f64, f64)) -> f64| places.iter().map(pick).sum::<f64>() / places.len() as f64;
        let (lon, lat) = (mean(|p| p.0), mean(|p| p.1));
        (SANTA_ROSA.west..=SANTA_ROSA.east).contains(&lon) && (SANTA_ROSA.south..=SANTA_ROSA.north).contains(&lat)
    };
    let ways = data.ways().filter(|way| way.tags.get("building").is_some() && mean_inside(way.refs)).count();
    assert_eq!(ways, 4_108);
}

#[test]
fn roads_and_buildings_from_two_files_make_one_scene() {
    let files = ["osm/piedmont-ca-buildings.overpass.json.gz", "osm/piedmont-ca-roads.overpass.json.gz"];
    let Some((features, _)) = run(&files, None) else { return };
    assert_eq!(count(&features, FeatureClass::Building), 4_701);
    assert_eq!(count(&features, FeatureClass::Highway), 1_034);
    let geojson = ["osm/santa-rosa-ca-roads.geojson"];
    let (roads, _) = run(&geojson, Some(SANTA_ROSA)).unwrap();
    let border = 2_100.0;
    let points = roads.iter().flat_map(|r| if let Outline::Line(l) = &r.outline { l.clone() } else { Vec::new() });
    assert!(roads.len() > 300 && points.map(|p| p.abs().max_element()).all(|reach| reach < border));
}

/// (file, buildings, parts) of whole files.
#[test]
fn small_shared_maps_make_features() {
    let files = [
        ("osm/west-oakland-ca.osm.bz2", 151, 0),
        ("osm/chicago-back-of-the-yards.osm", 1_796, 0),
        ("osm/munich-altstadt.osm.gz", 476, 130),
        ("osm/monaco.osm.pbf", 1_205, 11),
        ("hazards/monaco-lz4.osm.pbf", 1_205, 11),
        ("osm/baltimore-harbor.osm.pbf", 1_737, 0),
        ("hazards/la-split-buildings.geojson.gz", 4_151, 0),
    ];
    for (file, buildings, parts) in files {
        let Some((features, _)) = run(&[file], None) else { return };
        assert_eq!(count(&features, FeatureClass::Building), buildings, "{file}");
        assert_eq!(count(&features, FeatureClass::BuildingPart), parts, "{file}");
    }
}

/// The windows of `SOURCES.md`, whose counts are of ways by the mean of their vertices: within 2 %.
#[test]
fn windows_of_large_maps_hold_their_buildings() {
    let windows = [
        ("piedmont-ca-buildings.overpass.json.gz", [-122.2473, 37.8143, -122.2245, 37.8323], 3_771),
        ("queens-village-ny.osm.pbf", [-73.7581, 40.6940, -73.7343, 40.7120], 13_697),
        ("imperial-county-ca.osm.pbf", [-115.5682, 32.7715, -115.5468, 32.7895], 2_023),
        ("andorra.osm.pbf", [1.5177, 42.5011, 1.5421, 42.5191], 770),
        ("monaco.osm.pbf", [7.4100, 43.7269, 7.4348, 43.7449], 1_008),
        ("baltimore-harbor.osm.pbf", [-76.6103, 39.2700, -76.5871, 39.2880], 406),
    ];
    for (file, [west, south, east, north], expected) in windows {
        let window = LonLatBox { west, south, east, north };
        let Some((features, _)) = run(&[&format!("osm/{file}")], Some(window)) else { return };
        let found = count(&features, FeatureClass::Building);
        assert!(found.abs_diff(expected) * 50 <= expected, "{file}: {found} instead of {expected}");
    }
}

#[test]
fn the_sea_of_monaco_and_baltimore_is_closed() {
    for (file, least, most) in [("osm/monaco.osm.pbf", 0.1, 0.7), ("osm/baltimore-harbor.osm.pbf", 0.1, 0.7)] {
        let Some(path) = shared(file) else { return };
        let data = read_files(&[path], &|_| {}).unwrap();
        let b = extent(&data).unwrap();
        let (features, _) = make(&data, Some(b));
        let sea: f64 = features.iter().filter(|f| f.tags.get("water").is_some_and(|w| &**w == "sea")).map(area).sum();
        let size = (b.east - b.west) * (b.north - b.south) * 111_320.0 * 111_320.0 * libm::cos(b.south.to_radians());
        assert!((least..most).contains(&(sea / size)), "{file}: {}", sea / size);
    }
}

#[test]
fn hazard_relations() {
    let name = |file: &str| format!("hazards/relation-{file}.overpass.json");
    let Some((features, ledger)) = run(&[&name("no-outer")], None) else { return };
    assert_eq!((features.len(), ledger.skipped), (1, 1));
    assert_eq!(ledger.entries[0].outcome, Outcome::Skipped("the relation has no outer ring".to_owned()));
    let holes = |f: &Feature| if let Outline::Area(p) = &f.outline { p.holes.len() } else { 0 };
    let (chain, _) = run(&[&name("inner-chain")], None).unwrap();
    assert_eq!((chain.len(), holes(&chain[0])), (1, 8));
    let (clapham, _) = run(&[&name("clapham-common")], None).unwrap();
    let common: Vec<&Feature> = clapham.iter().filter(|f| f.id.kind == ObjectKind::Relation).collect();
    assert_eq!((common.len(), common.iter().map(|f| holes(f)).sum::<usize>()), (5, 1));
    let (inner, _) = run(&[&name("inner-tagged-building")], None).unwrap();
    assert_eq!(count(&inner, FeatureClass::Building), 2);
    assert_eq!(inner.iter().map(holes).sum::<usize>(), 2);
}

/// A town on a grid of 1e-4 degrees about (0, 0): about 11 m.
struct Town(String);

impl Town {
    fn new() -> Self {
        Town(String::new())
    }

    /// A way through grid points; nodes are named by their place.
    fn way(mut self, id: i64, points: &[(i32, i32)], tags: &str) -> Self {
        for (x, y) in points {
            let (lon, lat) = (f64::from(*x) * 1e-4, f64::from(*y) * 1e-4);
            self.0 += &format!("<node id='{}' lon='{lon}' lat='{lat}'/>", Self::node(*x, *y));
        }
        let refs: String = points.iter().map(|(x, y)| format!("<nd ref='{}'/>", Self::node(*x, *y))).collect();
        self.0 += &format!("<way id='{id}'>{refs}{}</way>", Self::tags(tags));
        self
    }

    fn relation(mut self, id: i64, members: &[(i64, &str)], tags: &str) -> Self {
        let members: String =
            members.iter().map(|(id, role)| format!("<member type='way' ref='{id}' role='{role}'/>")).collect();
        self.0 += &format!("<relation id='{id}'>{members}{}</relation>", Self::tags(tags));
        self
    }

    fn node(x: i32, y: i32) -> i64 {
        i64::from(x + 500) * 1000 + i64::from(y + 500)
    }

    fn tags(tags: &str) -> String {
        let pair = |tag: &str| tag.split_once('=').map(|(k, v)| format!("<tag k='{k}' v='{v}'/>"));
        tags.split_whitespace().filter_map(pair).collect()
    }

    fn make(&self, area: Option<LonLatBox>) -> (Vec<Feature>, Ledger) {
        let mut builder = OsmBuilder::default();
        let text = format!("<osm version='0.6'>{}</osm>", self.0);
        read_stream(text.as_bytes(), "town", &mut builder).unwrap();
        make(&builder.finish(), area)
    }
}

fn square(x: i32, y: i32, size: i32) -> [(i32, i32); 5] {
    [(x, y), (x + size, y), (x + size, y + size), (x, y + size), (x, y)]
}

fn reason(ledger: &Ledger, feature: &str) -> String {
    ledger.entries.iter().filter(|e| e.feature == feature).map(|e| format!("{:?}", e.outcome)).collect()
}

const UNIT: f64 = 11.1 * 11.1;

#[test]
fn parts_stand_for_an_outline_that_they_cover() {
    let (features, ledger) = Town::new()
        .way(1, &square(0, 0, 10), "building=school building:colour=red")
        .way(2, &[(0, 0), (5, 0), (5, 10), (0, 10), (0, 0)], "building:part=yes height=10")
        .way(3, &[(5, 0), (10, 0), (10, 10), (5, 10), (5, 0)], "building:part=yes building:colour=blue")
        .make(None);
    assert_eq!(features.iter().map(|f| f.class).collect::<Vec<_>>(), [FeatureClass::BuildingPart; 2]);
    assert!(reason(&ledger, "way/1").contains("drawn as its 2 building parts"));
    let tag = |i: usize, key: &str| features[i].tags.get(key).map(|v| v.to_string());
    assert_eq!(tag(0, "building:colour").as_deref(), Some("red"));
    assert_eq!(tag(1, "building:colour").as_deref(), Some("blue"));
    assert_eq!((tag(0, "mansard:outline").as_deref(), tag(0, "building").as_deref()), (Some("way/1"), Some("school")));
}

#[test]
fn an_outline_half_covered_keeps_the_rest_and_a_hanging_part_takes_nothing() {
    let town = |part: &str| {
        Town::new()
            .way(1, &square(0, 0, 10), "building=yes")
            .way(2, &[(0, 0), (5, 0), (5, 10), (0, 10), (0, 0)], part)
            .make(None)
    };
    let (features, ledger) = town("building:part=yes height=20");
    assert!((area(&features[0]) / (50.0 * UNIT) - 1.0).abs() < 0.02 && reason(&ledger, "way/1").contains("taken out"));
    let (features, _) = town("building:part=yes height=20 min_height=9");
    assert!((area(&features[0]) / (100.0 * UNIT) - 1.0).abs() < 0.02);
}

/// way/222512600 of Munich, a door way in a tower: its walls and those of the tower stood in one place.
#[test]
fn a_part_inside_another_is_not_drawn() {
    let drawn = |tower: &str, door: &str| {
        let (features, ledger) = Town::new()
            .way(1, &square(0, 0, 10), "building=church")
            .way(2, &square(0, 0, 10), &format!("building:part=yes {tower}"))
            .way(3, &[(4, 0), (6, 0), (6, 2), (4, 2), (4, 0)], &format!("building:part=yes {door}"))
            .make(None);
        let hidden = reason(&ledger, "way/3").contains("inside the building part way/2");
        assert_eq!(hidden, features.iter().all(|f| f.id.id != 3));
        !hidden
    };
    assert!(!drawn("height=30", "height=4"));
    assert!(!drawn("height=30 roof:shape=pyramidal roof:height=20", "height=10 min_height=2"));
    // It rises above the tower or its eaves, or stands below it.
    assert!(drawn("height=30", "height=31"));
    assert!(drawn("height=30 roof:shape=pyramidal roof:height=20", "height=11"));
    assert!(drawn("height=30 roof:shape=pyramidal", "height=11"));
    assert!(drawn("height=30 min_height=4", "height=4"));
    // Neither has a height: both have the same one.
    assert!(!drawn("start_date=1900", "start_date=1901"));
}

#[test]
fn stacked_parts_stay_and_repeated_footprints_go() {
    let (features, ledger) = Town::new()
        .way(1, &square(0, 0, 4), "building=yes")
        .way(2, &[(4, 4), (0, 4), (0, 0), (4, 0), (4, 4)], "building=house")
        .way(3, &square(20, 0, 4), "building:part=yes height=5")
        .way(4, &square(20, 0, 4), "building:part=yes min_height=5 height=9")
        .way(5, &square(20, 0, 4), "building:part=yes min_height=5 height=9")
        .make(None);
    assert_eq!(features.iter().map(|f| f.id.id).collect::<Vec<_>>(), [1, 3, 4]);
    assert!(reason(&ledger, "way/2").contains("the same footprint as way/1"));
    assert!(reason(&ledger, "way/5").contains("the same footprint as way/4"));
}

#[test]
fn what_is_not_drawn_says_why() {
    let (features, ledger) = Town::new()
        .way(1, &square(0, 0, 4), "building=yes layer=-1")
        .way(2, &square(10, 0, 4), "building=no")
        .way(3, &square(20, 0, 4), "building=demolished")
        .way(4, &[(0, 9), (9, 9)], "highway=service tunnel=building_passage")
        .way(5, &[(0, 9), (9, 9)], "highway=proposed")
        .way(6, &[(0, 9), (9, 9)], "building=yes")
        .way(7, &[(0, 9), (9, 9), (9, 12)], "landuse=grass")
        .way(8, &[(30, 0), (34, 0), (34, 4), (30, 4)], "building=yes")
        .relation(9, &[(1, "outer"), (77, "outer")], "type=multipolygon building=yes")
        .make(None);
    assert_eq!(features.iter().map(|f| f.id.id).collect::<Vec<_>>(), [8, 9]);
    let expected = [
        ("way/1", "underground: layer=-1"),
        ("way/3", "not a standing building"),
        ("way/4", "tunnel=building_passage"),
        ("way/5", "not built"),
        ("way/6", "only 2"),
        ("way/7", "not closed"),
        ("way/8", "the open outline was closed"),
        ("relation/9", "1 of 2 member ways are missing"),
    ];
    for (feature, why) in expected {
        assert!(reason(&ledger, feature).contains(why), "{feature}: {}", reason(&ledger, feature));
    }
    assert_eq!(reason(&ledger, "way/2"), "");
}

#[test]
fn objects_without_a_place_are_counted_where_there_is_an_area() {
    let mut town = Town::new().way(1, &square(0, 0, 4), "building=yes");
    town.0 += "<way id='2'><nd ref='77'/><tag k='building' v='yes'/></way>";
    assert!(reason(&town.make(None).1, "way/2").contains("1 of 1 nodes are missing"));
    let window = LonLatBox { west: 0.0, south: 0.0, east: 10e-4, north: 10e-4 };
    let ledger = town.make(Some(window)).1;
    assert_eq!((ledger.skipped, ledger.assumptions.values().sum::<usize>()), (0, 1));
}

#[test]
fn old_style_multipolygons_take_the_tags_of_their_outline() {
    let (features, ledger) = Town::new()
        .way(1, &square(0, 0, 10), "building=yes name=Hof")
        .way(2, &square(2, 2, 4), "")
        .relation(3, &[(1, "outer"), (2, "inner")], "type=multipolygon")
        .make(None);
    assert_eq!(features.len(), 1);
    assert_eq!(features[0].id.to_string(), "relation/3");
    assert!((area(&features[0]) / (84.0 * UNIT) - 1.0).abs() < 0.02);
    assert!(reason(&ledger, "way/1").contains("drawn as relation/3"));
    assert_eq!(features[0].tags.get("name").map(|n| n.to_string()).as_deref(), Some("Hof"));
}

#[test]
fn the_area_takes_whole_buildings_and_cuts_the_rest() {
    let town = Town::new()
        .way(1, &square(-2, 0, 6), "building=yes")
        .way(2, &square(-5, 0, 6), "building=yes")
        .way(3, &[(-50, 5), (50, 5)], "highway=residential")
        .way(4, &square(-50, -50, 100), "landuse=forest");
    let window = LonLatBox { west: 0.0, south: 0.0, east: 10e-4, north: 10e-4 };
    let (features, ledger) = town.make(Some(window));
    assert_eq!(features.iter().map(|f| f.id.id).collect::<Vec<_>>(), [1, 3, 4]);
    assert!((area(&features[0]) / (36.0 * UNIT) - 1.0).abs() < 0.02, "a building is not cut");
    assert!((area(&features[2]) / (100.0 * UNIT) - 1.0).abs() < 0.02, "a forest is");
    let Outline::Line(road) = &features[1].outline else { panic!("a road is a line") };
    assert!((road[0].distance(road[1]) / 111.0 - 1.0).abs() < 0.02);
    assert_eq!((ledger.ok, ledger.entries.len()), (3, 0));
}

#[test]
fn a_bow_tie_becomes_two_buildings_of_one_object() {
    let (features, ledger) = Town::new().way(1, &[(0, 0), (4, 4), (4, 0), (0, 4), (0, 0)], "building=yes").make(None);
    assert_eq!(features.iter().map(|f| f.id.to_string()).collect::<Vec<_>>(), ["way/1", "way/1#1"]);
    assert!(reason(&ledger, "way/1").contains("crossing edges resolved"));
}

mod ribbons {
    use super::super::ribbon::{Cap, caps, pieces, ribbon};
    use super::*;
    use crate::geometry::polygon::signed_area;

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    fn size(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    #[test]
    fn a_straight_road_is_a_rectangle_and_a_right_angle_has_a_full_corner() {
        let straight = ribbon(&line(&[(0.0, 0.0), (10.0, 0.0)]), 4.0, [Cap::Flat; 2]).unwrap();
        assert!((size(&straight) - 40.0).abs() < 1e-6);
        for turn in [10.0, -10.0] {
            let bend = ribbon(&line(&[(0.0, 0.0), (10.0, 0.0), (10.0, turn)]), 4.0, [Cap::Flat; 2]).unwrap();
            assert_eq!(bend.len(), 1);
            // Two arms of 10 x 4, less the overlap 2 x 2, and the mitred corner 2 x 2.
            assert!((size(&bend) - 80.0).abs() < 1e-6, "{}", size(&bend));
        }
    }

    #[test]
    fn sharp_bends_are_bevelled_and_turning_back_is_no_trouble() {
        let hairpin = line(&[(0.0, 0.0), (20.0, 0.0), (0.0, 1.0)]);
        let made = ribbon(&hairpin, 4.0, [Cap::Flat; 2]).unwrap();
        let reach = made[0].outer.iter().map(|p| p.x).fold(f64::MIN, f64::max);
        assert!(reach < 22.5, "{reach}");
        let back = ribbon(&line(&[(0.0, 0.0), (10.0, 0.0), (0.0, 0.0)]), 4.0, [Cap::Flat; 2]).unwrap();
        assert!((size(&back) - 40.0).abs() < 1e-6);
    }

    #[test]
    fn a_closed_road_is_a_ring() {
        let round =
            ribbon(&line(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]), 2.0, [Cap::Flat; 2]);
        let round = round.unwrap();
        assert_eq!((round.len(), round[0].holes.len()), (1, 1));
        assert!((size(&round) - (22.0 * 22.0 - 18.0 * 18.0)).abs() < 1e-6);
    }

    /// Long ways had corners a grid step apart, and outlines that crossed themselves there (way/-15912 of Santa Rosa).
    #[test]
    fn corners_that_differ_by_rounding_are_one() {
        let wave: Vec<DVec2> =
            (0..60).map(|i| DVec2::new(f64::from(i) * 137.3, 90.0 * libm::sin(f64::from(i) * 1.7))).collect();
        let made = ribbon(&wave, 6.0, [Cap::Round; 2]).unwrap();
        assert_eq!(made.len(), 1);
        for ring in made[0].rings() {
            let shortest =
                (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])).fold(f64::MAX, f64::min);
            assert!(shortest >= 1e-3, "{shortest}");
        }
        assert_eq!(crate::geometry::polygon_checks::crossing_edges(&made[0]), []);
    }

    #[test]
    fn every_piece_is_convex_and_counter_clockwise() {
        let bends = line(&[(0.0, 0.0), (5.0, 1.0), (6.0, -3.0), (5.5, -3.0), (0.0, 8.0), (0.0, 8.0), (-4.0, 8.0)]);
        for piece in pieces(&bends, 3.0, [Cap::Round; 2]) {
            assert!(signed_area(&piece.outer) > 0.0, "{piece:?}");
            let n = piece.outer.len();
            let turn = |i: usize| {
                let at = |k: usize| piece.outer[(i + k) % n];
                (at(1) - at(0)).perp_dot(at(2) - at(1))
            };
            assert!((0..n).all(|i| turn(i) > -1e-9), "{piece:?}");
        }
    }

    #[test]
    fn ends_at_a_junction_are_round_and_dead_ends_flat() {
        let (a, b) = (line(&[(0.0, 0.0), (5.0, 0.0), (9.0, 0.0)]), line(&[(5.0, 0.0), (5.0, 7.0)]));
        assert_eq!(caps(&[&a, &b]), [[Cap::Flat, Cap::Flat], [Cap::Round, Cap::Flat]]);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert!(pieces(&line(&[(1.0, 1.0), (1.0, 1.0)]), 3.0, [Cap::Round; 2]).is_empty());
        assert!(pieces(&line(&[(1.0, 1.0), (2.0, 1.0)]), 0.0, [Cap::Round; 2]).is_empty());
    }
}
