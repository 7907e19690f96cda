//! One recipe with the files that it uses, as an editor asks about it. In: a path, settings, unsaved texts. Out: a
//! [`RecipeFile`]: its mistakes, what stands at a place and what that means.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::position::{Encoding, Lines, line_starts};
use super::rule_file::Place;
use crate::cga::codes;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::parsing::decode;
use crate::pipeline::{PipelineError, RecipeOptions, load_recipe_over};
use crate::source::{Access, MOST_TEXT_BYTES, Overlay, SourceMap, Span};
use crate::spec;
use crate::spec::ast::{Assignment, Block, Clause, Expr, ExprKind, Name, Property, SpecAst};

/// One text of a recipe.
pub struct Part {
    pub path: PathBuf,
    pub text: Arc<str>,
    pub ast: SpecAst,
    starts: Vec<u32>,
}

/// A recipe with its mistakes.
pub struct RecipeFile {
    /// The recipe first, then what it uses.
    pub parts: Vec<Part>,
    /// Texts that the diagnostics point into.
    pub sources: SourceMap,
    pub diagnostics: Diagnostics,
    /// Folder that the names of its rule files' imports count from.
    pub folder: PathBuf,
}

/// What a word of a recipe means.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// A kind of block.
    Kind(String),
    /// The name of a block.
    Block {
        kind: String,
        name: String,
    },
    Key {
        block: String,
        key: String,
    },
    Clause {
        block: String,
        key: String,
        word: String,
    },
    Input(String),
    /// A file, as written.
    File(String),
    /// The start rule of a rule file, as written.
    Start {
        file: String,
        rule: String,
    },
    /// An attribute of a rule file, as written.
    Attribute {
        file: String,
        name: String,
    },
}

/// A word with its place in its part.
#[derive(Clone, Debug)]
pub struct Word {
    pub span: Span,
    pub meaning: Meaning,
    /// Whether this is where it is declared.
    pub declares: bool,
}

impl RecipeFile {
    pub fn read(path: &Path, options: &RecipeOptions, overlay: &Overlay) -> RecipeFile {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut sources = SourceMap::default();
        let diagnostics = diagnostics(path, options, overlay, &mut sources);
        RecipeFile { parts: parts(path, &folder, options, overlay), sources, diagnostics, folder }
    }

    pub fn lines(&self, part: usize, encoding: Encoding) -> Lines<'_> {
        let part = &self.parts[part];
        Lines::new(&part.text, &part.starts, encoding)
    }

    /// The word at a place of the recipe's own text.
    pub fn at(&self, offset: u32) -> Option<Word> {
        let words = self.parts.first()?.words();
        words.into_iter().filter(|w| w.span.start <= offset && offset <= w.span.end).max_by_key(|w| w.span.start)
    }

    /// Words of all parts with this meaning.
    pub fn places(&self, meaning: &Meaning, declarations_only: bool) -> Vec<Place> {
        let mut out = Vec::new();
        for part in &self.parts {
            let fits = |word: &Word| word.meaning == *meaning && (word.declares || !declarations_only);
            let place = |word: Word| Place { path: part.path.clone(), start: word.span.start, end: word.span.end };
            out.extend(part.words().into_iter().filter(fits).map(place));
        }
        out
    }

    /// Blocks of all parts.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.parts.iter().flat_map(|part| &part.ast.blocks)
    }
}

/// As `mansard check` does it: a recipe whose inputs are not given is checked as far as it goes.
fn diagnostics(path: &Path, options: &RecipeOptions, overlay: &Overlay, sources: &mut SourceMap) -> Diagnostics {
    let incomplete = |d: &Diagnostics| {
        d.iter().all(|d| matches!(d.code, "spec::missing-input" | "spec::missing-block")) && d.has_errors()
    };
    match load_recipe_over(path, options, overlay, sources) {
        Ok(recipe) => recipe.warnings,
        Err(PipelineError::Diagnostics(found)) if incomplete(&found) => match access(path, options, overlay) {
            Some(access) => spec::check(&path.display().to_string(), &access, sources, &options.arguments),
            None => found,
        },
        Err(PipelineError::Diagnostics(found)) => found,
        Err(other) => {
            let file = sources.add(path.display().to_string(), "");
            let mut found = Diagnostics::default();
            found.push(Diagnostic::error(codes::UNREADABLE_FILE, Span::new(file.id, 0, 0), other.to_string()));
            found
        }
    }
}

