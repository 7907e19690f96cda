//! `textDocument/codeLens`: above each rule what the last derivation counted; above the first one the way to derive.

use lsp_types::{CodeLens, CodeLensParams, Command};
use serde_json::json;

use super::execute_command::DERIVE;
use crate::language_server::derivation::{Count, Rule, grouped};
use crate::language_server::rule_file::Kind;
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

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
        let count = workspace.lenses.counts.get(&key);
        let title = match count {
            Some(count) => told(*count, &workspace.lenses.subject),
            None if number == 0 => "Derive".to_owned(),
            None => continue,
        };
        out.push(CodeLens {
            range: lines.of(rule.name.span),
            command: Some(Command { title, command: DERIVE.to_owned(), arguments: Some(vec![json!(uri)]) }),
            data: None,
        });
    }
    Ok(out)
}

fn told(count: Count, subject: &str) -> String {
    let leaves = if count.leaves == 1 { "1 leaf".to_owned() } else { format!("{} leaves", grouped(count.leaves)) };
    match count.milliseconds {
        Some(time) => format!("{leaves} · {time:.0} ms ({subject})"),
        None => leaves,
    }
}
