//! The checker: what is accepted, and for every code a text that gives exactly it.

use std::path::Path;

use proptest::prelude::*;

use super::{CompileOptions, compile, compile_text, styles};
use crate::cga::program::{Constant, ExprKind, Item, Program, Successor, Type};
use crate::diagnostics::{Diagnostics, Severity};
use crate::source::{Access, SourceMap};

fn check(text: &str) -> (Option<Program>, Diagnostics) {
    compile_text("test.cga", text, &mut SourceMap::default(), &CompileOptions::default())
}

fn list(diagnostics: &Diagnostics) -> Vec<(&'static str, String)> {
    diagnostics.iter().map(|d| (d.code, d.message.clone())).collect()
}

/// The program of a text without any mistake or warning.
#[track_caller]
fn program(text: &str) -> Program {
    let (program, diagnostics) = check(text);
    assert!(diagnostics.is_empty(), "{text}\n{:#?}", list(&diagnostics));
    program.expect("no errors, so a program")
}

/// The text has exactly one diagnostic, with this code, at this part of the text.
#[track_caller]
fn one(text: &str, code: &str, severity: Severity, at: &str) {
    let (program, diagnostics) = check(text);
    let found = list(&diagnostics);
    assert_eq!(found.len(), 1, "{text}\n{found:#?}");
    let d = diagnostics.iter().next().expect("there is one");
    assert_eq!((d.code, d.severity), (code, severity), "{}", d.message);
    assert_eq!(&text[d.span.start as usize..d.span.end as usize], at, "{}", d.message);
    assert_eq!(program.is_some(), severity == Severity::Warning);
}

#[track_caller]
fn error(text: &str, code: &str, at: &str) {
    one(text, code, Severity::Error, at);
}

#[track_caller]
fn warning(text: &str, code: &str, at: &str) {
    one(text, code, Severity::Warning, at);
}

/// A folder of rule files, compiled from `main.cga`.
fn files(texts: &[(&str, &str)], style: Option<&str>) -> (Option<Program>, Diagnostics) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in texts {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("files lie in folders")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    }
    let access = Access::new(folder.path()).expect("the folder exists");
    let options = CompileOptions { style: style.map(str::to_owned) };
    compile(&folder.path().join("main.cga"), &access, &mut SourceMap::default(), &options)
}

#[track_caller]
fn linked(texts: &[(&str, &str)]) -> Program {
    let (program, diagnostics) = files(texts, None);
    assert!(diagnostics.is_empty(), "{:#?}", list(&diagnostics));
    program.expect("no errors, so a program")
}

#[track_caller]
fn link_error(texts: &[(&str, &str)], code: &str) {
    let (program, diagnostics) = files(texts, None);
    assert_eq!(diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [code], "{:#?}", list(&diagnostics));
    assert!(program.is_none());
}

#[test]
fn broken_syntax_gives_no_program() {
    use crate::cga::codes as c;
    error("attr a = 1 )", c::SYNTAX, ")");
    let (found, diagnostics) = check(&format!("f = {}1{}", "(".repeat(600), ")".repeat(600)));
    assert_eq!(diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), [c::TOO_DEEP]);
    assert!(found.is_none());
}

/// `@A(@A(@A(...` took quadratic time. Sixteen times the text may take four times as long per byte, which leaves room
/// for a busy machine.
#[test]
fn one_token_over_and_over_takes_linear_time() {
    let time = |token: &str, count: usize| {
        let text = token.repeat(count);
        let one = |_| {
            let start = std::time::Instant::now();
            check(&text);
            start.elapsed()
        };
        (0..3).map(one).min().expect("three tries")
    };
    for token in ["@A(", "(", "[", "{", "case ", "A --> ", "\"", "comp(f) { ", "/*"] {
        let (short, long) = (time(token, 1_000), time(token, 16_000));
        assert!(long < short * 64 + std::time::Duration::from_millis(20), "{token}: {short:?}, {long:?}");
    }
}

#[test]
fn the_deepest_text_allowed_compiles_and_is_dropped() {
    program(&format!("f = {}1{}", "(1+".repeat(160), ")".repeat(160)));
    program(&format!("f = 1{}", "+1".repeat(490)));
    program(&format!("A --> {}B.{}", "split(x) { ~1 : ".repeat(200), "}".repeat(200)));
}

