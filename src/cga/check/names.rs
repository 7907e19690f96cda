//! In: names as the checker resolves them. Out: what each of them means, for editors: [`Index`].

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use super::instance::{Tables, Value};
use super::load::{Loaded, Loader};
use super::{every_style_noting, on_big_stack};
use crate::cga::ast::{Ast, Text};
use crate::cga::builtins::{Function, Operation, Word};
use crate::cga::program::Program;
use crate::diagnostics::Diagnostics;
use crate::source::{Access, SourceMap, Span};

/// What a name means. Names of the files lead to the name where it is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Meaning {
    Rule(Span),
    /// An attribute, constant or function.
    Value(Span),
    /// A parameter, or a local of `with`.
    Local(Span),
    Import(Span),
    Operation(Operation),
    BuiltinFunction(Function),
    /// By its name in the table.
    BuiltinAttribute(&'static str),
    Word(Word),
    /// A shape without a rule.
    Leaf,
}

/// A name where it is used. One file can be imported twice, so one name may have several meanings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Name {
    /// One part of a dotted name.
    pub span: Span,
    pub meaning: Meaning,
}

/// One file of an [`Index`].
#[derive(Debug)]
pub struct IndexedFile {
    pub ast: Ast,
    /// Its real path.
    pub path: PathBuf,
    pub text: Arc<str>,
    /// Index of the file that each import leads to, in source order.
    pub imports: Vec<Option<usize>>,
}

/// A rule file and its imports with what their names mean, in all styles, however broken they are.
#[derive(Debug, Default)]
pub struct Index {
    pub diagnostics: Diagnostics,
    /// The main file first; none if it cannot be read.
    pub files: Vec<IndexedFile>,
    /// Sorted by place; without declarations.
    pub names: Vec<Name>,
    /// Declarations of one thing: an attribute and the imported one that it overrides, an extension rule and what
    /// replaces it. They must have one name.
    pub links: Vec<(Span, Span)>,
    /// Of the default style, if nothing in the files is wrong.
    pub program: Option<Program>,
}

/// Checks a rule file as [`super::check`] does, and keeps what was found out about its names.
pub fn index(path: &Path, access: &Access, sources: &mut SourceMap) -> Index {
    on_big_stack(|| {
        let mut loader = Loader::new(Some(access), sources);
        loader.main_file(path, access);
        let loaded = loader.finish();
        let recorder = Recorder::default();
        let (program, diagnostics) = every_style_noting(&loaded, Some(&recorder));
        let (names, links) = recorder.sorted();
        Index { diagnostics, files: files(loaded), names, links, program }
    })
}

fn files(loaded: Loaded) -> Vec<IndexedFile> {
    let file = |f: super::load::LoadedFile| IndexedFile { ast: f.ast, path: f.path, text: f.text, imports: f.imports };
    loaded.files.into_iter().map(file).collect()
}

/// Takes names down; clones write into one list.
#[derive(Clone, Default)]
pub struct Recorder {
    names: Rc<RefCell<Vec<Name>>>,
    links: Rc<RefCell<Vec<(Span, Span)>>>,
    /// The name of each import statement, by the importing instance.
    imports: BTreeMap<(usize, Arc<str>), Span>,
}

impl Recorder {
    pub fn import(&mut self, instance: usize, prefix: &Text) {
        self.imports.insert((instance, prefix.text.clone()), prefix.span);
    }

    fn sorted(self) -> (Vec<Name>, Vec<(Span, Span)>) {
        let (mut names, mut links) = (self.names.take(), self.links.take());
        names.sort_unstable();
        names.dedup();
        links.sort_unstable();
        links.dedup();
        (names, links)
    }
}

