//! Everything the server knows of the project. In: open documents, folders, settings. Out: checked rule files and
//! recipes, kept until a text that they were made of changes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use lsp_types::{Location, Range, TextDocumentPositionParams, Uri};
use serde::Deserialize;

use super::derivation::Lenses;
use super::documents::Documents;
use super::position::{Encoding, Lines, line_starts};
use super::recipe_file::RecipeFile;
use super::rule_file::{Place, RuleFile};
use super::uri;
use crate::parsing::decode;
use crate::pipeline::RecipeOptions;
use crate::source::{Access, MOST_TEXT_BYTES, Project, read_regular};

/// What the user sets: `mansard.*` of the editor's settings, or `initializationOptions`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Settings {
    /// The recipe that code lenses derive; the nearest one that uses the rule file otherwise.
    pub recipe: Option<PathBuf>,
    /// `NAME=VALUE` for inputs of recipes.
    pub set: Vec<String>,
    /// Folder trees that rules and recipes may read besides their own.
    pub allow: Vec<PathBuf>,
    /// Scheme of links to the pages of `mansard explain`, if the editor opens them.
    pub explain_scheme: Option<String>,
}

impl Settings {
    pub fn recipe_options(&self) -> RecipeOptions {
        let pair = |text: &String| text.split_once('=').map(|(a, b)| (a.to_owned(), b.to_owned()));
        RecipeOptions {
            arguments: self.set.iter().filter_map(pair).collect(),
            allow: self.allow.clone(),
            ..RecipeOptions::default()
        }
    }
}

/// What the client can do that changes our answers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Client {
    pub snippets: bool,
    pub document_changes: bool,
    pub hierarchical_symbols: bool,
    pub refreshes_lenses: bool,
    pub label_offsets: bool,
    pub registers_watchers: bool,
}

/// The two languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    Rules,
    Recipe,
}

impl Language {
    pub fn of(path: &Path) -> Option<Language> {
        match path.extension()?.to_str()? {
            "cga" => Some(Language::Rules),
            "render" => Some(Language::Recipe),
            _ => None,
        }
    }
}

/// Entries of folders that a search looks at, at most.
const MOST_ENTRIES: usize = 50_000;

#[derive(Default)]
pub struct Workspace {
    pub documents: Documents,
    pub encoding: Encoding,
    pub client: Client,
    pub settings: Settings,
    /// Folders that the editor has open.
    pub roots: Vec<PathBuf>,
    /// What the last derivation counted.
    pub lenses: Lenses,
    rules: BTreeMap<PathBuf, Rc<RuleFile>>,
    recipes: BTreeMap<PathBuf, Rc<RecipeFile>>,
}

impl Workspace {
    /// The path of a document; one without a file gets a path in the first folder of the workspace.
    pub fn path(&self, document: &Uri) -> PathBuf {
        if let Some(path) = self.documents.path_of(document) {
            return path.clone();
        }
        uri::path(document).map_or_else(
            || {
                let name = document.as_str().rsplit([':', '/']).next().unwrap_or_default();
                let folder = self.roots.first().cloned().or_else(|| std::env::current_dir().ok()).unwrap_or_default();
                folder.join(name)
            },
            |path| uri::real(&path),
        )
    }

    /// The URI of a path: as the editor wrote it, where it has the document open.
    pub fn uri(&self, path: &Path) -> Option<Uri> {
        self.documents.get(path).map(|document| document.uri.clone()).or_else(|| uri::uri(path))
    }

    /// Drops what was made of the text of a file.
    pub fn changed(&mut self, path: &Path) {
        self.rules.retain(|_, file| !file.index.files.iter().any(|f| f.path == path) && file.main().is_some());
        let of_recipe = |file: &RecipeFile| {
            let names = file.sources.files().iter().map(|source| uri::real(&file.folder.join(&*source.name)));
            file.parts.iter().any(|part| part.path == path) || names.into_iter().any(|name| name == path)
        };
        self.recipes.retain(|_, file| !of_recipe(file));
    }

    /// Drops everything: files came or went.
    pub fn changed_anything(&mut self) {
        self.rules.clear();
        self.recipes.clear();
    }

