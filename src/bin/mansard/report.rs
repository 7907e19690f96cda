//! How the program says what went wrong. In: failures. Out: text on standard error and the exit code.

use std::io::IsTerminal;
use std::process::ExitCode;

use mansard::diagnostics::{Diagnostics, Severity, render};
use mansard::pipeline::PipelineError;
use mansard::source::SourceMap;

use crate::{UNABLE, WRONG};

/// Why a command ends without success. What is worth saying was said or is in `message`.
#[derive(Debug)]
pub struct Failure {
    pub code: u8,
    pub message: Option<String>,
}

impl Failure {
    /// The input is wrong.
    pub fn wrong(message: impl Into<String>) -> Self {
        Failure { code: WRONG, message: Some(message.into()) }
    }

    /// The command line is wrong or the machine cannot do it.
    pub fn unable(message: impl Into<String>) -> Self {
        Failure { code: UNABLE, message: Some(message.into()) }
    }

    /// Everything was said already.
    pub fn said() -> Self {
        Failure { code: WRONG, message: None }
    }

    pub fn report(self) -> ExitCode {
        if let Some(message) = self.message {
            eprintln!("error: {message}");
        }
        ExitCode::from(self.code)
    }
}

/// Prints diagnostics as pictures of their places, errors last so that they stay in sight.
pub fn print(diagnostics: &Diagnostics, sources: &SourceMap) {
    let colour = std::io::stderr().is_terminal();
    for severity in [Severity::Warning, Severity::Error] {
        for diagnostic in diagnostics.iter().filter(|d| d.severity == severity) {
            eprint!("{}", render(diagnostic, sources, colour));
        }
    }
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    let warnings = diagnostics.iter().count() - errors;
    if errors + warnings > 0 {
        eprintln!("{errors} errors, {warnings} warnings");
    }
}

/// A pipeline's error as this program's failure; diagnostics are printed.
pub fn failure(error: PipelineError, sources: &SourceMap) -> Failure {
    let code = error.exit_code();
    match error {
        PipelineError::Diagnostics(diagnostics) => {
            print(&diagnostics, sources);
            Failure { code, message: None }
        }
        other => Failure { code, message: Some(chain(&other)) },
    }
}

/// An error with its causes, each said once.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(inner) = cause {
        let said = inner.to_string();
        if !text.contains(&said) {
            text.push_str(": ");
            text.push_str(&said);
        }
        cause = inner.source();
    }
    text
}
