//! `mansard check --cityengine`: what rule files written for CityEngine meet here. In: files and folders. Out: a report
//! per file and one line per folder. A file that is wrong is told about and never stops the others.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use mansard::cga::compatibility::{Report, report, summary, text};
use mansard::source::SourceMap;

use crate::args::{Format, RecipeOptions};
use crate::check::rule_access;
use crate::report::{self as told, Failure};

pub fn run(files: &[PathBuf], format: Format, options: &RecipeOptions) -> Result<(), Failure> {
    let mut found: Vec<PathBuf> = Vec::new();
    for file in files {
        if !file.exists() {
            return Err(Failure::wrong(format!("{}: no such file or folder", file.display())));
        }
        rule_files(file, &mut found);
    }
    if found.is_empty() {
        return Err(Failure::wrong("there is no .cga file"));
    }
    let mut reports: BTreeMap<PathBuf, Vec<Report>> = BTreeMap::new();
    for file in &found {
        let access = rule_access(file, &options.allow)?;
        let folder = file.parent().unwrap_or(Path::new("")).to_owned();
        reports.entry(folder).or_default().push(report(file, &access, &mut SourceMap::default()));
    }
    told::out(&match format {
        Format::Text => all_text(&reports),
        Format::Short => reports.iter().map(|(folder, reports)| folder_line(folder, reports)).collect(),
        Format::Json => json(&reports),
    })
}

/// A file itself, or the rule files below a folder in the order of their names. Links to folders are not followed.
fn rule_files(path: &Path, out: &mut Vec<PathBuf>) {
    if !path.is_dir() {
        return out.push(path.to_owned());
    }
    let Ok(entries) = std::fs::read_dir(path) else { return };
    let mut inside: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    inside.sort();
    for path in inside {
        let is_link = path.is_symlink();
        if path.is_dir() && !is_link || path.extension().is_some_and(|e| e == "cga") && path.is_file() {
            rule_files(&path, out);
        }
    }
}

/// Every report, and behind those of a folder its line.
fn all_text(reports: &BTreeMap<PathBuf, Vec<Report>>) -> String {
    let mut out = String::new();
    for (folder, reports) in reports {
        reports.iter().for_each(|report| out.push_str(&text(report)));
        out.push_str(&folder_line(folder, reports));
    }
    out
}

fn folder_line(folder: &Path, reports: &[Report]) -> String {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    format!("{}: {}\n", folder.display(), summary(reports))
}

/// One object per file, then one per folder, each on a line.
fn json(reports: &BTreeMap<PathBuf, Vec<Report>>) -> String {
    let mut out = String::new();
    for (folder, reports) in reports {
        for report in reports {
            let value = serde_json::json!({ "report": report, "outcome": report.outcome() });
            writeln!(out, "{value}").expect("writing to a string cannot fail");
        }
        let value = serde_json::json!({ "folder": folder.display().to_string(), "summary": summary(reports) });
        writeln!(out, "{value}").expect("writing to a string cannot fail");
    }
    out
}
