//! What changes a fingerprint and what does not.

use super::*;
use crate::cga::{CompileOptions, compile_text};
use crate::source::SourceMap;

const RULES: &str = "
attr height = 9
attr floors = height / 3
twice(x) = x * 2
Lot --> extrude(twice(height)) comp(f){ side: Wall | top: Roof }
Wall --> split(y){ ~3: Floor }*
Floor --> color(1, 0, 0)
";

fn prints(text: &str) -> Fingerprints {
    let mut sources = SourceMap::default();
    // Another text in front: the numbers of sources do not count.
    sources.add("other", "x".repeat(text.len()));
    let (program, diagnostics) = compile_text("test.cga", text, &mut sources, &CompileOptions::default());
    program.unwrap_or_else(|| panic!("{text}: {diagnostics:?}")).fingerprints()
}

/// Paths and names of the items that differ; new ones included.
fn changed(text: &str) -> Vec<String> {
    let (old, new) = (prints(RULES), prints(text));
    assert_eq!(old.whole, new.whole);
    let items = |of: &Fingerprints| {
        let rules = of.rules.iter().map(|r| (r.path.to_string(), r.print));
        let functions = of.functions.iter().map(|f| (f.path.to_string(), f.print));
        let defaults = of.attributes.iter().map(|a| (a.name.to_string(), a.default));
        rules.chain(functions).chain(defaults).collect::<Vec<_>>()
    };
    let known = items(&old);
    items(&new).into_iter().filter(|item| !known.contains(item)).map(|(path, _)| path).collect()
}

#[test]
fn only_what_is_edited_changes() {
    let edit = |from: &str, to: &str| {
        assert!(RULES.contains(from), "{from}");
        changed(&RULES.replace(from, to))
    };
    assert_eq!(edit("color(1, 0, 0)", "color( 1, 0,0 ) // red"), Vec::<String>::new());
    assert_eq!(edit("color(1, 0, 0)", "color(1, 0, 0.1)"), ["Floor/0"]);
    assert_eq!(edit("x * 2", "x * 3"), ["twice/1"]);
    assert_eq!(edit("attr height = 9", "attr height = 10"), ["height"]);
    assert_eq!(edit("height / 3", "height / 4"), ["floors"]);
    assert_eq!(edit("~3: Floor", "3: Floor"), ["Wall/0"]);
    assert_eq!(edit("twice(x) = x * 2", "twice(wide) = wide * 2"), Vec::<String>::new());
    // A rule in front shifts all ids.
    assert_eq!(edit("Lot -->", "A --> NIL\nB --> A\nLot -->"), ["A/0", "B/0"]);
    assert_eq!(edit("attr height", "attr aa = 1\nattr height"), ["aa"]);
    // A leaf that becomes a rule: who calls it changes too.
    assert_eq!(edit("Floor -->", "Roof --> NIL\nFloor -->"), ["Lot/0", "Roof/0"]);
}

#[test]
fn what_items_read_is_known() {
    let prints = prints(RULES);
    let names = |reads: &BTreeSet<AttributeId>| {
        reads.iter().map(|id| prints.attributes[id.0 as usize].name.to_string()).collect::<Vec<_>>()
    };
    assert_eq!(names(&prints.rules[0].reads), ["height"]);
    assert_eq!(names(&prints.attributes[1].reads), ["height"]);
    assert!(prints.rules[1].reads.is_empty());
    assert_eq!(prints.attributes.iter().map(|a| a.is_literal).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn only_what_restricts_values_is_declared() {
    let declared = |text: &str| prints(&format!("{text}attr a = 1\nLot --> extrude(a)\n")).attributes[0].declared;
    let plain = declared("");
    assert_eq!(declared("@Range(min=0, max=9, restricted=false)\n"), plain);
    assert_eq!(declared("@Hidden\n"), plain);
    assert_ne!(declared("@Range(min=0, max=9, restricted=true)\n"), plain);
}
