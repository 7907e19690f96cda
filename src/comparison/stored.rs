//! A dataset's manifest, read back. In: `manifest.json`. Out: the fields that comparing needs, with every path checked:
//! a manifest may come from anywhere, and must not lead out of the folders it is about.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use super::error::ComparisonError;
use crate::dataset::manifest::ChosenRecord;
use crate::dataset::writer::WrittenFile;

/// The name of the file in a dataset's folder.
pub const MANIFEST: &str = "manifest.json";

/// As [`crate::dataset::Manifest`].
#[derive(Clone, Debug, Deserialize)]
pub struct Stored {
    pub manifest: u32,
    pub generator: Generator,
    pub dataset: String,
    /// Absent in manifests of before 22 November 2026.
    pub recipe: Option<String>,
    pub arguments: BTreeMap<String, String>,
    pub inputs: Vec<StoredInput>,
    pub renderer: Renderer,
    pub classes: BTreeMap<u8, String>,
    pub scenes: Vec<StoredScene>,
    #[serde(default)]
    pub budgets: Vec<StoredBudget>,
    pub views: Vec<StoredView>,
    pub files: Vec<WrittenFile>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct Generator {
    pub version: String,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
pub struct StoredInput {
    pub role: String,
    pub name: String,
    pub path: Option<String>,
    pub bytes: u64,
    pub sha256: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Renderer {
    pub backend: String,
    pub adapter: Option<String>,
    pub driver: Option<String>,
    pub samples_per_pixel: Option<u32>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredScene {
    pub name: String,
    pub geometry_sha256: String,
    pub changes: Vec<StoredChange>,
    pub ledger: StoredLedger,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredChange {
    pub name: String,
    pub share: f64,
    pub changed: Vec<StoredChanged>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredChanged {
    pub feature: String,
    pub level: u8,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredLedger {
    pub entries: Vec<StoredEntry>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredEntry {
    pub feature: String,
    pub outcome: String,
    pub detail: Option<String>,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredBudget {
    pub scene: String,
    pub chosen: ChosenRecord,
}

#[derive(Clone, Debug, Deserialize)]
pub struct StoredView {
    pub name: String,
    pub scene: String,
    pub draws: BTreeMap<String, Value>,
    pub acquisitions: Vec<Value>,
    pub images: BTreeMap<String, WrittenFile>,
    #[serde(default)]
    pub outputs: BTreeMap<String, String>,
}

impl Renderer {
    /// For people.
    pub fn text(&self) -> String {
        match (&self.adapter, &self.driver, self.samples_per_pixel) {
            (_, _, Some(samples)) => format!("the reference renderer, {samples} samples per pixel"),
            (Some(adapter), driver, None) => {
                let driver = driver.as_ref().map_or(String::new(), |driver| format!(", {driver}"));
                format!("{adapter} ({}{driver})", self.backend)
            }
            (None, _, None) => self.backend.clone(),
        }
    }
}

impl Stored {
    /// Reads and checks the manifest of a dataset's folder.
    pub fn read(folder: &Path) -> Result<Stored, ComparisonError> {
        let path = folder.join(MANIFEST);
        let bytes = std::fs::read(&path).map_err(ComparisonError::read(&path))?;
        let wrong = |why: String| ComparisonError::Manifest { path: path.clone(), why };
        let stored: Stored = serde_json::from_slice(&bytes).map_err(|error| wrong(error.to_string()))?;
        if stored.manifest != 1 {
            return Err(wrong(format!("it has version {}, not 1", stored.manifest)));
        }
        let inputs = stored.inputs.iter().filter_map(|input| input.path.as_ref());
        let images = stored.views.iter().flat_map(|view| view.images.values()).map(|file| &file.path);
        // Scenes lie beside the folders of several datasets.
        let files = stored.files.iter().map(|file| (&file.path, file.path.strip_prefix("../").unwrap_or(&file.path)));
        let mut all = inputs.chain(images).map(|path| (path, path.as_str())).chain(files);
        match all.find(|(_, named)| !stays_below(named)).map(|(path, _)| path) {
            Some(named) => Err(wrong(format!("`{named}` leads out of its folder"))),
            None => Ok(stored),
        }
    }

    /// Files of the dataset by their path, images first.
    pub fn all_files(&self) -> impl Iterator<Item = &WrittenFile> {
        self.views.iter().flat_map(|view| view.images.values()).chain(&self.files)
    }
}

fn stays_below(named: &str) -> bool {
    !named.is_empty()
        && !named.contains('\\')
        && Path::new(named).components().all(|part| matches!(part, Component::Normal(_)))
}

/// The folders with manifests that an output folder has: itself, or those of several datasets in it, sorted.
pub fn dataset_folders(folder: &Path) -> Result<Vec<PathBuf>, ComparisonError> {
    if folder.join(MANIFEST).is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let entries = std::fs::read_dir(folder).map_err(ComparisonError::read(folder))?;
    let mut found: Vec<PathBuf> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.join(MANIFEST).is_file()).collect();
    found.sort();
    if found.is_empty() {
        let message = format!("{} has no {MANIFEST}, nor has any folder in it", folder.display());
        return Err(ComparisonError::Operand(message));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(path: &str) -> String {
        serde_json::json!({
            "manifest": 1, "generator": { "name": "mansard", "version": "0.1.0" }, "dataset": "d", "arguments": {},
            "inputs": [{ "role": "map", "name": "a.osm", "path": path, "bytes": 1, "sha256": "00" }],
            "renderer": { "backend": "vulkan" }, "classes": {}, "scenes": [], "views": [], "files": [],
        })
        .to_string()
    }

    #[test]
    fn no_path_leads_out() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        for (path, fine) in
            [("a/b.osm", true), ("../a.osm", false), ("/etc/passwd", false), ("a/../../b", false), ("", false)]
        {
            std::fs::write(folder.path().join(MANIFEST), manifest(path)).expect("writable");
            assert_eq!(Stored::read(folder.path()).is_ok(), fine, "{path}");
        }
        std::fs::write(folder.path().join(MANIFEST), "{").expect("writable");
        assert!(matches!(Stored::read(folder.path()), Err(ComparisonError::Manifest { .. })));
    }

    #[test]
    fn datasets_lie_in_the_folder_or_one_below() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        assert!(dataset_folders(folder.path()).is_err());
        for name in ["b", "a"] {
            std::fs::create_dir(folder.path().join(name)).expect("writable");
            std::fs::write(folder.path().join(name).join(MANIFEST), "{}").expect("writable");
        }
        let found = dataset_folders(folder.path()).expect("two");
        assert_eq!(found, [folder.path().join("a"), folder.path().join("b")]);
    }
}
