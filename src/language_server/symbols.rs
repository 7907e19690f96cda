//! Names across files. In: a place in a rule file or a recipe. Out: the declarations it leads to and every use of them,
//! in rule files and recipes of the workspace.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use super::recipe_file::{self, RecipeFile};
use super::rule_file::{Declared, Kind, Place, RuleFile};
use super::uri;
use super::workspace::{Language, Workspace};
use crate::cga::Meaning;
use crate::cga::ast::DeclarationKind;
use crate::source::Span;

/// The declarations that the name at a place leads to.
pub fn declarations(workspace: &mut Workspace, path: &Path, language: Language, offset: u32) -> Vec<Place> {
    match language {
        Language::Rules => {
            let Some(file) = workspace.rules(path) else { return Vec::new() };
            let Some((_, meanings)) = file.at(offset) else { return Vec::new() };
            meanings.into_iter().filter_map(|meaning| file.place(file.declaration(meaning)?.name.span)).collect()
        }
        Language::Recipe => {
            let file = workspace.recipe(path);
            let Some(word) = file.at(offset) else { return Vec::new() };
            match &word.meaning {
                recipe_file::Meaning::Block { .. } | recipe_file::Meaning::Input(_) => file.places(&word.meaning, true),
                recipe_file::Meaning::Start { .. } | recipe_file::Meaning::Attribute { .. } => {
                    in_rules(workspace, &file, &word.meaning).into_iter().collect()
                }
                _ => Vec::new(),
            }
        }
    }
}

/// The declaration of a start rule or attribute that a recipe names.
fn in_rules(workspace: &mut Workspace, recipe: &RecipeFile, meaning: &recipe_file::Meaning) -> Option<Place> {
    let (file, declared) = named_rule(workspace, recipe, meaning)?;
    file.place(file.declared[declared].name.span)
}

/// As [`in_rules`]: the rule file and the index of the declared name.
pub fn named_rule(
    workspace: &mut Workspace,
    recipe: &RecipeFile,
    meaning: &recipe_file::Meaning,
) -> Option<(Rc<RuleFile>, usize)> {
    let (written, name, is_rule) = match meaning {
        recipe_file::Meaning::Start { file, rule } => (file, rule, true),
        recipe_file::Meaning::Attribute { file, name } => (file, name, false),
        _ => return None,
    };
    let file = workspace.rules(&named_file(recipe, written)?)?;
    let found = named(&file, name, |kind| if is_rule { kind == Kind::Rule } else { kind == Kind::Attribute })?;
    Some((file, found))
}

/// The existing file that a recipe names.
pub fn named_file(recipe: &RecipeFile, written: &str) -> Option<PathBuf> {
    let path = uri::real(&recipe.folder.join(written));
    path.is_file().then_some(path)
}

/// Index of the declared name that a host calls `lib.windows.height`.
pub fn named(file: &RuleFile, name: &str, is_kind: impl Fn(Kind) -> bool) -> Option<usize> {
    let (mut at, mut rest) = (0, name);
    while let Some((first, tail)) = rest.split_once('.') {
        at = import(file, at, first)?.1?;
        rest = tail;
    }
    let fits = |d: &Declared| d.file == at && is_kind(d.kind) && &*d.name.text == rest;
    file.declared.iter().position(fits)
}

/// The name of an import where it is declared, and the file it leads to.
pub fn import(file: &RuleFile, at: usize, prefix: &str) -> Option<(Span, Option<usize>)> {
    let indexed = file.index.files.get(at)?;
    let imports = indexed.ast.declarations.iter().filter_map(|d| match &d.kind {
        DeclarationKind::Import(import) => Some(import),
        _ => None,
    });
    let (import, target) = imports.zip(&indexed.imports).find(|(import, _)| &*import.prefix.text == prefix)?;
    Some((import.prefix.span, *target))
}

/// Where the imports stand that a recipe's name of an attribute goes through: `lib` in `lib.height`.
fn import_uses(
    workspace: &mut Workspace,
    recipe: &RecipeFile,
    (word, text): (&recipe_file::Word, &str),
    targets: &BTreeSet<Place>,
) -> Vec<(u32, u32)> {
    let recipe_file::Meaning::Attribute { file: written, name } = &word.meaning else { return Vec::new() };
    let Some(file) = named_file(recipe, written).and_then(|path| workspace.rules(&path)) else { return Vec::new() };
    let quote = u32::from(text[word.span.start as usize..].starts_with('"'));
    let (mut at, mut start, mut rest) = (0, word.span.start + quote, name.as_str());
    let mut out = Vec::new();
    while let Some((first, tail)) = rest.split_once('.')
        && let Some((span, target)) = import(&file, at, first)
    {
        let end = start + first.len() as u32;
        if file.place(span).is_some_and(|place| targets.contains(&place)) {
            out.push((start, end));
        }
        let Some(next) = target else { break };
        (at, start, rest) = (next, end + 1, tail);
    }
    out
}

