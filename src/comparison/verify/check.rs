//! A dataset's folder against what was made again. In: the folder, its manifest, the new files. Out: what became of every
//! file, the geometry's hashes, and what the manifest says otherwise.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};

use super::{Colours, DatasetVerification, FileFate, FileVerification, ImageVerification, Made, SceneVerification};
use crate::comparison::error::ComparisonError;
use crate::comparison::pixels::{Kind, compare_pixels, decode, kind};
use crate::comparison::stored::{MANIFEST, Stored};
use crate::comparison::views::{DrawDifference, flatten};
use crate::dataset::writer::WrittenFile;
use crate::pipeline::file_sha256;

/// Colours may differ by this much on another adapter, parts of 255.
const CLOSE_COLOUR: f64 = 1.0;
/// Depths, of themselves: a centimetre at a kilometre.
const CLOSE_DEPTH: f64 = 1e-5;

/// Checks a dataset; `drawn` is the folder of the new images and manifest, if there are any, `files` what was written of
/// the geometry.
pub fn check(
    folder: &Path,
    stored: &Stored,
    made: &Made,
    files: &[WrittenFile],
    drawn: Option<&Path>,
    colours: Colours,
) -> Result<DatasetVerification, ComparisonError> {
    let again = drawn.map(Stored::read).transpose()?;
    let elsewhere = again.as_ref().is_some_and(|again| again.renderer != stored.renderer);
    let scenes = stored.scenes.iter().map(|scene| {
        let built = made.built.iter().find(|built| built.record.name == scene.name);
        let again = built.map_or_else(|| "none".to_owned(), |built| built.record.geometry_sha256.clone());
        SceneVerification { scene: scene.name.clone(), geometry_sha256: [scene.geometry_sha256.clone(), again] }
    });
    let context = Context { folder, stored, drawn, close: elsewhere && colours == Colours::Close };
    Ok(DatasetVerification {
        dataset: stored.dataset.clone(),
        folder: folder.display().to_string(),
        made_by: stored.renderer.text(),
        drawn_again_by: again.as_ref().map(|again| again.renderer.text()),
        scenes: scenes.collect(),
        manifest: manifest_differences(folder, made, drawn)?,
        files: context.files(&new_files(stored, made, files, again.as_ref()))?,
    })
}

/// Path below the dataset's folder → hash, of everything that was made again.
fn new_files(stored: &Stored, made: &Made, files: &[WrittenFile], again: Option<&Stored>) -> BTreeMap<String, String> {
    let of = |file: &WrittenFile| (file.path.clone(), file.sha256.clone());
    if let Some(again) = again {
        return again.all_files().map(of).collect();
    }
    // Scenes lie beside the folders of several datasets.
    let above = made.recipe.spec.datasets.len() > 1 || stored.files.iter().any(|file| file.path.starts_with("../"));
    let place = |file: &WrittenFile| if above { format!("../{}", file.path) } else { file.path.clone() };
    files.iter().map(|file| (place(file), file.sha256.clone())).collect()
}

struct Context<'a> {
    folder: &'a Path,
    stored: &'a Stored,
    drawn: Option<&'a Path>,
    /// Whether colours may be a little off.
    close: bool,
}

