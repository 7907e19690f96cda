//! `textDocument/documentSymbol`: the declarations of a rule file with their parameters, the blocks of a recipe with their
//! properties.

use std::path::Path;

use lsp_types::{DocumentSymbol, DocumentSymbolParams, DocumentSymbolResponse, SymbolInformation, SymbolKind, Uri};

use crate::language_server::position::Lines;
use crate::language_server::rule_file::{Declared, Kind, RuleFile};
use crate::language_server::server::Refusal;
use crate::language_server::workspace::{Language, Workspace};
use crate::source::Span;
use crate::spec::ast::Block;

pub fn document_symbols(
    workspace: &mut Workspace,
    params: DocumentSymbolParams,
) -> Result<DocumentSymbolResponse, Refusal> {
    let uri = params.text_document.uri;
    let path = workspace.path(&uri);
    let symbols = match Language::of(&path) {
        Some(Language::Rules) => of_rules(workspace, &path),
        Some(Language::Recipe) => of_recipe(workspace, &path),
        None => Vec::new(),
    };
    Ok(match workspace.client.hierarchical_symbols {
        true => DocumentSymbolResponse::Nested(symbols),
        false => {
            let mut flat = Vec::new();
            symbols.into_iter().for_each(|symbol| flatten(symbol, None, &uri, &mut flat));
            DocumentSymbolResponse::Flat(flat)
        }
    })
}

#[expect(deprecated, reason = "the type has a deprecated field that must be filled in")]
pub fn symbol(
    name: String,
    detail: Option<String>,
    kind: SymbolKind,
    lines: &Lines,
    (whole, name_span): (Span, Span),
    children: Vec<DocumentSymbol>,
) -> DocumentSymbol {
    let whole = if whole.source == name_span.source { whole.to(name_span) } else { name_span };
    DocumentSymbol {
        // Some clients refuse symbols without a name.
        name: if name.is_empty() { "?".to_owned() } else { name },
        detail,
        kind,
        tags: None,
        deprecated: None,
        range: lines.of(whole),
        selection_range: lines.of(name_span),
        children: (!children.is_empty()).then_some(children),
    }
}

pub fn symbol_kind(kind: Kind) -> SymbolKind {
    match kind {
        Kind::Rule => SymbolKind::CLASS,
        Kind::Attribute => SymbolKind::PROPERTY,
        Kind::Constant => SymbolKind::CONSTANT,
        Kind::Function => SymbolKind::FUNCTION,
        Kind::Parameter | Kind::Local => SymbolKind::VARIABLE,
        Kind::Import => SymbolKind::MODULE,
        Kind::Style => SymbolKind::NAMESPACE,
    }
}

fn of_rules(workspace: &mut Workspace, path: &Path) -> Vec<DocumentSymbol> {
    let encoding = workspace.encoding;
    let Some(file) = workspace.rules(path).filter(|file| file.main().is_some()) else { return Vec::new() };
    let lines = file.lines(0, encoding);
    file.own().map(|declared| of_declared(&file, declared, &lines)).collect()
}

fn of_declared(file: &RuleFile, declared: &Declared, lines: &Lines) -> DocumentSymbol {
    let inner = file
        .declared
        .iter()
        .filter(|d| d.kind.is_inner() && (d.file, d.declaration) == (declared.file, declared.declaration));
    let children = inner.map(|d| {
        let detail = Some(d.kind.word().to_owned());
        symbol(d.name.text.to_string(), detail, symbol_kind(d.kind), lines, (d.name.span, d.name.span), Vec::new())
    });
    let whole = file.tree(declared).span;
    let detail = Some(declared.kind.word().to_owned());
    let spans = (whole, declared.name.span);
    symbol(declared.form(), detail, symbol_kind(declared.kind), lines, spans, children.collect())
}

fn of_recipe(workspace: &mut Workspace, path: &Path) -> Vec<DocumentSymbol> {
    let encoding = workspace.encoding;
    let file = workspace.recipe(path);
    let Some(part) = file.parts.first() else { return Vec::new() };
    let lines = file.lines(0, encoding);
    let inputs = part.ast.inputs.iter().map(|input| {
        let detail = Some(format!("input : {}", input.kind.text));
        let spans = (input.span, input.name.span);
        symbol(input.name.text.clone(), detail, SymbolKind::VARIABLE, &lines, spans, Vec::new())
    });
    inputs.chain(part.ast.blocks.iter().map(|block| of_block(block, &lines))).collect()
}

fn of_block(block: &Block, lines: &Lines) -> DocumentSymbol {
    let children = block.properties.iter().map(|property| {
        let spans = (property.span, property.key.span);
        symbol(property.key.text.clone(), None, SymbolKind::FIELD, lines, spans, Vec::new())
    });
    let whole = block.properties.last().map_or(block.span, |last| block.span.to(last.span));
    let name = block.name.as_ref().unwrap_or(&block.kind);
    let detail = Some(block.kind.text.clone());
    symbol(name.text.clone(), detail, SymbolKind::STRUCT, lines, (whole, name.span), children.collect())
}

#[expect(deprecated, reason = "the type has a deprecated field that must be filled in")]
fn flatten(symbol: DocumentSymbol, around: Option<String>, uri: &Uri, out: &mut Vec<SymbolInformation>) {
    out.push(SymbolInformation {
        name: symbol.name.clone(),
        kind: symbol.kind,
        tags: None,
        deprecated: None,
        location: lsp_types::Location { uri: uri.clone(), range: symbol.range },
        container_name: around,
    });
    for child in symbol.children.into_iter().flatten() {
        flatten(child, Some(symbol.name.clone()), uri, out);
    }
}
