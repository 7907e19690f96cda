//! In: any bytes. Out: nothing, or a panic where parsing or formatting breaks its word.

use crate::cga::ast::Ast;
use crate::cga::{CompileOptions, compile_text, format, parse};
use crate::diagnostics::render;
use crate::parsing::decode;
use crate::source::SourceMap;

/// Longest text, in bytes: longer ones are slow to run and say no more.
pub const LONGEST: usize = 20_000;

/// Messages drawn per text: drawing is slower than finding.
pub const SHOWN: usize = 5;

/// Parses and formats: every message can be shown, formatting twice changes nothing more, the tree stays.
pub fn parse_and_format(bytes: &[u8]) {
    let text = decode(bytes).text;
    let mut sources = SourceMap::default();
    let file = sources.add("fuzz.cga", text);
    let (ast, diagnostics) = parse::parse(&file);
    for diagnostic in diagnostics.iter().take(SHOWN) {
        assert!(!render(diagnostic, &sources, false).is_empty());
    }
    if diagnostics.has_errors() {
        assert!(format(&file).is_err());
        return;
    }
    let once = format(&file).expect("a file without errors is formatted");
    let once = sources.add("once.cga", once);
    let again = format(&once).expect("a formatted file has no errors");
    assert_eq!(again, &*once.text, "formatting twice");
    let (formatted, _) = parse::parse(&once);
    assert_eq!(without_places(&formatted), without_places(&ast), "the tree");
}

/// Compiles a text.
pub fn check(text: &str) {
    let mut sources = SourceMap::default();
    let (_, diagnostics) = compile_text("fuzz.cga", text, &mut sources, &CompileOptions::default());
    for diagnostic in diagnostics.iter().take(SHOWN) {
        assert!(!render(diagnostic, &sources, false).is_empty());
    }
}

fn without_places(ast: &Ast) -> String {
    let full = format!("{:?}", (&ast.version, &ast.declarations, &ast.trailing));
    let mut out = String::new();
    let mut rest = &*full;
    while let Some(at) = rest.find("Span { ") {
        out.push_str(&rest[..at]);
        rest = &rest[at + rest[at..].find('}').expect("a span is closed") + 1..];
    }
    out + rest
}
