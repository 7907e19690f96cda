//! The parser on the reference's examples, on broken text, and on random text.

mod forms;
mod mistakes;

use proptest::prelude::*;

use super::parse;
use crate::cga::ast::{Ast, DeclarationKind, DefinitionKind, Expr, ExprKind, ItemKind, Part, Successor};
use crate::diagnostics::Diagnostics;
use crate::source::SourceMap;

fn read(text: &str) -> (Ast, Diagnostics, SourceMap) {
    let mut sources = SourceMap::default();
    let file = sources.add("test.cga", text);
    let (ast, diagnostics) = parse(&file);
    (ast, diagnostics, sources)
}

fn messages(text: &str) -> Vec<String> {
    let (_, diagnostics, sources) = read(text);
    let line = |d: &crate::diagnostics::Diagnostic| sources.get(d.span.source).place(d.span.start).line;
    diagnostics.iter().map(|d| format!("{}: {}", line(d), d.message)).collect()
}

#[track_caller]
fn accept(text: &str) -> Ast {
    let (ast, diagnostics, _) = read(text);
    assert!(diagnostics.is_empty(), "{text}\n{:#?}", diagnostics.iter().map(|d| &d.message).collect::<Vec<_>>());
    ast
}

/// The value of `f = text`.
fn expression(text: &str) -> Expr {
    let ast = accept(&format!("f = {text}"));
    match ast.declarations.into_iter().next().map(|d| d.kind) {
        Some(DeclarationKind::Definition(definition)) => definition.value,
        other => panic!("not a definition: {other:?}"),
    }
}

/// An expression with all brackets, for comparing precedence.
fn bracketed(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(n) => n.to_string(),
        ExprKind::Bool(b) => b.to_string(),
        ExprKind::String(s) => format!("{s:?}"),
        ExprKind::Call { name, args } => match args {
            None => name.text.to_string(),
            Some(args) => {
                let args: Vec<String> = args.iter().map(|a| bracketed(&a.value)).collect();
                format!("{}({})", name.text, args.join(","))
            }
        },
        ExprKind::Unary(operator, inner) => format!("({}{})", operator.text(), bracketed(inner)),
        ExprKind::Binary(operator, a, b) => format!("({}{}{})", bracketed(a), operator.text(), bracketed(b)),
        ExprKind::Index { array, row, .. } => format!("{}[{}]", bracketed(array), bracketed(row)),
        ExprKind::Array(rows) => {
            let rows: Vec<String> =
                rows.iter().map(|r| r.iter().map(bracketed).collect::<Vec<_>>().join(",")).collect();
            format!("[{}]", rows.join(";"))
        }
        ExprKind::Range { from, to, .. } => format!("{}:{}", bracketed(from), bracketed(to)),
        ExprKind::Case { branches, .. } => format!("case{}", branches.len()),
        ExprKind::Stochastic { branches, .. } => format!("random{}", branches.len()),
        ExprKind::Comp { selectors, .. } => format!("comp{}", selectors.len()),
    }
}

#[test]
fn the_torture_list_parses_but_for_its_mixed_chain() {
    let first = r#"
version "2025.1"
// numbers and dots
f1 = .5 + 1. + 2e-1
constant_like = 3        # not the keyword const
attr a.b = 1             // dotted attribute name
attr kind = 50% : "x" else : "y"
half(x) with( h := x/2 ) = h
Lot -->
    case kind == "x" :
        case scope.sx > 10 : A(1).
        else : B.
    30%  : C D.                 /* error: mixes case and percent on one level - must be rejected */
    else : NIL
"#;
    let found = messages(first);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].starts_with("13: expected"), "{found:?}");
    let second = r#"
Lot  --> s('0.9 , '1, ' 0.9) center(xz) [ t(0, '1 + 2, 0) Marker ] extrude(half(9)) Mass
Mass --> comp(f) { geometry.area > 20 && !top : [ case comp.index % 2 == 0 : Even else : Odd ]
                 | top = roofGable(case scope.sx > 8 : 25 else : 40) Roof.
                 | all : NIL }
