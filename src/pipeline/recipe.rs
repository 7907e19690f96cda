//! The recipe and the rules it names, checked. In: a path and the command line's arguments. Out: a [`Recipe`] whose
//! programs are compiled, or all mistakes at once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::build::BuiltScene;
use super::error::PipelineError;
use super::record;
use super::rules::{self, Programs};
use crate::dataset::manifest::InputFile;
use crate::diagnostics::Diagnostics;
use crate::interpreter::FileAssets;
use crate::output::OutputError;
use crate::source::{Access, AccessError, Looked, Overlay, SourceMap};
use crate::spec;
use crate::spec::render_spec::RenderSpec;

/// What the command line says about a recipe.
#[derive(Clone, Debug, Default)]
pub struct RecipeOptions {
    /// Values of the recipe's arguments.
    pub arguments: Vec<(String, String)>,
    /// Folder trees that may be read besides the recipe's own.
    pub allow: Vec<PathBuf>,
    /// Where every path that is looked for is written down.
    pub looked: Option<Looked>,
}

/// A checked recipe with everything needed to build its scenes.
#[derive(Clone)]
pub struct Recipe {
    pub path: PathBuf,
    pub spec: RenderSpec,
    pub access: Access,
    /// What rules may read: also the projects of rule files that the command line names.
    readable: Access,
    pub programs: Arc<Programs>,
    pub arguments: Vec<(String, String)>,
    /// Warnings of the recipe and its rules.
    pub warnings: Diagnostics,
}

/// Reads and checks a recipe and every rule file that it names.
pub fn load_recipe(path: &Path, options: &RecipeOptions, sources: &mut SourceMap) -> Result<Recipe, PipelineError> {
    load_recipe_over(path, options, &Overlay::default(), sources)
}

/// As [`load_recipe`], with texts in the place of files.
pub fn load_recipe_over(
    path: &Path,
    options: &RecipeOptions,
    overlay: &Overlay,
    sources: &mut SourceMap,
) -> Result<Recipe, PipelineError> {
    if let Some(looked) = &options.looked {
        looked.note(path);
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !path.is_file() && overlay.get(path).is_none() {
        let source = std::io::Error::new(std::io::ErrorKind::NotFound, "no such file");
        return Err(AccessError::Io { path: path.display().to_string(), source }.into());
    }
    let mut access = Access::new(folder)?.with_overlay(overlay);
    if let Some(looked) = &options.looked {
        access = access.noting(looked.clone());
    }
    for tree in &options.allow {
        access.allow(tree)?;
    }
    let (spec, mut diagnostics) = spec::load(&path.display().to_string(), &access, sources, &options.arguments);
    let Some(spec) = spec else { return Err(PipelineError::Diagnostics(diagnostics.sorted())) };
    rules::check_files(&spec, &access, &mut diagnostics);
    let programs = Arc::new(rules::compile(&spec, &access, sources, &mut diagnostics));
    let mut readable = access.clone();
    for tree in programs.trees() {
        readable.allow(tree)?;
    }
    let diagnostics = diagnostics.sorted();
    if diagnostics.has_errors() {
        return Err(PipelineError::Diagnostics(diagnostics));
    }
    let arguments = options.arguments.clone();
    Ok(Recipe { path: path.to_owned(), spec, access, readable, programs, arguments, warnings: diagnostics })
}

/// What OpenStreetMap's licence asks of everything made from its data.
const ATTRIBUTION: &str = "Map data © OpenStreetMap contributors, ODbL 1.0, https://www.openstreetmap.org/copyright";

impl Recipe {
    /// Text that must accompany what is made of this recipe.
    pub fn attribution(&self) -> &'static str {
        ATTRIBUTION
    }

    /// What rules may read.
    pub fn assets_access(&self) -> &Access {
        &self.readable
    }

    /// Files that rules may read.
    pub fn assets(&self) -> FileAssets {
        FileAssets::new(self.readable.clone())
    }

    /// Every input by content, those that only deriving showed as far as scenes are built; sorted.
    pub fn inputs(&self, sources: &SourceMap, built: &[BuiltScene]) -> Result<Vec<InputFile>, OutputError> {
        record::inputs(self, sources, built).map_err(|source| OutputError::new(&self.path, source))
    }

    /// The command line's arguments as the manifest tells them: paths by their names alone.
    pub fn arguments_without_folders(&self) -> BTreeMap<String, String> {
        let short = |item: &str| match Path::new(item.trim()) {
            path if path.exists() => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            _ => item.to_owned(),
        };
        let shortened = |value: &str| value.split(',').map(short).collect::<Vec<_>>().join(",");
        self.arguments.iter().map(|(name, value)| (name.clone(), shortened(value))).collect()
    }
}
