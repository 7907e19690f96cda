//! In: a pest error and the text. Out: one diagnostic, "expected ..., found ...".

use pest::RuleType;
use pest::error::{Error, ErrorVariant, InputLocation};

use super::Origin;
use crate::diagnostics::Diagnostic;
use crate::source::Span;

/// How a message names a rule that would have fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    Strong(&'static str),
    /// Named only where nothing strong would have fitted.
    Weak(&'static str),
    Silent,
}

/// How a grammar's rules are named in messages.
pub type Wording<R> = fn(&R) -> Expected;

/// Words a failed parse. `text` is the slice that was parsed; `origin` says where it lies.
pub fn syntax_error<R: RuleType>(
    code: &'static str,
    error: &Error<R>,
    text: &str,
    origin: Origin,
    wording: Wording<R>,
) -> Diagnostic {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => skip_layout(text, at),
    };
    let (found, length) = token(&text[at..]);
    let span = Span::new(origin.source, origin.offset + at, origin.offset + at + length);
    match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => {
            let expected = expected(positives, wording);
            let message = match expected.is_empty() {
                true => format!("unexpected {found}"),
                false => format!("expected {expected}, found {found}"),
            };
            Diagnostic::error(code, span, message)
        }
        ErrorVariant::CustomError { message } => {
            Diagnostic::error(code, span, format!("the text is nested too deeply to be read ({message})"))
        }
    }
}

/// The rules that would have fitted as "a, b or c"; empty if none has a name.
pub fn expected<R: RuleType>(rules: &[R], wording: Wording<R>) -> String {
    let (mut strong, mut weak) = (Vec::new(), Vec::new());
    for rule in rules {
        let (list, word) = match wording(rule) {
            Expected::Strong(word) => (&mut strong, word),
            Expected::Weak(word) => (&mut weak, word),
            Expected::Silent => continue,
        };
        if !list.contains(&word) {
            list.push(word);
        }
    }
    let words = if strong.is_empty() { weak } else { strong };
    match words.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}

/// Moves past white space and comments, where pest may have stopped.
fn skip_layout(text: &str, mut at: usize) -> usize {
    loop {
        let rest = &text[at..];
        let skipped = if rest.starts_with("//") || rest.starts_with('#') {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(0, |end| end + 2)
        } else {
            rest.len() - rest.trim_start().len()
        };
        if skipped == 0 {
            return at;
        }
        at += skipped;
    }
}

/// How to name the token at the start of `rest`, and its length in bytes.
fn token(rest: &str) -> (String, usize) {
    let Some(first) = rest.chars().next() else { return ("the end of the file".to_owned(), 0) };
    if first == '"' {
        let end = rest[1..].find('"').map(|end| end + 2);
        return match end {
            Some(end) if !rest[..end].contains('\n') => ("a string".to_owned(), end),
            _ => ("a string that is not closed".to_owned(), rest.lines().next().map_or(1, str::len)),
        };
    }
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let length = match first {
        c if word(c) => rest.find(|c| !word(c)).unwrap_or(rest.len()),
        '-' if rest.starts_with("-->") => 3,
        _ if ["==", "!=", "<=", ">=", "&&", "||", ":=", "=:"].iter().any(|o| rest.starts_with(o)) => 2,
        c => c.len_utf8(),
    };
    (format!("`{}`", &rest[..length]), length)
}
