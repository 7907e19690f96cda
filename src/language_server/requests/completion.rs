//! `textDocument/completion`: what may be written at a place, by language.

use std::path::Path;

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionList, CompletionParams, CompletionResponse, CompletionTextEdit,
    Documentation, InsertTextFormat, MarkupContent, MarkupKind, TextEdit,
};

use super::{completion_recipe, completion_rules};
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, LinedText, Workspace};

/// Entries of a folder that are offered, at most.
const MOST_FILES: usize = 500;

pub fn completion(workspace: &mut Workspace, params: CompletionParams) -> Result<Option<CompletionResponse>, Refusal> {
    let Some((path, language, text, offset)) = workspace.asked(&params.text_document_position) else { return Ok(None) };
    let offers = match language {
        Language::Rules => completion_rules::offers(workspace, &path, &text.text, offset),
        Language::Recipe => completion_recipe::offers(workspace, &path, &text.text, offset),
    };
    let snippets = workspace.client.snippets;
    let (start, offers) = offers;
    let items = offers.into_iter().enumerate().map(|(n, offer)| item(offer, n, &text, (start, offset), snippets));
    Ok(Some(CompletionResponse::List(CompletionList { is_incomplete: false, items: items.collect() })))
}

/// One proposal.
#[derive(Clone, Debug)]
pub struct Offer {
    pub label: String,
    pub kind: CompletionItemKind,
    pub detail: Option<String>,
    /// Markdown.
    pub documentation: Option<String>,
    /// With `$1` for places to fill in.
    pub snippet: Option<String>,
    pub deprecated: bool,
}

impl Offer {
    pub fn new(label: impl Into<String>, kind: CompletionItemKind) -> Self {
        Offer { label: label.into(), kind, detail: None, documentation: None, snippet: None, deprecated: false }
    }

    pub fn detail(self, detail: impl Into<String>) -> Self {
        Offer { detail: Some(detail.into()), ..self }
    }

    pub fn documentation(self, markdown: impl Into<String>) -> Self {
        let markdown = markdown.into();
        Offer { documentation: (!markdown.is_empty()).then_some(markdown), ..self }
    }

    pub fn snippet(self, snippet: impl Into<String>) -> Self {
        Offer { snippet: Some(snippet.into()), ..self }
    }
}

fn item(offer: Offer, number: usize, text: &LinedText, (start, end): (u32, u32), snippets: bool) -> CompletionItem {
    let snippet = offer.snippet.filter(|_| snippets);
    let is_snippet = snippet.is_some();
    let new_text = snippet.unwrap_or_else(|| offer.label.clone());
    let range = text.lines().range(start, end);
    CompletionItem {
        label: offer.label.clone(),
        kind: Some(offer.kind),
        detail: offer.detail,
        documentation: offer
            .documentation
            .map(|value| Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value })),
        tags: offer.deprecated.then(|| vec![lsp_types::CompletionItemTag::DEPRECATED]),
        // Ours come in the order in which they are likely.
        sort_text: Some(format!("{number:05}")),
        filter_text: Some(offer.label),
        insert_text_format: is_snippet.then_some(InsertTextFormat::SNIPPET),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit { range, new_text })),
        ..CompletionItem::default()
    }
}

/// Files and folders below `folder` for a path that was begun: those in the folder that it names so far. `endings` empty
/// for all. Gives the length of what stays in front.
pub fn files(folders: &[&Path], begun: &str, endings: &[&str]) -> (usize, Vec<Offer>) {
    let kept = begun.rfind('/').map_or(0, |slash| slash + 1);
    let mut names: Vec<(String, bool)> = Vec::new();
    for folder in folders {
        let Ok(entries) = std::fs::read_dir(folder.join(&begun[..kept])) else { continue };
        for entry in entries.flatten().take(MOST_FILES) {
            let name = entry.file_name().to_string_lossy().into_owned();
            let is_folder = entry.path().is_dir();
            let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase();
            let wanted = is_folder || endings.is_empty() || endings.contains(&ending.as_str());
            if wanted && !name.starts_with('.') && !names.iter().any(|(known, _)| *known == name) {
                names.push((name, is_folder));
            }
        }
    }
    names.sort();
    let offer = |(name, is_folder): (String, bool)| match is_folder {
        true => Offer::new(format!("{name}/"), CompletionItemKind::FOLDER),
        false => Offer::new(name, CompletionItemKind::FILE),
    };
    (kept, names.into_iter().map(offer).collect())
}
