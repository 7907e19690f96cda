//! A compatibility report for people. In: a [`Report`]. Out: a headline, what is supported, a line per finding.

use std::fmt::Write;

use super::{Outcome, Report, Verdict};

pub fn text(report: &Report) -> String {
    let version = report.version.as_ref().map_or("no version".to_owned(), |v| format!("version {v}"));
    let fares = match report.outcome() {
        Outcome::Runs => "runs as in CityEngine",
        Outcome::Differs => "runs with other results",
        Outcome::Lacks => "lacks something",
        Outcome::Broken => "broken",
    };
    let uses: usize = report.supported.values().sum();
    let mut out = format!(
        "{} ({version}): {fares}\n  supported: {} built-ins, used {uses} times\n",
        report.file,
        report.supported.len()
    );
    for finding in &report.findings {
        let verdict = match finding.verdict {
            Verdict::Changed => "changed",
            Verdict::Deprecated => "deprecated",
            Verdict::Missing => "missing",
            Verdict::Wrong => "wrong",
        };
        let times = if finding.count > 1 { format!(" ({} times)", finding.count) } else { String::new() };
        let place = format!("{}:{}:{}", finding.file, finding.line, finding.column);
        writeln!(out, "  {verdict}: {place}: {}{times} [{}]", finding.message, finding.code)
            .expect("writing to a string cannot fail");
    }
    out
}