/// Every use of declarations called `name`, declarations themselves left out.
pub fn uses(workspace: &mut Workspace, targets: &BTreeSet<Place>, name: &str, near: &Path) -> BTreeSet<Place> {
    let mut out = BTreeSet::new();
    for path in mentioning(workspace, Language::Rules, name, near) {
        let Some(file) = workspace.rules(&path) else { continue };
        for used in &file.index.names {
            let (Meaning::Rule(span) | Meaning::Value(span) | Meaning::Local(span) | Meaning::Import(span)) =
                used.meaning
            else {
                continue;
            };
            if file.place(span).is_some_and(|place| targets.contains(&place)) {
                out.extend(file.place(used.span));
            }
        }
    }
    for path in mentioning(workspace, Language::Recipe, name, near) {
        let recipe = workspace.recipe(&path);
        for (number, part) in recipe.parts.iter().enumerate() {
            for word in part.words() {
                let place = Place { path: part.path.clone(), start: word.span.start, end: word.span.end };
                let through = import_uses(workspace, &recipe, (&word, &part.text), targets);
                let place_of = |(start, end)| Place { path: part.path.clone(), start, end };
                out.extend(through.into_iter().map(place_of));
                let leads = match &word.meaning {
                    recipe_file::Meaning::Start { .. } | recipe_file::Meaning::Attribute { .. } if number == 0 => {
                        in_rules(workspace, &recipe, &word.meaning).into_iter().collect()
                    }
                    recipe_file::Meaning::Block { .. } | recipe_file::Meaning::Input(_) => {
                        recipe.places(&word.meaning, true)
                    }
                    _ => Vec::new(),
                };
                if leads.iter().any(|place| targets.contains(place)) && !targets.contains(&place) {
                    out.insert(place);
                }
            }
        }
    }
    out
}

/// Files in whose text a name occurs.
pub fn mentioning(workspace: &Workspace, language: Language, name: &str, near: &Path) -> Vec<PathBuf> {
    let mut files = workspace.files(language, near);
    files.retain(|path| workspace.text(path).is_some_and(|text| text.contains(name)));
    files
}

/// All declarations that must be called the same as these, those included.
pub fn linked(workspace: &mut Workspace, targets: BTreeSet<Place>, name: &str, near: &Path) -> BTreeSet<Place> {
    let mut out = targets;
    let files: Vec<Rc<RuleFile>> = mentioning(workspace, Language::Rules, name, near)
        .into_iter()
        .filter_map(|path| workspace.rules(&path))
        .collect();
    loop {
        let before = out.len();
        for file in &files {
            for (one, other) in &file.index.links {
                let (Some(one), Some(other)) = (file.place(*one), file.place(*other)) else { continue };
                if out.contains(&one) || out.contains(&other) {
                    out.extend([one, other]);
                }
            }
            // The same definition in several styles.
            let own = |d: &&Declared| !d.kind.is_inner() && d.file == 0;
            let known: Vec<&Declared> = file.declared.iter().filter(own).collect();
            let hit: Vec<&&Declared> =
                known.iter().filter(|d| file.place(d.name.span).is_some_and(|p| out.contains(&p))).collect();
            let same = |d: &Declared| {
                hit.iter()
                    .any(|h| (h.kind, &h.name.text, h.parameters.len()) == (d.kind, &d.name.text, d.parameters.len()))
            };
            let more: Vec<Place> = known.iter().filter(|d| same(d)).filter_map(|d| file.place(d.name.span)).collect();
            out.extend(more);
        }
        if out.len() == before {
            return out;
        }
    }
}

/// The part of a place that holds the name itself, without quotes and imports in front; none if it is not written there.
pub fn narrowed(text: &str, place: &Place, name: &str) -> Option<(u32, u32)> {
    let written = text.get(place.start as usize..place.end as usize)?;
    let bare = written.strip_suffix('"').unwrap_or(written);
    let end = place.start + bare.len() as u32;
    let start = end.checked_sub(name.len() as u32).filter(|_| bare.ends_with(name))?;
    Some((start, end))
}

/// The last part of a dotted name.
pub fn last_part(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}
