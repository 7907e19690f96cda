//! Proposals in a rule file. In: the spot of [`context`]. Out: names that fit there, the file's own first.

use std::path::Path;

use lsp_types::CompletionItemKind as ItemKind;

use super::completion::{Offer, files};
use super::hover::annotation;
use crate::cga;
use crate::cga::ast::DeclarationKind;
use crate::cga::builtins::{Attr, Function, Operation, Signature, Word, usage};
use crate::cga::program::{Constant, Type};
use crate::language_server::context::{Call, Context, Spot, context};
use crate::language_server::describe;
use crate::language_server::manual;
use crate::language_server::rule_file::{Declared, Kind, RuleFile};
use crate::language_server::symbols::import;
use crate::language_server::workspace::Workspace;
use crate::source::Project;

/// Endings of textures.
const PICTURES: &[&str] = &["png", "jpg", "jpeg", "tif", "tiff", "bmp", "tga"];
/// Endings of geometry.
const MODELS: &[&str] = &["obj", "glb", "gltf"];

/// Where the replaced text begins, and what may stand there.
pub fn offers(workspace: &mut Workspace, path: &Path, text: &str, offset: u32) -> (u32, Vec<Offer>) {
    let found = context(text, offset);
    let rules = workspace.rules(path);
    let Some(file) = rules.as_deref().filter(|file| file.main().is_some()) else { return (found.start, Vec::new()) };
    let begun = &text[found.start as usize..offset as usize];
    let offers = match &found.spot {
        Spot::Nothing => Vec::new(),
        Spot::Declaration => declarations(),
        Spot::Annotation => cga::annotation_names().map(annotation_offer).collect(),
        Spot::AnnotationArgument(name) => annotation_arguments(name),
        Spot::Sequence => sequence(file, begun),
        Spot::Selector => {
            let words = cga::selector_words().iter().map(|word| word_offer(*word));
            words.chain(values(file, &found, begun)).collect()
        }
        Spot::Expression => expression(file, &found, begun),
        Spot::Override(prefix) => overrides(file, prefix),
        Spot::ImportPath(_) | Spot::Text(_) => {
            let is_import = matches!(found.spot, Spot::ImportPath(_));
            let (kept, offers) = texts(path, is_import, found.call.as_ref(), begun);
            return (found.start + kept as u32, offers);
        }
    };
    (found.start, offers)
}

fn declarations() -> Vec<Offer> {
    let snippets = [
        ("attr", "attr ${1:name} = ${2:0}"),
        ("const", "const ${1:name} = ${2:0}"),
        ("import", "import ${1:prefix} : \"${2:file.cga}\""),
        ("style", "style ${1:Name}"),
        ("version", "version \"${1:2024.0}\""),
        ("start", "start ${1:Lot} -->\n\t$0"),
        ("extension", "extension ${1:Name} -->\n\t$0"),
    ];
    let said = |word: &str| manual::KEYWORDS.iter().find(|(k, _)| *k == word).map_or("", |(_, said)| said);
    let keyword =
        |(word, snippet): (&str, &str)| Offer::new(word, ItemKind::KEYWORD).documentation(said(word)).snippet(snippet);
    let mut out: Vec<Offer> = snippets.into_iter().map(keyword).collect();
    out.push(Offer::new("@StartRule", ItemKind::KEYWORD).documentation(annotation("StartRule")));
    out.push(
        Offer::new("@Range", ItemKind::KEYWORD).documentation(annotation("Range")).snippet("@Range(min=$1, max=$2)"),
    );
    out
}

fn annotation_offer(name: &'static str) -> Offer {
    let offer = Offer::new(name, ItemKind::PROPERTY).documentation(annotation(name));
    match name {
        "Range" => offer.snippet("Range(min=$1, max=$2)"),
        "Enum" | "Group" | "Description" | "DisplayName" | "File" => offer.snippet(format!("{name}(\"$1\")")),
        "Order" => offer.snippet("Order($1)"),
        _ => offer,
    }
}

fn annotation_arguments(name: &str) -> Vec<Offer> {
    let keys: &[&str] = match name {
        "Range" => &["min", "max", "stepsize", "restricted"],
        "Enum" => &["restricted", "valuesAttr"],
        "Handle" => &["shape", "axis", "type", "reference", "color"],
        "Out" => &["granularity"],
        _ => &[],
    };
    keys.iter().map(|key| Offer::new(*key, ItemKind::PROPERTY).snippet(format!("{key}=$1"))).collect()
}