fn access(path: &Path, options: &RecipeOptions, overlay: &Overlay) -> Option<Access> {
    let mut access = Access::new(path.parent()?).ok()?.with_overlay(overlay);
    // A folder that is not there allows nothing; the recipe's own diagnostics say what cannot be read.
    options.allow.iter().for_each(|tree| drop(access.allow(tree)));
    Some(access)
}

fn parts(path: &Path, folder: &Path, options: &RecipeOptions, overlay: &Overlay) -> Vec<Part> {
    let mut out: Vec<Part> = Vec::new();
    let Some(access) = access(path, options, overlay) else { return out };
    let mut texts = SourceMap::default();
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut waiting = vec![(folder.to_owned(), name)];
    while let Some((base, written)) = waiting.pop() {
        let Ok((real, bytes)) = access.read(&base, &written, MOST_TEXT_BYTES) else { continue };
        if out.iter().any(|part| part.path == real) {
            continue;
        }
        let file = texts.add(real.display().to_string(), decode(&bytes).text);
        let (ast, _) = spec::parse::parse(&file);
        let folder = real.parent().unwrap_or(Path::new("")).to_owned();
        waiting.extend(ast.uses.iter().rev().map(|used| (folder.clone(), used.text.clone())));
        out.push(Part { path: real, starts: line_starts(&file.text), text: file.text, ast });
    }
    out
}

/// Kinds of block that a bare word may name at a place of a property.
pub fn referred(block: &str, key: &str, clause: Option<&str>) -> &'static [&'static str] {
    match (block, key, clause) {
        ("dataset", "views", _) => &["camera"],
        ("dataset", "scenes", _) | ("dataset", "split", Some(_)) => &["scene"],
        ("dataset", "passes", _) => &["pass"],
        ("dataset", "sun", _) => &["sun"],
        ("dataset", "effects", _) => &["effects"],
        ("dataset", "quality", _) => &["quality"],
        ("pass", "show", None | Some("only" | "with" | "mark")) => &["change"],
        _ => &[],
    }
}

/// Whether a text at a place of a property names a file.
pub fn names_file(key: &str, clause: Option<&str>) -> bool {
    matches!((key, clause), ("map" | "elevation" | "imagery" | "rules", None) | ("level", Some("rules")))
}

impl Part {
    /// Every word with a meaning, in the order of the text.
    pub fn words(&self) -> Vec<Word> {
        let mut out = Words { out: Vec::new() };
        for used in &self.ast.uses {
            out.add(used.span, Meaning::File(used.text.clone()), false);
        }
        for input in &self.ast.inputs {
            out.add(input.name.span, Meaning::Input(input.name.text.clone()), true);
            out.files(&input.default, matches!(input.kind.text.as_str(), "file" | "files"));
        }
        for block in &self.ast.blocks {
            out.block(block);
        }
        out.out.sort_by_key(|word| word.span);
        out.out
    }
}

struct Words {
    out: Vec<Word>,
}

impl Words {
    fn add(&mut self, span: Span, meaning: Meaning, declares: bool) {
        self.out.push(Word { span, meaning, declares });
    }

    fn block(&mut self, block: &Block) {
        let kind = &block.kind.text;
        self.add(block.kind.span, Meaning::Kind(kind.clone()), false);
        let named = |name: &Name| Meaning::Block { kind: kind.clone(), name: name.text.clone() };
        if let Some(name) = &block.name {
            self.add(name.span, named(name), true);
        }
        if let Some(parent) = &block.parent {
            self.add(parent.span, named(parent), false);
        }
        for property in &block.properties {
            self.property(kind, property);
        }
    }

