//! Operands → snapshots. In: recipes, revisions and output folders. Out: what they come to, built and drawn as far as the
//! comparison needs it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::error::ComparisonError;
use super::glb::{self, StoredObjects};
use super::operand::Operand;
use super::properties::properties;
use super::revision::{self, Unpacked};
use super::rules::RuleText;
use super::snapshot::{
    DatasetSnapshot, FeatureSnapshot, ImageSnapshot, InputSnapshot, Meaning, SceneSnapshot, Snapshot, ViewSnapshot,
    change_text, outcome_text, scene_snapshot,
};
use super::stored::{Stored, StoredScene, dataset_folders};
use crate::pipeline::{
    BuiltScene, PipelineError, Progress, Recipe, RecipeOptions, RenderOptions, acquisition_record, build_scenes,
    drawn_views, load_recipe, render_built, write_geometry,
};
use crate::source::SourceMap;

/// Whether recipes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixels {
    Compared,
    Left,
}

/// A side, and the temporary folders that its files lie in.
#[derive(Debug)]
pub struct Collected {
    pub snapshot: Snapshot,
    _unpacked: Option<Unpacked>,
    _drawn: Option<tempfile::TempDir>,
}

/// Collects a side. `as_stored`: the other side is a folder, whose meshes have the precision of files. `told` hears of
/// every scene that is built.
pub fn collect(
    operand: &Operand,
    as_stored: bool,
    pixels: Pixels,
    options: &RecipeOptions,
    sources: &mut SourceMap,
    progress: &dyn Progress,
) -> Result<Collected, ComparisonError> {
    let nothing = |snapshot| Collected { snapshot, _unpacked: None, _drawn: None };
    match operand {
        Operand::Folder(folder) => Ok(nothing(of_folder(folder)?)),
        Operand::Recipe(path) => {
            let label = path.display().to_string();
            of_recipe(path, label, as_stored, pixels, options, sources, progress)
        }
        Operand::Revision { revision, path } => {
            let unpacked = revision::unpack(revision, path)?;
            let label = format!("{revision}:{}", path.trim_start_matches("./"));
            let collected = of_recipe(&unpacked.recipe, label, as_stored, pixels, options, sources, progress)?;
            Ok(Collected { _unpacked: Some(unpacked), ..collected })
        }
    }
}

fn of_recipe(
    path: &Path,
    label: String,
    as_stored: bool,
    pixels: Pixels,
    options: &RecipeOptions,
    sources: &mut SourceMap,
    progress: &dyn Progress,
) -> Result<Collected, ComparisonError> {
    let recipe = load_recipe(path, options, sources)?;
    let built = build_scenes(&recipe, progress, &|_| {})?;
    let inputs = recipe.inputs(sources, &built)?;
    let input = |i: crate::dataset::manifest::InputFile| InputSnapshot {
        role: i.role.to_owned(),
        name: i.name,
        path: i.path,
        sha256: i.sha256,
    };
    let mut snapshot = Snapshot {
        label,
        recipe: path.file_name().map(|name| name.to_string_lossy().into_owned()),
        inputs: inputs.into_iter().map(input).collect(),
        arguments: recipe.arguments_without_folders(),
        meaning: Some(Meaning { properties: properties(&recipe.spec), rules: rule_texts(&recipe, sources) }),
        ..Snapshot::default()
    };
    let drawn = match pixels {
        Pixels::Compared if !recipe.spec.datasets.is_empty() => {
            let folder = tempfile::tempdir().map_err(ComparisonError::read(&std::env::temp_dir()))?;
            let options = RenderOptions { output: folder.path().to_owned(), ..RenderOptions::default() };
            let files = write_geometry(&recipe, &built, folder.path())?;
            render_built(&recipe, &options, sources, &built, files, progress)?;
            snapshot.datasets = datasets(&dataset_folders(folder.path())?)?;
            Some(folder)
        }
        Pixels::Compared | Pixels::Left => {
            snapshot.datasets = planned(&recipe, &built);
            None
        }
    };
    for (index, built) in built.into_iter().enumerate() {
        let name = built.record.name.clone();
        let scene = if as_stored { as_stored_scene(&recipe, built)? } else { scene_snapshot(&recipe, index, built) };
        snapshot.scenes.insert(name, scene);
    }
    Ok(Collected { snapshot, _unpacked: None, _drawn: drawn })
}

/// The rule files of a recipe by where they lie below it, each once.
fn rule_texts(recipe: &Recipe, sources: &SourceMap) -> Vec<RuleText> {
    let mut out: Vec<RuleText> = Vec::new();
    for file in sources.files().iter().filter(|file| file.name.ends_with(".cga")) {
        let below = crate::pipeline::below_root(Path::new(&*file.name), &recipe.access);
        let text = RuleText { name: below.unwrap_or_else(|| file.name.to_string()), text: file.text.clone() };
        if !out.contains(&text) {
            out.push(text);
        }
    }
    out
}