/// Names that declarations of the file or, behind an import's prefix, of imported files have.
fn own<'f>(file: &'f RuleFile, begun: &str, is_kind: impl Fn(Kind) -> bool + 'f) -> Vec<(String, &'f Declared)> {
    // `lib.windows.` leads from file to file; the last part is still being written.
    let mut at = 0;
    let mut prefix = String::new();
    for part in begun.split('.').take(begun.matches('.').count()) {
        let Some(next) = import_named(file, at, part) else { return Vec::new() };
        at = next;
        prefix.push_str(part);
        prefix.push('.');
    }
    let mut out: Vec<(String, &Declared)> = Vec::new();
    for declared in file.declared.iter().filter(|d| d.file == at && !d.kind.is_inner() && is_kind(d.kind)) {
        let name = format!("{prefix}{}", declared.name.text);
        let known =
            |(other, d): &(String, &Declared)| *other == name && d.parameters.len() == declared.parameters.len();
        if !out.iter().any(known) {
            out.push((name, declared));
        }
    }
    out
}

fn import_named(file: &RuleFile, at: usize, prefix: &str) -> Option<usize> {
    import(file, at, prefix)?.1
}

fn declared_offer(file: &RuleFile, name: String, declared: &Declared) -> Offer {
    let kind = match declared.kind {
        Kind::Rule => ItemKind::CLASS,
        Kind::Attribute => ItemKind::PROPERTY,
        Kind::Constant => ItemKind::CONSTANT,
        Kind::Function => ItemKind::FUNCTION,
        Kind::Parameter | Kind::Local => ItemKind::VARIABLE,
        Kind::Import | Kind::Style => ItemKind::MODULE,
    };
    let is_called = !declared.parameters.is_empty() || declared.kind == Kind::Function;
    let snippet = is_called.then(|| {
        let places = declared.parameters.iter().enumerate().map(|(n, p)| format!("${{{}:{p}}}", n + 1));
        format!("{name}({})", places.collect::<Vec<_>>().join(", "))
    });
    let offer = Offer::new(name, kind).detail(declared.form()).documentation(describe::declared(file, declared));
    Offer { snippet, ..offer }
}

fn sequence(file: &RuleFile, begun: &str) -> Vec<Offer> {
    let rules = own(file, begun, |kind| matches!(kind, Kind::Rule | Kind::Import));
    let mut out: Vec<Offer> = rules.into_iter().map(|(name, d)| declared_offer(file, name, d)).collect();
    if begun.contains('.') {
        return out;
    }
    out.extend(Operation::ALL.iter().map(|operation| operation_offer(*operation)));
    out.push(Offer::new("NIL", ItemKind::KEYWORD).detail("nothing is left"));
    out.push(Offer::new("case", ItemKind::KEYWORD).snippet("case ${1:condition} : $2\n\telse : $0"));
    out.push(Offer::new("else", ItemKind::KEYWORD).snippet("else : $0"));
    out
}

fn operation_offer(operation: Operation) -> Offer {
    let forms = usage::operation(operation);
    let name = operation.name();
    let arguments = if operation.signatures().iter().all(|s| s.is_empty()) { "()" } else { "($1)" };
    let snippet = match operation {
        Operation::Comp | Operation::Modify => format!("{name}(${{1:f}}) {{ ${{2:side}} : $0 }}"),
        Operation::Split | Operation::SplitArea => format!("{name}(${{1:x}}) {{ ${{2:1}} : $0 }}"),
        Operation::Setback | Operation::SetbackPerEdge | Operation::SetbackToArea => {
            format!("{name}($1) {{ ${{2:all}} : $3 | remainder : $0 }}")
        }
        Operation::ShapeL | Operation::ShapeU | Operation::ShapeO | Operation::InnerRectangle => {
            format!("{name}($1) {{ shape : $2 | remainder : $0 }}")
        }
        Operation::Scatter => format!("{name}($1) {{ $0 }}"),
        Operation::Inline => format!("{name}(${{1:append}}) {{ $0 }}"),
        Operation::Union | Operation::Subtract | Operation::Intersect => format!("{name} {{ $1 | $0 }}"),
        _ => format!("{name}{arguments}"),
    };
    let first = forms.first().cloned().unwrap_or_default();
    Offer::new(name, ItemKind::METHOD).detail(first).documentation(manual::operation(operation)).snippet(snippet)
}

fn word_offer(word: Word) -> Offer {
    Offer::new(word.text(), ItemKind::ENUM_MEMBER)
}

/// Keywords of the argument, then values.
fn expression(file: &RuleFile, found: &Context, begun: &str) -> Vec<Offer> {
    let mut out: Vec<Offer> = Vec::new();
    if let Some(call) = &found.call {
        out.extend(words(call).into_iter().map(word_offer));
        if call.name == "set" && call.argument == 0 {
            let writable = Attr::table().filter(|row| row.writable && !row.deprecated);
            let own = own(file, begun, |kind| kind == Kind::Attribute);
            out.extend(own.into_iter().map(|(name, d)| declared_offer(file, name, d)));
            out.extend(writable.map(|row| attribute_offer(row.name, row.kind)));
            return out;
        }
        out.extend(choices(file, call));
    }
    out.extend(values(file, found, begun));
    out
}