    fn property(&mut self, block: &str, property: &Property) {
        let key = &property.key;
        self.add(key.span, Meaning::Key { block: block.to_owned(), key: key.text.clone() }, false);
        self.values(block, &key.text, None, &property.values);
        let rules = rule_file(property);
        for Clause { word, values } in &property.clauses {
            let meaning = Meaning::Clause { block: block.to_owned(), key: key.text.clone(), word: word.text.clone() };
            self.add(word.span, meaning, false);
            if let (Some(file), "start", [Expr { kind: ExprKind::Word(rule), span }]) =
                (rules, word.text.as_str(), &values[..])
            {
                self.add(*span, Meaning::Start { file: file.to_owned(), rule: rule.clone() }, false);
            } else {
                self.values(block, &key.text, Some(&word.text), values);
            }
        }
        for Assignment { name, value } in property.body.iter().flatten() {
            if let Some(file) = rules {
                let meaning = Meaning::Attribute { file: file.to_owned(), name: name.text.clone() };
                self.add(name.span, meaning, false);
            }
            self.values(block, &key.text, Some("="), std::slice::from_ref(value));
        }
    }

    fn values(&mut self, block: &str, key: &str, clause: Option<&str>, values: &[Expr]) {
        self.files(values, names_file(key, clause));
        let kinds = referred(block, key, clause);
        for value in values {
            self.value(kinds, value);
        }
    }

    fn files(&mut self, values: &[Expr], are_files: bool) {
        for value in values {
            match &value.kind {
                ExprKind::Text(text) if are_files => self.add(value.span, Meaning::File(text.clone()), false),
                ExprKind::Argument(name) => self.add(value.span, Meaning::Input(name.clone()), false),
                _ => {}
            }
        }
    }

    /// Names of blocks in a value, however deep.
    fn value(&mut self, kinds: &[&str], value: &Expr) {
        let named = |name: &str| kinds.first().map(|k| Meaning::Block { kind: (*k).to_owned(), name: name.to_owned() });
        match &value.kind {
            ExprKind::Word(word) => {
                if let Some(meaning) = named(word) {
                    self.add(value.span, meaning, false);
                }
            }
            ExprKind::Call { name, arguments } => {
                if let Some(meaning) = named(&name.text) {
                    self.add(name.span, meaning, false);
                }
                // `both(burnt)` names changes; `satellite(gsd = 1m)` names properties.
                let inner = if name.text == "both" { kinds } else { &[] };
                arguments.iter().for_each(|argument| self.value(inner, &argument.value));
            }
            ExprKind::List(values) | ExprKind::Group(values) | ExprKind::Or(values) | ExprKind::And(values) => {
                values.iter().for_each(|value| self.value(kinds, value));
            }
            ExprKind::By(a, b) | ExprKind::Times(a, b) => [a, b].into_iter().for_each(|v| self.value(kinds, v)),
            ExprKind::Not(inner) => self.value(kinds, inner),
            ExprKind::Argument(name) if kinds.is_empty() => {
                let known = self.out.iter().any(|word| word.span == value.span);
                if !known {
                    self.add(value.span, Meaning::Input(name.clone()), false);
                }
            }
            ExprKind::Quantity { .. }
            | ExprKind::Text(_)
            | ExprKind::Date(_)
            | ExprKind::Clock(_)
            | ExprKind::Argument(_)
            | ExprKind::Object { .. }
            | ExprKind::Filter { .. } => {}
        }
    }
}

/// The rule file of a `rules` or `level` property, as written.
pub fn rule_file(property: &Property) -> Option<&str> {
    let values = match property.key.text.as_str() {
        "rules" => &property.values,
        "level" => &property.clause("rules")?.values,
        _ => return None,
    };
    values.iter().find_map(|value| match &value.kind {
        ExprKind::Text(text) => Some(text.as_str()),
        _ => None,
    })
}
