//! What the user got wrong: stable code, span, terse message, help; many per run.
//!
//! In: mistakes found by any phase. Out: a [`Diagnostics`] list, rendered for people by [`render`] or as JSON lines.

mod explain;
mod render;
mod suggest;

use crate::source::Span;

pub use explain::{explain, pages};
pub use render::{Rendered, json_line, render, short_line};
pub use suggest::suggest;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    Warning,
    Error,
}

/// One mistake in the user's text.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Stable, such as `cga::unknown-operation`.
    pub code: &'static str,
    pub severity: Severity,
    /// One line, no full stop, names quoted with backticks.
    pub message: String,
    pub span: Span,
    /// What the label under the span says; the message where it is empty.
    pub label: String,
    pub help: Option<String>,
}

impl Diagnostic {
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { code, severity: Severity::Error, message: message.into(), span, label: String::new(), help: None }
    }

    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Diagnostic { severity: Severity::Warning, ..Diagnostic::error(code, span, message) }
    }

    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// The mistakes of one run in the order they were found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
}

impl Diagnostics {
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.list.push(diagnostic);
    }

    pub fn extend(&mut self, other: Diagnostics) {
        self.list.extend(other.list);
    }

    pub fn retain(&mut self, keep: impl FnMut(&Diagnostic) -> bool) {
        self.list.retain(keep);
    }

    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|d| d.severity == Severity::Error)
    }

    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Orders by place and drops repeats, so that output does not depend on the order of checks.
    pub fn sorted(mut self) -> Self {
        self.list.sort_by(|a, b| (a.span, a.code, &a.message).cmp(&(b.span, b.code, &b.message)));
        self.list.dedup();
        self
    }
}