/// Keywords that an argument of a built-in takes.
fn words(call: &Call) -> Vec<Word> {
    let overloads: &[Signature] = match (Operation::from_name(&call.name), Function::from_name(&call.name)) {
        (Some(operation), _) if !call.is_value || call.name == "comp" => operation.overloads(),
        (_, Some(function)) => function.overloads(),
        (Some(operation), None) => operation.overloads(),
        (None, None) => &[],
    };
    let mut out: Vec<Word> = Vec::new();
    for word in overloads.iter().filter_map(|s| s.parameters.get(call.argument)).flat_map(|p| &p.words) {
        if !out.contains(word) {
            out.push(*word);
        }
    }
    out
}

/// The values of an attribute's `@Enum`, where `set` writes it.
fn choices(file: &RuleFile, call: &Call) -> Vec<Offer> {
    let Some(program) = file.index.program.as_ref().filter(|_| call.name == "set" && call.argument == 1) else {
        return Vec::new();
    };
    let list = program.attributes().iter().filter_map(|a| a.annotations.choices.as_ref());
    let value = |constant: &Constant| match constant {
        Constant::String(text) => format!("\"{text}\""),
        Constant::Float(number) => number.to_string(),
        Constant::Bool(value) => value.to_string(),
    };
    list.flat_map(|choices| &choices.values).map(|c| Offer::new(value(c), ItemKind::VALUE)).collect()
}

fn attribute_offer(name: &'static str, kind: Type) -> Offer {
    let offer = Offer::new(name, ItemKind::PROPERTY).detail(manual::type_word(kind));
    offer.documentation(manual::attribute(name))
}

/// Parameters, attributes, functions, built-in ones.
fn values(file: &RuleFile, found: &Context, begun: &str) -> Vec<Offer> {
    let mut out: Vec<Offer> = Vec::new();
    if !begun.contains('.') {
        out.extend(found.locals.iter().map(|name| Offer::new(name, ItemKind::VARIABLE).detail("parameter")));
    }
    let is_value = |kind| matches!(kind, Kind::Attribute | Kind::Constant | Kind::Function | Kind::Import);
    out.extend(own(file, begun, is_value).into_iter().map(|(name, d)| declared_offer(file, name, d)));
    out.extend(Attr::table().filter(|row| !row.deprecated).map(|row| attribute_offer(row.name, row.kind)));
    for function in Function::ALL {
        let forms = usage::function(*function);
        let empty = function.signatures().iter().all(|s| s.trim_start().starts_with("->"));
        let snippet = format!("{}({})", function.name(), if empty { "" } else { "$1" });
        let offer = Offer::new(function.name(), ItemKind::FUNCTION).detail(forms.first().cloned().unwrap_or_default());
        out.push(offer.documentation(manual::function(*function)).snippet(snippet));
    }
    if !begun.contains('.') {
        out.extend(["true", "false", "case", "else"].map(|word| Offer::new(word, ItemKind::KEYWORD)));
    }
    out
}

/// Attributes and extension rules of an imported file, by the import's prefix.
fn overrides(file: &RuleFile, prefix: &str) -> Vec<Offer> {
    let Some(at) = import_named(file, 0, prefix) else { return Vec::new() };
    let declared = file.declared.iter().filter(|d| d.file == at);
    let mut out = Vec::new();
    for declared in declared {
        let is_extension = match &file.tree(declared).kind {
            DeclarationKind::Rule(rule) => rule.modifier == Some(crate::cga::ast::Modifier::Extension),
            _ => false,
        };
        let snippet = match declared.kind {
            Kind::Attribute => format!("{} = $1", declared.name.text),
            Kind::Rule if is_extension => format!("{} --> $1", declared.name.text),
            _ => continue,
        };
        out.push(declared_offer(file, declared.name.text.to_string(), declared).snippet(snippet));
    }
    out
}

/// Files, where the text is one that names a file.
fn texts(path: &Path, is_import: bool, call: Option<&Call>, begun: &str) -> (usize, Vec<Offer>) {
    let folder = path.parent().unwrap_or(Path::new(""));
    let project = Project::of(folder);
    let (assets, root) = (project.root().join("assets"), project.root().to_owned());
    let endings: &[&str] = match call.map(|call| call.name.as_str()) {
        _ if is_import => &["cga"],
        Some("texture" | "imageInfo") => PICTURES,
        Some("i" | "assetInfo" | "insertAlongUV") => MODELS,
        Some("set") => PICTURES,
        Some("fileExists" | "fileSearch" | "readTextFile" | "readStringTable" | "readFloatTable") => &[],
        _ => return (0, Vec::new()),
    };
    // The order in which the names are looked for.
    let folders = [assets.as_path(), root.as_path(), folder, &folder.join("assets")];
    files(&folders, begun, endings)
}
