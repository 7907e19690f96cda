//! The texts that the editor shows. In: opened, changed and closed documents. Out: their present texts and versions, and
//! the [`Overlay`] that puts them in the place of files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use lsp_types::{TextDocumentContentChangeEvent, Uri};

use super::position::{Encoding, Lines, line_starts};
use crate::source::Overlay;

/// An open document.
#[derive(Clone, Debug)]
pub struct Document {
    /// As the editor writes it.
    pub uri: Uri,
    pub version: i32,
    pub text: Arc<str>,
}

/// Open documents by real path. A document without a file has a path that only we know.
#[derive(Clone, Debug, Default)]
pub struct Documents {
    open: BTreeMap<PathBuf, Document>,
}

impl Documents {
    pub fn open(&mut self, path: PathBuf, document: Document) {
        self.open.insert(path, document);
    }

    pub fn close(&mut self, path: &Path) -> Option<Document> {
        self.open.remove(path)
    }

    pub fn get(&self, path: &Path) -> Option<&Document> {
        self.open.get(path)
    }

    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.open.keys()
    }

    /// The path under which a document was opened.
    pub fn path_of(&self, uri: &Uri) -> Option<&PathBuf> {
        self.open.iter().find(|(_, document)| document.uri == *uri).map(|(path, _)| path)
    }

    /// Applies changes in their order; each counts in the text that the one before it left. False if it is not open.
    pub fn change(
        &mut self,
        path: &Path,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) -> bool {
        let Some(document) = self.open.get_mut(path) else { return false };
        for change in changes {
            let Some(range) = change.range else {
                document.text = change.text.into();
                continue;
            };
            let starts = line_starts(&document.text);
            let lines = Lines::new(&document.text, &starts, encoding);
            let (a, b) = (lines.offset(range.start) as usize, lines.offset(range.end) as usize);
            let (start, end) = (a.min(b), a.max(b));
            document.text = [&document.text[..start], &change.text, &document.text[end..]].concat().into();
        }
        document.version = version;
        true
    }

    pub fn overlay(&self) -> Overlay {
        Overlay::new(self.open.iter().map(|(path, document)| (path.clone(), document.text.clone())).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{Document, Documents};
    use crate::language_server::position::Encoding;
    use lsp_types::{Position, Range, TextDocumentContentChangeEvent};
    use std::path::Path;

    #[test]
    fn changes_are_applied_one_after_the_other() {
        let mut documents = Documents::default();
        let path = Path::new("/x.cga");
        let uri = "file:///x.cga".parse().expect("a URI");
        documents.open(path.to_owned(), Document { uri, version: 1, text: "Ä --> B\nC\n".into() });
        let edit = |a: (u32, u32), b: (u32, u32), text: &str| TextDocumentContentChangeEvent {
            range: Some(Range::new(Position::new(a.0, a.1), Position::new(b.0, b.1))),
            range_length: None,
            text: text.to_owned(),
        };
        let changes = vec![edit((0, 6), (0, 7), "𝄞x"), edit((0, 8), (0, 9), "y"), edit((1, 0), (2, 0), "")];
        assert!(documents.change(path, 2, changes, Encoding::Utf16));
        let document = documents.get(path).expect("open");
        assert_eq!((&*document.text, document.version), ("Ä --> 𝄞y\n", 2));
        assert!(!documents.change(Path::new("/y.cga"), 3, Vec::new(), Encoding::Utf16));
    }
}
