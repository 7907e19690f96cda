//! `textDocument/codeLens`: above each rule what the last derivation counted; above the first one the way to derive.

use lsp_types::{CodeLens, CodeLensParams, Command};
use serde_json::json;

use super::execute_command::DERIVE;
use crate::language_server::derivation::{Count, Rule};
use crate::language_server::rule_file::Kind;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};
use crate::live::thousands;

pub fn code_lens(workspace: &mut Workspace, params: CodeLensParams) -> Result<Vec<CodeLens>, Refusal> {
    let uri = params.text_document.uri;
    let path = workspace.path(&uri);
    if Language::of(&path) != Some(Language::Rules) {
        return Ok(Vec::new());
    }
    let encoding = workspace.encoding;
    let Some(file) = workspace.rules(&path).filter(|file| file.main().is_some()) else { return Ok(Vec::new()) };
    let lines = file.lines(0, encoding);
    let mut out = Vec::new();
    for (number, rule) in file.own().filter(|d| d.kind == Kind::Rule).enumerate() {
        let key = Rule::new(path.clone(), &rule.name.text, rule.parameters.len());
        let subject = &workspace.lenses.subject;
        let counted = workspace.lenses.counts.get(&key).map(|count| told(*count));
        let offered = (number == 0).then(|| match subject.is_empty() {
            true => "Derive".to_owned(),
            false => format!("Derived: {subject}"),
        });
        out.extend(counted.into_iter().chain(offered).map(|title| CodeLens {
            range: lines.of(rule.name.span),
            command: Some(Command { title, command: DERIVE.to_owned(), arguments: Some(vec![json!(uri)]) }),
            data: None,
        }));
    }
    Ok(out)
}

fn told(count: Count) -> String {
    let Count { calls, leaves, milliseconds } = count;
    let some = |number: u64, one: &str, many: &str| match number {
        1 => format!("1 {one}"),
        number => format!("{} {many}", thousands(number as usize)),
    };
    let time = if milliseconds < 10.0 { format!("{milliseconds:.1} ms") } else { format!("{milliseconds:.0} ms") };
    match (calls, leaves) {
        (0, _) => "not called".to_owned(),
        // A rule that only leads to others.
        (calls, 0) => format!("{} · {time}", some(calls, "call", "calls")),
        (_, leaves) => format!("{} · {time}", some(leaves, "leaf", "leaves")),
    }
}
