//! In: the path of a recipe. Out: its blocks and inputs together with those of every file that it uses.

use std::path::{Path, PathBuf};

use super::ast::{Block, ExprKind, InputDecl, Name, SpecAst};
use super::parse::parse;
use super::render_spec::Origin;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::{Access, MOST_TEXT_BYTES, SourceId, SourceMap, Span};

/// Where the paths of each text start.
#[derive(Debug, Default)]
pub(super) struct Folders(Vec<(SourceId, Origin)>);

impl Folders {
    pub fn add(&mut self, source: SourceId, origin: Origin) {
        self.0.push((source, origin));
    }

    pub fn origin(&self, source: SourceId) -> Origin {
        let found = self.0.iter().find(|(id, _)| *id == source);
        found.expect("every text of a recipe was registered").1.clone()
    }
}

/// All files of a recipe taken together.
#[derive(Debug, Default)]
pub(super) struct Recipe {
    pub inputs: Vec<InputDecl>,
    pub blocks: Vec<Block>,
    pub folders: Folders,
}

/// Reads the recipe and, after it, the files it uses; each file once, so that circles do no harm.
pub(super) fn read(path: &str, access: &Access, sources: &mut SourceMap, diagnostics: &mut Diagnostics) -> Recipe {
    let mut recipe = Recipe::default();
    let mut seen: Vec<PathBuf> = Vec::new();
    // The user's own path may lead through links; only what the recipe names is held to its folder tree.
    let (folder, file) = match (Path::new(path).parent(), Path::new(path).file_name()) {
        (Some(folder), Some(file)) => (folder.to_owned(), file.to_string_lossy().into_owned()),
        _ => (PathBuf::new(), path.to_owned()),
    };
    // Path as written, the folder it is relative to, what messages call it, where it was asked for.
    let mut waiting = vec![(file, folder, path.to_owned(), None)];
    while let Some((written, base, shown, asked)) = waiting.pop() {
        let (real, text) = match text(access, &base, &written) {
            Ok(found) => found,
            Err(message) => {
                let at = asked.unwrap_or_else(|| Span::new(sources.add(shown.as_str(), "").id, 0, 0));
                diagnostics.push(Diagnostic::error("spec::unreadable-file", at, message));
                continue;
            }
        };
        if seen.contains(&real) {
            continue;
        }
        let file = sources.add(shown.as_str(), text);
        let folder = real.parent().unwrap_or(Path::new("")).to_owned();
        seen.push(real);
        recipe.folders.add(file.id, Origin::Beside(folder.clone()));
        let (ast, found) = parse(&file);
        diagnostics.extend(found);
        check_version(&ast, diagnostics);
        for Name { text: used, span } in ast.uses.iter().rev() {
            let beside = Path::new(&shown).parent().unwrap_or(Path::new("")).join(used);
            waiting.push((used.clone(), folder.clone(), beside.display().to_string(), Some(*span)));
        }
        recipe.inputs.extend(ast.inputs);
        recipe.blocks.extend(ast.blocks);
    }
    recipe
}

fn text(access: &Access, base: &Path, written: &str) -> Result<(PathBuf, String), String> {
    let (real, bytes) = access.read(base, written, MOST_TEXT_BYTES).map_err(|error| error.to_string())?;
    let text = String::from_utf8(bytes)
        .map_err(|error| format!("{written} is not UTF-8 text: wrong byte at {}", error.utf8_error().valid_up_to()))?;
    Ok((real, text))
}

fn check_version(ast: &SpecAst, diagnostics: &mut Diagnostics) {
    if let Some(version) = &ast.version
        && !matches!(&version.kind, ExprKind::Quantity { value, unit: None } if *value == 1.0)
    {
        let message = format!("this program reads version 1 of the language, not {version}");
        diagnostics.push(Diagnostic::error("spec::unknown-version", version.span, message));
    }
}
