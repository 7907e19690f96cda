//! In: a rule file. Out: readable text of its syntax tree or of the compiled program, for `mansard dump`.

use std::fmt::Write;
use std::path::Path;

use super::check::{CompileOptions, compile};
use super::parse::parse;
use super::program::Program;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::parsing::decode;
use crate::source::{Access, MOST_TEXT_BYTES, SourceMap, Span};

/// The tree of one file as nested text, one node per line; imports are not read.
pub fn dump_ast(path: &Path, access: &Access, sources: &mut SourceMap) -> (Option<String>, Diagnostics) {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    match access.read(folder, &name, MOST_TEXT_BYTES) {
        Ok((_, bytes)) => {
            let file = sources.add(path.display().to_string(), decode(&bytes).text);
            let (ast, diagnostics) = parse(&file);
            (Some(format!("{ast:#?}\n")), diagnostics)
        }
        Err(error) => {
            let file = sources.add(path.display().to_string(), "");
            let mut diagnostics = Diagnostics::default();
            let span = Span::new(file.id, 0, 0);
            diagnostics.push(Diagnostic::error(super::codes::UNREADABLE_FILE, span, error.to_string()));
            (None, diagnostics)
        }
    }
}

/// The compiled program: its attributes in the order of evaluation, its functions and its rules with their ids.
pub fn dump_program(path: &Path, access: &Access, sources: &mut SourceMap) -> (Option<String>, Diagnostics) {
    let (program, diagnostics) = compile(path, access, sources, &CompileOptions::default());
    (program.map(|program| program_text(&program)), diagnostics)
}

fn program_text(program: &Program) -> String {
    let mut out = String::new();
    for id in program.initial_order() {
        let attribute = program.attribute(*id);
        let word = if attribute.is_const { "const" } else { "attr" };
        let kind = attribute.kind.map_or_else(|| "?".to_owned(), |kind| format!("{kind:?}"));
        write_node(&mut out, &format!("{word} #{} {}: {kind}", id.0, attribute.name), &attribute.default.kind);
    }
    for (id, function) in program.functions().iter().enumerate() {
        write_node(&mut out, &format!("function #{id} {}", function.path), &function.body.kind);
    }
    for (id, rule) in program.rules().iter().enumerate() {
        let start = if rule.is_start { " start" } else { "" };
        write_node(&mut out, &format!("rule #{id} {}{start}", rule.path), &rule.successor);
    }
    out
}

fn write_node(out: &mut String, head: &str, node: &impl std::fmt::Debug) {
    let text = format!("{node:#?}").replace('\n', "\n    ");
    writeln!(out, "{head}\n    {text}").expect("writing to a string cannot fail");
}