/// What would be drawn, without drawing it.
fn planned(recipe: &Recipe, built: &[BuiltScene]) -> BTreeMap<String, DatasetSnapshot> {
    let mut out = BTreeMap::new();
    for dataset in &recipe.spec.datasets {
        let mut snapshot = DatasetSnapshot::default();
        for (index, scene) in built.iter().enumerate() {
            for drawn in drawn_views(recipe, dataset, index, scene) {
                let view = ViewSnapshot {
                    scene: scene.record.name.clone(),
                    draws: drawn.draws.iter().map(|draw| (draw.path.clone(), draw.value.into())).collect(),
                    acquisitions: drawn
                        .demands
                        .iter()
                        .map(|demand| serde_json::json!(acquisition_record(demand)))
                        .collect(),
                    images: BTreeMap::new(),
                };
                snapshot.views.insert(drawn.name, view);
            }
        }
        out.insert(dataset.name.clone(), snapshot);
    }
    out
}

fn datasets(folders: &[PathBuf]) -> Result<BTreeMap<String, DatasetSnapshot>, ComparisonError> {
    let one = |folder: &PathBuf| {
        let stored = Stored::read(folder)?;
        Ok((stored.dataset.clone(), dataset(folder, stored)))
    };
    folders.iter().map(one).collect()
}

fn dataset(folder: &Path, stored: Stored) -> DatasetSnapshot {
    let renderer = Some(stored.renderer.text());
    let views = stored.views.into_iter().map(|view| {
        let outputs = view.outputs;
        let image = |(name, file): (String, crate::dataset::writer::WrittenFile)| {
            let output = outputs.get(&name).cloned();
            (name, ImageSnapshot { path: file.path, sha256: file.sha256, output })
        };
        let images = view.images.into_iter().map(image).collect();
        let snapshot = ViewSnapshot { scene: view.scene, draws: view.draws, acquisitions: view.acquisitions, images };
        (view.name, snapshot)
    });
    DatasetSnapshot { folder: Some(folder.to_owned()), renderer, views: views.collect(), classes: stored.classes }
}

fn of_folder(folder: &Path) -> Result<Snapshot, ComparisonError> {
    let folders = dataset_folders(folder)?;
    // Datasets of one run share everything but their images.
    let first = Stored::read(&folders[0])?;
    let mut scenes = BTreeMap::new();
    for scene in &first.scenes {
        let names = [format!("scene-{}.glb", scene.name), "scene.glb".to_owned()];
        let wanted = |file: &&crate::dataset::writer::WrittenFile| {
            names.iter().any(|name| file.path.trim_start_matches("../") == name)
        };
        let file = first.files.iter().find(wanted).ok_or_else(|| ComparisonError::Manifest {
            path: folders[0].clone(),
            why: format!("it names no glTF file of scene {}", scene.name),
        })?;
        let path = folders[0].join(&file.path);
        let bytes = std::fs::read(&path).map_err(ComparisonError::read(&path))?;
        let objects = glb::read(&bytes).map_err(|why| ComparisonError::Scene { path, why })?;
        scenes.insert(scene.name.clone(), stored_scene(scene, objects));
    }
    let input =
        |i: super::stored::StoredInput| InputSnapshot { role: i.role, name: i.name, path: i.path, sha256: i.sha256 };
    Ok(Snapshot {
        label: folder.display().to_string(),
        datasets: datasets(&folders)?,
        recipe: first.recipe,
        inputs: first.inputs.into_iter().map(input).collect(),
        arguments: first.arguments,
        meaning: None,
        scenes,
    })
}

/// A built scene as its files would tell it.
fn as_stored_scene(recipe: &Recipe, built: BuiltScene) -> Result<SceneSnapshot, ComparisonError> {
    let bytes = crate::scene::export::to_glb(&built.scene, recipe.attribution()).map_err(PipelineError::from)?;
    let path = recipe.path.clone();
    let wrong = |why: String| ComparisonError::Scene { path: path.clone(), why };
    let objects = glb::read(&bytes).map_err(wrong)?;
    let record = serde_json::to_value(&built.record).expect("names and finite numbers serialise");
    let scene: StoredScene = serde_json::from_value(record).map_err(|error| wrong(error.to_string()))?;
    Ok(stored_scene(&scene, objects))
}

/// Features of files are those with geometry, and those that the ledger tells of.
fn stored_scene(scene: &StoredScene, stored: StoredObjects) -> SceneSnapshot {
    let mut features: BTreeMap<String, FeatureSnapshot> = BTreeMap::new();
    for object in stored.objects.iter().filter(|object| object.feature != super::meshes::GROUND) {
        let ok =
            FeatureSnapshot { class: object.class.clone(), outcome: "ok".to_owned(), ..FeatureSnapshot::default() };
        features.entry(object.feature.clone()).or_insert(ok);
    }
    for entry in &scene.ledger.entries {
        let value = serde_json::json!({ "outcome": entry.outcome, "detail": entry.detail });
        features.entry(entry.feature.clone()).or_default().outcome = outcome_text(&value);
    }
    for change in &scene.changes {
        let several = change.changed.iter().any(|changed| changed.level > 1);
        for changed in &change.changed {
            let ok = FeatureSnapshot { outcome: "ok".to_owned(), ..FeatureSnapshot::default() };
            let feature = features.entry(changed.feature.clone()).or_insert(ok);
            feature.change = change_text(&change.name, several.then_some(usize::from(changed.level)));
        }
    }
    SceneSnapshot {
        geometry_sha256: scene.geometry_sha256.clone(),
        features,
        shares: scene.changes.iter().map(|change| (change.name.clone(), change.share)).collect(),
        objects: stored.objects,
        instances: stored.instances,
    }
}
