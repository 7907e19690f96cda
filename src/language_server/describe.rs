//! In: a declared name. Out: what hover says about it, as Markdown: its head, type, annotations and the comment above.

use std::fmt::Write;

use super::manual::type_word;
use super::rule_file::{Declared, Kind, RuleFile, annotation_text, comment_above};
use crate::cga::Meaning;
use crate::cga::ast::{DeclarationKind, Override};
use crate::cga::program::{Parameter, Program, Type};
use crate::source::Span;

/// Characters of a value that are shown.
const MOST_SHOWN: usize = 80;

/// Everything about a declaration.
pub fn declared(file: &RuleFile, declared: &Declared) -> String {
    let declaration = file.tree(declared);
    let mut out = format!("```cga\n{}\n```", head(file, declared));
    if declared.kind.is_inner() {
        return out;
    }
    let annotations = declaration.annotations.iter().filter(|a| !matches!(&*a.name.text, "Group" | "Order"));
    let annotations: Vec<String> = annotations.map(|a| format!("`{}`", annotation_text(file, a))).collect();
    if !annotations.is_empty() {
        write!(out, "\n\n{}", annotations.join(" ")).expect("a string takes everything");
    }
    let indexed = &file.index.files[declared.file];
    let comment = comment_above(&indexed.text, declaration);
    if !comment.is_empty() {
        write!(out, "\n\n{}", escaped(&comment)).expect("a string takes everything");
    }
    if declared.file > 0 {
        let name = indexed.path.file_name().unwrap_or_default().to_string_lossy();
        write!(out, "\n\n*{name}*").expect("a string takes everything");
    }
    out
}

/// The first line: `attr height: number = 3`, `Wall(h: number) -->`.
fn head(file: &RuleFile, declared: &Declared) -> String {
    let name = &declared.name.text;
    let program = file.index.program.as_ref();
    match &file.tree(declared).kind {
        _ if declared.kind.is_inner() => inner(file, declared),
        DeclarationKind::Rule(rule) => {
            let modifier = match rule.modifier {
                Some(crate::cga::ast::Modifier::Start) => "start ",
                Some(crate::cga::ast::Modifier::Extension) => "extension ",
                None => "",
            };
            let known = program.and_then(|p| p.rules().iter().find(|r| r.span == rule.name.span));
            format!("{modifier}{name}{} -->", parameters(declared, known.map(|rule| &rule.parameters[..])))
        }
        DeclarationKind::Definition(definition) => {
            let value = shortened(file.written(definition.value.span));
            let span = definition.name.span;
            let kind = program.and_then(|p| value_type(p, span)).map(|kind| format!(": {}", type_word(kind)));
            let kind = kind.unwrap_or_default();
            if declared.kind == Kind::Function {
                let known = program.and_then(|p| p.functions().iter().find(|f| f.span == span));
                let list = parameters(declared, known.map(|function| &function.parameters[..]));
                let list = if list.is_empty() { "()".to_owned() } else { list };
                return format!("{name}{list}{kind} = {value}");
            }
            let word = if declared.kind == Kind::Constant { "const" } else { "attr" };
            format!("{word} {name}{kind} = {value}")
        }
        DeclarationKind::Import(import) if declared.name.span == import.prefix.span => {
            format!("import {name} : \"{}\"", import.path.text)
        }
        DeclarationKind::Import(import) => {
            let is_it =
                |item: &&Override| matches!(item, Override::Rule { name, .. } if name.span == declared.name.span);
            let replaced = import.overrides.iter().flatten().find(is_it);
            let of = replaced.map_or(String::new(), |_| format!("{}.", import.prefix.text));
            format!("{of}{} -->", declared.form())
        }
        DeclarationKind::Style(style) => match &style.base {
            Some(base) => format!("style {name} extends {}", base.text),
            None => format!("style {name}"),
        },
    }
}

/// `(h: number, n)` with the types that inference found.
fn parameters(declared: &Declared, known: Option<&[Parameter]>) -> String {
    let list: Vec<String> = declared
        .parameters
        .iter()
        .enumerate()
        .map(|(i, name)| match known.and_then(|known| known.get(i)).and_then(|p| p.kind) {
            Some(kind) => format!("{name}: {}", type_word(kind)),
            None => name.to_string(),
        })
        .collect();
    if list.is_empty() { String::new() } else { format!("({})", list.join(", ")) }
}

fn inner(file: &RuleFile, declared: &Declared) -> String {
    let around = file
        .declared
        .iter()
        .find(|d| !d.kind.is_inner() && (d.file, d.declaration) == (declared.file, declared.declaration));
    let of = around.map_or(String::new(), |outer| format!(" of {}", outer.form()));
    format!("{} {}{of}", declared.kind.word(), declared.name.text)
}

/// The type of an attribute, constant or function.
pub fn value_type(program: &Program, span: Span) -> Option<Type> {
    let attribute = program.attributes().iter().find(|a| a.span == span).and_then(|a| a.kind);
    attribute.or_else(|| program.functions().iter().find(|f| f.span == span).and_then(|f| f.body.value))
}

/// On one line, not too long.
fn shortened(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(MOST_SHOWN) {
        Some((end, _)) => format!("{}…", &line[..end]),
        None => line,
    }
}

/// Comments are plain text.
fn escaped(text: &str) -> String {
    text.chars().fold(String::new(), |mut out, c| {
        if matches!(c, '*' | '_' | '`' | '<' | '[' | '\\') {
            out.push('\\');
        }
        out.push(c);
        if c == '\n' {
            out.insert_str(out.len() - 1, "  ");
        }
        out
    })
}

/// What a meaning is called in one word, for messages.
pub fn word(meaning: Meaning) -> &'static str {
    match meaning {
        Meaning::Rule(_) => "a rule",
        Meaning::Value(_) => "a value",
        Meaning::Local(_) => "a parameter",
        Meaning::Import(_) => "an import",
        Meaning::Operation(_) => "an operation of the language",
        Meaning::BuiltinFunction(_) => "a function of the language",
        Meaning::BuiltinAttribute(_) => "an attribute of the language",
        Meaning::Word(_) => "a keyword of the language",
        Meaning::Leaf => "a shape without a rule",
    }
}
