//! `report`: what is counted, and how.

use super::*;
use crate::interpreter::reports::table;

#[test]
fn shapes_that_end_in_nil_count_like_others() {
    let rules = r#"
Lot --> extrude(4) report("volume", geometry.volume) comp(f) { side : Wall | top : Roof | bottom : NIL }
Wall --> report("area.wall", geometry.area) report("glazed", scope.sx > 15) NIL
Roof --> report("area.roof", geometry.area) report("kind", "flat") report("kind", "2 storeys") Slab.
"#;
    let tree = run(rules, LOT);
    assert_eq!(tree.leaves.len(), 1);
    let expected = "\
report     type    count  sum  average  min  max
area.*     group       5  440       88   40  200
area.roof  float       1  200      200  200  200
area.wall  float       4  240       60   40   80
glazed     bool        4    2      0.5    0    1
kind       string      2    2        1    0    2
volume     float       1  800      800  800  800
";
    assert_eq!(table(&tree.reports), expected);
}

#[test]
fn one_key_keeps_its_types_apart() {
    let tree = run("Lot --> report(\"a\", 2) report(\"a\", true) report(\"a\", \"x\") A.", LOT);
    let kinds: Vec<_> = tree.reports.iter().map(|r| (r.kind.name(), r.count, r.sum)).collect();
    assert_eq!(kinds, [("float", 1, 2.0), ("bool", 1, 1.0), ("string", 1, 0.0)]);
}