impl Tables<'_> {
    /// Takes down what a whole name means. A later meaning of the same place replaces the one before: an argument that
    /// could be a value turned out to be a keyword.
    pub fn note(&self, span: Span, meaning: Meaning) {
        let Some(recorder) = &self.names else { return };
        let mut names = recorder.names.borrow_mut();
        if matches!(meaning, Meaning::Word(_)) && names.last().is_some_and(|name| name.span == span) {
            names.pop();
        }
        names.push(Name { span, meaning });
    }

    /// As [`Tables::note`], of a name that may stand behind imports: `lib.windows.Frame`.
    pub fn refer(&self, scope: usize, name: &Text, meaning: Meaning) {
        let Some(recorder) = &self.names else { return };
        // The span of a name may begin earlier: with a dot, or with a key in front.
        let (mut at, mut start, mut rest) = (scope, name.span.end as usize - name.text.len(), &*name.text);
        while let Some((first, tail)) = rest.split_once('.')
            && let Some(&child) = self.instances[at].children.get(first)
        {
            if let Some(import) = recorder.imports.get(&(at, Arc::from(first))) {
                self.note(Span::new(name.span.source, start, start + first.len()), Meaning::Import(*import));
            }
            (at, start, rest) = (child, start + first.len() + 1, tail);
        }
        self.note(Span::new(name.span.source, start, name.span.end as usize), meaning);
    }

    /// Takes down that two declarations must have one name.
    pub fn link(&self, one: Span, other: Span) {
        if let Some(recorder) = &self.names {
            recorder.links.borrow_mut().push((one, other));
        }
    }

    pub fn value_meaning(&self, value: Value) -> Meaning {
        Meaning::Value(match value {
            Value::Attribute(id) => self.attributes[id.0 as usize].span,
            Value::Function(id) => self.functions[id.0 as usize].definition.name.span,
        })
    }

    pub fn import_meaning(&self, instance: usize, name: &str) -> Option<Meaning> {
        let span = self.names.as_ref()?.imports.get(&(instance, Arc::from(name)))?;
        Some(Meaning::Import(*span))
    }
}

#[cfg(test)]
mod tests {
    use super::{Meaning, index};
    use crate::source::{Access, SourceMap};

    /// `name → meaning` of every name of the main file.
    fn meanings(files: &[(&str, &str)]) -> Vec<String> {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for (name, text) in files {
            std::fs::write(folder.path().join(name), text).expect("writable");
        }
        let access = Access::new(folder.path()).expect("it exists");
        let mut sources = SourceMap::default();
        let index = index(&folder.path().join(files[0].0), &access, &mut sources);
        let text = |span: crate::source::Span| {
            let file = sources.get(span.source);
            let name = file.name.rsplit('/').next().unwrap_or_default();
            (file.text[span.start as usize..span.end as usize].to_owned(), format!("{name}:{}", span.start))
        };
        let main = index.files[0].ast.source;
        let tell = |meaning: Meaning| match meaning {
            Meaning::Rule(at) => format!("rule {}", text(at).1),
            Meaning::Value(at) => format!("value {}", text(at).1),
            Meaning::Local(at) => format!("local {}", text(at).1),
            Meaning::Import(at) => format!("import {}", text(at).1),
            Meaning::Operation(_) => "operation".to_owned(),
            Meaning::BuiltinFunction(_) => "function".to_owned(),
            Meaning::BuiltinAttribute(_) => "attribute".to_owned(),
            Meaning::Word(_) => "word".to_owned(),
            Meaning::Leaf => "leaf".to_owned(),
        };
        let own = index.names.iter().filter(|name| name.span.source == main);
        own.map(|name| format!("{} → {}", text(name.span).0, tell(name.meaning))).collect()
    }

    #[test]
    fn every_name_leads_to_its_declaration() {
        let main = "import lib : \"lib.cga\" (height = 3)\nattr w = 2\ng(x) = x * w + scope.sx\n\
                    Lot(h) --> extrude(world.up, h) comp(f) { inside : lib.Wall | top && w > 1 : Roof. }\n\
                    lib.Ext --> set(w, rand(1, 2)) Lot(lib.height)\n";
        let lib = "attr height = 1\nattr w = 7\nWall --> Ext\nextension Ext --> NIL\n";
        insta::assert_snapshot!(meanings(&[("main.cga", main), ("lib.cga", lib)]).join("\n"));
    }

    #[test]
    fn names_of_a_broken_file_are_known_as_far_as_it_goes() {
        let found = meanings(&[("main.cga", "A --> extrude(\nB --> nothing(3) C\nC --> A\n")]);
        assert!(found.contains(&"C → rule main.cga:34".to_owned()), "{found:?}");
    }
}
