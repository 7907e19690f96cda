//! Rule files. In: the texts of both sides. Out: which rules, functions and attributes were added, removed or changed.
//! They are compared by their syntax trees, so comments, layout and order make no difference.

use std::collections::BTreeMap;
use std::fmt::{self, Debug, Write};
use std::sync::Arc;

use serde::Serialize;

use crate::cga::ast::{Ast, Declaration, DeclarationKind, DefinitionKind};
use crate::cga::parse::parse;
use crate::source::{SourceFile, SourceMap, Span};

/// A rule file of one side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleText {
    /// Below the recipe's folder, or `mansard:…`.
    pub name: String,
    pub text: Arc<str>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    Removed,
    Added,
    Changed,
    /// Only what annotations say to people.
    Annotated,
}

/// A rule file that differs in more than its name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FileDifference {
    /// In B, or in A where it is removed.
    pub file: String,
    /// In A, where it has another name there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub was: Option<String>,
    pub fate: Fate,
    /// Empty where only comments, layout or order differ, which is no difference.
    pub declarations: Vec<DeclarationDifference>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct DeclarationDifference {
    /// `rule`, `attr`, `const`, `function`, `import`, `style`, `version`.
    pub what: &'static str,
    /// With the number of parameters, `Wall/2`, where there are any; `STYLE.` in front of what a style says.
    pub name: String,
    pub fate: Fate,
    pub line_a: Option<usize>,
    pub line_b: Option<usize>,
}

impl FileDifference {
    /// Whether the rules themselves are the same.
    pub fn is_layout_only(&self) -> bool {
        self.fate == Fate::Changed && self.declarations.is_empty()
    }
}

/// Compares all rule files. Files are paired by name, then by content; sorted by name.
pub fn compare_rules(a: &[RuleText], b: &[RuleText]) -> Vec<FileDifference> {
    let (same_name, others): (Vec<_>, Vec<_>) = a.iter().partition(|x| b.iter().any(|y| y.name == x.name));
    let mut right: Vec<&RuleText> = b.iter().collect();
    let mut pairs: Vec<(Option<&RuleText>, Option<&RuleText>)> = Vec::new();
    let mut pair =
        |x, found: Option<usize>, right: &mut Vec<_>| pairs.push((Some(x), found.map(|at| right.remove(at))));
    for x in same_name {
        let found = right.iter().position(|y| y.name == x.name);
        pair(x, found, &mut right);
    }
    for x in others {
        let found = right.iter().position(|y| y.text == x.text);
        pair(x, found, &mut right);
    }
    pairs.extend(right.into_iter().map(|y| (None, Some(y))));
    let mut out: Vec<FileDifference> = pairs.into_iter().filter_map(|(a, b)| file_difference(a, b)).collect();
    out.sort_by(|x, y| x.file.cmp(&y.file));
    out
}

fn file_difference(a: Option<&RuleText>, b: Option<&RuleText>) -> Option<FileDifference> {
    let (fate, file) = match (a, b) {
        (Some(a), Some(b)) if a.text == b.text => return None,
        (Some(_), Some(b)) => (Fate::Changed, b),
        (None, Some(b)) => (Fate::Added, b),
        (Some(a), None) => (Fate::Removed, a),
        (None, None) => return None,
    };
    let was = a.filter(|a| a.name != file.name).map(|a| a.name.clone());
    Some(FileDifference { file: file.name.clone(), was, fate, declarations: compare_declarations(a, b) })
}

