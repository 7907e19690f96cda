//! Three small rule files as people write them, and the forms their results leave in.

use super::*;
use crate::interpreter::{json::to_json, obj::to_obj, text::to_text};

const HOUSE: &str = r##"
version "2025.1"
@Range(min=2, max=20)
attr eaves = 5
attr roofColor = 40% : "#8b3a2b" 30% : "#6b6b6b" else : "#a0522d"
@StartRule
Lot --> extrude(eaves) comp(f) { top : Roof | side : Wall | bottom : NIL }
Roof --> color(roofColor) roofGable(35, 0.4, 0.3) comp(f) { bottom : NIL | vertical : Gable | all = Tiles. }
Gable --> color("#f0e6d2") Plaster.
Wall --> color("#f0e6d2") setupProjection(0, scope.xy, 2, 2) projectUV(0) Plaster.
"##;

const BLOCK: &str = r##"
attr floorHeight = 3
attr bay = 2.5
const height = 15
Lot --> extrude(height) report("volume", geometry.volume) comp(f) { side : Facade | top : offset(-0.5) comp(f) { inside : Flat. | border : extrude(0.8) Parapet. } }
Facade --> split(y) { 4 : Ground | { ~floorHeight : Floor(split.index) }* }
Ground --> color("#808080") Wall.
Floor(n) --> split(x) { 0.5 : Wall. | { ~bay : Bay | 0.5 : Wall. }* }
Bay --> split(x) { ~1 : Wall. | 1.2 : split(y) { 0.9 : Wall. | 1.4 : Window | ~1 : Wall. } | ~1 : Wall. }
Window --> s('1, '1, 0.1) t(0, 0, -0.1) color("#405060") [ primitiveCube Frame. ] Glass.
"##;

const COURT: &str = r#"
Lot --> shapeO(8, 8, 8, 8) { shape : Wings | remainder : Court. }
Wings --> extrude(12) comp(f) { top : roofHip(30) Roof. | bottom : NIL | side : Wall. }
"#;

#[test]
fn a_house_with_a_gable_roof() {
    let tree = run(HOUSE, SMALL);
    assert_eq!((count(&tree, "Plaster"), count(&tree, "Tiles")), (6, 1));
    let high = tree.leaves.iter().filter_map(|l| l.mesh.bounds()).map(|b| b.1.y).fold(0.0, f64::max);
    assert!((high - (5.0 + 3.0 * libm::tan(35f64.to_radians()))).abs() < 1e-9, "{high}");
}

#[test]
fn a_block_with_floors_and_windows() {
    let tree = run(BLOCK, LOT);
    assert_eq!((count(&tree, "Glass"), count(&tree, "Frame")), (4 * (7 + 3) * 2, 4 * (7 + 3) * 2));
    assert_eq!((count(&tree, "Flat"), count(&tree, "Parapet")), (1, 4));
    near(&[tree.reports[0].sum], &[3000.0]);
    let facade: f64 = areas(&tree, "Wall").iter().sum::<f64>() + areas(&tree, "Glass").iter().sum::<f64>();
    near(&[facade], &[60.0 * 15.0]);
}

#[test]
fn a_courtyard() {
    let lot = [(0.0, 0.0), (40.0, 0.0), (40.0, -30.0), (0.0, -30.0)];
    let tree = run(COURT, &lot);
    assert_eq!(areas(&tree, "Court"), [24.0 * 14.0]);
    assert_eq!((count(&tree, "Wall"), count(&tree, "Roof")), (8, 1));
    let roof = &tree.leaves.iter().find(|l| &*l.rule == "Roof").expect("a roof").mesh;
    assert!(crate::geometry::mesh_checks::is_closed(roof));
    assert!((roof.bounds().expect("a roof").1.y - (12.0 + 4.0 * libm::tan(30f64.to_radians()))).abs() < 1e-9);
}

#[test]
fn results_leave_as_json_obj_and_text() {
    let tree = run(
        "attr a = 1.5\nLot --> report(\"n\", 2) print(\"hi\") setupProjection(0, scope.xz, 1, 1) projectUV(0) A.",
        SMALL,
    );
    let json = to_json(&tree, &SourceMap::default());
    assert_eq!(json["leaves"][0]["rule"], "A");
    assert_eq!(json["leaves"][0]["attributes"]["a"], 1.5);
    assert_eq!(json["leaves"][0]["faces"][0], serde_json::json!({ "outer": [0, 1, 2, 3], "holes": [] }));
    assert_eq!(json["leaves"][0]["vertices"][1], serde_json::json!([10.0, 0.0, 0.0]));
    assert_eq!(json["leaves"][0]["uvs"]["0"][1], serde_json::json!([10.0, 6.0]));
    assert_eq!(
        json["reports"]["n"],
        serde_json::json!({ "type": "float", "count": 1, "sum": 2.0, "average": 2.0, "min": 2.0, "max": 2.0 })
    );
    assert_eq!(json["prints"], serde_json::json!(["hi"]));
    let obj = to_obj(&tree);
    assert!(obj.contains("v 10 0 0\n") && obj.contains("f 1/1 2/2 3/3 4/4\n"), "{obj}");
    let text = to_text(&tree);
    assert!(text.starts_with("0 A  #ffffff  4 vertices, 1 faces, box 0 0 -6 … 10 0 0\n"), "{text}");
}
