//! One rule file with its imports, as an editor asks about it. In: a path, folders, unsaved texts. Out: a [`RuleFile`]:
//! what stands at a place, what it means, where it is declared.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::position::{Encoding, Lines, line_starts};
use crate::cga::ast::{self, Declaration, DeclarationKind, DefinitionKind, Override, Text};
use crate::cga::{self, Index, IndexedFile, Meaning};
use crate::source::{Access, SourceId, SourceMap, Span};

/// What kind of thing a name was declared as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Rule,
    Attribute,
    Constant,
    Function,
    Parameter,
    Local,
    Import,
    Style,
}

impl Kind {
    /// As messages call it.
    pub fn word(self) -> &'static str {
        match self {
            Kind::Rule => "rule",
            Kind::Attribute => "attribute",
            Kind::Constant => "constant",
            Kind::Function => "function",
            Kind::Parameter => "parameter",
            Kind::Local => "local",
            Kind::Import => "import",
            Kind::Style => "style",
        }
    }

    pub fn is_inner(self) -> bool {
        matches!(self, Kind::Parameter | Kind::Local)
    }
}

/// A declared name.
#[derive(Clone, Debug)]
pub struct Declared {
    pub kind: Kind,
    pub name: Text,
    /// Of the rule or function.
    pub parameters: Vec<Arc<str>>,
    /// Index of the file.
    pub file: usize,
    /// Index of the declaration in its file that it is or lies in.
    pub declaration: usize,
}

/// A range of bytes in a file: the same from whichever file it was reached.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    pub path: PathBuf,
    pub start: u32,
    pub end: u32,
}

/// A checked rule file with what its names mean.
pub struct RuleFile {
    pub sources: SourceMap,
    pub index: Index,
    pub declared: Vec<Declared>,
    /// Starts of the lines of each file.
    starts: Vec<Vec<u32>>,
}

impl RuleFile {
    pub fn read(path: &Path, access: &Access) -> RuleFile {
        let mut sources = SourceMap::default();
        let index = cga::index(path, access, &mut sources);
        let starts = index.files.iter().map(|file| line_starts(&file.text)).collect();
        let declared = declared(&index);
        RuleFile { sources, index, declared, starts }
    }

    /// The file itself; none if it cannot be read.
    pub fn main(&self) -> Option<&IndexedFile> {
        self.index.files.first()
    }

    pub fn file_of(&self, source: SourceId) -> Option<usize> {
        self.index.files.iter().position(|file| file.ast.source == source)
    }

    pub fn lines(&self, file: usize, encoding: Encoding) -> Lines<'_> {
        Lines::new(&self.index.files[file].text, &self.starts[file], encoding)
    }

    pub fn place(&self, span: Span) -> Option<Place> {
        let file = &self.index.files[self.file_of(span.source)?];
        Some(Place { path: file.path.clone(), start: span.start, end: span.end })
    }

    /// What is written in the main file at a place and what that means; a declaration means itself.
    pub fn at(&self, offset: u32) -> Option<(Span, Vec<Meaning>)> {
        let source = self.main()?.ast.source;
        let covers = |span: Span| span.source == source && span.start <= offset && offset <= span.end;
        let mut found: Vec<(Span, Meaning)> =
            self.index.names.iter().filter(|name| covers(name.span)).map(|name| (name.span, name.meaning)).collect();
        let own = self.declared.iter().filter(|d| covers(d.name.span)).map(|d| (d.name.span, d.meaning()));
        found.extend(own);
        // In `a+b` both names touch the place behind `a+`; the one that begins there is meant. Parts of dotted names touch too.
        let span = found.iter().map(|(span, _)| *span).max_by_key(|span| (offset < span.end, span.start))?;
        let mut meanings: Vec<Meaning> = found.into_iter().filter(|(s, _)| *s == span).map(|(_, m)| m).collect();
        meanings.sort_unstable();
        meanings.dedup();
        Some((span, meanings))
    }

    /// The declaration that a meaning leads to.
    pub fn declaration(&self, meaning: Meaning) -> Option<&Declared> {
        let (Meaning::Rule(span) | Meaning::Value(span) | Meaning::Local(span) | Meaning::Import(span)) = meaning
        else {
            return None;
        };
        self.declared.iter().find(|d| d.name.span == span)
    }

    /// The syntax tree of a declared name's declaration.
    pub fn tree(&self, declared: &Declared) -> &Declaration {
        &self.index.files[declared.file].ast.declarations[declared.declaration]
    }

    /// What is declared in the main file, without parameters and locals.
    pub fn own(&self) -> impl Iterator<Item = &Declared> {
        self.declared.iter().filter(|d| d.file == 0 && !d.kind.is_inner())
    }

    pub fn written(&self, span: Span) -> &str {
        self.file_of(span.source).map_or("", |f| &self.index.files[f].text[span.start as usize..span.end as usize])
    }
}

