//! In: a failed declaration. Out: one diagnostic, "expected ..., found ...", and where its mistake lies.

use pest::error::{Error, ErrorVariant, InputLocation};

use super::Rule;
use super::tokens::{MAX_BRACKETS, Tokens, letter};
use super::wording::wording;
use crate::cga::codes;
use crate::diagnostics::Diagnostic;
use crate::parsing::expected;
use crate::source::{SourceFile, Span};

/// A declaration that could not be read: it begins at token `first`.
pub struct Reading<'f> {
    pub file: &'f SourceFile,
    pub tokens: &'f Tokens,
    pub first: usize,
}

pub struct Problem {
    pub diagnostic: Diagnostic,
    /// The token that did not fit.
    pub token: usize,
    /// Where reading goes on after a string that is not closed: the tokens behind it are wrong.
    pub unclosed_until: Option<usize>,
}

pub fn explain(reading: &Reading<'_>, error: &Error<Rule>) -> Problem {
    let token = reading.first
        + match error.location {
            InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
        };
    if let Some(string) = reading.open_string(token) {
        return unclosed_string(reading.file, string, token);
    }
    let span = reading.tokens.span(reading.file, token, token + 1);
    let message = match &error.variant {
        _ if reading.tokens.letter(token) == letter::TOO_DEEP => {
            let message = format!("more than {MAX_BRACKETS} brackets within each other");
            return Problem { diagnostic: too_deep(span, message), token, unclosed_until: None };
        }
        ErrorVariant::CustomError { .. } => {
            let message = "this is nested too deeply to be read".to_owned();
            return Problem { diagnostic: too_deep(span, message), token, unclosed_until: None };
        }
        ErrorVariant::ParsingError { positives, .. } => match expected(&without_parts(positives), wording) {
            expected if expected.is_empty() => format!("unexpected {}", reading.found(token)),
            expected => format!("expected {expected}, found {}", reading.found(token)),
        },
    };
    let positives = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => &positives[..],
        ErrorVariant::CustomError { .. } => &[],
    };
    let mut diagnostic = Diagnostic::error(codes::SYNTAX, span, message);
    if let Some(help) = reading.help(token, positives) {
        diagnostic = diagnostic.help(help);
    }
    Problem { diagnostic, token, unclosed_until: None }
}

/// Where any expression fits, a string by itself is not worth naming.
fn without_parts(expected: &[Rule]) -> Vec<Rule> {
    let any_expression = expected.contains(&Rule::number);
    expected.iter().copied().filter(|kind| !any_expression || *kind != Rule::string).collect()
}

fn too_deep(span: Span, message: String) -> Diagnostic {
    Diagnostic::error(codes::TOO_DEEP, span, message).help("move the inner part into a rule or function")
}

fn unclosed_string(file: &SourceFile, start: usize, token: usize) -> Problem {
    let end = file.text[start..].find('\n').map_or(file.text.len(), |length| start + length);
    let span = Span::new(file.id, start, end);
    let diagnostic =
        Diagnostic::error(codes::SYNTAX, span, "this string is not closed on its line").help("put a `\"` at its end");
    Problem { diagnostic, token, unclosed_until: Some(end) }
}

impl Reading<'_> {
    pub fn text(&self, token: usize) -> &str {
        self.tokens.text(&self.file.text, token)
    }

    /// How to name a token.
    fn found(&self, token: usize) -> String {
        match self.tokens.letter(token) {
            0 => "the end of the file".to_owned(),
            letter::STRING => "a string".to_owned(),
            _ => {
                let text = self.text(token);
                let short: String = text.chars().take(40).collect();
                if short.len() < text.len() { format!("`{short}...`") } else { format!("`{text}`") }
            }
        }
    }

    /// The offset of the first string up to `token` that runs over a line end or is never closed.
    fn open_string(&self, token: usize) -> Option<usize> {
        let is_open = |&at: &usize| match self.tokens.letter(at) {
            letter::STRING => self.text(at).contains('\n'),
            letter::STRANGE => self.text(at).starts_with('"'),
            _ => false,
        };
        let string = (self.first..=token).find(is_open)?;
        Some(self.tokens.places[string].start as usize)
    }
}
