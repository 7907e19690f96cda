//! What an update did, as one JSON line. In: counts and times. Out: [`Update`].

use serde::Serialize;

use crate::diagnostics::{Diagnostic, Rendered, render};
use crate::source::SourceMap;

/// One round of bringing everything up to date.
#[derive(Clone, Debug, Serialize)]
pub struct Update {
    /// From 1.
    pub number: u64,
    /// Files that changed since the update before, as messages name them; empty in the first.
    pub changed: Vec<String>,
    pub redone: Redone,
    /// In the order they ran.
    pub phases: Vec<Phase>,
    /// Errors and warnings of this update, by place.
    pub diagnostics: Vec<Message>,
    /// The update failed, and the scene shown is that of an earlier one (or there is none yet).
    pub stands: bool,
    /// It was given up because something newer came.
    pub cancelled: bool,
    /// Of the scene shown; 0 without one.
    pub triangles: usize,
    /// Counts up whenever the scene shown is another one; 0 without one.
    pub scene: u64,
}

/// What was done again, and what was kept.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Redone {
    pub recipe: bool,
    /// Rule files compiled.
    pub programs: usize,
    /// Map and elevation.
    pub place: bool,
    /// States of features derived; one that a change touches has two.
    pub lots_derived: usize,
    pub lots_kept: usize,
    pub ground: bool,
    /// Objects put together.
    pub scene: bool,
    /// Views drawn anew: cameras, sun, effects.
    pub views: bool,
}

/// A phase and the milliseconds that it took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Phase {
    pub name: String,
    pub ms: f64,
}

impl Phase {
    pub fn new(name: impl Into<String>, seconds: f64) -> Phase {
        Phase { name: name.into(), ms: (seconds * 1e6).round() / 1e3 }
    }
}

/// A mistake of the user's, or what the world refused.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Message {
    /// Such as `cga::unknown-operation`; `error` for what has no code.
    pub code: String,
    pub severity: &'static str,
    pub message: String,
    /// `None` for what has no place in a text.
    #[serde(flatten)]
    pub place: Option<MessagePlace>,
    pub help: Option<String>,
    /// As `mansard check` prints it, without colours.
    #[serde(skip)]
    pub rendered: String,
}

/// Lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MessagePlace {
    pub file: String,
    pub line: usize,
    pub column: usize,
    pub end_line: usize,
    pub end_column: usize,
}

impl Message {
    pub fn new(diagnostic: &Diagnostic, sources: &SourceMap) -> Message {
        let Rendered { code, severity, message, file, line, column, end_line, end_column, help } =
            Rendered::new(diagnostic, sources);
        let place = MessagePlace { file: file.to_owned(), line, column, end_line, end_column };
        Message {
            code: code.to_owned(),
            severity: if severity == "warning" { "warning" } else { "error" },
            message: message.to_owned(),
            place: Some(place),
            help: help.map(str::to_owned),
            rendered: render(diagnostic, sources, false),
        }
    }

    /// What has no place in a text.
    pub fn plain(message: impl Into<String>) -> Message {
        let message = message.into();
        let rendered = format!("error: {message}\n");
        Message { code: "error".to_owned(), severity: "error", message, place: None, help: None, rendered }
    }

    pub fn is_error(&self) -> bool {
        self.severity != "warning"
    }
}

impl Update {
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Message::is_error)
    }

    /// One line of JSON.
    pub fn json_line(&self) -> String {
        serde_json::to_string(self).expect("plain strings and numbers serialise")
    }
}
