//! Reference 2.6 (streetWidth), 3.7, 3.12, 6.9: what the host says about edges, streets and places.

use super::super::HostData;
use super::super::host::{EdgeAttribute, EdgeValues, Place};
use super::*;

#[track_caller]
fn derived_with(rules: &str, corners: &[(f64, f64)], host: HostData) -> ShapeTree {
    let start = StartShape { host, ..start(ground(corners), 0) };
    let tree = derive(&compiled(rules), &start, &NoAssets, &Limits::default());
    let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(messages.is_empty(), "{rules}\n{messages:?}");
    tree
}

fn streets(widths: &[f64]) -> HostData {
    HostData { street_widths: widths.to_vec(), ..HostData::default() }
}

/// Sides of the extruded test lot by street selector, as numbers of their edges: 0 south, 1 east, 2 north, 3 west.
const SIDES: &str = r#"Lot --> extrude(8) comp(f) {
  street.front : A("front") | street.back : A("back") | street.left : A("left") | street.right : A("right") | all : NIL }
A(s) --> print(s + " " + edgeAttr.getFloat("number")) NIL"#;

fn numbered(host: HostData) -> HostData {
    let values = EdgeValues::Floats(vec![0.0, 1.0, 2.0, 3.0]);
    HostData { edge_attributes: vec![EdgeAttribute { name: "number".into(), values }], ..host }
}

#[test]
fn sides_are_named_as_seen_from_the_street() {
    let sides = |widths: &[f64]| derived_with(SIDES, LOT, numbered(streets(widths))).prints;
    assert_eq!(sides(&[6.0, 0.0, 0.0, 0.0]), ["front 0", "back 2", "left 3", "right 1"]);
    assert_eq!(sides(&[0.0, 0.0, 6.0, 0.0]), ["front 2", "back 0", "left 1", "right 3"]);
    assert_eq!(sides(&[0.0, 6.0]), ["front 1", "back 3", "left 0", "right 2"]);
    // A corner lot looks to the south-south-east: the north side is its back, the west side its left.
    assert_eq!(sides(&[20.0, 20.0, 0.0, 0.0]), ["front 0", "front 1", "back 2", "left 3"]);
}

#[test]
fn without_streets_the_object_frame_decides() {
    assert_eq!(
        derived_with(SIDES, LOT, numbered(HostData::default())).prints,
        ["front 0", "back 2", "left 3", "right 1"]
    );
    let tree = derived_with(SIDES, LOT, numbered(streets(&[0.0; 4])));
    assert_eq!(tree.prints[0], "front 0");
}

#[test]
fn street_words_work_in_setback_and_measures() {
    let rules = r#"Lot --> print(geometry.area(street.front) + " " + geometry.isOriented(street.front))
  setback(2) { street.front : F. | street.side : S. | remainder : R. } extrude(8)
  print(geometry.area(street.front) + " " + geometry.area(street.side) + " " + geometry.area(street.back))
  comp(f) { street.side = print(geometry.isOriented(street.left) + " " + geometry.isOriented(street.back)) NIL }"#;
    let tree = derived_with(rules, LOT, streets(&[0.0, 0.0, 5.0, 0.0]));
    assert_eq!(tree.prints, ["0 false", "160 160 160", "true false"]);
    assert_eq!((areas(&tree, "F"), count(&tree, "S")), (vec![40.0 - 4.0], 2));
    // The strip lies along the north edge.
    let front = tree.leaves.iter().find(|l| &*l.rule == "F").expect("a strip at the street");
    assert_eq!(front.mesh.bounds().expect("it has corners").1.z, 192.0);
}

#[test]
fn old_street_words_mean_front_and_the_other_sides() {
    let rules = "Lot --> comp(fe) { streetSide : A. | noStreetSide : B. }
    \n@StartRule\nBlock --> extrude(8) comp(f) { streetSide : A. | noStreetSide : B. | all : C. }";
    let tree = derived_with(rules, LOT, streets(&[0.0, 0.0, 0.0, 4.0]));
    assert_eq!((count(&tree, "A"), count(&tree, "B"), count(&tree, "C")), (1, 3, 2));
}

#[test]
fn the_street_width_attribute_counts_edges() {
    let rules = r#"attr streetWidth(edge) = case edge == 1 : 5 else : 0
attr widest = max(streetWidth(0), streetWidth(1))
Lot --> print(streetWidth(0) + " " + streetWidth(1) + " " + streetWidth(9) + " " + widest) extrude(8)
  comp(f) { street.front : print(scope.sx) NIL }"#;
    assert_eq!(derived_with(rules, LOT, HostData::default()).prints, ["0 5 0 5", "10"]);
    assert_eq!(derived_with(rules, LOT, streets(&[3.0, 0.0, 0.0, 0.0])).prints, ["3 0 0 3", "20"]);
    let tree = derived_with(rules, LOT, streets(&[3.0, 0.0, 0.0, 0.0]));
    assert!(tree.leaves.iter().all(|leaf| leaf.attributes.iter().all(|(name, _)| &**name == "widest")));
}

