//! In: a decoded rule file. Out: its [`Ast`] and the syntax errors; after an error reading goes on at the next
//! declaration, so that one file shows all its mistakes at once.

mod build;
mod declarations;
mod expressions;
mod resume;
mod successors;
#[cfg(test)]
mod tests;
mod wording;

use pest::Parser;
use pest::error::{Error, InputLocation};

use super::ast::Ast;
use super::codes;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::parsing::{Origin, syntax_error};
use crate::source::{SourceFile, Span};
use build::Builder;

/// Syntax errors shown per file; later ones are mostly echoes of earlier ones.
const MAX_ERRORS: usize = 50;

/// The pest parser of grammar/lexical.pest and grammar/cga.pest.
mod grammar {
    #![allow(missing_docs)]

    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/lexical.pest"]
    #[grammar = "../grammar/cga.pest"]
    pub struct Grammar;
}

pub(super) use grammar::{Grammar, Rule};

/// Parses a whole file. The tree holds every declaration that could be read.
///
/// Deeply nested text is refused, not overflowed: pest watches the stack, and the tree has a depth limit of its own.
pub fn parse(file: &SourceFile) -> (Ast, Diagnostics) {
    let text = &*file.text;
    let mut builder = Builder::new(file);
    let mut at = 0;
    for _ in 0..MAX_ERRORS {
        let rest = &text[at..];
        builder.origin = Origin { source: file.id, offset: at };
        if let Ok(pairs) = Grammar::parse(Rule::declarations, rest) {
            let mut end = 0;
            for pair in pairs.flat_map(|root| root.into_inner()).filter(|p| p.as_rule() == Rule::declaration) {
                end = pair.as_span().end();
                builder.declaration(pair);
            }
            at += end;
        }
        let rest = &text[at..];
        if Grammar::parse(Rule::end, rest).is_ok() {
            break;
        }
        // Read the declaration that did not fit once more, alone, for its error.
        let Err(error) = Grammar::parse(Rule::one_declaration, rest) else { break };
        let origin = Origin { source: file.id, offset: at };
        let (diagnostic, from) = explain(file, rest, origin, &error);
        builder.diagnostics.push(diagnostic);
        // Look from the start of the line: in "attr a = <newline> Lot --> ..." the error is found at the arrow.
        let line = text[..from].rfind('\n').map_or(0, |newline| newline + 1);
        at = resume::next_declaration(text, if line > at { line } else { from.max(at + 1) });
    }
    builder.finish()
}

/// The diagnostic for a failed declaration and the offset in the file where to look for the next one.
fn explain(file: &SourceFile, rest: &str, origin: Origin, error: &Error<Rule>) -> (Diagnostic, usize) {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    if let Some(start) = resume::string_over_lines(rest, at) {
        let start = origin.offset + start;
        let end = file.text[start..].find('\n').map_or(file.text.len(), |length| start + length);
        let span = Span::new(file.id, start, end);
        let diagnostic = Diagnostic::error(codes::SYNTAX, span, "this string is not closed on its line")
            .help("put a `\"` at its end");
        return (diagnostic, end);
    }
    (syntax_error(codes::SYNTAX, error, rest, origin, wording::wording), origin.offset + at)
}
