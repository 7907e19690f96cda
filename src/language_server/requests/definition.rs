//! `textDocument/definition`: from a name to where it is declared, from a file's name to the file.

use std::path::Path;

use lsp_types::{GotoDefinitionParams, Location};

use crate::cga::ast::DeclarationKind;
use crate::language_server::recipe_file;
use crate::language_server::server::Refusal;
use crate::language_server::symbols;
use crate::language_server::workspace::{Language, Workspace};

pub fn definition(workspace: &mut Workspace, params: GotoDefinitionParams) -> Result<Vec<Location>, Refusal> {
    let at = params.text_document_position_params;
    let Some((path, language, _, offset)) = workspace.asked(&at) else { return Ok(Vec::new()) };
    if let Some(file) = named_file(workspace, &path, language, offset) {
        return Ok(file.into_iter().collect());
    }
    let places = symbols::declarations(workspace, &path, language, offset);
    Ok(places.iter().filter_map(|place| workspace.location(place)).collect())
}

/// Where the text at a place names a file: that file, if it is there.
fn named_file(workspace: &mut Workspace, path: &Path, language: Language, offset: u32) -> Option<Option<Location>> {
    let named = match language {
        Language::Rules => {
            let file = workspace.rules(path)?;
            let main = file.main()?;
            let imports = main.ast.declarations.iter().filter_map(|d| match &d.kind {
                DeclarationKind::Import(import) => Some(import.path.span),
                _ => None,
            });
            let (_, target) = imports.zip(&main.imports).find(|(s, _)| s.start <= offset && offset <= s.end)?;
            target.map(|index| file.index.files[index].path.clone())
        }
        Language::Recipe => {
            let file = workspace.recipe(path);
            let recipe_file::Meaning::File(written) = file.at(offset)?.meaning else { return None };
            symbols::named_file(&file, &written)
        }
    };
    Some(named.and_then(|path| workspace.file_location(&path)))
}
