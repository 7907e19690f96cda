//! Attributes from tags: units, colours, bearings, what is assumed and that it is counted.

use super::*;
use crate::geodata::feature::{FeatureId, ObjectKind, Outline};
use crate::geometry::Polygon;

fn feature(class: FeatureClass, tags: &[(&str, &str)]) -> Feature {
    Feature {
        id: FeatureId { kind: ObjectKind::Way, id: 12, part: 0 },
        class,
        outline: Outline::Area(Polygon::default()),
        tags: tags.iter().map(|&(k, v)| (Arc::from(k), Arc::from(v))).collect(),
    }
}

fn building(tags: &[(&str, &str)]) -> (Vec<(Arc<str>, TagValue)>, Ledger) {
    let mut ledger = Ledger::default();
    let list = attributes(&feature(FeatureClass::Building, tags), &Defaults::default(), &mut ledger);
    (list, ledger)
}

fn number_of(list: &[(Arc<str>, TagValue)], name: &str) -> Option<f64> {
    list.iter().find(|(n, _)| &**n == name).and_then(|(_, v)| if let TagValue::Number(n) = v { Some(*n) } else { None })
}

fn text_of<'a>(list: &'a [(Arc<str>, TagValue)], name: &str) -> Option<&'a str> {
    list.iter().find(|(n, _)| &**n == name).and_then(|(_, v)| if let TagValue::Text(t) = v { Some(&**t) } else { None })
}

#[test]
fn lengths_come_in_many_spellings() {
    let cases = [
        ("14", 14.0),
        ("14m", 14.0),
        ("3 m", 3.0),
        ("12,5", 12.5),
        ("12.5 metres", 12.5),
        ("45'", 13.716),
        ("5'6\"", 1.6764),
        ("30 ft", 9.144),
        ("30 ft.", 9.144),
        ("6\"", 0.1524),
        ("180cm", 1.8),
        ("~10", 10.0),
        ("-2", -2.0),
        ("7;9", 7.0),
    ];
    for (text, metres) in cases {
        let found = length(text).unwrap_or_else(|| panic!("{text} was not read"));
        assert!((found - metres).abs() < 1e-12, "{text}: {found}");
    }
    for text in ["", "high", "5 storeys", "10-12", "1e3", "nan", "inf", "m", "'", "5'x\"", "3 m 4"] {
        assert_eq!(length(text), None, "{text}");
    }
}

#[test]
fn colours_come_as_names_and_hex() {
    let cases = [
        ("red", "#ff0000"),
        ("Light_Grey", "#d3d3d3"),
        ("dark red", "#8b0000"),
        ("#AbC", "#aabbcc"),
        ("#A0b1C2", "#a0b1c2"),
        ("c0ffee", "#c0ffee"),
        ("brown;red", "#a52a2a"),
    ];
    for (text, hex) in cases {
        assert_eq!(colour(text).as_deref(), Some(hex), "{text}");
    }
    for text in ["", "#12", "#12345g", "reddish", "ümlaut"] {
        assert_eq!(colour(text), None, "{text}");
    }
}

#[test]
fn bearings_come_as_degrees_and_points() {
    let cases = [("N", 0.0), ("SSW", 202.5), ("west", 270.0), ("135", 135.0), ("-90", 270.0), ("45°", 45.0)];
    for (text, degrees) in cases {
        assert_eq!(compass(text), Some(degrees), "{text}");
    }
    assert_eq!(compass("up"), None);
}

#[test]
fn a_fully_tagged_building_needs_no_assumption() {
    let (list, ledger) = building(&[
        ("building", "house"),
        ("height", "9 m"),
        ("building:levels", "2"),
        ("roof:height", "3"),
        ("roof:shape", "Gabled"),
        ("roof:colour", "red"),
        ("roof:direction", "E"),
        ("min_height", "0"),
    ]);
    assert_eq!(ledger, Ledger::default());
    assert_eq!(text_of(&list, "osmId"), Some("way/12"));
    assert_eq!(text_of(&list, "buildingType"), Some("house"));
    assert_eq!(text_of(&list, "roofShape"), Some("gabled"));
    assert_eq!(text_of(&list, "roofColor"), Some("#ff0000"));
    assert_eq!(text_of(&list, "wallColor"), None);
    for (name, value) in
        [("height", 9.0), ("levels", 2.0), ("roofHeight", 3.0), ("eaveHeight", 6.0), ("roofDirection", 90.0)]
    {
        assert_eq!(number_of(&list, name), Some(value), "{name}");
    }
}

