//! In: a rule file without syntax errors. Out: the same rules in the house layout, every comment in its place.
//!
//! The house layout:
//! * lines of at most 100 characters, indented by 4; no white space at their ends; at most one empty line in a row;
//! * an empty line around every rule of more than one line; elsewhere empty lines stay as they are;
//! * annotations, attributes and rules: `@Range(min=0, max=3)`, `attr a = 1`, `Name(a, b) -->`; a body that is longer
//!   than its line, or was begun on a line of its own, stands indented below;
//! * a sequence breaks where its author broke it, and where a line is full;
//! * a chain has one line per branch, `case` and `else` below each other, percentages aligned to the right, unless it was
//!   written on one line and fits there;
//! * a block `{ a | b }` stands on one line if it fits and was begun on its line; otherwise one item per line, indented,
//!   the bars at the ends;
//! * one space around binary operators, `:` and `|`; none behind `'`, `~`, unary operators and names of calls.
//!
//! Strings, numbers and comments are never changed, but for the indentation of comments. Line ends stay LF or CRLF.

mod document;
mod expressions;
mod layout;
mod successors;
#[cfg(test)]
mod tests;
mod trivia;

use pest::Parser;

use super::parse::{Grammar, Rule, lex, parse};
use crate::diagnostics::Diagnostics;
use crate::source::SourceFile;
use layout::Layout;

/// Passes at most: comments in odd places may settle only when the lines around them have.
const MAX_PASSES: usize = 6;

/// Formats a decoded rule file. Formatting twice changes nothing more, and the syntax tree stays as it is.
///
/// Errors: the file's diagnostics if it has syntax errors; warnings alone are no reason.
pub fn format(file: &SourceFile) -> Result<String, Diagnostics> {
    let (_, diagnostics) = parse(file);
    if diagnostics.has_errors() {
        return Err(diagnostics);
    }
    let mut text = file.text.to_string();
    for _ in 0..MAX_PASSES {
        let next = pass(&text);
        if next == text {
            break;
        }
        text = next;
    }
    Ok(text)
}

fn pass(text: &str) -> String {
    let tokens = lex(text, 0);
    let pairs = Grammar::parse(Rule::declarations, &tokens.letters).expect("the file was parsed before");
    let docs = Layout { text, tokens: &tokens }.file(pairs);
    let is_windows = text.find('\n').is_some_and(|end| text[..end].ends_with('\r'));
    document::render(text, docs, if is_windows { "\r\n" } else { "\n" })
}
