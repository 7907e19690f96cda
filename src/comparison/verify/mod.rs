//! Verification: a dataset made again from its manifest. In: a dataset's folder. Out: a [`Verification`], file by file.
//!
//! 1. [`locate`] finds the recipe and every input by content; a run from other content would prove nothing.
//! 2. The scenes are built again; the inputs that only building shows are held against the manifest too.
//! 3. Images are drawn again, into a temporary folder: the same views, renderer and settled quality.
//! 4. [`check`] compares what lies in the folder, what the manifest says and what was made again.

mod check;
mod locate;
mod search;
mod text;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::error::ComparisonError;
use super::pixels::Kind;
use super::stored::{Stored, dataset_folders};
use super::views::DrawDifference;
use crate::dataset::manifest::InputFile;
use crate::gpu::GpuError;
use crate::pipeline::{
    BackendChoice, BuiltScene, PipelineError, Progress, Recipe, RecipeOptions, RenderOptions, build_scenes,
    load_recipe, render_built, write_geometry,
};
use crate::reference::Options;
use crate::source::SourceMap;
pub use text::verification_text;

/// What is taken for the same colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colours {
    /// Equal to the bit.
    #[default]
    Exact,
    /// On another adapter or driver, colours within 1/255 and depths within 1e-5 of themselves.
    Close,
}

#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// Where the recipe lies; searched for otherwise.
    pub recipe: Option<PathBuf>,
    /// Folders to look for inputs in, and to read from.
    pub inputs: Vec<PathBuf>,
    /// Whether images are drawn again.
    pub images: bool,
    pub colours: Colours,
}

/// What became of a file of the dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FileFate {
    /// In the manifest, not in the folder.
    Missing,
    /// Not what the manifest says: somebody changed it after it was made.
    Altered,
    /// As the manifest says, but made again it is another.
    Different,
    /// In the manifest, and made again it does not come about; or the other way round.
    Unexpected,
    /// In the folder, not in the manifest.
    Extra,
    /// Colours or depths differ as they may on another adapter.
    Close,
    /// As the manifest says, and not drawn again.
    Unchecked,
    Same,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileVerification {
    /// Below the dataset's folder.
    pub path: String,
    pub fate: FileFate,
    /// Of images that differ.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageVerification>,
    /// Of files that are not the same: in the manifest, in the folder, made again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sha256: Option<[Option<String>; 3]>,
}

/// How an image of the folder differs from the one made again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImageVerification {
    pub kind: Kind,
    pub pixels: u64,
    pub differing: u64,
    /// Colours in parts of 255, depths in metres.
    pub greatest: Option<f64>,
    /// Why pixels cannot be compared.
    pub incomparable: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneVerification {
    pub scene: String,
    /// In the manifest, and made again.
    pub geometry_sha256: [String; 2],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DatasetVerification {
    pub dataset: String,
    pub folder: String,
    /// What made it, and what drew it again.
    pub made_by: String,
    pub drawn_again_by: Option<String>,
    pub scenes: Vec<SceneVerification>,
    /// What the manifest says otherwise than the one made again.
    pub manifest: Vec<DrawDifference>,
    /// What is wrong comes first.
    pub files: Vec<FileVerification>,
}

/// A dataset against itself made again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verification {
    pub verified: bool,
    /// Version that made it, and this one.
    pub versions: [String; 2],
    /// How many inputs have the content that the manifest says: all, or there is no verification.
    pub inputs: usize,
    /// Inputs that were found under another name or in another place.
    pub gathered: Vec<String>,
    pub datasets: Vec<DatasetVerification>,
}

/// Verifies a dataset's folder, or all datasets of one run in a folder.
pub fn verify(
    folder: &Path,
    options: &VerifyOptions,
    sources: &mut SourceMap,
    progress: &dyn Progress,
) -> Result<Verification, ComparisonError> {
    let folders = dataset_folders(folder)?;
    let stored = folders.iter().map(|folder| Stored::read(folder)).collect::<Result<Vec<_>, _>>()?;
    let first = &stored[0];
    if let Some(other) = stored.iter().find(|other| other.inputs != first.inputs || other.recipe != first.recipe) {
        let why =
            format!("datasets {} and {} are of different runs; verify them one by one", first.dataset, other.dataset);
        return Err(ComparisonError::Unverifiable(why));
    }

    // Find what it was made of.
    let located = locate::locate(first, &folders[0], options)?;
    let recipe_options = RecipeOptions {
        arguments: located.arguments.clone(),
        allow: located.allow.clone(),
        ..RecipeOptions::default()
    };
    let recipe = load_recipe(&located.recipe, &recipe_options, sources)?;
    let early = |role: &str| matches!(role, "recipe" | "rules" | "map" | "elevation");
    check_inputs(first, &recipe.inputs(sources, &[])?, &early)?;

    // Build it.
    let built = build_scenes(&recipe, progress, &|_| {})?;
    check_inputs(first, &recipe.inputs(sources, &built)?, &|_| true)?;
    let again = tempfile::tempdir().map_err(ComparisonError::read(&std::env::temp_dir()))?;
    let made = Made { recipe: &recipe, sources, built: &built, folder: again.path(), progress };

    // Draw it, and compare.
    let files = write_geometry(&recipe, &built, again.path())?;
    let mut datasets = Vec::new();
    for (folder, stored) in folders.iter().zip(&stored) {
        let drawn = if options.images { Some(made.draw(stored, files.clone())?) } else { None };
        datasets.push(check::check(folder, stored, &made, &files, drawn.as_deref(), options.colours)?);
    }
    let versions = [first.generator.version.clone(), env!("CARGO_PKG_VERSION").to_owned()];
    let verified = datasets.iter().all(is_verified);
    Ok(Verification { verified, versions, inputs: first.inputs.len(), gathered: located.gathered, datasets })
}

