//! In: the path of the main rule file. Out: it and every file it imports, parsed once each.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::cga::ast::{Ast, DeclarationKind, Import};
use crate::cga::codes;
use crate::cga::parse::parse;
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::parsing::decode;
use crate::source::{Access, AccessError, MOST_TEXT_BYTES, Project, SourceFile, SourceMap, Span};

/// A parsed file.
pub struct LoadedFile {
    pub ast: Ast,
    pub text: Arc<str>,
    /// Its real path; empty for a text without one.
    pub path: PathBuf,
    /// Folder that holds it.
    pub folder: PathBuf,
    /// Index of the file each import statement leads to, in the order of the statements; none if it failed.
    pub imports: Vec<Option<usize>>,
}

pub struct Loaded {
    /// The main file first; empty if it cannot be read.
    pub files: Vec<LoadedFile>,
    pub diagnostics: Diagnostics,
}

pub struct Loader<'s> {
    /// Absent for a text that is part of the program; it cannot import.
    access: Option<&'s Access>,
    sources: &'s mut SourceMap,
    files: Vec<LoadedFile>,
    /// Canonical paths of `files`, empty for a text without a path.
    paths: Vec<PathBuf>,
    /// Files being read right now, outermost first.
    open: Vec<usize>,
    diagnostics: Diagnostics,
}

impl<'s> Loader<'s> {
    pub fn new(access: Option<&'s Access>, sources: &'s mut SourceMap) -> Self {
        let diagnostics = Diagnostics::default();
        Loader { access, sources, files: Vec::new(), paths: Vec::new(), open: Vec::new(), diagnostics }
    }

    pub fn finish(self) -> Loaded {
        Loaded { files: self.files, diagnostics: self.diagnostics }
    }

    pub fn main_file(&mut self, path: &Path, access: &Access) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        match access.read(folder, &name, MOST_TEXT_BYTES) {
            Ok((real, bytes)) => {
                self.file(real, &path.display().to_string(), &bytes);
            }
            Err(error) => {
                let file = self.sources.add(path.display().to_string(), "");
                let span = Span::new(file.id, 0, 0);
                self.diagnostics.push(Diagnostic::error(codes::UNREADABLE_FILE, span, error.to_string()));
            }
        }
    }

    pub fn main_text(&mut self, name: &str, text: &str) {
        let file = self.sources.add(name, text);
        self.parsed(PathBuf::new(), PathBuf::new(), &file);
    }

    fn file(&mut self, path: PathBuf, name: &str, bytes: &[u8]) -> usize {
        let decoded = decode(bytes);
        let file = self.sources.add(name, decoded.text);
        if decoded.guessed {
            let span = Span::new(file.id, 0, 0);
            let message = "the file is not UTF-8; it is read as Windows-1252";
            self.diagnostics.push(Diagnostic::warning(codes::ENCODING, span, message));
        }
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        self.parsed(path, folder, &file)
    }

    fn parsed(&mut self, path: PathBuf, folder: PathBuf, file: &SourceFile) -> usize {
        let (ast, diagnostics) = parse(file);
        self.diagnostics.extend(diagnostics);
        let index = self.files.len();
        let imports: Vec<Import> = ast
            .declarations
            .iter()
            .filter_map(|d| match &d.kind {
                DeclarationKind::Import(import) => Some(import.clone()),
                _ => None,
            })
            .collect();
        self.files.push(LoadedFile {
            ast,
            text: file.text.clone(),
            path: path.clone(),
            folder: folder.clone(),
            imports: Vec::new(),
        });
        self.paths.push(path);
        self.open.push(index);
        for import in imports {
            let target = self.import(&import, &folder);
            self.files[index].imports.push(target);
        }
        self.open.pop();
        index
    }

    fn import(&mut self, import: &Import, folder: &Path) -> Option<usize> {
        let Some(access) = self.access else {
            let message = "a text without a file cannot import";
            self.diagnostics.push(Diagnostic::error(codes::IMPORT_OUTSIDE, import.path.span, message));
            return None;
        };
        let path = match Project::of(folder).find(access, &import.path.text) {
            Ok(path) => path,
            Err(error) => {
                let code = match error {
                    AccessError::Outside(_) => codes::IMPORT_OUTSIDE,
                    _ => codes::UNREADABLE_FILE,
                };
                self.diagnostics.push(Diagnostic::error(code, import.path.span, error.to_string()));
                return None;
            }
        };
        if let Some(known) = self.paths.iter().position(|p| *p == path) {
            if self.open.contains(&known) {
                let message = format!("`{}` is imported by a file that it imports itself", import.path.text);
                self.diagnostics.push(Diagnostic::error(codes::IMPORT_CYCLE, import.path.span, message));
                return None;
            }
            return Some(known);
        }
        match access.read_real(&path, MOST_TEXT_BYTES) {
            Ok(bytes) => {
                let name = path.strip_prefix(access.root()).unwrap_or(&path).display().to_string();
                Some(self.file(path, &name, &bytes))
            }
            Err(error) => {
                let message = error.to_string();
                self.diagnostics.push(Diagnostic::error(codes::UNREADABLE_FILE, import.path.span, message));
                None
            }
        }
    }
}
