//! How the program says what went wrong. In: failures. Out: text on standard error and the exit code.

use std::io::{IsTerminal, Write};
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

    /// Says what there is to say.
    pub fn tell(&self) {
        if let Some(message) = &self.message {
            eprintln!("error: {message}");
        }
    }

    pub fn report(self) -> ExitCode {
        self.tell();
        ExitCode::from(self.code)
    }
}

/// Prints what a command gives; a reader that stops listening ends it in peace.
pub fn out(text: &str) -> Result<(), Failure> {
    out_bytes(text.as_bytes())
}

/// [`out`] of any bytes.
pub fn out_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::unable(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints diagnostics as pictures of their places, errors last so that they stay in sight; `quiet` leaves warnings out.
pub fn print(diagnostics: &Diagnostics, sources: &SourceMap, quiet: bool) {
    let colour = std::io::stderr().is_terminal();
    let shown = if quiet { &[Severity::Error][..] } else { &[Severity::Warning, Severity::Error] };
    for &severity in shown {
        for diagnostic in diagnostics.iter().filter(|d| d.severity == severity) {
            eprint!("{}", render(diagnostic, sources, colour));
        }
    }
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    let warnings = diagnostics.iter().count() - errors;
    if errors > 0 || (warnings > 0 && !quiet) {
        let plural = |n: usize| if n == 1 { "" } else { "s" };
        eprintln!("{errors} error{}, {warnings} warning{}", plural(errors), plural(warnings));
    }
}

/// A pipeline's error as this program's failure; diagnostics are printed.
pub fn failure(error: PipelineError, sources: &SourceMap) -> Failure {
    let code = error.exit_code();
    match error {
        PipelineError::Diagnostics(diagnostics) => {
            print(&diagnostics, sources, false);
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