#[test]
fn missing_heights_are_assumed_and_counted() {
    let (list, ledger) = building(&[("building", "yes"), ("building:levels", "3"), ("roof:levels", "1")]);
    assert_eq!((number_of(&list, "height"), number_of(&list, "eaveHeight")), (Some(12.0), Some(9.0)));
    assert_eq!(ledger.assumptions.keys().collect::<Vec<_>>(), ["height: from levels", "roofHeight: from roof:levels"]);
    let (list, ledger) = building(&[("building", "yes")]);
    assert_eq!((number_of(&list, "height"), number_of(&list, "levels")), (Some(6.0), Some(2.0)));
    assert_eq!(ledger.assumptions["height: default 6 m"], 1);
    let (list, _) = building(&[("building", "garage")]);
    assert_eq!(number_of(&list, "height"), Some(3.0));
}

#[test]
fn nonsense_heights_are_ignored_and_counted() {
    for tag in ["-3", "5000", "tall", "0"] {
        let (list, ledger) = building(&[("building", "yes"), ("height", tag)]);
        assert_eq!(number_of(&list, "height"), Some(6.0), "{tag}");
        assert_eq!(ledger.assumptions["height: default 6 m"], 1, "{tag}");
    }
    let (list, ledger) = building(&[("building:part", "yes"), ("height", "5"), ("min_height", "8")]);
    assert_eq!((number_of(&list, "height"), number_of(&list, "minHeight")), (Some(11.0), Some(8.0)));
    assert_eq!(ledger.assumptions["height: not above minHeight, one storey added"], 1);
    let (list, _) = building(&[("building", "yes"), ("height", "5"), ("roof:height", "9")]);
    assert_eq!((number_of(&list, "roofHeight"), number_of(&list, "eaveHeight")), (Some(5.0), Some(0.0)));
}

#[test]
fn road_widths_come_from_tags_then_lanes_then_class() {
    let width = |tags: &[(&str, &str)]| road_width(&feature(FeatureClass::Highway, tags).tags).metres;
    assert_eq!(width(&[("highway", "primary"), ("width", "9.5 m"), ("lanes", "4")]), 9.5);
    assert_eq!(width(&[("highway", "primary"), ("lanes", "4")]), 15.5);
    assert_eq!(width(&[("highway", "residential")]), 6.0);
    assert_eq!(width(&[("highway", "residential"), ("oneway", "yes")]), 4.5);
    assert_eq!(width(&[("highway", "residential;service")]), 6.0);
    assert_eq!(width(&[("highway", "footway"), ("width", "900")]), 2.0);
    assert_eq!(width(&[("highway", "never_heard_of")]), 3.0);
    let mut ledger = Ledger::default();
    let road = feature(FeatureClass::Highway, &[("highway", "service"), ("bridge", "yes"), ("layer", "1")]);
    let list = attributes(&road, &Defaults::default(), &mut ledger);
    assert_eq!((text_of(&list, "highwayClass"), number_of(&list, "layer")), (Some("service"), Some(1.0)));
    assert!(list.contains(&("bridge".into(), TagValue::Bool(true))));
    assert_eq!(ledger.assumptions["width: default of highway=service"], 1);
}

#[test]
fn land_cover_has_the_kind_that_made_its_class() {
    let kind = |class, tags: &[(&str, &str)]| {
        let list = attributes(&feature(class, tags), &Defaults::default(), &mut Ledger::default());
        text_of(&list, "kind").map(str::to_owned)
    };
    assert_eq!(kind(FeatureClass::Landuse, &[("landuse", "forest"), ("natural", "wood")]).as_deref(), Some("forest"));
    assert_eq!(kind(FeatureClass::Water, &[("natural", "water"), ("water", "lake")]).as_deref(), Some("lake"));
    assert_eq!(kind(FeatureClass::Water, &[("landuse", "reservoir")]).as_deref(), Some("reservoir"));
}
