//! One recipe, kept up to date. In: its path, options, [`Overrides`]. Out: the last good scene and an [`Update`] per round.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use super::overrides::Overrides;
use super::picking::{LotInfo, Ray};
use super::update::{Message, Phase, Redone, Update};
use crate::cga::program::Program;
use crate::pipeline::{BuiltScene, PipelineError, Recipe, RecipeOptions};
use crate::plan::demand::State;
use crate::plan::view::DrawnView;
use crate::source::SourceMap;

/// A rule file that the recipe assigns, with its program: attributes and their annotations.
pub struct RuleFile<'a> {
    /// As the recipe writes it; the key of [`super::AttributeOverride::file`].
    pub written: &'a str,
    pub program: &'a Program,
}

/// A recipe with the last good scene and everything that is kept of it.
pub struct Session {
    path: PathBuf,
    options: RecipeOptions,
    stop: Arc<AtomicBool>,
}

impl Session {
    /// Nothing is read yet: the first [`Session::update`] does it, and tells what is wrong.
    pub fn open(path: &Path, options: RecipeOptions) -> Session;

    /// Set it from any thread to give up the update that is running; the update clears it when it begins.
    pub fn stop(&self) -> Arc<AtomicBool>;

    /// Brings everything up to date with the files on disk and the overrides. Never fails: what went wrong is in the
    /// update, and the scene before stands.
    pub fn update(&mut self, overrides: &Overrides) -> Update;

    /// The last good scene; another `Arc` whenever anything of it changed.
    pub fn built(&self) -> Option<&Arc<BuiltScene>>;

    /// The recipe of the last good scene, overrides applied.
    pub fn recipe(&self) -> Option<&Recipe>;

    /// Texts of the last good scene's recipe and rules.
    pub fn sources(&self) -> &SourceMap;

    /// Index of the scene shown, into the recipe's.
    pub fn scene(&self) -> usize;

    /// Views that the recipe's datasets have of the scene shown, in their order, drawn under the overrides.
    pub fn views(&self) -> &[DrawnView];

    /// Every file that an update would look at, those included that are missing now.
    pub fn watched(&self) -> Vec<PathBuf>;

    /// Rule files of the last good recipe, without repeats, in its order.
    pub fn rule_files(&self) -> Vec<RuleFile<'_>>;

    /// What is known of an object of the scene shown, by its label in instance images; with a ray also the leaf that it
    /// meets first.
    pub fn lot(&self, instance: u32, state: State, ray: Option<Ray>) -> Option<LotInfo>;

    /// Hash of all meshes, materials and labels of the scene shown, as the manifest tells it.
    pub fn geometry_sha256(&self) -> Option<String>;
}