#[test]
fn edge_attributes_are_found_by_what_covers_them() {
    let host = HostData {
        edge_attributes: vec![
            EdgeAttribute { name: "n".into(), values: EdgeValues::Floats(vec![1.5, 2.5, 3.5, 4.5]) },
            EdgeAttribute {
                name: "s".into(),
                values: EdgeValues::Strings(["a", "b", "c", "d"].map(Into::into).into()),
            },
            EdgeAttribute { name: "b".into(), values: EdgeValues::Bools(vec![false, true]) },
        ],
        ..HostData::default()
    };
    let rules = r#"Lot --> Show s('0.5, '1, '0.5) center(xz) extrude(3) comp(f) { side : Show | all : NIL }
Show --> print(edgeAttr.getFloat("n") + edgeAttr.getString("s") + edgeAttr.getBool("b")) NIL"#;
    // The lot itself covers all edges: the first of the longest counts. A house in the middle looks at one edge a side.
    let tree = derived_with(rules, LOT, host.clone());
    assert_eq!(tree.prints, ["1.5afalse", "1.5afalse", "2.5btrue", "3.5cfalse", "4.5dfalse"]);
    let rules = r#"Lot --> print(edgeAttr.getFloat("s") + edgeAttr.getString("x") + edgeAttr.getBool("n")) 
      print(comp(fe) { all : edgeAttr.getString("/edgeattr/s") })"#;
    assert_eq!(derived_with(rules, LOT, host).prints, ["0false", "(4)[a,b,c,d]"]);
}

#[test]
fn edges_keep_their_numbers_when_a_vertex_is_dropped() {
    let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 0.0), (10.0, -6.0), (0.0, -6.0)];
    let values = EdgeValues::Floats(vec![0.0, 1.0, 2.0, 3.0, 4.0]);
    let host =
        HostData { edge_attributes: vec![EdgeAttribute { name: "n".into(), values }], ..streets(&[0.0, 0.0, 5.0]) };
    let rules = r#"Lot --> print(comp(fe) { all : edgeAttr.getFloat("n") }) comp(fe) { street.front : print(edgeAttr.getFloat("n")) NIL }"#;
    let start = StartShape { host, ..start(ground(&corners), 0) };
    let tree = derive(&compiled(rules), &start, &NoAssets, &Limits::default());
    assert_eq!(tree.prints, ["(4)[0,2,3,4]", "2"]);
}

#[derive(Debug)]
struct Equator;

impl Place for Equator {
    fn lon_lat(&self, x: f64, z: f64) -> Option<(f64, f64)> {
        Some((x / 1000.0, -z / 1000.0))
    }
}

#[test]
fn places_come_from_the_host() {
    let rules = "Lot --> t(1, 0, 0) print(getGeoCoord(X) + \" \" + getGeoCoord(Y)) print(getGeoCoord(lon) + \" \" + getGeoCoord(lat)) A.";
    let host = HostData { place: Some(Arc::new(Equator)), ..HostData::default() };
    assert_eq!(derived_with(rules, LOT, host).prints, ["101 -190", "0.101 -0.19"]);
    let tree = derived(rules, ground(LOT));
    assert_eq!(tree.prints, ["101 -190", "nan nan"]);
    assert!(tree.diagnostics.iter().all(|d| d.code == "cga::no-place"));
}

#[test]
fn tree_keys_count_children() {
    let rules = r#"attr start = getTreeKey
Lot --> print("[" + start + getTreeKey + "]") A A split(x) { ~1 : B | ~1 : print(getTreeKey) NIL }
A --> print(getTreeKey) B
B --> [ print(getTreeKey) ] print(getTreeKey) NIL"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.prints, ["[]", "", "0;", "0;0;", "0;0;", "1;", "1;0;", "1;0;", "2;", "2;"]);
}

#[test]
fn edge_attributes_become_tags() {
    let values = EdgeValues::Strings(["main", "side", "", "side"].map(Into::into).into());
    let host = HostData { edge_attributes: vec![EdgeAttribute { name: "kind".into(), values }], ..HostData::default() };
    let rules = r#"Lot --> s('0.5, '1, '0.5) center(xz) setTagsFromEdgeAttrs print(geometry.tags("edgeattr", edges))
  comp(fe) { isTagged("edgeattr.kind.main") : M. | isTagged("edgeattr.kind.side") : S. | all : N. }"#;
    let tree = derived_with(rules, LOT, host);
    assert_eq!(tree.prints, ["(2)[edgeattr.kind.main,edgeattr.kind.side]"]);
    assert_eq!(["M", "S", "N"].map(|rule| count(&tree, rule)), [1, 2, 1]);
}
