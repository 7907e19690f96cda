//! Imports at run time: dynamic import calls, replaced extension rules, imported styles (reference 1.12).

use super::*;
use crate::cga::compile;
use crate::source::Access;

/// Derives `main.cga` of a folder of rule files on the test lot, without any message.
#[track_caller]
fn run_files(files: &[(&str, &str)], style: Option<&str>, host: &[(&str, f64)]) -> ShapeTree {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    let access = Access::new(folder.path()).expect("the folder exists");
    let options = CompileOptions { style: style.map(str::to_owned) };
    let (program, diagnostics) = compile(&folder.path().join("main.cga"), &access, &mut SourceMap::default(), &options);
    let messages: Vec<&str> = diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(messages.is_empty(), "{messages:?}");
    let mut start = start(ground(LOT), 0);
    start.attributes = host.iter().map(|(name, x)| ((*name).into(), Scalar::Float(*x))).collect();
    let tree = derive(&program.expect("no errors, so a program"), &start, &NoAssets, &Limits::default());
    let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(messages.is_empty(), "{messages:?}");
    tree
}

const PART: (&str, &str) =
    ("part.cga", "attr h = 3 attr w = h * 2 const k = w + 1 P --> print(h + \" \" + w + \" \" + k) NIL");

fn prints(main: &str, host: &[(&str, f64)]) -> Vec<String> {
    run_files(&[("main.cga", main), PART], None, host).prints
}

#[test]
fn a_dynamic_import_call_evaluates_the_import_again() {
    let import = "import p : \"part.cga\" (h = 4)";
    // The values given come first, and what depends on them follows.
    assert_eq!(prints(&format!("{import} Lot --> p(h = 10).P p.P"), &[]), ["10 20 21", "4 8 9"]);
    // Without values an earlier `set` is lost.
    assert_eq!(prints(&format!("{import} Lot --> set(p.w, 50) p.P p( ).P"), &[]), ["4 50 9", "4 8 9"]);
    // Parameters and the shape at hand can be used.
    let main = format!("{import} Lot --> s(7, 0, 2) Q(2) Q(x) --> p(h = x * scope.sx).P");
    assert_eq!(prints(&main, &[]), ["14 28 29"]);
    // The host wins over the file, a dynamic value over the host.
    assert_eq!(prints(&format!("{import} Lot --> p( ).P p(h = 1).P"), &[("p.h", 6.0)]), ["6 12 13", "1 2 3"]);
}

#[test]
fn what_a_dynamic_import_call_sets_stays_below_it() {
    let part = ("part.cga", "attr h = 3 P --> Q Q --> print(h) NIL");
    let main = "import p : \"part.cga\" Lot --> [ p(h = 8).P ] p.P p(h = 9).P";
    assert_eq!(run_files(&[("main.cga", main), part], None, &[]).prints, ["8", "3", "9"]);
}

#[test]
fn a_dynamic_import_call_can_bring_rules() {
    let part = ("part.cga", "P --> Inner Inner --> Cap extension Cap --> print(\"own\") NIL");
    let main = "import p : \"part.cga\"\n\
        Lot --> p(Cap --> print(\"mine\") NIL).P p.P p(Cap --> Mine(2)).P\nMine(x) --> print(x) NIL";
    assert_eq!(run_files(&[("main.cga", main), part], None, &[]).prints, ["mine", "own", "2"]);
}

#[test]
fn a_replaced_extension_rule_is_reached_by_its_full_name() {
    let part = ("part.cga", "P --> Cap extension Cap --> print(\"own\") NIL");
    let main = "import p : \"part.cga\" (Cap --> MyCap)\n\
        Lot --> p.P extension MyCap --> print(\"before\") p.Cap";
    assert_eq!(run_files(&[("main.cga", main), part], None, &[]).prints, ["before", "own"]);
}

#[test]
fn a_start_rule_can_forward_to_that_of_an_import() {
    let part = ("part.cga", "start P --> print(\"one\") NIL start Q(x) --> print(x) NIL");
    let main = "import p : \"part.cga\" start Lot --> p.start p.start(3)";
    assert_eq!(run_files(&[("main.cga", main), part], None, &[]).prints, ["one", "3"]);
}

#[test]
fn a_style_of_an_import_is_chosen_by_its_full_name() {
    let part = ("part.cga", "attr h = 3 P --> print(h) NIL style Tall attr h = 9 style Low attr h = 1");
    let main = "import p (Tall) : \"part.cga\" Lot --> p.P";
    let printed = |style| run_files(&[("main.cga", main), part], style, &[]).prints;
    assert_eq!([printed(None), printed(Some("p.Tall"))], [["3"], ["9"]]);
}
