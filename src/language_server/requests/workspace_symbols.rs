//! `workspace/symbol`: declarations of all rule files and blocks of all recipes whose name holds the letters of the query
//! in their order.

use std::path::Path;

use lsp_types::{Location, SymbolInformation, SymbolKind, WorkspaceSymbolParams};

use super::document_symbols::symbol_kind;
use crate::language_server::rule_file::Place;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

/// Symbols of one answer, at most.
const MOST: usize = 1000;

pub fn workspace_symbols(
    workspace: &mut Workspace,
    params: WorkspaceSymbolParams,
) -> Result<Vec<SymbolInformation>, Refusal> {
    let near = workspace.documents.paths().next().cloned().unwrap_or_default();
    let mut found: Vec<(String, SymbolKind, Place, String)> = Vec::new();
    for path in workspace.files(Language::Rules, &near) {
        of_rules(workspace, &path, &params.query, &mut found);
        if found.len() > MOST {
            break;
        }
    }
    for path in workspace.files(Language::Recipe, &near) {
        let file = workspace.recipe(&path);
        let Some(part) = file.parts.first() else { continue };
        for block in &part.ast.blocks {
            let name = block.name.as_ref().unwrap_or(&block.kind);
            if fits(&name.text, &params.query) {
                let place = Place { path: path.clone(), start: name.span.start, end: name.span.end };
                found.push((name.text.clone(), SymbolKind::STRUCT, place, block.kind.text.clone()));
            }
        }
    }
    found.truncate(MOST);
    Ok(found.into_iter().filter_map(|symbol| told(workspace, symbol)).collect())
}

/// Declarations of one file, parsed alone: its imports are files of the workspace themselves.
fn of_rules(workspace: &Workspace, path: &Path, query: &str, found: &mut Vec<(String, SymbolKind, Place, String)>) {
    let Some(text) = workspace.text(path) else { return };
    let mut sources = crate::source::SourceMap::default();
    let (ast, _) = crate::cga::parse::parse(&sources.add(path.display().to_string(), text));
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    for (name, kind) in ast.declarations.iter().map(|d| declared(&d.kind)) {
        if fits(&name.text, query) {
            let place = Place { path: path.to_owned(), start: name.span.start, end: name.span.end };
            found.push((name.text.to_string(), symbol_kind(kind), place, file.clone()));
        }
    }
}

fn declared(
    kind: &crate::cga::ast::DeclarationKind,
) -> (&crate::cga::ast::Text, crate::language_server::rule_file::Kind) {
    use crate::cga::ast::{DeclarationKind as D, DefinitionKind};
    use crate::language_server::rule_file::Kind;
    match kind {
        D::Import(import) => (&import.prefix, Kind::Import),
        D::Style(style) => (&style.name, Kind::Style),
        D::Rule(rule) => (&rule.name, Kind::Rule),
        D::Definition(definition) => {
            let kind = match definition.kind {
                DefinitionKind::Attr => Kind::Attribute,
                DefinitionKind::Const => Kind::Constant,
                DefinitionKind::Function => Kind::Function,
            };
            (&definition.name, kind)
        }
    }
}

/// Whether the letters of the query stand in the name in their order, case ignored.
fn fits(name: &str, query: &str) -> bool {
    let mut letters = name.chars().flat_map(char::to_lowercase);
    query.chars().flat_map(char::to_lowercase).all(|wanted| letters.any(|letter| letter == wanted))
}

#[expect(deprecated, reason = "the type has a deprecated field that must be filled in")]
fn told(
    workspace: &Workspace,
    (name, kind, place, container): (String, SymbolKind, Place, String),
) -> Option<SymbolInformation> {
    let location: Location = workspace.location(&place)?;
    Some(SymbolInformation { name, kind, tags: None, deprecated: None, location, container_name: Some(container) })
}