impl Declared {
    pub fn meaning(&self) -> Meaning {
        let span = self.name.span;
        match self.kind {
            Kind::Rule => Meaning::Rule(span),
            Kind::Attribute | Kind::Constant | Kind::Function => Meaning::Value(span),
            Kind::Parameter | Kind::Local => Meaning::Local(span),
            // Styles are named by nothing that the checker resolves, so their names never meet those of imports.
            Kind::Import | Kind::Style => Meaning::Import(span),
        }
    }

    /// `Wall(h, n)`, or the name alone.
    pub fn form(&self) -> String {
        match (self.parameters.is_empty(), self.kind) {
            (true, Kind::Function) => format!("{}()", self.name.text),
            (true, _) => self.name.text.to_string(),
            (false, _) => format!("{}({})", self.name.text, self.parameters.join(", ")),
        }
    }
}

fn declared(index: &Index) -> Vec<Declared> {
    let mut out = Vec::new();
    for (file, indexed) in index.files.iter().enumerate() {
        for (number, declaration) in indexed.ast.declarations.iter().enumerate() {
            Collector { file, declaration: number, out: &mut out }.declaration(&declaration.kind);
        }
    }
    // Rules and parameters inside dynamic import calls.
    for name in &index.names {
        let (kind, span) = match name.meaning {
            Meaning::Rule(span) => (Kind::Rule, span),
            Meaning::Local(span) => (Kind::Parameter, span),
            _ => continue,
        };
        let Some(file) = index.files.iter().position(|f| f.ast.source == span.source) else { continue };
        if out.iter().any(|d| d.name.span == span) {
            continue;
        }
        let inside = |d: &Declaration| d.span.start <= span.start && span.end <= d.span.end;
        let Some(declaration) = index.files[file].ast.declarations.iter().position(inside) else { continue };
        let text = index.files[file].text[span.start as usize..span.end as usize].into();
        out.push(Declared { kind, name: Text { text, span }, parameters: Vec::new(), file, declaration });
    }
    out
}

struct Collector<'o> {
    file: usize,
    declaration: usize,
    out: &'o mut Vec<Declared>,
}

impl Collector<'_> {
    fn declaration(&mut self, kind: &DeclarationKind) {
        match kind {
            DeclarationKind::Rule(rule) => {
                self.add(Kind::Rule, &rule.name, &rule.parameters);
                self.inner(&rule.parameters, &rule.locals);
            }
            DeclarationKind::Definition(definition) => {
                let kind = match definition.kind {
                    DefinitionKind::Attr => Kind::Attribute,
                    DefinitionKind::Const => Kind::Constant,
                    DefinitionKind::Function => Kind::Function,
                };
                let parameters = definition.parameters.as_deref().unwrap_or_default();
                self.add(kind, &definition.name, parameters);
                self.inner(parameters, &definition.locals);
            }
            DeclarationKind::Import(import) => {
                self.add(Kind::Import, &import.prefix, &[]);
                for item in import.overrides.iter().flatten() {
                    if let Override::Rule { name, parameters, .. } = item {
                        self.add(Kind::Rule, name, parameters);
                        self.inner(parameters, &[]);
                    }
                }
            }
            DeclarationKind::Style(style) => self.add(Kind::Style, &style.name, &[]),
        }
    }

    fn add(&mut self, kind: Kind, name: &Text, parameters: &[Text]) {
        let parameters = parameters.iter().map(|p| p.text.clone()).collect();
        let (file, declaration) = (self.file, self.declaration);
        self.out.push(Declared { kind, name: name.clone(), parameters, file, declaration });
    }

    fn inner(&mut self, parameters: &[Text], locals: &[(Text, ast::Expr)]) {
        parameters.iter().for_each(|name| self.add(Kind::Parameter, name, &[]));
        locals.iter().for_each(|(name, _)| self.add(Kind::Local, name, &[]));
    }
}

/// The comment directly above a declaration, without its marks.
pub fn comment_above(text: &str, declaration: &Declaration) -> String {
    let first = declaration.annotations.first().map_or(declaration.span, |a| a.name.span);
    let start = first.start.min(declaration.span.start) as usize;
    let before = &text[..text[..start].rfind('\n').map_or(0, |end| end)];
    let mut lines: Vec<&str> = Vec::new();
    let mut in_block = false;
    for line in before.lines().rev() {
        let line = line.trim();
        let ends_block = line.ends_with("*/");
        if !(in_block || ends_block || line.starts_with("//") || line.starts_with('#')) {
            break;
        }
        in_block = (in_block || ends_block) && !line.starts_with("/*");
        lines.push(line);
    }
    let bare = |line: &&str| {
        let line = line.trim_start_matches(['/', '*', '#', '!']).trim_end_matches(['/', '*']);
        line.trim_matches(['-', '=', ' ', '\t']).to_owned()
    };
    let lines: Vec<String> = lines.iter().rev().map(bare).filter(|line| !line.is_empty()).collect();
    lines.join("\n")
}

/// An annotation as written.
pub fn annotation_text(file: &RuleFile, annotation: &ast::Annotation) -> String {
    let mut out = format!("@{}", annotation.name.text);
    if let (Some(first), Some(last)) = (annotation.args.first(), annotation.args.last()) {
        out.push_str(&format!("({})", file.written(first.span.to(last.span))));
    }
    out
}