#[test]
fn declarations_are_checked() {
    use crate::cga::codes as c;
    warning(r#"attr a = "\q""#, c::UNKNOWN_ESCAPE, r"\q");
    warning("attr a = 1 version \"2020.0\"", c::MISPLACED_VERSION, "version \"2020.0\"");
    error("attr a = 1 const a = 2", c::DUPLICATE_DEFINITION, "a");
    error("A --> NIL A --> NIL", c::DUPLICATE_DEFINITION, "A");
    error("A(x) --> NIL A(y) --> NIL", c::DUPLICATE_DEFINITION, "A");
    error("f(x, x) = x", c::DUPLICATE_PARAMETER, "x");
    error("style A start B --> NIL", c::MISPLACED_DECLARATION, "B");
    error("attr f(x) = x", c::MISPLACED_DECLARATION, "f");
    error("style A extends B", c::UNKNOWN_STYLE, "B");
    warning("@Grop attr a = 1", c::UNKNOWN_ANNOTATION, "Grop");
    warning("@Range(min=0, maximum=1) attr a = 1", c::ANNOTATION_ARGUMENT, "maximum=1");
    error("attr a = b attr b = f f = a", c::ATTRIBUTE_CYCLE, "a");
    error("import a : \"b.cga\"", c::IMPORT_OUTSIDE, "\"b.cga\"");
}

#[test]
fn names_are_checked() {
    use crate::cga::codes as c;
    error("attr h = heigt attr height = 1", c::UNKNOWN_NAME, "heigt");
    error("attr h = sqroot(2)", c::UNKNOWN_NAME, "sqroot");
    warning("A --> extrud(3) B.", c::UNKNOWN_OPERATION, "extrud");
    warning("A --> Wall", c::UNDEFINED_RULE, "Wall");
    warning("A --> A(1)", c::UNDEFINED_RULE, "A");
    error("A --> comp(f) { tob : B. }", c::UNKNOWN_SELECTOR, "tob");
    error("A --> shapeL(1, 2) { shape : B. | front : C. }", c::UNKNOWN_SELECTOR, "front");
    error("A --> center(xw)", c::UNKNOWN_KEYWORD, "xw");
    error("A --> set(hieght, 3)", c::UNKNOWN_ATTRIBUTE, "hieght");
    error("const h = 1 A --> set(h, 3)", c::READ_ONLY, "h");
    error("A --> set(split.index, 3)", c::READ_ONLY, "split.index");
    warning("A --> offsetUV(0, 1, 1)", c::DEPRECATED, "offsetUV");
}

#[test]
fn arguments_are_checked() {
    use crate::cga::codes as c;
    error("A --> extrude(1, 2, 3)", c::ARGUMENT_COUNT, "extrude(1, 2, 3)");
    error("f(x) = x attr a = f(1, 2)", c::ARGUMENT_COUNT, "f(1, 2)");
    error("A --> extrude(\"high\")", c::TYPE_MISMATCH, "\"high\"");
    error("A --> extrude('3)", c::MISPLACED_PREFIX, "'3");
    error("A --> s(~1, '1, '1)", c::MISPLACED_PREFIX, "~1");
    error("A --> B('1) B(x) --> extrude(x)", c::MISPLACED_PREFIX, "'1");
    error("A --> comp(f)", c::MISSING_BLOCK, "comp(f)");
    warning("A --> split(x) { B. | 1 : C. }", c::MISSING_SIZE, "B.");
    error("A --> 70% : B. 40% : C. else : D.", c::WEIGHTS_OVER_100, "70% : B. 40");
}

#[test]
fn types_are_checked() {
    use crate::cga::codes as c;
    for (text, at) in [
        ("attr a = 1 + true", "1 + true"),
        ("attr a = \"x\" * 2", "\"x\""),
        ("attr a = 1 == \"x\"", "1 == \"x\""),
        ("attr a = !3", "3"),
        ("attr a = case 1 : 2 else : 3", "1"),
        ("attr a = case true : 2 else : \"x\"", "\"x\""),
        ("attr a = [1, true]", "true"),
        ("attr a = 3[0]", "3"),
        ("attr a = [1][\"x\"]", "\"x\""),
        ("attr h = 3 A --> set(h, \"x\")", "\"x\""),
        ("A --> set(material.opacity, true)", "true"),
        ("A --> B(\"x\") B(h) --> extrude(h)", "\"x\""),
        ("A --> B(\"x\") B(h) --> C(h) C(k) --> extrude(k)", "\"x\""),
        ("f(h) = h * 2 attr a = f(true)", "true"),
        ("A --> split(x) { \"x\" : B. }", "\"x\""),
        ("A --> comp(f) { \"x\" : B. }", "\"x\""),
        ("A --> 50 + \"x\" % : B. else : C.", "50 + \"x\""),
        ("attr a = abs(true)", "true"),
    ] {
        error(text, c::TYPE_MISMATCH, at);
    }
}

#[test]
fn five_mistakes_in_one_rule_give_five_errors() {
    let (_, diagnostics) = check(
        "Lot --> extrude(\"high\") color(1, 2) set(hight, 3) t(0, ~1, 0) comp(f) { tob : Wall. | side : rotate(3) }",
    );
    let codes: Vec<&str> = diagnostics.iter().map(|d| d.code).collect();
    let expected = [
        "type-mismatch",
        "argument-count",
        "unknown-attribute",
        "misplaced-prefix",
        "unknown-selector",
        "argument-count",
    ];
    assert_eq!(codes, expected.map(|code| format!("cga::{code}")));
}

#[test]
fn accepts_what_the_reference_allows() {
    for text in [
        "attr color = \"#ff0000\" attr front = 3 A --> color(color) extrude(front)",
        "t(x) = x s = 2 A(p) --> t(t(1), s, p) B(p) B(p) --> extrude(p(0.5) && true || p == 1 ? 1 : 2)"
            .split(" extrude")
            .next()
            .expect("a text"),
        "t(x) --> extrude(x) A --> t(1) t(0, '1, 0) B.",
        "rand(x) = x attr a = rand(3) + rand()",
        "f(x) = x * 2 f(x, y) = x + y attr a = f(1) + f(1, 2)",
        "A --> Roof(30) Roof(\"flat\") Roof(a) --> roofHip(a) Roof(kind) --> report(kind + \"!\", 1) color(kind)",
        "A --> offset(-1, inside) comp(f) { inside : B. | border = C. } comp(e) { all : D. }",
        "A --> comp(f) { geometry.area > 20 && !top : B. | comp.index : C. | all : D. }",
        "A --> split(x) { ~h : B. | '0.5 : C. | { 1 : D. }* } h = 3",
        "fact(n) = case n <= 1 : 1 else : n * fact(n - 1) attr a = fact(5)",
        "A --> setup(1) setup(x) --> NIL G.H --> NIL",
        "A --> setupProjection(0, scope.xy, ~2, '1) projectUV(0) tileUV(0, ~1, '1) texture(\"x.png\")",
        "attr a = geometry.area + geometry.area() + geometry.area(top) + scope.sx",
        "attr a = sum(comp(f) { vertical : geometry.area | all = 0 })",
        "attr a = [1:3] .* 2 .+ [1, 0, 1] attr b = floatArray[1:2] attr c = a[0] + 1 attr d = a[a .== 2]",
        "A(x) with(y := x / 2 z := y * 2) --> B(z) B(w) --> t(0, w, 0) C.",
        "A --> case scope.sx > 3 : 50% : B. else : C. else : NIL",
        "start A --> start(3) start B(x) --> extrude(x)",
        "A --> i(\"a.obj\") i(\"a.obj\", yUp, keepSizeAndPosition)",
        "A --> alignScopeToGeometry(yUp, any, longest) alignScopeToGeometry(zUp, 0, 1) alignScopeToGeometry(yUp, any, world.lowest)",
        "inside = 3 A --> offset(-1, inside) extrude(inside)",
        "A --> set(material.name, \"x\") set(scope.sx, 3) set(material.colormap.su, 2) set(seedian, 3)",
        "A --> setback(2) { all : B. | remainder : C. } setback([1, 2]) { front : D. }",
    ] {
        program(text);
    }
}

#[test]
fn a_file_s_own_names_come_first() {
    let found = program("max(a, b) = 7 attr a = max(1, 2) attr b = min(1, 2)");
    let attribute = |name| &found.attribute(found.attribute_named(name).expect("it is there")).default.kind;
    assert!(matches!(attribute("a"), ExprKind::Call { .. }));
    assert!(matches!(attribute("b"), ExprKind::Builtin { .. }));
}

#[test]
fn overloads_are_chosen_by_number_and_type() {
    let found = program("A --> B(1) B(\"x\") B B(h) --> extrude(h) B(c) --> color(c) B --> NIL");
    let Successor::Sequence(sequence) = &found.rules()[0].successor else { panic!("a sequence") };
    let called: Vec<u32> = sequence
        .items
        .iter()
        .map(|item| match item {
            Item::Call { rule, .. } => rule.0,
            other => panic!("not a call: {other:?}"),
        })
        .collect();
    assert_eq!(called, [1, 2, 3]);
    assert_eq!(found.rules()[1].parameters[0].kind, Some(Type::Float));
    assert_eq!(found.rules()[2].parameters[0].kind, Some(Type::String));
}

#[test]
fn anonymous_leaves_stand_where_nothing_makes_a_shape() {
    let found = program(
        "A --> extrude(3) B --> extrude(3) A C --> [ report(\"n\", 1) ] D --> [ A ] E --> comp(f) { top : color(\"#fff\") }",
    );
    let leaf = |rule: usize| match &found.rules()[rule].successor {
        Successor::Sequence(sequence) => sequence.implicit_leaf,
        _ => panic!("a sequence"),
    };
    assert_eq!([leaf(0), leaf(1), leaf(2), leaf(3), leaf(4)], [true, false, true, false, false]);
    let Successor::Sequence(sequence) = &found.rules()[4].successor else { panic!("a sequence") };
    let Item::Comp { selectors, .. } = &sequence.items[0] else { panic!("a comp") };
    assert!(matches!(&selectors[0].body, Successor::Sequence(s) if s.implicit_leaf));
    assert_eq!(&*selectors[0].text, "top");
}

#[test]
fn every_draw_has_a_site_of_its_own() {
    let found = program("A --> 50% : t(rand, rand(1), 0) B. else : report(\"x\", case p(0.5) : 1 else : 2) C.");
    assert_eq!(found.rules()[0].draws, 4);
}

#[test]
fn attributes_are_ordered_by_what_they_read() {
    let found = program("attr a = f(1) + c attr b = 1 f(x) = x + b const c = b * 2");
    let order: Vec<&str> = found.initial_order().iter().map(|id| &*found.attribute(*id).name).collect();
    assert_eq!(order, ["b", "c", "a"]);
}

#[test]
fn annotations_are_read() {
    let found = program(
        "@Group(\"Size\", 1) @Range(min=0, max=10) @Order(2) @Description(\"how high\") attr h = 3\n\
         @Hidden @Enum(\"a\", \"b\", restricted=false) attr k = \"a\"\n@Group @Range(min=-1, stepsize=0.5) attr d = 1\n\
         @StartRule Lot --> extrude(h)",
    );
    let h = &found.attributes()[0].annotations;
    assert_eq!((h.groups.len(), h.order, h.description.as_deref()), (1, Some(2.0), Some("how high")));
    assert_eq!(h.range.as_ref().map(|r| (r.min, r.max)), Some((Some(0.0), Some(10.0))));
    let k = &found.attributes()[1].annotations;
    assert!(k.hidden && k.groups.len() == 1);
    let choices = k.choices.as_ref().expect("choices");
    assert_eq!((&choices.values[1], choices.restricted), (&Constant::String("b".into()), false));
    let d = &found.attributes()[2].annotations;
    assert!(d.groups.is_empty());
    assert_eq!(d.range.as_ref().map(|r| (r.min, r.max, r.step)), Some((Some(-1.0), None, 0.5)));
    assert_eq!(found.start_rules().len(), 1);
}

#[test]
fn imports_are_instances_with_their_own_names() {
    let found = linked(&[
        ("main.cga", "import a : \"lib/part.cga\" import b : \"lib/part.cga\" (h = 7) Lot --> a.Part b.Part a.Free."),
        ("lib/part.cga", "attr h = 3 import c : \"deep.cga\" Part --> extrude(h) c.Deep"),
        ("lib/deep.cga", "attr h = 1 Deep --> t(0, h, 0) Stone."),
    ]);
    let names: Vec<&str> = found.attributes().iter().map(|a| &*a.name).collect();
    assert_eq!(names, ["a.h", "a.c.h", "b.h", "b.c.h"]);
    assert!(matches!(found.attributes()[1].default.kind, ExprKind::Attribute(id) if id.0 == 0), "h flows into c.h");
    assert!(matches!(found.attributes()[2].default.kind, ExprKind::Number(7.0)));
    assert!(found.rule_named("b.c.Deep", 0).is_some());
    assert_eq!(found.files().len(), 3);
}

#[test]
fn attributes_flow_into_imports_unless_protected() {
    let part = ("part.cga", "attr h = 3 attr w = 2 P --> extrude(h * w)");
    let flows = |main: &str| {
        let found = linked(&[("main.cga", main), part]);
        let id = found.attribute_named("p.h").expect("the imported attribute");
        matches!(found.attribute(id).default.kind, ExprKind::Attribute(_))
    };
    assert!(flows("attr h = 9 import p : \"part.cga\" L --> p.P"));
    assert!(!flows("attr h = 9 import p : \"part.cga\" (h) L --> p.P"));
    assert!(!flows("attr h = 9 import p : \"part.cga\" () L --> p.P"));
    let back = linked(&[("main.cga", "attr h = p.h * 2 import p : \"part.cga\" L --> p.P"), part]);
    let order: Vec<&str> = back.initial_order().iter().map(|id| &*back.attribute(*id).name).collect();
    let at = |name| order.iter().position(|n| *n == name).expect(name);
    assert!(at("p.h (own default)") < at("h") && at("h") < at("p.h"), "{order:?}");
}

#[test]
fn rules_of_an_import_can_be_replaced_and_continued() {
    let part = ("part.cga", "P --> Cap Pane extension Cap --> NIL");
    let main = "import p : \"part.cga\" (Cap --> Mine) p.Pane --> Mine Mine --> color(\"#fff\") L --> p.P";
    let (found, diagnostics) = files(&[("main.cga", main), part], None);
    assert!(diagnostics.is_empty(), "{:#?}", list(&diagnostics));
    let found = found.expect("a program");
    let calls = |name: &str| match &found.rule(found.rule_named(name, 0).expect(name)).successor {
        Successor::Sequence(sequence) => sequence
            .items
            .iter()
            .map(|item| match item {
                Item::Call { rule, .. } => found.rule(*rule).name.to_string(),
                other => format!("{other:?}"),
            })
            .collect::<Vec<_>>(),
        _ => panic!("a sequence"),
    };
    assert_eq!(calls("p.P"), ["p.Cap", "p.Pane"]);
    assert_eq!(calls("p.Cap"), ["Mine"]);
    assert_eq!(calls("p.Pane"), ["Mine"]);
}

#[test]
fn broken_imports_are_errors() {
    use crate::cga::codes as c;
    let part = ("part.cga", "attr h = 3 P --> extrude(h)");
    link_error(&[("main.cga", "import p : \"none.cga\"")], c::UNREADABLE_FILE);
    link_error(&[("main.cga", "import p : \"../../../../etc/passwd\"")], c::IMPORT_OUTSIDE);
    link_error(&[("main.cga", "import p : \"b.cga\""), ("b.cga", "import q : \"main.cga\"")], c::IMPORT_CYCLE);
    link_error(&[("main.cga", "import p : \"part.cga\" (w = 3)"), part], c::BAD_OVERRIDE);
    link_error(&[("main.cga", "import p : \"part.cga\" (h = 3, h = 4)"), part], c::BAD_OVERRIDE);
    link_error(&[("main.cga", "import p : \"part.cga\" (P --> NIL)"), part], c::BAD_OVERRIDE);
    link_error(&[("main.cga", "import p : \"part.cga\" import p : \"part.cga\""), part], c::DUPLICATE_DEFINITION);
    link_error(&[("other.cga", "")], c::UNREADABLE_FILE);
    let ladder: Vec<(String, String)> = (0..12)
        .map(|i| {
            let next = format!("import a : \"{0}.cga\" import b : \"{0}.cga\" import c : \"{0}.cga\"", i + 1);
            (format!("{i}.cga"), if i < 11 { next } else { String::new() })
        })
        .collect();
    let mut texts: Vec<(&str, &str)> = ladder.iter().map(|(n, t)| (&**n, &**t)).collect();
    texts.push(("main.cga", "import a : \"0.cga\""));
    let (_, diagnostics) = files(&texts, None);
    assert!(diagnostics.iter().all(|d| d.code == c::TOO_MANY_IMPORTS) && diagnostics.has_errors());
}

#[test]
fn import_paths_are_found_from_the_file_the_project_and_the_workspace() {
    for path in ["sub/part.cga", "/rules/sub/part.cga", "/project/rules/sub/part.cga", "rules/sub/part.cga"] {
        let main = format!("import p : \"{path}\" L --> p.P");
        linked(&[
            ("main.cga", "import m : \"rules/m.cga\" L --> m.L"),
            ("rules/m.cga", &main),
            ("rules/sub/part.cga", "P --> NIL"),
        ]);
    }
}

#[test]
fn a_style_replaces_what_it_redefines() {
    let text = "attr h = 1 attr w = 2 L --> extrude(h) Roof.\nstyle Tall attr h = 10\nstyle Taller extends Tall attr w = 5 L --> extrude(h + w) Roof.";
    let height = |style: Option<&str>, name: &str| {
        let (program, diagnostics) = files(&[("main.cga", text)], style);
        let program = program.unwrap_or_else(|| panic!("{:#?}", list(&diagnostics)));
        match program.attribute(program.attribute_named(name).expect(name)).default.kind {
            ExprKind::Number(number) => number,
            _ => panic!("a number"),
        }
    };
    assert_eq!([height(None, "h"), height(Some("Tall"), "h"), height(Some("Taller"), "h")], [1.0, 10.0, 10.0]);
    assert_eq!([height(None, "w"), height(Some("Tall"), "w"), height(Some("Taller"), "w")], [2.0, 2.0, 5.0]);
    let (_, diagnostics) = files(&[("main.cga", text)], Some("Tal"));
    assert_eq!(list(&diagnostics)[0].0, crate::cga::codes::UNKNOWN_STYLE);
    let file = SourceMap::default().add("x", text);
    assert_eq!(styles(&file).iter().map(|s| &**s).collect::<Vec<_>>(), ["Tall", "Taller"]);
}

#[test]
fn other_encodings_are_read_with_a_warning() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("main.cga"), b"// Stra\xdfe\nL --> NIL").expect("a file");
    let access = Access::new(folder.path()).expect("the folder exists");
    let path = folder.path().join("main.cga");
    let (program, diagnostics) = compile(&path, &access, &mut SourceMap::default(), &CompileOptions::default());
    assert_eq!(list(&diagnostics).len(), 1);
    assert_eq!(diagnostics.iter().next().map(|d| d.code), Some(crate::cga::codes::ENCODING));
    assert!(program.is_some());
    let (program, diagnostics) =
        compile(Path::new("/nowhere/x.cga"), &access, &mut SourceMap::default(), &CompileOptions::default());
    assert!(program.is_none() && diagnostics.has_errors());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn any_salad_of_declarations_gives_a_program_or_errors(parts in prop::collection::vec(prop::sample::select(vec![
        "attr a = b", "const b = 1", "f(x) = x + a", "f = rand", "A --> extrude(a)", "A(x) --> B(x) split(x) { x : A }",
        "B --> comp(f) { top : A | a : B | all = C }", "style S", "import i : \"x.cga\"", "@Range(1)", "@Group(\"x\")",
        "A --> set(a, \"x\")", "B(y) with(z := y) --> t(z, 'y, 0)", "attr c = c", "g(x) = g(x) + h(x)", "h(x) = g(x)",
        "A --> 10% : f else : a", "start A --> start", "C --> inline { A } union { A | B }", "B --> sel(\"x\") a b c",
        "attr a = case a : f(1) else : \"x\"", "A --> color(f(a), b) texture(x)", "attr d = comp(f) { top : a | f : 1 }",
    ]), 0..12)) {
        let text = parts.join("\n");
        let (program, diagnostics) = check(&text);
        prop_assert_eq!(program.is_none(), diagnostics.has_errors());
    }
}