impl Context<'_> {
    fn files(&self, again: &BTreeMap<String, String>) -> Result<Vec<FileVerification>, ComparisonError> {
        let mut out = Vec::new();
        let mut known: Vec<&str> = Vec::new();
        for file in self.stored.all_files() {
            known.push(&file.path);
            out.push(self.file(file, again.get(&file.path))?);
        }
        let unexpected = again.iter().filter(|(path, _)| !known.contains(&path.as_str()));
        out.extend(unexpected.map(|(path, sha256)| FileVerification {
            path: path.clone(),
            fate: FileFate::Unexpected,
            image: None,
            sha256: Some([None, None, Some(sha256.clone())]),
        }));
        for path in present(self.folder)? {
            if path != MANIFEST && !known.contains(&path.as_str()) && !again.contains_key(&path) {
                out.push(FileVerification { path, fate: FileFate::Extra, image: None, sha256: None });
            }
        }
        out.sort_by(|x, y| (x.fate, &x.path).cmp(&(y.fate, &y.path)));
        Ok(out)
    }

    fn file(&self, file: &WrittenFile, again: Option<&String>) -> Result<FileVerification, ComparisonError> {
        let path = self.folder.join(&file.path);
        let here = match path.is_file() {
            true => Some(file_sha256(&path).map_err(ComparisonError::read(&path))?.1),
            false => None,
        };
        let is_image = self.stored.views.iter().any(|view| view.images.values().any(|image| image.path == file.path));
        let unchecked = is_image && self.drawn.is_none();
        let mut image = None;
        let fate = match (&here, again) {
            (None, _) => FileFate::Missing,
            (Some(here), Some(again)) if here == again => FileFate::Same,
            (Some(here), _) if *here != file.sha256 => FileFate::Altered,
            (Some(_), None) if unchecked => FileFate::Unchecked,
            (Some(_), None) => FileFate::Unexpected,
            (Some(_), Some(_)) => FileFate::Different,
        };
        if matches!(fate, FileFate::Altered | FileFate::Different)
            && is_image
            && let Some(drawn) = self.drawn.filter(|_| again.is_some())
        {
            image = Some(self.image(&file.path, drawn));
        }
        let close = |image: &(ImageVerification, bool)| fate == FileFate::Different && self.close && image.1;
        let fate = if image.as_ref().is_some_and(close) { FileFate::Close } else { fate };
        let hashes = [Some(file.sha256.clone()), here, again.cloned()];
        Ok(FileVerification {
            path: file.path.clone(),
            fate,
            image: image.map(|(image, _)| image),
            sha256: (!matches!(fate, FileFate::Same | FileFate::Unchecked)).then_some(hashes),
        })
    }

    /// How an image differs, and whether that may be on another adapter.
    fn image(&self, path: &str, drawn: &Path) -> (ImageVerification, bool) {
        let views = self.stored.views.iter();
        let named = views.flat_map(|view| view.images.iter().map(move |(name, file)| (view, name, file)));
        let output = named.filter(|(_, _, file)| file.path == path).find_map(|(view, name, _)| view.outputs.get(name));
        let nothing =
            ImageVerification { kind: Kind::Colour, pixels: 0, differing: 0, greatest: None, incomparable: None };
        // An altered file need not be an image any more.
        let pair = decode(&self.folder.join(path)).and_then(|a| Ok((a, decode(&drawn.join(path))?)));
        let (a, b) = match pair {
            Ok(pair) => pair,
            Err(error) => return (ImageVerification { incomparable: Some(error.to_string()), ..nothing }, false),
        };
        let kind = kind(output.map(String::as_str), &b.pixels);
        match compare_pixels(&a, &b) {
            Err(why) => (ImageVerification { kind, incomparable: Some(why), ..nothing }, false),
            Ok(found) => {
                let greatest = found.greatest.filter(|_| kind != Kind::Labels);
                let close = match kind {
                    Kind::Labels => found.differing == 0,
                    Kind::Colour => found.greatest.is_some_and(|greatest| greatest <= CLOSE_COLOUR),
                    Kind::Depth => found.greatest_share.is_some_and(|share| share <= CLOSE_DEPTH),
                };
                let (pixels, differing) = (found.pixels, found.differing);
                (ImageVerification { kind, pixels, differing, greatest, incomparable: None }, close)
            }
        }
    }
}

/// Everything in a folder, by paths below it.
fn present(folder: &Path) -> Result<Vec<String>, ComparisonError> {
    let mut out = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(next) = waiting.pop() {
        for entry in std::fs::read_dir(&next).map_err(ComparisonError::read(&next))? {
            let path = entry.map_err(ComparisonError::read(&next))?.path();
            // Such as a desktop's notes about a folder.
            let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if path.is_dir() {
                waiting.push(path);
            } else if !hidden {
                let below = path.strip_prefix(folder).expect("it was found below");
                out.push(below.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/"));
            }
        }
    }
    out.sort();
    Ok(out)
}

/// What the manifest of the folder says otherwise than one made now. Hashes of files are compared with the files;
/// renderer, budget and version say how it was made.
fn manifest_differences(
    folder: &Path,
    made: &Made,
    drawn: Option<&Path>,
) -> Result<Vec<DrawDifference>, ComparisonError> {
    let here = read(&folder.join(MANIFEST))?;
    let again = match drawn {
        Some(drawn) => read(&drawn.join(MANIFEST))?,
        None => json!({
            "arguments": made.recipe.arguments_without_folders(),
            "inputs": made.recipe.inputs(made.sources, made.built)?,
            "scenes": made.built.iter().map(|built| &built.record).collect::<Vec<_>>(),
        }),
    };
    let compared = ["attribution", "dataset", "recipe", "arguments", "inputs", "classes", "scenes", "views"];
    let flat = |manifest: &Value| {
        let mut out = BTreeMap::new();
        for key in compared.iter().filter(|key| again.get(**key).is_some()) {
            flatten(key, &manifest[*key], &mut out);
        }
        out.retain(|path, _| {
            !(path.starts_with("views") && (path.ends_with(".sha256") || path.contains(".standard_errors.")))
        });
        out
    };
    let (a, b) = (flat(&here), flat(&again));
    let mut paths: Vec<&String> = a.keys().chain(b.keys()).collect();
    paths.sort();
    paths.dedup();
    let value = |side: &BTreeMap<String, Value>, path: &String| side.get(path).cloned().unwrap_or(Value::Null);
    let one = |path: &String| DrawDifference {
        view: MANIFEST.to_owned(),
        path: path.clone(),
        a: value(&a, path),
        b: value(&b, path),
    };
    Ok(paths.into_iter().map(one).filter(|d| d.a != d.b).collect())
}

fn read(path: &Path) -> Result<Value, ComparisonError> {
    let bytes = std::fs::read(path).map_err(ComparisonError::read(path))?;
    let wrong = |error: serde_json::Error| ComparisonError::Manifest { path: path.to_owned(), why: error.to_string() };
    serde_json::from_slice(&bytes).map_err(wrong)
}
