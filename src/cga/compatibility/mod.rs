//! What a rule file written for CityEngine meets here. In: a rule file. Out: a [`Report`]: which constructs are
//! supported, which mean something else, which are old, which are missing, and what is wrong, each with its place.

mod differences;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use super::ast::{DeclarationKind, Expr, ExprKind, Item, ItemKind};
use super::ast_walk::{self, Visitor};
use super::builtins::{Attr, Function, Operation};
use super::check::check;
use super::codes;
use super::parse::parse;
use crate::diagnostics::{Diagnostic, Severity};
use crate::parsing::decode;
use crate::source::{Access, MOST_TEXT_BYTES, SourceFile, SourceMap, Span};
pub use text::text;

/// How a construct fares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Runs, with another result than in CityEngine or in the version the file was written for.
    Changed,
    /// An old name or form that works.
    Deprecated,
    /// Known CGA that is not evaluated.
    Missing,
    /// A mistake, here and most probably in CityEngine.
    Wrong,
}

/// One thing worth saying, where it is first met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    pub verdict: Verdict,
    /// A code of `docs/diagnostics.md`, or the name of a difference of `docs/from-cityengine.md`.
    pub code: String,
    pub message: String,
    /// Lines and columns count from 1; the file, because a mistake can lie in an imported one.
    pub file: String,
    pub line: usize,
    pub column: usize,
    /// How often in the file.
    pub count: usize,
}

/// The report of one file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    pub file: String,
    /// `version` as written.
    pub version: Option<String>,
    /// Built-in operations, functions and attributes that are used and supported.
    pub supported: BTreeMap<String, usize>,
    /// Missing and wrong ones first.
    pub findings: Vec<Finding>,
}

/// What can be done with a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    Runs,
    /// Runs, but with other results.
    Differs,
    /// Needs what is missing.
    Lacks,
    /// Has mistakes, or cannot be read.
    Broken,
}

impl Report {
    pub fn count(&self, verdict: Verdict) -> usize {
        self.findings.iter().filter(|f| f.verdict == verdict).count()
    }

    pub fn outcome(&self) -> Outcome {
        match self {
            _ if self.count(Verdict::Wrong) > 0 => Outcome::Broken,
            _ if self.count(Verdict::Missing) > 0 => Outcome::Lacks,
            _ if self.count(Verdict::Changed) > 0 => Outcome::Differs,
            _ => Outcome::Runs,
        }
    }
}

/// Looks at one file with all it imports. A file that cannot be read or parsed gets a report that says so.
pub fn report(path: &Path, access: &Access, sources: &mut SourceMap) -> Report {
    let name = path.display().to_string();
    let mut out = Report { file: name.clone(), version: None, supported: BTreeMap::new(), findings: Vec::new() };
    let mut uses = Uses::default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let file_name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    if let Ok((_, bytes)) = access.read(folder, &file_name, MOST_TEXT_BYTES) {
        let file = sources.add(name, decode(&bytes).text);
        let (ast, _) = parse(&file);
        out.version = ast.version.as_ref().map(|v| v.text.to_string());
        let own: Vec<&str> = ast.declarations.iter().filter_map(|d| declared(&d.kind)).collect();
        ast_walk::file(&ast, &mut uses);
        uses.names.retain(|(name, _)| !own.contains(&name.as_str()));
        differences(&uses, &file, out.version.as_deref(), &mut out.findings);
    }
    for (name, _) in &uses.names {
        if is_builtin(name) {
            *out.supported.entry(name.clone()).or_default() += 1;
        }
    }
    let mistakes = check(path, access, sources);
    mistakes.iter().for_each(|d| diagnostic(d, sources, &mut out.findings));
    let missing = |name: &str| {
        let quoted = format!("`{name}`");
        out.findings.iter().any(|f| f.verdict == Verdict::Missing && f.message.contains(&quoted))
    };
    let lacking: Vec<String> = out.supported.keys().filter(|name| missing(name)).cloned().collect();
    out.supported.retain(|name, _| !lacking.contains(name));
    out.findings.sort_by(|a, b| {
        (std::cmp::Reverse(a.verdict), &a.file, a.line, a.column, &a.code).cmp(&(
            std::cmp::Reverse(b.verdict),
            &b.file,
            b.line,
            b.column,
            &b.code,
        ))
    });
    out
}

fn declared(kind: &DeclarationKind) -> Option<&str> {
    match kind {
        DeclarationKind::Definition(definition) => Some(&definition.name.text),
        DeclarationKind::Rule(rule) => Some(&rule.name.text),
        DeclarationKind::Import(_) | DeclarationKind::Style(_) => None,
    }
}

fn is_builtin(name: &str) -> bool {
    Operation::from_name(name).is_some() || Function::from_name(name).is_some() || Attr::from_name(name).is_some()
}

/// Names of operations, functions and attributes that a file uses, and chains of percentages.
#[derive(Default)]
struct Uses {
    names: Vec<(String, Span)>,
    percentages: Vec<Span>,
    /// Names of files in formats that are not read.
    formats: Vec<Span>,
}

