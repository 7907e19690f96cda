//! The manual's text, from the pages that tests hold to the program's tables. In: a name of the rule language or a key of
//! a recipe. Out: what `docs/cga.md` and `docs/render.md` say about it, as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::LazyLock;

use crate::cga::builtins::{Attr, AttrInfo, Function, Operation, usage};
use crate::cga::program::Type;
use crate::spec::PRESETS;
use crate::spec::schema::{BlockShape, Key};

static RULES: &str = include_str!("../../docs/cga.md");
static RECIPES: &str = include_str!("../../docs/render.md");

/// Pages in the order of the tables, put together once.
static OPERATIONS: LazyLock<Vec<String>> = LazyLock::new(|| {
    Operation::ALL.iter().map(|operation| page(&usage::operation(*operation), &operation_text(*operation))).collect()
});
static FUNCTIONS: LazyLock<Vec<String>> = LazyLock::new(|| {
    Function::ALL.iter().map(|function| page(&usage::function(*function), &function_text(*function))).collect()
});
static ATTRIBUTES: LazyLock<BTreeMap<&str, String>> =
    LazyLock::new(|| Attr::table().map(|row| (row.name, attribute_page(row))).collect());

/// Signatures and text of an operation.
pub fn operation(operation: Operation) -> &'static str {
    &OPERATIONS[operation as usize]
}

/// The prose of an operation's section and its example.
pub fn operation_text(operation: Operation) -> String {
    let heading = format!("\n#### {}\n", operation.name());
    let Some(start) = RULES.find(&heading).map(|at| at + heading.len()) else { return String::new() };
    let section = &RULES[start..];
    let end = ["\n#### ", "\n### ", "\n## "].iter().filter_map(|next| section.find(next)).min();
    let mut out = String::new();
    // The signatures are written anew; pictures and what examples print stay in the manual.
    let mut hidden = false;
    for line in section[..end.unwrap_or(section.len())].lines() {
        if let Some(kind) = line.strip_prefix("```") {
            let opens = !kind.is_empty();
            let was_hidden = std::mem::replace(&mut hidden, opens && !kind.starts_with("cga"));
            if !hidden && !was_hidden {
                out.push_str(if opens { "```cga\n" } else { "```\n" });
            }
        } else if !hidden && !line.starts_with("![") && !line.starts_with("<!--") {
            out.push_str(line);
            out.push('\n');
        }
    }
    while out.contains("\n\n\n") {
        out = out.replace("\n\n\n", "\n\n");
    }
    out.trim().to_owned()
}

/// Signatures and text of a function.
pub fn function(function: Function) -> &'static str {
    &FUNCTIONS[function as usize]
}

pub fn function_text(function: Function) -> String {
    row(RULES, "Functions", function.name()).and_then(|cells| cells.last().cloned()).unwrap_or_default()
}

/// Type and text of a built-in attribute.
pub fn attribute(name: &str) -> &'static str {
    ATTRIBUTES.get(name).map_or("", String::as_str)
}

fn attribute_page(info: &AttrInfo) -> String {
    let name = info.name;
    let read_only = if info.writable { "" } else { ", read only" };
    let head = format!("{name}: {}{read_only}", type_word(info.kind));
    let present = info.attr.info().name;
    let mut text = row(RULES, "Attributes", present).and_then(|cells| cells.last().cloned()).unwrap_or_default();
    if info.deprecated {
        text = format!("An old name of `{present}`. {text}");
    }
    page(&[head], &text)
}

/// A type as the manual calls it.
pub fn type_word(kind: Type) -> &'static str {
    match kind {
        Type::Float => "number",
        Type::Bool => "bool",
        Type::String => "text",
        Type::Floats => "numbers",
        Type::Bools => "bools",
        Type::Strings => "texts",
    }
}

fn page(signatures: &[String], text: &str) -> String {
    let code = signatures.join("\n");
    if text.is_empty() { format!("```cga\n{code}\n```") } else { format!("```cga\n{code}\n```\n\n{text}") }
}

/// The cells of the row that names `name` in its first cell, in the chapter of this heading.
fn row(page: &'static str, chapter: &str, name: &str) -> Option<Vec<String>> {
    let start = page.find(&format!("\n## {chapter}\n"))?;
    let chapter = &page[start + 1..];
    let chapter = &chapter[..chapter.find("\n## ").unwrap_or(chapter.len())];
    row_in(chapter, name)
}

fn row_in(section: &str, name: &str) -> Option<Vec<String>> {
    let name = format!("`{name}`");
    section.lines().filter_map(cells).find(|cells| cells[0].split([' ', ',']).any(|word| word == name))
}

fn cells(line: &str) -> Option<Vec<String>> {
    let inner = line.strip_prefix("| ")?.strip_suffix('|')?;
    Some(inner.split(" | ").map(|cell| cell.trim().trim_matches('|').trim().replace("\\|", "|")).collect())
}

fn section(kind: &str) -> &'static str {
    let Some(start) = RECIPES.find(&format!("\n### {kind}\n")) else { return "" };
    let section = &RECIPES[start + 1..];
    &section[..section.find("\n##").unwrap_or(section.len())]
}

