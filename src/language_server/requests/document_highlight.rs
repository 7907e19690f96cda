//! `textDocument/documentHighlight`: the other places of the same file where the name under the cursor stands.

use std::path::Path;

use lsp_types::{DocumentHighlight, DocumentHighlightKind, DocumentHighlightParams};

use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

pub fn document_highlight(
    workspace: &mut Workspace,
    params: DocumentHighlightParams,
) -> Result<Vec<DocumentHighlight>, Refusal> {
    let at = params.text_document_position_params;
    let Some((path, language, text, offset)) = workspace.asked(&at) else { return Ok(Vec::new()) };
    let found = match language {
        Language::Rules => in_rules(workspace, &path, offset),
        Language::Recipe => in_recipe(workspace, &path, offset),
    };
    let lines = text.lines();
    let highlight = |(start, end, declares): (u32, u32, bool)| DocumentHighlight {
        range: lines.range(start, end),
        kind: Some(if declares { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ }),
    };
    Ok(found.into_iter().map(highlight).collect())
}

/// Start, end, whether it declares.
fn in_rules(workspace: &mut Workspace, path: &Path, offset: u32) -> Vec<(u32, u32, bool)> {
    let Some(file) = workspace.rules(path) else { return Vec::new() };
    let (Some(main), Some((_, meanings))) = (file.main(), file.at(offset)) else { return Vec::new() };
    let own = |span: crate::source::Span| span.source == main.ast.source;
    let uses = file.index.names.iter().filter(|n| own(n.span) && meanings.contains(&n.meaning));
    let declared = file.declared.iter().filter(|d| own(d.name.span) && meanings.contains(&d.meaning()));
    let mut out: Vec<_> = uses.map(|n| (n.span.start, n.span.end, false)).collect();
    out.extend(declared.map(|d| (d.name.span.start, d.name.span.end, true)));
    out.sort_unstable();
    out.dedup();
    out
}

fn in_recipe(workspace: &mut Workspace, path: &Path, offset: u32) -> Vec<(u32, u32, bool)> {
    let file = workspace.recipe(path);
    let (Some(part), Some(word)) = (file.parts.first(), file.at(offset)) else { return Vec::new() };
    let same = part.words().into_iter().filter(|other| other.meaning == word.meaning);
    same.map(|other| (other.span.start, other.span.end, other.declares)).collect()
}
