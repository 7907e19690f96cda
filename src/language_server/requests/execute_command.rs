//! `workspace/executeCommand`: `mansard.derive` counts for code lenses, `mansard.explain` gives the page of a code.

use std::path::{Path, PathBuf};

use lsp_types::Uri;
use serde_json::Value;

use crate::diagnostics;
use crate::language_server::derivation::{Subject, Work};
use crate::language_server::recipe_file;
use crate::language_server::server::Refusal;
use crate::language_server::symbols;
use crate::language_server::uri;
use crate::language_server::workspace::{Language, Workspace};
use crate::source::{Access, Project};

/// Argument: the URI of a rule file. Result: one line for the user, when the derivation is done.
pub const DERIVE: &str = "mansard.derive";
/// Argument: a diagnostic's code. Result: its page, as Markdown.
pub const EXPLAIN: &str = "mansard.explain";

pub fn explain(arguments: &[Value]) -> Result<String, Refusal> {
    let code = arguments.first().and_then(Value::as_str).unwrap_or_default();
    let page = diagnostics::explain(code);
    page.map(str::to_owned).ok_or_else(|| Refusal::failed(format!("there is no page about `{code}`")))
}

/// What is to be derived, ready for another thread.
pub fn derive(workspace: &mut Workspace, arguments: &[Value]) -> Result<Work, Refusal> {
    let named: Option<Uri> = arguments.first().cloned().and_then(|uri| serde_json::from_value(uri).ok());
    let named = named.ok_or_else(|| Refusal::failed("the command's argument is the URI of a rule file"))?;
    let rules = workspace.path(&named);
    if Language::of(&rules) != Some(Language::Rules) {
        return Err(Refusal::failed(format!("{} is no rule file", rules.display())));
    }
    let folder = rules.parent().unwrap_or(Path::new("")).to_owned();
    let mut access = Access::new(Project::of(&folder).tree()).map_err(|error| Refusal::failed(error.to_string()))?;
    for tree in &workspace.settings.allow {
        access.allow(tree).map_err(|error| Refusal::failed(error.to_string()))?;
    }
    let recipe = match &workspace.settings.recipe {
        Some(named) => {
            let folder = workspace.roots.first().unwrap_or(&folder);
            Some((uri::real(&folder.join(named)), true))
        }
        None => nearest_recipe(workspace, &rules).map(|path| (path, false)),
    };
    let options = workspace.settings.recipe_options();
    let recipe = recipe.map(|(path, is_set)| Subject { path, options, is_set });
    Ok(Work { rules, access, overlay: workspace.documents.overlay(), recipe })
}

/// The recipe that uses a rule file and lies nearest to it: the most folders in common, then the first by name.
fn nearest_recipe(workspace: &mut Workspace, rules: &Path) -> Option<PathBuf> {
    let recipes = workspace.files(Language::Recipe, rules);
    let uses = |workspace: &mut Workspace, recipe: &Path| {
        let file = workspace.recipe(recipe);
        let words = file.parts.iter().flat_map(|part| part.words());
        let files: Vec<PathBuf> = words
            .filter_map(|word| match word.meaning {
                recipe_file::Meaning::File(written) => symbols::named_file(&file, &written),
                _ => None,
            })
            .filter(|path| Language::of(path) == Some(Language::Rules))
            .collect();
        files.iter().any(|path| {
            workspace.rules(path).is_some_and(|file| file.index.files.iter().any(|file| file.path == rules))
        })
    };
    let common = |path: &Path| path.components().zip(rules.components()).take_while(|(a, b)| a == b).count();
    let mut found: Vec<PathBuf> = recipes.into_iter().filter(|recipe| uses(workspace, recipe)).collect();
    found.sort_by_key(|path| (std::cmp::Reverse(common(path)), path.clone()));
    found.into_iter().next()
}
