//! `textDocument/hover`: what stands under the mouse, in the manual's words or the author's.

use std::path::Path;

use lsp_types::{Hover, HoverContents, HoverParams, MarkupContent, MarkupKind, Range};

use crate::cga::Meaning;
use crate::language_server::describe;
use crate::language_server::manual;
use crate::language_server::recipe_file;
use crate::language_server::server::Refusal;
use crate::language_server::symbols;
use crate::language_server::workspace::{Language, LinedText, Workspace};
use crate::spec::schema::BlockShape;

pub fn hover(workspace: &mut Workspace, params: HoverParams) -> Result<Option<Hover>, Refusal> {
    let at = params.text_document_position_params;
    let Some((path, language, text, offset)) = workspace.asked(&at) else { return Ok(None) };
    let found = match language {
        Language::Rules => in_rules(workspace, &path, offset).or_else(|| keyword(&text, offset)),
        Language::Recipe => in_recipe(workspace, &path, offset),
    };
    Ok(found.map(|(start, end, markdown)| Hover {
        contents: HoverContents::Markup(MarkupContent { kind: MarkupKind::Markdown, value: markdown }),
        range: Some(text_range(&text, start, end)),
    }))
}

fn text_range(text: &LinedText, start: u32, end: u32) -> Range {
    text.lines().range(start, end)
}

fn in_rules(workspace: &mut Workspace, path: &Path, offset: u32) -> Option<(u32, u32, String)> {
    let file = workspace.rules(path)?;
    let (span, meanings) = file.at(offset)?;
    let mut texts: Vec<String> = Vec::new();
    for meaning in meanings {
        let text = match meaning {
            Meaning::Operation(operation) => manual::operation(operation).to_owned(),
            Meaning::BuiltinFunction(function) => manual::function(function).to_owned(),
            Meaning::BuiltinAttribute(name) => manual::attribute(name).to_owned(),
            Meaning::Word(word) => format!("`{}`: a keyword of the language", word.text()),
            Meaning::Leaf => "A shape without a rule: a leaf of the tree.".to_owned(),
            own => file.declaration(own).map(|declared| describe::declared(&file, declared)).unwrap_or_default(),
        };
        texts.push(text);
    }
    texts.retain(|text| !text.is_empty());
    texts.dedup();
    (!texts.is_empty()).then(|| (span.start, span.end, texts.join("\n\n---\n\n")))
}

/// A word that no declaration and no table explains: keywords, annotations, names in declarations that cannot be read.
fn keyword(text: &LinedText, offset: u32) -> Option<(u32, u32, String)> {
    use crate::cga::builtins::{Attr, Function, Operation};
    let tokens = crate::cga::parse::lex(&text.text, 0);
    let at = tokens.places.iter().rposition(|place| place.start <= offset && offset <= place.end)?;
    let place = tokens.places[at];
    let word = tokens.text(&text.text, at);
    let is_annotation = at > 0 && tokens.letter(at - 1) == b'@';
    let markdown = if is_annotation {
        crate::cga::annotation_names().find(|name| *name == word).map(|name| annotation(name).to_owned())
    } else if let Some((_, said)) = manual::KEYWORDS.iter().find(|(keyword, _)| *keyword == word) {
        Some((*said).to_owned())
    } else if let Some(operation) = Operation::from_name(word) {
        Some(manual::operation(operation).to_owned())
    } else if let Some(function) = Function::from_name(word) {
        Some(manual::function(function).to_owned())
    } else {
        Attr::from_name(word).map(|row| manual::attribute(row.name).to_owned())
    };
    markdown.map(|markdown| (place.start, place.end, markdown))
}

/// What an annotation does.
pub fn annotation(name: &str) -> &'static str {
    match name {
        "StartRule" => "`@StartRule`: hosts may begin with this rule",
        "Hidden" => "`@Hidden`: not shown to the user",
        "Group" => "`@Group(\"name\", order)`: shown together; holds for what follows too",
        "Order" => "`@Order(n)`: place among the others",
        "Range" => "`@Range(min=0, max=1, stepsize=0.1, restricted=true)`: the values that may be given",
        "Enum" => "`@Enum(\"a\", \"b\", restricted=true)`: the values that may be given",
        "Color" => "`@Color`: a colour such as `\"#ff8800\"`",
        "File" => "`@File(\"png\", \"jpg\")`: the name of a file with one of these endings",
        "Directory" => "`@Directory`: the name of a folder",
        "MaterialFile" => "`@MaterialFile`: the name of a file of materials",
        "Angle" => "`@Angle`: degrees, 0 to 360",
        "Distance" => "`@Distance`: metres",
        "Percent" => "`@Percent`: a share, 0 to 1",
        "Description" => "`@Description(\"text\")`: what the user reads about it",
        "DisplayName" => "`@DisplayName(\"text\")`: what the user sees it called",
        "RuleFileDescription" => "`@RuleFileDescription(\"text\")`: what the user reads about the file",
        "Handle" => "`@Handle(shape=Name, axis=y)`: a handle in the host's view; has no effect here",
        "InMesh" | "InPolygon" | "InLine" | "InPoint" | "InPointCloud" => {
            "The kind of start shape that the rule is meant for"
        }
        "Out" => "`@Out(granularity=separatedShapes)`: how a host takes the result",
        _ => "",
    }
}

fn in_recipe(workspace: &mut Workspace, path: &Path, offset: u32) -> Option<(u32, u32, String)> {
    use recipe_file::Meaning as M;
    let file = workspace.recipe(path);
    let word = file.at(offset)?;
    let markdown = match &word.meaning {
        M::Kind(kind) => manual::block(BlockShape::find(kind)?),
        M::Key { block, key } | M::Clause { block, key, .. } => {
            let shape = BlockShape::find(block)?;
            manual::key(shape, shape.key(key)?)
        }
        M::Start { .. } | M::Attribute { .. } => {
            let (rules, declared) = symbols::named_rule(workspace, &file, &word.meaning)?;
            describe::declared(&rules, &rules.declared[declared])
        }
        M::Block { kind, name } => {
            let block =
                file.blocks().find(|b| b.kind.text == *kind && b.name.as_ref().is_some_and(|n| n.text == *name))?;
            let list: Vec<String> = block.properties.iter().map(|property| format!("    {property}\n")).collect();
            format!("```render\n{kind} {name} {{\n{}}}\n```", list.concat())
        }
        M::Input(name) => {
            let input = file.parts.iter().flat_map(|part| &part.ast.inputs).find(|input| input.name.text == *name)?;
            format!("```render\ninput {name} : {}\n```", input.kind.text)
        }
        M::File(written) => {
            let found = symbols::named_file(&file, written)?;
            format!("`{}`", found.display())
        }
    };
    Some((word.span.start, word.span.end, markdown))
}

#[cfg(test)]
mod tests {
    use super::annotation;

    #[test]
    fn every_annotation_is_explained() {
        assert!(crate::cga::annotation_names().all(|name| !annotation(name).is_empty()));
    }
}
