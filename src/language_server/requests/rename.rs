//! `textDocument/rename`: rules, attributes, constants, functions, parameters, locals, imports; blocks and inputs of
//! recipes. Every file of the workspace that names the thing is changed. Refused, with the reason: names of the language,
//! files that came with the program, names that would clash or be captured.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use lsp_types::{PrepareRenameResponse, RenameParams, TextDocumentPositionParams, TextEdit};
use serde_json::{Value, json};

use crate::cga::builtins::{Attr, Function, Operation, Word};
use crate::language_server::describe;
use crate::language_server::manual::KEYWORDS;
use crate::language_server::rule_file::{Declared, Kind, Place, RuleFile};
use crate::language_server::server::Refusal;
use crate::language_server::symbols::{self, declarations, last_part, linked, mentioning, narrowed, uses};
use crate::language_server::workspace::{Language, Workspace};
use crate::source::Span;

pub fn prepare(
    workspace: &mut Workspace,
    params: TextDocumentPositionParams,
) -> Result<Option<PrepareRenameResponse>, Refusal> {
    let Some((path, language, text, offset)) = workspace.asked(&params) else { return Ok(None) };
    let Some((start, end)) = renamable(workspace, &path, language, &text.text, offset)? else { return Ok(None) };
    let placeholder = text.text[start as usize..end as usize].to_owned();
    Ok(Some(PrepareRenameResponse::RangeWithPlaceholder { range: text.lines().range(start, end), placeholder }))
}

/// The range of the name that would be replaced.
fn renamable(
    workspace: &mut Workspace,
    path: &Path,
    language: Language,
    text: &str,
    offset: u32,
) -> Result<Option<(u32, u32)>, Refusal> {
    let span = match language {
        Language::Rules => {
            let Some((file, (span, meanings))) =
                workspace.rules(path).and_then(|file| Some((file.clone(), file.at(offset)?)))
            else {
                return Ok(None);
            };
            if !meanings.iter().any(|meaning| file.declaration(*meaning).is_some()) {
                let what = meanings.first().map_or("nothing", |meaning| describe::word(*meaning));
                return Err(Refusal::failed(format!("`{}` is {what} and keeps its name", file.written(span))));
            }
            if meanings.iter().filter_map(|m| file.declaration(*m)).any(|d| d.kind == Kind::Style) {
                return Err(Refusal::failed("styles are named by hosts too and keep their names"));
            }
            span
        }
        Language::Recipe => match workspace.recipe(path).at(offset) {
            Some(word) => word.span,
            None => return Ok(None),
        },
    };
    if declarations(workspace, path, language, offset).is_empty() {
        return Err(Refusal::failed("this is no name that was declared in a file of the project"));
    }
    let place = Place { path: path.to_owned(), start: span.start, end: span.end };
    let written = text.get(span.start as usize..span.end as usize).unwrap_or_default();
    let name = last_part(written.trim_matches('"'));
    Ok(narrowed(text, &place, name))
}

pub fn rename(workspace: &mut Workspace, params: RenameParams) -> Result<Value, Refusal> {
    let at = params.text_document_position;
    let Some((path, language, text, offset)) = workspace.asked(&at) else { return Ok(Value::Null) };
    let Some((start, end)) = renamable(workspace, &path, language, &text.text, offset)? else { return Ok(Value::Null) };
    let old = text.text[start as usize..end as usize].to_owned();
    let new = params.new_name;
    let targets: BTreeSet<Place> = declarations(workspace, &path, language, offset).into_iter().collect();
    let targets = linked(workspace, targets, &old, &path);
    let in_rules = targets.iter().any(|place| Language::of(&place.path) == Some(Language::Rules));
    check_word(&new, in_rules)?;
    let mut places = uses(workspace, &targets, &old, &path);
    check_clashes(workspace, (&targets, &places), (&old, &new), &path)?;
    places.extend(targets);
    Ok(edits(workspace, &places, &old, &new))
}

/// Whether something can be called so at all.
fn check_word(new: &str, in_rules: bool) -> Result<(), Refusal> {
    let starts =
        new.starts_with(|c: char| c == '_' || if in_rules { c.is_alphabetic() } else { c.is_ascii_alphabetic() });
    let goes_on = |c: char| c == '_' || if in_rules { c.is_alphanumeric() } else { c.is_ascii_alphanumeric() };
    if !starts || !new.chars().all(goes_on) {
        return Err(Refusal::failed(format!("`{new}` is no name: letters, digits and `_`, no digit in front")));
    }
    let known = Operation::from_name(new).is_some() || Function::from_name(new).is_some();
    let known = known || Attr::from_name(new).is_some() || Word::from_text(new).is_some();
    if in_rules && (known || KEYWORDS.iter().any(|(word, _)| *word == new)) {
        return Err(Refusal::failed(format!("`{new}` is a name of the language")));
    }
    Ok(())
}

