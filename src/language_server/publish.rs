//! In: a checked file. Out: its diagnostics as the editor shows them: those in the file itself, and one where it names
//! another file that has errors.

use std::path::Path;
use std::str::FromStr;

use lsp_types::{
    CodeDescription, Diagnostic as Shown, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location,
    NumberOrString, Range, Uri,
};

use super::position::{Lines, line_starts};
use super::recipe_file::{Meaning, RecipeFile};
use super::rule_file::RuleFile;
use super::uri;
use super::workspace::{Language, Workspace};
use crate::cga::codes;
use crate::diagnostics::{Diagnostic, Severity};
use crate::source::{SourceFile, SourceMap, Span};

/// All diagnostics of a document.
pub fn diagnostics(workspace: &mut Workspace, path: &Path) -> Vec<Shown> {
    match Language::of(path) {
        Some(Language::Rules) => {
            let file = workspace.rules(path);
            file.map_or_else(Vec::new, |file| of_rules(workspace, &file))
        }
        Some(Language::Recipe) => {
            let file = workspace.recipe(path);
            of_recipe(workspace, path, &file)
        }
        None => Vec::new(),
    }
}

fn of_rules(workspace: &Workspace, file: &RuleFile) -> Vec<Shown> {
    let Some(main) = file.main() else { return Vec::new() };
    let lines = file.lines(0, workspace.encoding);
    let own = file.index.diagnostics.iter().filter(|d| d.span.source == main.ast.source);
    let mut out: Vec<Shown> = own.map(|d| shown(workspace, d, lines.of(d.span))).collect();
    // Errors of imported files stand where the main file imports what leads to them.
    let imports = main.ast.declarations.iter().filter_map(|d| match &d.kind {
        crate::cga::ast::DeclarationKind::Import(import) => Some(import.path.span),
        _ => None,
    });
    for (span, target) in imports.zip(&main.imports) {
        let Some(target) = *target else { continue };
        let reached = reached(file, target);
        let inside = |d: &&Diagnostic| file.file_of(d.span.source).is_some_and(|f| reached.contains(&f));
        let errors: Vec<&Diagnostic> =
            file.index.diagnostics.iter().filter(|d| d.severity == Severity::Error).filter(inside).collect();
        let located = |d: &Diagnostic| {
            let path = &file.index.files[file.file_of(d.span.source)?].path;
            Some(Location { uri: workspace.uri(path)?, range: range(workspace, &file.sources, d.span) })
        };
        out.extend(elsewhere(&errors, lines.of(span), located));
    }
    out
}

/// A file and all that it imports.
fn reached(file: &RuleFile, from: usize) -> Vec<usize> {
    let mut out = vec![from];
    let mut next = 0;
    while let Some(&at) = out.get(next) {
        let more: Vec<usize> =
            file.index.files[at].imports.iter().flatten().copied().filter(|i| !out.contains(i)).collect();
        out.extend(more);
        next += 1;
    }
    out
}

fn of_recipe(workspace: &Workspace, path: &Path, file: &RecipeFile) -> Vec<Shown> {
    let mut out = Vec::new();
    let mut others: Vec<(std::path::PathBuf, &Diagnostic)> = Vec::new();
    for diagnostic in file.diagnostics.iter() {
        let source = file.sources.get(diagnostic.span.source);
        let of = uri::real(&file.folder.join(&*source.name));
        if of == path {
            out.push(shown(workspace, diagnostic, range(workspace, &file.sources, diagnostic.span)));
        } else if diagnostic.severity == Severity::Error {
            others.push((of, diagnostic));
        }
    }
    let Some(part) = file.parts.first() else { return out };
    let lines = file.lines(0, workspace.encoding);
    let mut told: Vec<usize> = Vec::new();
    for word in part.words() {
        let Meaning::File(written) = &word.meaning else { continue };
        let named = uri::real(&file.folder.join(written));
        let own = others.iter().enumerate().filter(|(n, (of, _))| *of == named && !told.contains(n));
        let (numbers, errors): (Vec<usize>, Vec<&Diagnostic>) = own.map(|(n, (_, d))| (n, *d)).unzip();
        let located = |d: &Diagnostic| {
            Some(Location { uri: workspace.uri(&named)?, range: range(workspace, &file.sources, d.span) })
        };
        out.extend(elsewhere(&errors, lines.of(word.span), located));
        told.extend(numbers);
    }
    // What no word of the recipe leads to: values of settings, files of files.
    for (_, (of, diagnostic)) in others.iter().enumerate().filter(|(n, _)| !told.contains(n)) {
        let mut one = shown(workspace, diagnostic, Range::default());
        one.message = format!("{}: {}", of.display(), one.message);
        out.push(one);
    }
    out
}

/// Errors of another file, told once at `at`.
fn elsewhere(errors: &[&Diagnostic], at: Range, located: impl Fn(&Diagnostic) -> Option<Location>) -> Option<Shown> {
    let first = errors.first()?;
    let message = match errors.len() {
        1 => format!("this file has an error: {}", first.message),
        n => format!("this file has {n} errors, the first is: {}", first.message),
    };
    let related = errors
        .iter()
        .take(20)
        .filter_map(|d| Some(DiagnosticRelatedInformation { location: located(d)?, message: d.message.clone() }));
    Some(Shown {
        range: at,
        severity: Some(DiagnosticSeverity::ERROR),
        code: Some(NumberOrString::String(first.code.to_owned())),
        source: Some("mansard".to_owned()),
        message,
        related_information: Some(related.collect()),
        ..Shown::default()
    })
}

/// A diagnostic with its code, its page, its tags and its help.
fn shown(workspace: &Workspace, diagnostic: &Diagnostic, range: Range) -> Shown {
    let mut message = diagnostic.message.clone();
    if !diagnostic.label.is_empty() {
        message = format!("{message} ({})", diagnostic.label);
    }
    if let Some(help) = &diagnostic.help {
        message = format!("{message}\nhelp: {help}");
    }
    let scheme = workspace.settings.explain_scheme.as_ref();
    let page = scheme.filter(|_| crate::diagnostics::explain(diagnostic.code).is_some());
    let href = page.and_then(|scheme| Uri::from_str(&format!("{scheme}:{}.md", diagnostic.code)).ok());
    Shown {
        range,
        severity: Some(match diagnostic.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: Some(NumberOrString::String(diagnostic.code.to_owned())),
        code_description: href.map(|href| CodeDescription { href }),
        source: Some("mansard".to_owned()),
        message,
        tags: tag(diagnostic.code).map(|tag| vec![tag]),
        // What a quick fix needs.
        data: diagnostic.help.clone().map(serde_json::Value::String),
        ..Shown::default()
    }
}

fn tag(code: &str) -> Option<DiagnosticTag> {
    match code {
        codes::UNUSED_RULE | codes::UNREACHABLE | codes::NO_EFFECT | codes::NEVER_FITS | codes::NEEDLESS_DOT => {
            Some(DiagnosticTag::UNNECESSARY)
        }
        codes::DEPRECATED | codes::MISSING_SIZE => Some(DiagnosticTag::DEPRECATED),
        _ => None,
    }
}

fn range(workspace: &Workspace, sources: &SourceMap, span: Span) -> Range {
    let file: &SourceFile = sources.get(span.source);
    let starts = line_starts(&file.text);
    Lines::new(&file.text, &starts, workspace.encoding).of(span)
}