Even --> split(y) { { ~3 : F | 0.2 : G. }* | ~1 : H }
F    --> 60% : W. else : report("n." + split.index, 1) W.
G.H  --> NIL                    // a dotted rule name is legal
"#;
    assert_eq!(accept(second).declarations.len(), 5);
}

#[test]
fn operators_bind_as_the_reference_says() {
    for (text, expected) in [
        ("1 + 2 * 3 - 4 / 2", "((1+(2*3))-(4/2))"),
        ("-7 % 3", "((-7)%3)"),
        ("a || b && !c == d", "(a||(b&&((!c)==d)))"),
        ("2.+[1,2]", "(2.+[1,2])"),
        ("3.*v", "(3.*v)"),
        ("[1:3] .* 2 .+ [1,0,1]", "(([1:3].*2).+[1,0,1])"),
        ("[1,2;3,4][1,0]", "[1,2;3,4][1]"),
        ("[5,6,7][[true,false,true]]", "[5,6,7][[true,false,true]]"),
        ("m[n .== 2]", "m[(n.==2)]"),
        ("a - -b", "(a-(-b))"),
        ("1. + .5e1", "(1+5)"),
        ("f(case a : 1 else : 2, 30% : 3 else : 4)", "f(case1,random1)"),
        ("case a : 1 else : case b : 2 else : 3", "case2"),
        ("(case a : 1 else : 2) + 1", "(case1+1)"),
        ("comp(fe) { front : 1 | all = 2 }", "comp2"),
        ("geometry.area(top) * x.y.z", "(geometry.area(top)*x.y.z)"),
        (r#""a" + "\"q\"" + "\u0041\n""#, r#"(("a"+"\"q\"")+"A\n")"#),
        ("001", "1"),
        ("a < b != (c >= d)", "((a<b)!=(c>=d))"),
    ] {
        assert_eq!(bracketed(&expression(text)), expected, "{text}");
    }
}

#[test]
fn every_form_of_the_usage_survey_parses() {
    for text in [
        "version \"2011.1\"\r\nattr h = 3\r\nLot-->extrude(h)Mass",
        "\u{feff}// Straße\nattr höhe = 3 # note\n/** doc **/ Lot --> NIL",
        "import a : \"x y.cga\"\nimport b : \"/p/q.cga\" ( h = 3, keep, c.d = h * 2, /* note */ Cap(x) --> extrude(x) Y )",
        "import a (Old, New-er) : \"f.cga\" ()",
        "@Group(\"A\", 1) @Range(0, -10)\n@Order(1)\nattr a = 1 @Hidden const b = a @Decription(\"x\") Lot --> NIL @Group",
        "@Range(min=0, max=b * 2, stepsize = 0.1, restricted=false) attr a = 1\n@Enum(\"a\", 'b, 2, valuesAttr=c) attr d = 1",
        "@Handle(shape=Box*^2, axis=y, skin=doubleArrow, translate={0,1,0}) attr a = 1\n@Order() attr b = 2",
        "style Night\nattr a = 2\nstyle Dark-Night extends Night\nattr a = 3",
        "start --> extrude(3) start(1)\nstart(x) --> NIL",
        "start Lot --> m.start(3)\nextension Cap(h) --> NIL\nstart extension --> NIL",
        "attr streetWidth(edge) = 0\nA.B(x, y) --> t(x, y, 0) imp.Rule imp.start(3) C.",
        "A --> 50% : B 25 % : C else : 30% : D else : E",
        "A --> share % : B else : C\nshare = 20",
        "A --> (a + b) % : B.\n(c)% : D. else : E.",
        "A --> B C(1). D.(2) E. }".trim_end_matches('}'),
        "A --> split ( x ) \n { 1 : B | ~ h : C | '(0.5) : D | ' 1 : E | ~-1 : NIL | { ~f(1) : G } * } *",
        "A --> split(x) { B | 1 : C | }",
        "A --> split(u, unitSpace, 0) { 1 : B }* split(x, noAdjust) { ~1 : C }",
        "A --> comp(f) { street.front : B | top = C | 0 : D | side =: E | isTagged(\"a.b\") && !top : F } G",
        "A --> setback(2) { streetSide : B | remainder : C } shapeL(1, 2) { shape : D | remainder : NIL }",
        "A --> scatter(surface, 10, gaussian, center, '0.2) { B } innerRect C",
        "A --> inline(append) B(1) inline { C. } inline comp(f) { all : D. } modify(v) { 0 : t(0,0,1) E. }",
        "A --> union { B. | C } subtract B intersect(swap) C",
        "A --> lib(h = 3, Cap --> extrude(1)).Rule(2) lib( ).Other",
        "A --> splitAndSetbackPerimeter('0.1) { 10 : 1 : B | { ~1 : 0 : NIL }* } { remainder : R }",
        "A --> set(material.colormap, case a : \"x\" else : \"y\") [ case a : B else : [ C ] ] reverseNormals",
        "A --> setupProjection(0, scope.xy, ~2, '1, '-.5, 0) projectUV(0) s('1, '1, '-1) t(\u{2019}0.5, 0, 0)",
        "A(x) with ( y := x / 2 z := y * 2 ) --> B(z)\nf() = 3\ng(h) with(k := h) = k",
        "attribute1 = 3 constant = 4\nattr import1 = 2\nA --> case1 NILx truex",
        "A -->\nB --> case x : else : NIL",
        "const s = \"#ff8800 // no /* comment\" A --> NIL",
        "",
        "// only a comment",
    ] {
        accept(text);
    }
}

#[test]
fn a_case_chain_takes_its_own_else() {
    let ast = accept("A --> case a : case b : B else : C case d : D else : E");
    let DeclarationKind::Rule(rule) = &ast.declarations[0].kind else { panic!("a rule") };
    let Successor::Case { branches, otherwise } = &rule.successor else { panic!("a chain") };
    assert_eq!(branches.len(), 2);
    assert!(matches!(branches[0].1, Successor::Case { .. }));
    assert!(matches!(&**otherwise, Successor::Sequence(items) if items.len() == 1));
}

#[test]
fn a_split_keeps_prefixes_groups_and_the_star() {
    let ast = accept("A --> split(y) { '0.5 : B | { ~1 : C | 2 : D }* } E");
    let DeclarationKind::Rule(rule) = &ast.declarations[0].kind else { panic!("a rule") };
    let Successor::Sequence(items) = &rule.successor else { panic!("a sequence") };
    assert_eq!(items.len(), 2);
    let ItemKind::Split { block, .. } = &items[0].kind else { panic!("a split") };
    assert!(!block.repeat && matches!(&block.parts[1], Part::Group(inner) if inner.repeat && inner.parts.len() == 2));
}

#[test]
fn a_declaration_ends_where_the_next_begins() {
    let ast = accept("attr a = b\nc = 3\nLot --> color(c) c\nd(x) = x\nconst e = 1 F --> NIL");
    let kinds: Vec<&str> = ast
        .declarations
        .iter()
        .map(|d| match &d.kind {
            DeclarationKind::Definition(d) => match d.kind {
                DefinitionKind::Attr => "attr",
                DefinitionKind::Const => "const",
                DefinitionKind::Function => "function",
            },
            DeclarationKind::Rule(_) => "rule",
            _ => "other",
        })
        .collect();
    assert_eq!(kinds, ["attr", "function", "rule", "function", "const", "rule"]);
}

#[test]
fn five_mistakes_give_five_errors() {
    let found = messages(
        "attr a = \nLot --> extrude(5 Mass\nMass --> comp(f) { top  Roof | side : W }\nRoof --> split(x) { 1 : A\nattr b == 3\nW --> color(\"#fff)\nX --> NIL\n",
    );
    let lines: Vec<&str> = found.iter().map(|m| m.split(':').next().expect("a line")).collect();
    assert_eq!(lines, ["2", "2", "3", "5", "5", "6"], "{found:#?}");
}

#[test]
fn a_missing_parenthesis_says_what_was_expected() {
    let found = messages("A --> extrude(3\nB --> NIL");
    assert_eq!(found, ["2: expected `,` or `)`, found `B`"]);
}

#[test]
fn deep_nesting_is_an_error_not_an_overflow() {
    for text in [
        format!("f = {}1{}", "(".repeat(20_000), ")".repeat(20_000)),
        format!("f = {}1", "-".repeat(20_000)),
        format!("f = {}1", "1+".repeat(20_000)),
        format!("f = a{}", "[0]".repeat(20_000)),
        format!("A --> {}B{}", "[".repeat(10_000), "]".repeat(10_000)),
        format!("A --> {}B", "case a : ".repeat(10_000)),
        format!("A --> {}B", "1 % : ".repeat(10_000)),
        format!("A --> {}B", "inline ".repeat(10_000)),
        format!("A --> {}", "split(x){1:".repeat(5_000)),
    ] {
        assert!(read(&text).1.has_errors(), "{}", &text[..20]);
    }
}

#[test]
fn an_unclosed_chain_takes_no_exponential_time() {
    for text in [
        format!("A --> {}B", "case a : ".repeat(40)),
        format!("A --> {}B", "1 % : ".repeat(40)),
        format!("f = {}b", "case a : ".repeat(40)),
        format!("f = {}b", "1 % : ".repeat(40)),
        format!("A --> {}B", "split(x) { a : ".repeat(40)),
        format!("A --> {}B", "comp(f) { top : ".repeat(40)),
        format!("A --> {}B", "split(x) { comp(f) { top : ".repeat(40)),
        format!("A --> {}B", "union { ".repeat(40)),
        format!("A --> {}B", "i(b --> ".repeat(40)),
        format!("f = {}1", "comp(f) { a : ".repeat(40)),
        format!("f = {}1", "g(".repeat(40)),
        format!("f = {}1", "[1:".repeat(40)),
    ] {
        assert!(read(&text).1.has_errors(), "{}", &text[..20]);
    }
}

#[test]
fn long_flat_chains_are_no_nesting() {
    let chain = "case a == 1 : B ".repeat(1000);
    accept(&format!("A --> {chain} else : C"));
    accept(&format!("A --> {} D", "case a : B else : ".repeat(100)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn any_text_gives_a_tree_or_errors(text in "\\PC{0,200}") {
        read(&text);
    }

    #[test]
    fn a_damaged_text_gives_a_tree_or_errors(cut in 0usize..2000, length in 0usize..30, put in "[\\[\\](){}|\"':=*%.~ -]{0,3}") {
        let text = include_str!("../../../rules/residential.cga");
        let floor = |mut at: usize| {
            at = at.min(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let (from, to) = (floor(cut), floor(cut + length));
        let (_, diagnostics, sources) = read(&format!("{}{put}{}", &text[..from], &text[to..]));
        for diagnostic in diagnostics.iter() {
            prop_assert!(!crate::diagnostics::render(diagnostic, &sources, false).is_empty());
        }
    }

    #[test]
    fn any_salad_of_tokens_gives_a_tree_or_errors(tokens in prop::collection::vec(prop::sample::select(vec![
        "attr", "const", "import", "style", "case", "else", ":", "=", "==", "-->", "(", ")", "{", "}", "[", "]", "|", "*",
        "'", "~", "%", "1", ".5", "\"s\"", "\"", "A", "b", "x.y", ".", ",", ";", "NIL", "split(x)", "comp(f)", "with",
        ":=", "@Range", "@", "+", "-", "!", "true", "//c\n", "#c\n", "/*", "*/", "\n", "inline", "union", "é",
    ]), 0..60)) {
        read(&tokens.join(" "));
    }
}
