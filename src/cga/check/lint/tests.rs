//! What each check finds, and next to it what it must leave alone.

use crate::cga::{CompileOptions, compile_text};
use crate::source::SourceMap;

/// Codes and places of the warnings and errors of a text.
fn found(text: &str) -> Vec<(&'static str, &str)> {
    let (_, diagnostics) = compile_text("test.cga", text, &mut SourceMap::default(), &CompileOptions::default());
    diagnostics.iter().map(|d| (d.code, &text[d.span.start as usize..d.span.end as usize])).collect()
}

#[track_caller]
fn silent(text: &str) {
    assert_eq!(found(text), [], "{text}");
}

#[test]
fn rules_no_start_rule_leads_to() {
    const CODE: &str = "cga::unused-rule";
    assert_eq!(
        found("@StartRule A --> B B --> NIL C --> D D --> C1. E --> B"),
        [(CODE, "C"), (CODE, "D"), (CODE, "E")]
    );
    silent("A --> B B --> NIL C --> NIL");
    silent("@StartRule A --> split(x) { 1 : [ B ] } B --> comp(f) { all : C } C --> NIL Lot --> NIL");
    silent("@StartRule A --> NIL extension C --> D D --> NIL");
}

#[test]
fn recursion_without_a_condition() {
    const CODE: &str = "cga::endless-recursion";
    assert_eq!(found("A --> t(1, 0, 0) A"), [(CODE, "A")]);
    assert_eq!(found("A --> [ B ] B --> case p(0.5) : A else : split(x) { 1 : A }"), [(CODE, "A")]);
    assert_eq!(found("A --> comp(f) { all : A }"), [(CODE, "A")]);
    assert_eq!(found("A --> split(x) { '1 : A }"), [(CODE, "A")]);
    assert_eq!(found("f(x) = g(x) + 1 g(x) = case f(x) > 1 : 2 else : 3"), [(CODE, "f")]);
    silent("A --> case scope.sx > 1 : split(x) { 1 : A } else : NIL");
    silent("A --> split(x) { 1 : B. | ~1 : A }");
    silent("A --> split(x) { '0.5 : A | ~1 : B. }");
    silent("A --> 50% : A else : NIL");
    silent("A --> comp(f) { top : A }");
    silent("f(n) = case n <= 1 : 1 else : n * f(n - 1)");
    silent("f(n) = n > 1 && f(n - 1)");
}

#[test]
fn branches_that_are_never_taken() {
    const CODE: &str = "cga::unreachable";
    assert_eq!(found("A --> case true : B. case scope.sx > 1 : C. else : D."), [(CODE, "true")]);
    assert_eq!(found("A --> case 1 > 2 : B. else : D."), [(CODE, "1 > 2")]);
    assert_eq!(found("A(x) --> case x > 1 : B. case x>1 : C. else : D."), [(CODE, "x>1")]);
    assert_eq!(found("A --> 100% : B. 0% : C. else : D."), [(CODE, "0")]);
    assert_eq!(found("A(w) --> 60% : B. 40% : C. w% : D. else : NIL"), [(CODE, "w")]);
    assert_eq!(found("A --> comp(f) { top : B. | all : C. | side : D. }"), [(CODE, "side")]);
    assert_eq!(found("A --> comp(f) { top : B. | top : C. }"), [(CODE, "top")]);
    assert_eq!(found("f(x) = case x > 1 : 2 case x > 1 : 3 else : 4"), [(CODE, "x > 1")]);
    silent("A --> case p(0.5) : B. case p(0.5) : C. else : D.");
    silent("f = rand A --> case f > 0.5 : B. case f > 0.5 : C. else : D.");
    silent("const debug = false A --> case debug : B. else : D.");
    silent("A --> 50% : B. 50% : C. else : D.");
    silent("A --> setback(1) { front : B. | all : C. | remainder : D. }");
}

#[test]
fn parts_that_are_never_made() {
    const CODE: &str = "cga::never-fits";
    assert_eq!(found("A --> split(x) { -1 : B. | ~1 : C. }"), [(CODE, "-1")]);
    assert_eq!(found("A --> split(x) { '0.5 : B. | '0.5 : C. | 2 : D. }"), [(CODE, "2")]);
    assert_eq!(found("A --> s(5, 1, 1) split(x) { 3 : B. | 2 : C. | ~1 : D. | 1 : E. }"), [(CODE, "1"), (CODE, "1")]);
    assert_eq!(found("A --> split(x) { 2 : split(x) { 3 : B. | 1 : C. } }"), [(CODE, "1")]);
    assert_eq!(found("A --> split(x) { ~1 : B. | '1 : C. }"), [(CODE, "1")]);
    silent("A --> split(x) { 3 : B. | 2 : C. | ~1 : D. }");
    silent("A --> s(5, 1, 1) split(y) { 3 : B. }");
    silent("A --> s(5, 1, 1) extrude(3) split(x) { 9 : B. | 1 : C. }");
    silent("A --> split(x) { 2 : split(z) { 3 : B. | 1 : C. } }");
    silent("A --> split(x) { { 2 : B. | 3 : C. }* | 1 : D. }");
}

#[test]
fn constructs_that_changed_after_the_file_s_version() {
    const CODE: &str = "cga::changed-meaning";
    assert_eq!(
        found("version \"2009.1\" A --> s(-1, '1, '1) extrude(2) extrude(3)"),
        [(CODE, "-1"), (CODE, "extrude")]
    );
    assert_eq!(found("version \"2012.1\" attr a = geometry.area A --> extrude(a)"), [(CODE, "geometry.area")]);
    assert_eq!(found("version \"2022.0\" A --> offset(-1)"), [(CODE, "offset")]);
    silent("version \"2025.1\" attr a = geometry.area A --> s(-1, '1, '1) extrude(a) offset(-1)");
    silent("A --> s(-1, '1, '1) extrude(2)");
}

#[test]
fn operations_behind_the_last_shape() {
    const CODE: &str = "cga::no-effect";
    assert_eq!(found("A --> B. t(1, 0, 0) s(1, 1, 1)"), [(CODE, "t(1, 0, 0)")]);
    assert_eq!(found("A --> [ B. ] t(0, 3, 0) roofHip(30)"), [(CODE, "t(0, 3, 0)")]);
    assert_eq!(found("A --> [ t(1, 0, 0) ] B."), [(CODE, "t(1, 0, 0)")]);
    assert_eq!(found("A --> case scope.sx > 1 : NIL color(\"#fff\") else : extrude(3)"), [(CODE, "color(\"#fff\")")]);
    assert_eq!(found("A --> comp(f) { top : B. extrude(1) }"), [(CODE, "extrude(1)")]);
    assert_eq!(found("attr h = 1 A --> B. set(h, 2)"), [(CODE, "set(h, 2)")]);
    silent("A --> [ t(1, 0, 0) B. ] t(2, 0, 0) C.");
    silent("A --> B. report(\"n\", 1)");
    silent("A --> B. label(\"b\")");
    silent("A --> [ report(\"n\", 1) ] extrude(3) inline { t(1, 0, 0) }");
    silent("A --> B. inline { report(\"n\", 1) }");
    silent("A --> extrude(3)");
}
