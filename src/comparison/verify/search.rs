//! Files by content. In: folders, and what a file holds by its hash. Out: where such a file lies. Folders are listed once;
//! only files of the right length are read.

use std::path::{Path, PathBuf};

use crate::comparison::stored::StoredInput;
use crate::dataset::writer::sha256;
use crate::parsing::decode;
use crate::pipeline::file_sha256;
use crate::source::{MOST_TEXT_BYTES, read_regular};

/// Files that a search lists, and how deep it goes.
const MOST_FILES: usize = 100_000;
const DEEPEST: usize = 12;

/// Files below some folders.
pub struct Search {
    /// Folder by folder, with their lengths.
    files: Vec<(PathBuf, u64)>,
    /// Whether there are more than are listed.
    pub cut: bool,
}

impl Search {
    /// Lists folders; those with a dot in front, links, and `but` are left out.
    pub fn new(folders: &[PathBuf], but: &Path) -> Search {
        let mut search = Search { files: Vec::new(), cut: false };
        let but = but.canonicalize().ok();
        let mut seen: Vec<PathBuf> = Vec::new();
        let mut waiting: Vec<(PathBuf, usize)> = folders.iter().rev().map(|folder| (folder.clone(), 0)).collect();
        while let Some((folder, depth)) = waiting.pop() {
            let Ok(real) = folder.canonicalize() else { continue };
            if seen.contains(&real) || Some(&real) == but.as_ref() {
                continue;
            }
            seen.push(real);
            let Ok(entries) = std::fs::read_dir(&folder) else { continue };
            let mut entries: Vec<_> = entries.flatten().collect();
            entries.sort_by_key(std::fs::DirEntry::file_name);
            for entry in entries.into_iter().rev() {
                let Ok(metadata) = entry.metadata() else { continue };
                let hidden = entry.file_name().to_string_lossy().starts_with('.');
                if metadata.is_dir() && !hidden && depth < DEEPEST {
                    waiting.push((entry.path(), depth + 1));
                } else if metadata.is_file() {
                    search.files.push((entry.path(), metadata.len()));
                }
            }
            if search.files.len() >= MOST_FILES {
                search.cut = true;
                break;
            }
        }
        search
    }

    /// A file with an input's content; one with its name is preferred.
    pub fn by_content(&self, input: &StoredInput) -> Option<PathBuf> {
        let named = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy() == base_name(&input.name));
        let suffix = |path: &Path| path.extension().map(|suffix| suffix.to_ascii_lowercase());
        // The length of a text was taken after decoding.
        let wanted = suffix(Path::new(&input.name));
        let likely = |(path, length): &&(PathBuf, u64)| match input.role.as_str() {
            "rules" => suffix(path) == wanted,
            _ => *length == input.bytes,
        };
        let mut candidates: Vec<&PathBuf> = self.files.iter().filter(likely).map(|(path, _)| path).collect();
        candidates.sort_by_key(|path| !named(path));
        candidates.into_iter().find(|path| content_sha256(&input.role, path).as_ref() == Some(&input.sha256)).cloned()
    }

    /// A file with an input's name.
    pub fn by_name(&self, input: &StoredInput) -> Option<&PathBuf> {
        let named = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy() == base_name(&input.name));
        self.files.iter().map(|(path, _)| path).find(|path| named(path))
    }
}

fn base_name(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// The hash that the manifest has of an input: rule files are hashed as they were decoded.
pub fn content_sha256(role: &str, path: &Path) -> Option<String> {
    match role {
        "rules" => Some(sha256(decode(&read_regular(path, MOST_TEXT_BYTES).ok()?).text.as_bytes())),
        _ => path.is_file().then(|| file_sha256(path).ok()).flatten().map(|(_, sha256)| sha256),
    }
}
