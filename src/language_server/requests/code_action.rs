//! `textDocument/codeAction`: quick fixes from what the diagnostics' help proposes.

use lsp_types::{
    CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams, Diagnostic, NumberOrString, TextEdit,
};
use serde_json::json;

use crate::cga::codes;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{LinedText, Workspace};

/// Help that ends in a proposal for what is underlined.
const PROPOSALS: &[&str] = &["did you mean `", "write `"];

pub fn code_action(workspace: &mut Workspace, params: CodeActionParams) -> Result<Vec<CodeActionOrCommand>, Refusal> {
    let uri = params.text_document.uri;
    let path = workspace.path(&uri);
    let Some(text) = workspace.lined(&path) else { return Ok(Vec::new()) };
    let mut out = Vec::new();
    for diagnostic in params.context.diagnostics.iter().filter(|d| d.source.as_deref() == Some("mansard")) {
        for (number, (title, edit)) in fixes(&text, diagnostic).into_iter().enumerate() {
            let action = CodeAction {
                title,
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![diagnostic.clone()]),
                is_preferred: Some(number == 0),
                ..CodeAction::default()
            };
            // The map of changes is written by hand: its type hashes URIs.
            let mut action = json!(action);
            action["edit"] = json!({ "changes": { uri.as_str(): [edit] } });
            let action = serde_json::from_value(action).expect("an action with an edit is an action");
            out.push(CodeActionOrCommand::CodeAction(action));
        }
    }
    Ok(out)
}

/// Titles and edits.
fn fixes(text: &LinedText, diagnostic: &Diagnostic) -> Vec<(String, TextEdit)> {
    let mut out = Vec::new();
    let code = match &diagnostic.code {
        Some(NumberOrString::String(code)) => code.as_str(),
        _ => "",
    };
    let help = diagnostic.data.as_ref().and_then(|data| data.as_str()).unwrap_or_default();
    let lines = text.lines();
    let (start, end) = (lines.offset(diagnostic.range.start), lines.offset(diagnostic.range.end));
    let written = text.text.get(start as usize..end as usize).unwrap_or_default();
    let replaced = |new: &str| TextEdit { range: diagnostic.range, new_text: new.to_owned() };
    if let Some(new) = PROPOSALS.iter().find_map(|p| proposal(help, p)) {
        match code {
            // The help says what to put in front.
            codes::MISSING_SIZE => {
                let at = lsp_types::Range::new(diagnostic.range.start, diagnostic.range.start);
                let edit = TextEdit { range: at, new_text: format!("{} ", new.trim_end()) };
                out.push((format!("Write `{}` in front", new.trim_end()), edit));
            }
            codes::UNKNOWN_ANNOTATION => {
                let name = new.trim_start_matches('@');
                out.push((format!("Change to `@{name}`"), replaced(name)));
            }
            _ if is_name(new) && (is_name(written) || written.starts_with('"')) => {
                let quoted = written.starts_with('"') && written.ends_with('"') && written.len() > 1;
                let new_text = if quoted { format!("\"{new}\"") } else { new.to_owned() };
                out.push((format!("Change to `{new}`"), replaced(&new_text)));
            }
            _ => {}
        }
    }
    match code {
        codes::UNDEFINED_RULE if is_name(written) => {
            let at = lsp_types::Range::new(diagnostic.range.end, diagnostic.range.end);
            if !text.text[end as usize..].trim_start().starts_with('(') {
                let edit = TextEdit { range: at, new_text: ".".to_owned() };
                out.push((format!("Make `{written}.` a leaf"), edit));
            }
        }
        // The dot stands behind the name and its arguments; only the plain form is mended.
        codes::NEEDLESS_DOT if text.text[end as usize..].starts_with('.') => {
            let range = lines.range(end, end + 1);
            out.push(("Take the dot away".to_owned(), TextEdit { range, new_text: String::new() }));
        }
        _ => {}
    }
    out
}

/// What stands in backquotes behind `lead`.
fn proposal<'h>(help: &'h str, lead: &str) -> Option<&'h str> {
    let rest = &help[help.find(lead)? + lead.len()..];
    rest.split_once('`').map(|(new, _)| new)
}

fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '@'))
}
