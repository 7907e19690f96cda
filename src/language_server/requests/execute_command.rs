//! `workspace/executeCommand`: `mansard.derive` counts for code lenses, `mansard.explain` gives the page of a code.

use lsp_types::Uri;
use serde_json::Value;

use crate::diagnostics;
use crate::language_server::derivation::Work;
use crate::language_server::server::Refusal;
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
    let uri: Option<Uri> = arguments.first().cloned().and_then(|uri| serde_json::from_value(uri).ok());
    let uri = uri.ok_or_else(|| Refusal::failed("the command's argument is the URI of a rule file"))?;
    let rules = workspace.path(&uri);
    if Language::of(&rules) != Some(Language::Rules) {
        return Err(Refusal::failed(format!("{} is no rule file", rules.display())));
    }
    let folder = rules.parent().unwrap_or(std::path::Path::new(""));
    let mut access = Access::new(Project::of(folder).tree()).map_err(|error| Refusal::failed(error.to_string()))?;
    for tree in &workspace.settings.allow {
        access.allow(tree).map_err(|error| Refusal::failed(error.to_string()))?;
    }
    Ok(Work { rules, access, overlay: workspace.documents.overlay() })
}