/// Kind and name of a declaration.
type Key = (&'static str, String);

/// A declaration without its places.
struct Declared {
    line: usize,
    annotations: String,
    meaning: String,
}

fn compare_declarations(a: Option<&RuleText>, b: Option<&RuleText>) -> Vec<DeclarationDifference> {
    let [a, b] = [a, b].map(|text| text.map(declarations).unwrap_or_default());
    let mut keys: Vec<&Key> = a.keys().chain(b.keys()).collect();
    keys.sort();
    keys.dedup();
    let mut out = Vec::new();
    for key in keys {
        let [a, b] = [&a, &b].map(|side| side.get(key).map(Vec::as_slice).unwrap_or_default());
        for number in 0..a.len().max(b.len()) {
            let (a, b) = (a.get(number), b.get(number));
            let fate = match (a, b) {
                (Some(a), Some(b)) if a.meaning != b.meaning => Fate::Changed,
                (Some(a), Some(b)) if a.annotations != b.annotations => Fate::Annotated,
                (Some(_), Some(_)) | (None, None) => continue,
                (Some(_), None) => Fate::Removed,
                (None, Some(_)) => Fate::Added,
            };
            let line = |side: Option<&Declared>| side.map(|d| d.line);
            out.push(DeclarationDifference {
                what: key.0,
                name: key.1.clone(),
                fate,
                line_a: line(a),
                line_b: line(b),
            });
        }
    }
    out.sort_by_key(|d| d.line_b.or(d.line_a));
    out
}

/// Stack of the parsing thread, as of the compiler's.
const STACK: usize = 64 << 20;

/// The declarations of a file; several of one name stand in the order of the file.
fn declarations(text: &RuleText) -> BTreeMap<Key, Vec<Declared>> {
    std::thread::scope(|scope| {
        let read = || {
            let file = SourceMap::default().add(text.name.as_str(), text.text.clone());
            of_tree(&file, &parse(&file).0)
        };
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, read);
        thread.expect("the system grants one thread").join().expect("what was compiled can be parsed")
    })
}

fn of_tree(file: &SourceFile, ast: &Ast) -> BTreeMap<Key, Vec<Declared>> {
    let mut out: BTreeMap<Key, Vec<Declared>> = BTreeMap::new();
    let line = |span: Span| file.place(span.start).line;
    if let Some(version) = &ast.version {
        let declared =
            Declared { line: line(version.span), annotations: String::new(), meaning: version.text.to_string() };
        out.insert(("version", String::new()), vec![declared]);
    }
    let mut style = String::new();
    for declaration in &ast.declarations {
        let (what, name, span) = identity(declaration);
        let name = if what == "style" { name } else { format!("{style}{name}") };
        let declared = Declared {
            line: line(span),
            annotations: meaning(&declaration.annotations),
            meaning: meaning(&declaration.kind),
        };
        out.entry((what, name)).or_default().push(declared);
        if let DeclarationKind::Style(opened) = &declaration.kind {
            style = format!("{}.", opened.name.text);
        }
    }
    out
}

/// Kind, name with number of parameters, and place of a declaration.
fn identity(declaration: &Declaration) -> (&'static str, String, Span) {
    let with = |name: &str, parameters: usize| match parameters {
        0 => name.to_owned(),
        n => format!("{name}/{n}"),
    };
    match &declaration.kind {
        DeclarationKind::Import(import) => ("import", import.prefix.text.to_string(), import.prefix.span),
        DeclarationKind::Style(style) => ("style", style.name.text.to_string(), style.name.span),
        DeclarationKind::Rule(rule) => ("rule", with(&rule.name.text, rule.parameters.len()), rule.name.span),
        DeclarationKind::Definition(definition) => {
            let what = match definition.kind {
                DefinitionKind::Attr => "attr",
                DefinitionKind::Const => "const",
                DefinitionKind::Function => "function",
            };
            let parameters = definition.parameters.as_ref().map_or(0, Vec::len);
            (what, with(&definition.name.text, parameters), definition.name.span)
        }
    }
}

/// A part of a syntax tree as text, without the places of its nodes: equal texts, equal meaning. Taken from the derived
/// `Debug`, so that no field of the tree can be forgotten.
fn meaning(node: &impl Debug) -> String {
    let mut out = WithoutSpans::default();
    write!(out, "{node:?}").expect("writing to a string cannot fail");
    out.kept
}