    /// Whether a file was checked since its texts changed.
    pub fn is_fresh(&self, path: &Path) -> bool {
        self.rules.contains_key(path) || self.recipes.contains_key(path)
    }

    /// A checked rule file; none if its folder cannot be read.
    pub fn rules(&mut self, path: &Path) -> Option<Rc<RuleFile>> {
        if let Some(known) = self.rules.get(path) {
            return Some(known.clone());
        }
        let mut access = Access::new(Project::of(path.parent()?).tree()).ok()?.with_overlay(&self.documents.overlay());
        // A folder that is not there allows nothing.
        self.settings.allow.iter().for_each(|tree| drop(access.allow(tree)));
        let file = Rc::new(RuleFile::read(path, &access));
        self.rules.insert(path.to_owned(), file.clone());
        Some(file)
    }

    pub fn recipe(&mut self, path: &Path) -> Rc<RecipeFile> {
        if let Some(known) = self.recipes.get(path) {
            return known.clone();
        }
        let options = self.settings.recipe_options();
        let file = Rc::new(RecipeFile::read(path, &options, &self.documents.overlay()));
        self.recipes.insert(path.to_owned(), file.clone());
        file
    }

    /// The document's text if it is open, else the file's.
    pub fn text(&self, path: &Path) -> Option<Arc<str>> {
        match self.documents.get(path) {
            Some(document) => Some(document.text.clone()),
            None => Some(decode(&read_regular(path, MOST_TEXT_BYTES).ok()?).text.into()),
        }
    }

    /// The text with the starts of its lines.
    pub fn lined(&self, path: &Path) -> Option<LinedText> {
        let text = self.text(path)?;
        Some(LinedText { starts: line_starts(&text), text, encoding: self.encoding })
    }

    /// The file, its language, its text and the byte offset that a request asks about.
    pub fn asked(&self, at: &TextDocumentPositionParams) -> Option<(PathBuf, Language, LinedText, u32)> {
        let path = self.path(&at.text_document.uri);
        let language = Language::of(&path)?;
        let text = self.lined(&path)?;
        let offset = text.lines().offset(at.position);
        Some((path, language, text, offset))
    }

    pub fn location(&self, place: &Place) -> Option<Location> {
        let text = self.lined(&place.path)?;
        Some(Location { uri: self.uri(&place.path)?, range: text.lines().range(place.start, place.end) })
    }

    /// The beginning of a file.
    pub fn file_location(&self, path: &Path) -> Option<Location> {
        Some(Location { uri: self.uri(path)?, range: Range::default() })
    }

    /// Files of a language: open ones and those in the open folders, in the order of their paths. Where no folder is
    /// open, those of the project that holds `near`.
    pub fn files(&self, language: Language, near: &Path) -> Vec<PathBuf> {
        let mut roots = self.roots.clone();
        if !roots.iter().any(|root| near.starts_with(root)) {
            roots.extend(near.parent().map(|folder| Project::of(folder).tree().to_owned()));
        }
        let mut found: Vec<PathBuf> = self.documents.paths().cloned().collect();
        let mut folders = roots;
        let mut looked_at = 0;
        while let Some(folder) = folders.pop() {
            let Ok(entries) = std::fs::read_dir(&folder) else { continue };
            for entry in entries.flatten() {
                looked_at += 1;
                if looked_at > MOST_ENTRIES {
                    folders.clear();
                    break;
                }
                let name = entry.file_name();
                let skipped = name.to_string_lossy().starts_with('.') || name == "node_modules" || name == "target";
                match entry.file_type() {
                    Ok(kind) if kind.is_dir() && !skipped => folders.push(entry.path()),
                    Ok(kind) if kind.is_file() && Language::of(&entry.path()).is_some() => {
                        found.push(uri::real(&entry.path()));
                    }
                    _ => {}
                }
            }
        }
        found.retain(|path| Language::of(path) == Some(language));
        found.sort();
        found.dedup();
        found
    }
}

/// A text that answers about its own lines.
pub struct LinedText {
    pub text: Arc<str>,
    starts: Vec<u32>,
    encoding: Encoding,
}

impl LinedText {
    pub fn lines(&self) -> Lines<'_> {
        Lines::new(&self.text, &self.starts, self.encoding)
    }
}