fn is_verified(dataset: &DatasetVerification) -> bool {
    dataset.manifest.is_empty()
        && dataset.scenes.iter().all(|scene| scene.geometry_sha256[0] == scene.geometry_sha256[1])
        && dataset.files.iter().all(|f| matches!(f.fate, FileFate::Same | FileFate::Close | FileFate::Unchecked))
}

/// What was built again.
pub struct Made<'a> {
    recipe: &'a Recipe,
    sources: &'a SourceMap,
    built: &'a [BuiltScene],
    folder: &'a Path,
    progress: &'a dyn Progress,
}

impl Made<'_> {
    /// Draws the views of a dataset as the manifest says, and gives their folder.
    fn draw(
        &self,
        stored: &Stored,
        files: Vec<crate::dataset::writer::WrittenFile>,
    ) -> Result<PathBuf, ComparisonError> {
        let datasets = &self.recipe.spec.datasets;
        if !datasets.iter().any(|dataset| dataset.name == stored.dataset) {
            let why = format!("the recipe has no dataset `{}`", stored.dataset);
            return Err(ComparisonError::Unverifiable(why));
        }
        let mut views: Vec<String> = stored.views.iter().map(|view| view.name.clone()).collect();
        if views.is_empty() {
            // No name would mean all.
            views.push(String::new());
        }
        let reference = stored.renderer.backend == "reference";
        let settled = stored.budgets.iter().map(|budget| (budget.scene.clone(), budget.chosen));
        let options = RenderOptions {
            output: self.folder.to_owned(),
            views,
            backend: if reference { BackendChoice::Reference } else { BackendChoice::Gpu },
            samples: stored.renderer.samples_per_pixel.map(asked_for),
            dataset: Some(stored.dataset.clone()),
            settled: settled.collect::<BTreeMap<_, _>>(),
        };
        let drawn = render_built(self.recipe, &options, self.sources, self.built, files, self.progress);
        drawn.map_err(|error| match error {
            PipelineError::Gpu(error @ (GpuError::NoAdapter(_) | GpuError::NoDevice { .. })) => {
                let made_by = stored.renderer.text();
                ComparisonError::Unverifiable(format!(
                    "its images were drawn by {made_by}, and here {error}; `--no-images` verifies everything else"
                ))
            }
            error => error.into(),
        })?;
        let several = datasets.len() > 1;
        Ok(if several { self.folder.join(&stored.dataset) } else { self.folder.to_owned() })
    }
}

/// Samples to ask the reference for, so that it takes this many.
fn asked_for(taken: u32) -> u32 {
    (1..=taken).find(|asked| Options::of_samples(*asked).samples() == taken).unwrap_or(taken)
}

/// Holds inputs of some roles against the manifest.
fn check_inputs(stored: &Stored, found: &[InputFile], of: &dyn Fn(&str) -> bool) -> Result<(), ComparisonError> {
    let wanted =
        stored.inputs.iter().filter(|i| of(&i.role)).map(|i| (i.role.as_str(), i.name.as_str(), i.sha256.as_str()));
    let wanted: BTreeSet<_> = wanted.collect();
    let found = found.iter().filter(|i| of(i.role)).map(|i| (i.role, i.name.as_str(), i.sha256.as_str()));
    let found: BTreeSet<_> = found.collect();
    let mut lines = Vec::new();
    for (role, name, sha256) in wanted.difference(&found) {
        let other = found.difference(&wanted).find(|(r, n, _)| r == role && n == name);
        lines.push(match other {
            Some((_, _, other)) => another_content(role, name, sha256, "what the recipe finds", other),
            None => format!(
                "{role} {name}: the dataset was made with it (sha256 {sha256}), the recipe does not read it now"
            ),
        });
    }
    for (role, name, sha256) in found.difference(&wanted) {
        if !wanted.iter().any(|(r, n, _)| r == role && n == name) {
            lines.push(format!(
                "{role} {name}: the recipe reads it now (sha256 {sha256}), the dataset was made without it"
            ));
        }
    }
    if lines.is_empty() { Ok(()) } else { Err(ComparisonError::Inputs(lines)) }
}

/// The line on an input that is not what it was.
fn another_content(role: &str, name: &str, wanted: &str, place: &str, found: &str) -> String {
    format!("{role} {name}: another content: the dataset was made of sha256 {wanted}, {place} has {found}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_samples_are_taken_again_in_the_same_grid() {
        for asked in 1..2000 {
            let options = Options::of_samples(asked);
            let again = Options::of_samples(asked_for(options.samples()));
            assert_eq!((options.side, options.passes), (again.side, again.passes), "{asked}");
        }
    }
}
