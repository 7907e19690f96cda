//! Proposals in a recipe. In: the spot of [`recipe_context`]. Out: blocks, keys, clauses, values, names, files.

use std::path::Path;

use lsp_types::CompletionItemKind as ItemKind;

use super::completion::{Offer, files};
use crate::language_server::describe;
use crate::language_server::manual;
use crate::language_server::recipe_context::{Spot, spot};
use crate::language_server::recipe_file::{RecipeFile, names_file, referred};
use crate::language_server::rule_file::Kind;
use crate::language_server::symbols::named_file;
use crate::language_server::workspace::Workspace;
use crate::spec::filter::CLASSES;
use crate::spec::schema::{BLOCKS, BlockShape, Key, RESERVED};

/// Endings of maps and elevation files.
const MAPS: &[&str] = &["osm", "pbf", "gz", "bz2", "json", "geojson", "tif", "tiff", "hgt", "zip"];

/// Where the replaced text begins, and what may stand there.
pub fn offers(workspace: &mut Workspace, path: &Path, text: &str, offset: u32) -> (u32, Vec<Offer>) {
    let (spot, start) = spot(text, offset);
    let file = workspace.recipe(path);
    let begun = &text[start as usize..offset as usize];
    let offers = match &spot {
        Spot::Nothing | Spot::Filter => Vec::new(),
        Spot::Top => top(),
        Spot::Parent(kind) => names(&file, kind),
        Spot::Key { block, before } => {
            let clauses = before.iter().flat_map(|key| key.clauses).map(|word| clause(word));
            clauses.chain(block.keys.iter().filter(|key| key.evaluated).map(|key| key_offer(block, key))).collect()
        }
        Spot::Value { block, key, clause } => values(workspace, &file, (block, key, clause.as_deref()), text, offset),
        Spot::Attribute(written) => attributes(workspace, &file, written.as_deref()),
        Spot::AttributeValue => {
            let calls = [("tag", "tag(\"$1\")"), ("choice", "choice($1)"), ("uniform", "uniform($1, $2)")];
            let calls = calls.into_iter().chain([("normal", "normal($1, $2)")]);
            calls.map(|(name, form)| Offer::new(name, ItemKind::FUNCTION).snippet(form)).chain(inputs(&file)).collect()
        }
        Spot::Text(around) => {
            let endings: &[&str] = match &**around {
                Spot::Value { key, clause, .. } if names_file(key.key, clause.as_deref()) => {
                    if matches!(key.key, "rules" | "level") { &["cga"] } else { MAPS }
                }
                Spot::Top => &["render"],
                _ => return (start, Vec::new()),
            };
            let (kept, offers) = files(&[&file.folder], begun, endings);
            return (start + kept as u32, offers);
        }
    };
    (start, offers)
}

fn top() -> Vec<Offer> {
    let mut out: Vec<Offer> = Vec::new();
    for block in BLOCKS {
        let snippet = format!("{} ${{1:name}} {{\n\t$0\n}}", block.kind);
        out.push(Offer::new(block.kind, ItemKind::CLASS).documentation(manual::block(block)).snippet(snippet));
    }
    out.push(Offer::new("input", ItemKind::KEYWORD).snippet("input ${1:map} : ${2|file,files,text,value|}"));
    out.push(Offer::new("use", ItemKind::KEYWORD).snippet("use \"$1\""));
    out.push(Offer::new("version", ItemKind::KEYWORD).snippet("version 1"));
    out
}

fn key_offer(block: &BlockShape, key: &Key) -> Offer {
    Offer::new(key.key, ItemKind::PROPERTY).documentation(manual::key(block, key)).snippet(format!("{} $0", key.key))
}

fn clause(word: &str) -> Offer {
    Offer::new(word, ItemKind::KEYWORD).snippet(format!("{word} $0"))
}

fn names(file: &RecipeFile, kind: &str) -> Vec<Offer> {
    let named = file.blocks().filter(|block| block.kind.text == kind).filter_map(|block| block.name.as_ref());
    named.map(|name| Offer::new(&name.text, ItemKind::CLASS).detail(kind)).collect()
}

fn inputs(file: &RecipeFile) -> impl Iterator<Item = Offer> + use<'_> {
    let inputs = file.parts.iter().flat_map(|part| &part.ast.inputs);
    inputs.map(|input| Offer::new(format!("${}", input.name.text), ItemKind::VARIABLE).detail(&input.kind.text))
}

fn values(
    workspace: &mut Workspace,
    file: &RecipeFile,
    (block, key, clause_word): (&BlockShape, &Key, Option<&str>),
    text: &str,
    offset: u32,
) -> Vec<Offer> {
    let mut out: Vec<Offer> = Vec::new();
    for kind in referred(block.kind, key.key, clause_word) {
        out.extend(names(file, kind));
    }
    let value = |word: &str| Offer::new(word, ItemKind::VALUE);
    match (key.key, clause_word) {
        (_, Some("start")) => out.extend(start_rules(workspace, file, text, offset)),
        (_, Some("for")) | ("of" | "missing", None) => {
            out.extend(CLASSES.iter().map(|(class, _)| value(class)));
            out.push(value("all"));
        }
        ("show", None | Some("only" | "mark")) => {
            let sets = RESERVED.iter().filter(|word| !matches!(**word, "both" | "before"));
            out.extend(sets.map(|word| value(word)));
            out.extend(CLASSES.iter().map(|(class, _)| value(class)));
        }
        ("show", Some("with")) => out.extend(["all", "both", "before"].map(value)),
        ("show", Some("as")) => out.extend(["colour", "class", "mask", "level", "instance", "depth"].map(value)),
        _ => out.extend(manual::values(block, key).iter().map(|word| value(word))),
    }
    out.extend(inputs(file));
    out.extend(key.clauses.iter().filter(|word| Some(**word) != clause_word).map(|word| clause(word)));
    out
}

/// Rules without parameters of the rule file that the property names in front of the place.
fn start_rules(workspace: &mut Workspace, file: &RecipeFile, text: &str, offset: u32) -> Vec<Offer> {
    let before = &text[..offset as usize];
    let written = before.rsplit('"').nth(1).unwrap_or_default();
    let Some(rules) = named_file(file, written).and_then(|path| workspace.rules(&path)) else { return Vec::new() };
    let own = rules.own().filter(|d| d.kind == Kind::Rule && d.parameters.is_empty());
    own.map(|d| Offer::new(&*d.name.text, ItemKind::CLASS).documentation(describe::declared(&rules, d))).collect()
}

fn attributes(workspace: &mut Workspace, file: &RecipeFile, written: Option<&str>) -> Vec<Offer> {
    let path = written.and_then(|written| named_file(file, written));
    let Some(rules) = path.and_then(|path| workspace.rules(&path)) else { return Vec::new() };
    let own = rules.own().filter(|d| d.kind == Kind::Attribute);
    let offer = |name: &str, d| {
        let offer = Offer::new(name, ItemKind::PROPERTY).documentation(describe::declared(&rules, d));
        offer.snippet(format!("{name} = $1"))
    };
    own.map(|d| offer(&d.name.text, d)).collect()
}