/// Keeps what is written, but for every `Span { … }` outside quotes.
#[derive(Default)]
struct WithoutSpans {
    kept: String,
    quoted: bool,
    escaped: bool,
    /// Inside a span.
    skipping: bool,
    /// Open braces inside it.
    depth: usize,
}

const SPAN: &str = "Span {";

impl Write for WithoutSpans {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for c in text.chars() {
            if self.skipping {
                match c {
                    '{' => self.depth += 1,
                    '}' => self.depth -= 1,
                    _ => {}
                }
                self.skipping = self.depth > 0;
                continue;
            }
            self.kept.push(c);
            if self.quoted {
                self.quoted = self.escaped || c != '"';
                self.escaped = !self.escaped && c == '\\';
            } else if c == '"' {
                self.quoted = true;
            } else if c == '{' && self.kept.ends_with(SPAN) {
                self.kept.truncate(self.kept.len() - SPAN.len());
                (self.skipping, self.depth) = (true, 1);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(name: &str, text: &str) -> RuleText {
        RuleText { name: name.to_owned(), text: text.into() }
    }

    /// Kind, name, fate, line in A, line in B.
    type Told = (&'static str, String, Fate, Option<usize>, Option<usize>);

    fn differences(a: &str, b: &str) -> Vec<Told> {
        let files = compare_rules(&[text("x.cga", a)], &[text("x.cga", b)]);
        let all = files.into_iter().flat_map(|f| f.declarations);
        all.map(|d| (d.what, d.name, d.fate, d.line_a, d.line_b)).collect()
    }

    const RULES: &str =
        "attr height = 9\nconst low = \"Span { a } \\\" Span {\"\nWall(h) --> extrude(h) Side.\nLot --> Wall(height)\n";

    #[test]
    fn comments_layout_and_order_make_no_difference() {
        let other = "// new\n\nLot -->\n   Wall( height ) // call\nWall(h) --> extrude(h)\n  Side.\n\
                     const low=\"Span { a } \\\" Span {\"\nattr height = 9.0\n";
        assert_eq!(differences(RULES, other), []);
        let files = compare_rules(&[text("x.cga", RULES)], &[text("x.cga", other)]);
        assert!(files[0].is_layout_only());
        assert_eq!(compare_rules(&[text("x.cga", RULES)], &[text("y.cga", RULES)]), []);
    }

    #[test]
    fn each_change_is_told_with_both_lines() {
        let other = "\nattr height = 10\nconst low = \"Span { b } \\\" Span {\"\n@Hidden\nattr more = 1\nLot --> Wall(height) NIL\n";
        let expected = [
            ("attr", "height".to_owned(), Fate::Changed, Some(1), Some(2)),
            ("const", "low".to_owned(), Fate::Changed, Some(2), Some(3)),
            ("rule", "Wall/1".to_owned(), Fate::Removed, Some(3), None),
            ("attr", "more".to_owned(), Fate::Added, None, Some(5)),
            ("rule", "Lot".to_owned(), Fate::Changed, Some(4), Some(6)),
        ];
        assert_eq!(differences(RULES, other), expected);
        let annotated = RULES.replace("attr", "@Range(min=1, max=20)\nattr");
        let expected = [("attr", "height".to_owned(), Fate::Annotated, Some(1), Some(2))];
        assert_eq!(differences(RULES, &annotated), expected);
    }

    #[test]
    fn files_come_and_go() {
        let files = compare_rules(&[text("a.cga", "A --> NIL")], &[text("b.cga", "B --> NIL")]);
        let fates: Vec<_> = files.iter().map(|f| (f.file.as_str(), f.fate, f.declarations.len())).collect();
        assert_eq!(fates, [("a.cga", Fate::Removed, 1), ("b.cga", Fate::Added, 1)]);
    }
}
