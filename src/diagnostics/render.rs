//! In: a [`Diagnostic`] and the texts it points into. Out: a picture of the place for people (miette), or one JSON line.

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceSpan};
use serde::Serialize;

use super::{Diagnostic, Severity};
use crate::source::SourceMap;

/// Lines longer than this are not drawn: nobody could read them, and miette's columns end at 65,535.
const LONGEST_LINE: usize = 10_000;

/// A diagnostic without a picture.
fn plain(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let file = sources.get(diagnostic.span.source);
    let place = file.place(diagnostic.span.start);
    let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!("  help: {help}\n"));
    let at = format!("[{}:{}:{}]", file.name, place.line, place.column);
    format!("{}\n\n  × {}\n   {at}\n{help}", diagnostic.code, diagnostic.message)
}

/// Draws one diagnostic as miette does, with or without terminal colours.
pub fn render(diagnostic: &Diagnostic, sources: &SourceMap, colour: bool) -> String {
    let file = sources.get(diagnostic.span.source);
    if file.text.lines().any(|line| line.len() > LONGEST_LINE) {
        return plain(diagnostic, sources);
    }
    let length = (diagnostic.span.end - diagnostic.span.start) as usize;
    let at = SourceSpan::new((diagnostic.span.start as usize).into(), length);
    let label = if diagnostic.label.is_empty() { "here" } else { &diagnostic.label };
    let mut report = miette::MietteDiagnostic::new(&diagnostic.message)
        .with_code(diagnostic.code)
        .with_severity(match diagnostic.severity {
            Severity::Warning => miette::Severity::Warning,
            Severity::Error => miette::Severity::Error,
        })
        .with_label(LabeledSpan::new_with_span(Some(label.to_owned()), at));
    report.help = diagnostic.help.clone();
    let report = miette::Report::new(report).with_source_code(NamedSource::new(&*file.name, file.text.to_string()));
    let theme = if colour { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() };
    let mut out = String::new();
    GraphicalReportHandler::new_themed(theme)
        .with_links(false)
        .with_width(100)
        .render_report(&mut out, report.as_ref())
        .expect("writing to a string cannot fail");
    out
}

/// The fields of a diagnostic as `mansard check --format json` prints them; lines and columns count from 1.
#[derive(Serialize)]
pub struct Rendered<'a> {
    pub code: &'a str,
    pub severity: &'a str,
    pub message: &'a str,
    pub file: &'a str,
    pub line: usize,
    pub column: usize,
    pub end_line: usize,
    pub end_column: usize,
    pub help: Option<&'a str>,
}

impl<'a> Rendered<'a> {
    pub fn new(diagnostic: &'a Diagnostic, sources: &'a SourceMap) -> Self {
        let file = sources.get(diagnostic.span.source);
        let (start, end) = (file.place(diagnostic.span.start), file.place(diagnostic.span.end));
        Rendered {
            code: diagnostic.code,
            severity: match diagnostic.severity {
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            message: &diagnostic.message,
            file: &file.name,
            line: start.line,
            column: start.column,
            end_line: end.line,
            end_column: end.column,
            help: diagnostic.help.as_deref(),
        }
    }
}

/// One diagnostic as one line of JSON.
pub fn json_line(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    serde_json::to_string(&Rendered::new(diagnostic, sources)).expect("plain strings and numbers serialise")
}

/// One diagnostic as one line for editors: `FILE:LINE:COLUMN: error[CODE]: MESSAGE`; lines and columns count from 1.
pub fn short_line(diagnostic: &Diagnostic, sources: &SourceMap) -> String {
    let Rendered { code, severity, message, file, line, column, help, .. } = Rendered::new(diagnostic, sources);
    let help = help.map_or(String::new(), |help| format!(" ({help})"));
    format!("{file}:{line}:{column}: {severity}[{code}]: {message}{help}").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Span;

    #[test]
    fn a_mistake_in_an_endless_line_is_told_without_a_picture() {
        let mut sources = SourceMap::default();
        let file = sources.add("long.cga", format!("{}oops", " ".repeat(70_000)));
        let diagnostic = Diagnostic::error("test::code", Span::new(file.id, 70_000, 70_004), "what is this");
        let text = render(&diagnostic, &sources, false);
        assert!(text.contains("test::code") && text.contains("[long.cga:1:70001]"), "{text}");
    }

    #[test]
    fn a_short_line_is_one_line() {
        let mut sources = SourceMap::default();
        let file = sources.add("a.cga", "Lot -->\n  extrud(3)");
        let diagnostic = Diagnostic::error("cga::unknown-name", Span::new(file.id, 10, 16), "no `extrud`\nhere");
        let diagnostic = diagnostic.help("did you mean `extrude`?");
        let expected = "a.cga:2:3: error[cga::unknown-name]: no `extrud` here (did you mean `extrude`?)";
        assert_eq!(short_line(&diagnostic, &sources), expected);
    }
}