/// Geometry that CityEngine reads and this program does not.
const UNREAD: &[&str] = &[".fbx", ".dae", ".dwg", ".dxf", ".usd", ".usda", ".usdc", ".usdz", ".ifc", ".3ds", ".kmz"];

impl<'a> Visitor<'a> for Uses {
    fn item(&mut self, item: &'a Item) {
        let (name, span) = match &item.kind {
            ItemKind::Group(_) | ItemKind::Nil | ItemKind::Dynamic { .. } => return,
            ItemKind::Plain { name, .. } | ItemKind::Split { name, .. } | ItemKind::Selectors { name, .. } => {
                (&name.text, name.span)
            }
            ItemKind::Scatter { name, .. } | ItemKind::Perimeter { name, .. } => (&name.text, name.span),
            ItemKind::Inline { name, .. } | ItemKind::Boolean { name, .. } => (&name.text, name.span),
        };
        self.names.push((name.to_string(), span));
    }

    fn expression(&mut self, expression: &'a Expr) {
        match &expression.kind {
            ExprKind::Call { name, .. } => self.names.push((name.text.to_string(), name.span)),
            ExprKind::Stochastic { .. } => self.percentages.push(expression.span),
            ExprKind::String(text) if UNREAD.iter().any(|end| text.to_lowercase().ends_with(end)) => {
                self.formats.push(expression.span);
            }
            _ => {}
        }
    }

    fn choice(&mut self, weight: &'a Expr) {
        self.percentages.push(weight.span);
    }
}

/// What runs but gives something else than in CityEngine.
fn differences(uses: &Uses, file: &SourceFile, version: Option<&str>, out: &mut Vec<Finding>) {
    for difference in differences::all() {
        if !difference.concerns(version) {
            continue;
        }
        let named = uses.names.iter().filter(|(name, _)| difference.names.contains(&&**name)).map(|(_, span)| *span);
        let drawn = uses.percentages.iter().copied().filter(|_| difference.percentages);
        let mut places: Vec<Span> = named.chain(drawn).collect();
        places.sort();
        out.extend(finding(Verdict::Changed, difference.code, difference.message, &places, file));
    }
    let message = "assets are read as OBJ, glTF and GLB; a box stands in for this format";
    out.extend(finding(Verdict::Missing, differences::ASSET_FORMATS, message, &uses.formats, file));
}

/// All places of one kind as one finding at the first.
fn finding(verdict: Verdict, code: &str, message: &str, places: &[Span], file: &SourceFile) -> Option<Finding> {
    let place = file.place(places.first()?.start);
    Some(Finding {
        verdict,
        code: code.to_owned(),
        message: message.to_owned(),
        file: file.name.to_string(),
        line: place.line,
        column: place.column,
        count: places.len(),
    })
}

/// A mistake or warning as a finding; repeats of one message are counted. Style, such as unused rules, is left out.
fn diagnostic(diagnostic: &Diagnostic, sources: &SourceMap, out: &mut Vec<Finding>) {
    let verdict = match (diagnostic.code, diagnostic.severity) {
        (codes::DEPRECATED | codes::MISSING_SIZE, _) => Verdict::Deprecated,
        (codes::CHANGED_MEANING, _) => Verdict::Changed,
        (codes::REMOVED, _) => Verdict::Missing,
        (_, Severity::Error) => Verdict::Wrong,
        (_, Severity::Warning) => return,
    };
    let file = sources.get(diagnostic.span.source);
    let known = out.iter_mut().find(|f| {
        f.code == diagnostic.code
            && f.message == diagnostic.message
            && f.file == *file.name
            && verdict != Verdict::Wrong
    });
    if let Some(known) = known {
        known.count += 1;
        return;
    }
    let place = file.place(diagnostic.span.start);
    let mut message = diagnostic.message.clone();
    if let (Verdict::Deprecated, Some(help)) = (verdict, &diagnostic.help) {
        message = format!("{message}: {help}");
    }
    out.push(Finding {
        verdict,
        code: diagnostic.code.to_owned(),
        message,
        file: file.name.to_string(),
        line: place.line,
        column: place.column,
        count: 1,
    });
}

/// One line for a folder: how many files fare how, and how many places are concerned.
pub fn summary(reports: &[Report]) -> String {
    let of = |outcome: Outcome| reports.iter().filter(|r| r.outcome() == outcome).count();
    let sum = |verdict: Verdict| -> usize {
        reports.iter().flat_map(|r| &r.findings).filter(|f| f.verdict == verdict).map(|f| f.count).sum()
    };
    format!(
        "{} file{}: {} as in CityEngine, {} with other results, {} that lack something, {} broken; places: \
         {} changed, {} deprecated, {} missing, {} wrong",
        reports.len(),
        if reports.len() == 1 { "" } else { "s" },
        of(Outcome::Runs),
        of(Outcome::Differs),
        of(Outcome::Lacks),
        of(Outcome::Broken),
        sum(Verdict::Changed),
        sum(Verdict::Deprecated),
        sum(Verdict::Missing),
        sum(Verdict::Wrong),
    )
}