fn check_clashes(
    workspace: &mut Workspace,
    (targets, places): (&BTreeSet<Place>, &BTreeSet<Place>),
    (old, new): (&str, &str),
    near: &Path,
) -> Result<(), Refusal> {
    for path in mentioning(workspace, Language::Rules, old, near) {
        let Some(file) = workspace.rules(&path) else { continue };
        clash_in(&file, targets, places, new)?;
    }
    for place in targets.iter().filter(|place| Language::of(&place.path) == Some(Language::Recipe)) {
        let recipe = workspace.recipe(&place.path);
        let Some(word) = recipe.at(place.start) else { continue };
        let wanted = match word.meaning {
            crate::language_server::recipe_file::Meaning::Block { kind, .. } => {
                crate::language_server::recipe_file::Meaning::Block { kind, name: new.to_owned() }
            }
            _ => crate::language_server::recipe_file::Meaning::Input(new.to_owned()),
        };
        if !recipe.places(&wanted, true).is_empty() {
            return Err(Refusal::failed(format!("there is a `{new}` already")));
        }
    }
    Ok(())
}

/// Looks at one rule file with its imports.
fn clash_in(file: &RuleFile, targets: &BTreeSet<Place>, places: &BTreeSet<Place>, new: &str) -> Result<(), Refusal> {
    let is_target = |d: &&Declared| file.place(d.name.span).is_some_and(|place| targets.contains(&place));
    for target in file.declared.iter().filter(is_target) {
        let clashes = |other: &&Declared| {
            let same_file = other.file == target.file && last_part(&other.name.text) == new;
            // A value of an importing file would flow into the renamed one.
            let flows = !target.kind.is_inner()
                && is_value(target.kind)
                && is_value(other.kind)
                && &*other.name.text == new
                && file.index.files[other.file].imports.contains(&Some(target.file));
            let alike = match target.kind {
                Kind::Parameter | Kind::Local => other.kind.is_inner() && other.declaration == target.declaration,
                Kind::Rule => other.kind == Kind::Rule && other.parameters.len() == target.parameters.len(),
                Kind::Import | Kind::Style => other.kind == target.kind,
                Kind::Attribute | Kind::Constant | Kind::Function => is_value(other.kind),
            };
            (same_file && alike) || flows
        };
        if let Some(other) = file.declared.iter().find(clashes) {
            let path = file.index.files[other.file].path.file_name().unwrap_or_default().to_string_lossy();
            return Err(Refusal::failed(format!("{path} has a {} `{new}` already", other.kind.word())));
        }
        // A parameter would capture what its rule means by the new name.
        let inside = file.tree(target).span;
        let means_other = |name: &&crate::cga::Name| within(name.span, inside) && file.written(name.span) == new;
        if target.kind.is_inner() && file.index.names.iter().any(|name| means_other(&name)) {
            return Err(Refusal::failed(format!("`{new}` means something else in this definition")));
        }
    }
    // The renamed value would be captured by a parameter where it is used.
    let used = file.index.names.iter().filter(|n| file.place(n.span).is_some_and(|place| places.contains(&place)));
    for name in used {
        let captures = |d: &&Declared| {
            d.kind.is_inner() && &*d.name.text == new && within(name.span, file.tree(d).span) && !is_target(d)
        };
        let is_rule = matches!(name.meaning, crate::cga::Meaning::Rule(_));
        if let Some(other) = file.declared.iter().find(|d| !is_rule && captures(d)) {
            return Err(Refusal::failed(format!("a {} `{new}` would hide it where it is used", other.kind.word())));
        }
    }
    Ok(())
}

fn is_value(kind: Kind) -> bool {
    matches!(kind, Kind::Attribute | Kind::Constant | Kind::Function)
}

fn within(inner: Span, outer: Span) -> bool {
    inner.source == outer.source && outer.start <= inner.start && inner.end <= outer.end
}

/// A `WorkspaceEdit`; with versions if the client takes them.
fn edits(workspace: &Workspace, places: &BTreeSet<Place>, old: &str, new: &str) -> Value {
    let mut files: BTreeMap<&Path, Vec<TextEdit>> = BTreeMap::new();
    for place in places {
        let Some(text) = workspace.lined(&place.path) else { continue };
        // Uses that are written otherwise, such as `start`, stay.
        let Some((start, end)) = symbols::narrowed(&text.text, place, old) else { continue };
        let edit = TextEdit { range: text.lines().range(start, end), new_text: new.to_owned() };
        files.entry(&place.path).or_default().push(edit);
    }
    let named = files.into_iter().filter_map(|(path, edits)| Some((path, workspace.uri(path)?, edits)));
    if workspace.client.document_changes {
        let change = |(path, uri, edits): (&Path, lsp_types::Uri, Vec<TextEdit>)| {
            let version = workspace.documents.get(path).map(|document| document.version);
            json!({ "textDocument": { "uri": uri, "version": version }, "edits": edits })
        };
        return json!({ "documentChanges": named.map(change).collect::<Vec<_>>() });
    }
    let changes = named.map(|(_, uri, edits)| (uri.as_str().to_owned(), json!(edits)));
    json!({ "changes": changes.collect::<serde_json::Map<_, _>>() })
}