/// What the page says about a key of a block: its values, its default, the words that may follow.
pub fn key(block: &BlockShape, key: &Key) -> String {
    let section = section(block.kind);
    let header = section.lines().find_map(cells).unwrap_or_default();
    let mut out = format!("**{}** of `{}`", key.key, block.kind);
    for (title, cell) in header.iter().zip(row_in(section, key.key).unwrap_or_default()).skip(1) {
        if !cell.is_empty() {
            write!(out, "\n\n*{}*: {cell}", title.trim_matches('`')).expect("a string takes everything");
        }
    }
    if !key.clauses.is_empty() {
        let words: Vec<String> = key.clauses.iter().map(|word| format!("`{word}`")).collect();
        write!(out, "\n\n*may be followed by*: {}", words.join(", ")).expect("a string takes everything");
    }
    if !key.evaluated {
        out.push_str("\n\nNot evaluated yet.");
    }
    out
}

/// Words that the page names as values of a key, without those that come later.
pub fn values(block: &BlockShape, key: &Key) -> Vec<String> {
    let found = |kind: &str| row_in(section(kind), key.key).and_then(|cells| cells.get(1).cloned()).unwrap_or_default();
    let mut cell = found(block.kind);
    if block.kind == "pass" && (cell.contains("likewise") || cell.contains("as in `effects`")) {
        cell = found("effects");
    }
    let now: Vec<&str> = cell.split(';').filter(|part| !part.contains("**later**")).collect();
    let mut out: Vec<String> = Vec::new();
    for code in now.join(";").split('`').skip(1).step_by(2) {
        let word: String = code.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
        let is_word = word.starts_with(|c: char| c.is_ascii_lowercase()) && !key.clauses.contains(&word.as_str());
        if is_word && block.key(&word).is_none() && !out.contains(&word) {
            out.push(word);
        }
    }
    if key.key == "preset" {
        out.extend(PRESETS.iter().map(|(name, _)| (*name).to_owned()));
    }
    out
}

/// The keys of a block, one line.
pub fn block(shape: &BlockShape) -> String {
    let keys: Vec<String> = shape.keys.iter().map(|key| format!("`{}`", key.key)).collect();
    format!("**{}**: {}", shape.kind, keys.join(", "))
}

/// Words of the rule language that no table holds.
pub const KEYWORDS: &[(&str, &str)] = &[
    ("attr", "`attr name = value`: an attribute that the host may set, evaluated once per start shape"),
    ("const", "`const name = value`: as `attr`, but nothing sets it"),
    ("import", "`import prefix : \"file.cga\"`: the rules and attributes of another file, as `prefix.Name`"),
    ("style", "`style Name extends Base`: the definitions that follow replace those of the base"),
    ("version", "`version \"2024.0\"`: the version that the file was written for"),
    ("with", "`Rule(a) with( b := a * 2 ) -->`: values that the rule names, evaluated when it is entered"),
    ("case", "`case condition : … else : …`: the first branch whose condition holds"),
    ("else", "`else : …`: what is left of a `case` or of percentages"),
    ("NIL", "`NIL`: nothing is left of the shape"),
    ("start", "`start Rule --> …`: a rule that hosts may begin with"),
    ("extension", "`extension Rule --> …`: a rule that importing files may replace"),
    ("true", "The bool that holds"),
    ("false", "The bool that does not hold"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::schema::BLOCKS;

    #[test]
    fn the_manual_has_a_text_for_every_name() {
        let mut missing: Vec<&str> = Vec::new();
        missing.extend(Operation::ALL.iter().filter(|o| operation_text(**o).is_empty()).map(|o| o.name()));
        missing.extend(Function::ALL.iter().filter(|f| function_text(**f).is_empty()).map(|f| f.name()));
        let attributes = Attr::table().filter(|row| !row.deprecated).map(|row| row.name);
        missing.extend(attributes.filter(|name| attribute(name).ends_with("```")));
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn keys_of_recipes_have_the_text_of_their_row() {
        for block in BLOCKS {
            for key in block.keys.iter().filter(|key| key.evaluated && key.key != "preset") {
                let text = super::key(block, key);
                assert!(text.lines().count() > 1, "{} {}: {text}", block.kind, key.key);
            }
        }
        let camera = BlockShape::find("camera").expect("a block");
        let text = key(camera, camera.key("off_nadir").expect("a key"));
        assert!(text.contains("0deg to 80deg") && text.contains("*default*: 0deg"), "{text}");
    }

    #[test]
    fn values_are_the_words_of_the_row() {
        let values = |block: &str, key: &str| {
            let block = BlockShape::find(block).expect("a block");
            super::values(block, block.key(key).expect("a key"))
        };
        assert_eq!(values("camera", "projection"), ["perspective", "orthographic"]);
        assert_eq!(values("effects", "shadows"), ["off", "hard", "soft"]);
        assert_eq!(values("pass", "shadows"), ["off", "hard", "soft"]);
        assert_eq!(values("dataset", "layout"), ["plain", "levir", "levir_flat"]);
        assert_eq!(values("change", "effect"), ["demolished", "built"]);
    }

    #[test]
    fn an_operation_has_signatures_prose_and_its_example() {
        let text = operation(Operation::Extrude);
        assert!(text.starts_with("```cga\nextrude(number)\n") && text.contains("along its normal"), "{text}");
        assert!(text.ends_with("```cga\nLot --> extrude(6)\n```") && !text.contains("images/"), "{text}");
    }
}
