//! `textDocument/references`: every use of what a name means, in all rule files and recipes of the workspace.

use std::collections::BTreeSet;

use lsp_types::{Location, ReferenceParams};

use crate::language_server::rule_file::Place;
use crate::language_server::server::Refusal;
use crate::language_server::symbols::{declarations, last_part, uses};
use crate::language_server::workspace::Workspace;

pub fn references(workspace: &mut Workspace, params: ReferenceParams) -> Result<Vec<Location>, Refusal> {
    let Some((path, language, _, offset)) = workspace.asked(&params.text_document_position) else {
        return Ok(Vec::new());
    };
    let targets: BTreeSet<Place> = declarations(workspace, &path, language, offset).into_iter().collect();
    let Some(first) = targets.first() else { return Ok(Vec::new()) };
    let Some(text) = workspace.text(&first.path) else { return Ok(Vec::new()) };
    // A file that changed unseen has other text there by now.
    let Some(written) = text.get(first.start as usize..first.end as usize) else { return Ok(Vec::new()) };
    let name = last_part(written).to_owned();
    let mut found = uses(workspace, &targets, &name, &path);
    if params.context.include_declaration {
        found.extend(targets);
    }
    Ok(found.iter().filter_map(|place| workspace.location(place)).collect())
}
