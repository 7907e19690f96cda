//! `textDocument/signatureHelp`: the overloads of the call around the cursor, the argument's parameter marked.

use lsp_types::{
    Documentation, MarkupContent, MarkupKind, ParameterInformation, ParameterLabel, SignatureHelp, SignatureHelpParams,
    SignatureInformation,
};

use crate::cga::builtins::{Function, Operation, usage};
use crate::language_server::context::{Call, context};
use crate::language_server::describe;
use crate::language_server::manual;
use crate::language_server::rule_file::{Kind, RuleFile};
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};

/// A form, the number of its parameters, and what is said about it.
type Form = (String, Option<String>);

pub fn signature_help(
    workspace: &mut Workspace,
    params: SignatureHelpParams,
) -> Result<Option<SignatureHelp>, Refusal> {
    let at = params.text_document_position_params;
    let Some((path, Language::Rules, text, offset)) = workspace.asked(&at) else { return Ok(None) };
    let Some(call) = context(&text.text, offset).call else { return Ok(None) };
    let mut forms = workspace.rules(&path).map(|file| own(&file, &call)).unwrap_or_default();
    if forms.is_empty() {
        forms = built_in(&call);
    }
    if forms.is_empty() {
        return Ok(None);
    }
    let signatures: Vec<SignatureInformation> = forms.into_iter().map(|form| signature(workspace, form)).collect();
    let takes = |s: &SignatureInformation| s.parameters.as_ref().map_or(0, Vec::len) > call.argument;
    let active = signatures.iter().position(takes).unwrap_or(0) as u32;
    Ok(Some(SignatureHelp { signatures, active_signature: Some(active), active_parameter: Some(call.argument as u32) }))
}

fn own(file: &RuleFile, call: &Call) -> Vec<Form> {
    let (prefix, name) = call.name.rsplit_once('.').unwrap_or(("", &call.name));
    let fits = |kind: Kind| if call.is_value { kind == Kind::Function } else { kind == Kind::Rule };
    let at = match prefix {
        "" => Some(0),
        _ => crate::language_server::symbols::named(file, &call.name, fits).map(|found| file.declared[found].file),
    };
    let declared = file.declared.iter().filter(|d| Some(d.file) == at && fits(d.kind) && &*d.name.text == name);
    declared.map(|d| (d.form(), Some(describe::declared(file, d)))).collect()
}

fn built_in(call: &Call) -> Vec<Form> {
    let operation = Operation::from_name(&call.name).filter(|_| !call.is_value || call.name == "comp");
    let told = |forms: Vec<String>, text: String| forms.into_iter().map(|form| (form, Some(text.clone()))).collect();
    match (operation, Function::from_name(&call.name)) {
        (Some(operation), _) => told(usage::operation(operation), manual::operation_text(operation)),
        (None, Some(function)) => told(usage::function(function), manual::function_text(function)),
        (None, None) => Vec::new(),
    }
}

fn signature(workspace: &Workspace, (label, text): Form) -> SignatureInformation {
    let parameters = parameters(&label)
        .into_iter()
        .map(|(start, end)| {
            let units = |at: usize| workspace.encoding.length(&label[..at]);
            ParameterInformation {
                label: match workspace.client.label_offsets {
                    true => ParameterLabel::LabelOffsets([units(start), units(end)]),
                    false => ParameterLabel::Simple(label[start..end].to_owned()),
                },
                documentation: None,
            }
        })
        .collect();
    let documentation = text
        .filter(|text| !text.is_empty())
        .map(|value| Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value }));
    SignatureInformation { label, documentation, parameters: Some(parameters), active_parameter: None }
}

/// Where the parameters lie in `name(a, b [, c])`.
fn parameters(label: &str) -> Vec<(usize, usize)> {
    let Some(open) = label.find('(') else { return Vec::new() };
    let close = label[open..].find(')').map_or(label.len(), |at| open + at);
    let mut out = Vec::new();
    let mut start = open + 1;
    for piece in label[open + 1..close].split(',') {
        let trimmed = piece.trim_matches([' ', '[', ']']);
        if let Some(lead) = piece.find(trimmed).filter(|_| !trimmed.is_empty()) {
            out.push((start + lead, start + lead + trimmed.len()));
        }
        start += piece.len() + 1;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::parameters;

    #[test]
    fn parameters_are_found_in_a_form() {
        let label = "roofHip(number [, number [, bool]]) → x";
        let found: Vec<&str> = parameters(label).into_iter().map(|(a, b)| &label[a..b]).collect();
        assert_eq!(found, ["number", "number", "bool"]);
        assert!(parameters("footprint()").is_empty());
    }
}
