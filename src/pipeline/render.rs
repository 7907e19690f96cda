//! A recipe's dataset, from files to files. The geometry and `scene.glb` are written before the GPU is touched; images
//! are encoded while the next view is drawn.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use super::backend::{Backend, BackendChoice, Drawn};
use super::budget::{Settled, settle};
use super::build::{BuiltScene, Checks, build_scene};
use super::error::PipelineError;
use super::progress::Progress;
use super::recipe::Recipe;
use super::record::acquisition_record;
use super::views::{SceneViews, scene_views};
use crate::dataset::manifest::{BudgetRecord, ChosenRecord, Generator, Manifest, ViewRecord};
use crate::dataset::reports::{self, SceneReports};
use crate::dataset::writer::{WrittenFile, write_file};
use crate::dataset::{DatasetError, image_path, is_levir_label, write_image};
use crate::frame::{Frame, Image, Pixels};
use crate::output::prepare_folder;
use crate::plan::demand::Output;
use crate::plan::view::DrawnView;
use crate::scene::SceneClass;
use crate::scene::export::to_glb;
use crate::source::SourceMap;
use crate::spec::render_spec::{DatasetSpec, QualitySpec, ViewSpec};

/// What the command line says about a render.
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    pub output: PathBuf,
    /// Names of views, `*` stands for anything; all views if empty.
    pub views: Vec<String>,
    pub backend: BackendChoice,
    /// Per pixel, of the reference.
    pub samples: Option<u32>,
    /// Only this one; all if absent.
    pub dataset: Option<String>,
    /// Quality by scene that is not to be chosen again where the recipe has an error budget.
    pub settled: BTreeMap<String, ChosenRecord>,
}

/// What was made.
#[derive(Clone, Debug, Default)]
pub struct RenderSummary {
    pub views: usize,
    pub images: usize,
    /// Files besides the images.
    pub other_files: Vec<String>,
}

/// Makes all datasets of a recipe. `told` hears of every scene when its geometry is done.
pub fn render_dataset(
    recipe: &Recipe,
    options: &RenderOptions,
    sources: &SourceMap,
    progress: &dyn Progress,
    told: &dyn Fn(&BuiltScene),
) -> Result<RenderSummary, PipelineError> {
    if recipe.spec.datasets.is_empty() {
        return Err(PipelineError::NoDataset);
    }
    check_wanted(recipe, options)?;
    prepare_folder(&options.output)?;
    let built = build_scenes(recipe, progress, told)?;
    let files = write_geometry(recipe, &built, &options.output)?;
    render_built(recipe, options, sources, &built, files, progress)
}

/// Builds every scene of a recipe, which needs no GPU.
pub fn build_scenes(
    recipe: &Recipe,
    progress: &dyn Progress,
    told: &dyn Fn(&BuiltScene),
) -> Result<Vec<BuiltScene>, PipelineError> {
    let one = |index| {
        let scene = build_scene(recipe, index, Checks::Off, progress)?;
        told(&scene);
        Ok(scene)
    };
    (0..recipe.spec.scenes.len()).map(one).collect()
}

/// Writes the glTF of every scene, and the reports.
pub fn write_geometry(recipe: &Recipe, built: &[BuiltScene], folder: &Path) -> Result<Vec<WrittenFile>, PipelineError> {
    let mut files = Vec::new();
    for scene in built {
        let glb = to_glb(&scene.scene, recipe.attribution())?;
        let single = built.len() == 1;
        let name = if single { "scene.glb".to_owned() } else { format!("scene-{}.glb", scene.record.name) };
        files.push(write_file(folder, Path::new(&name), &glb)?);
    }
    files.extend(write_reports(built, folder)?);
    Ok(files)
}

/// Draws the views of built scenes and writes images and manifests; `scene_files` are what [`write_geometry`] wrote.
pub fn render_built(
    recipe: &Recipe,
    options: &RenderOptions,
    sources: &SourceMap,
    built: &[BuiltScene],
    scene_files: Vec<WrittenFile>,
    progress: &dyn Progress,
) -> Result<RenderSummary, PipelineError> {
    let several = recipe.spec.datasets.len() > 1;
    let folder = |d: &DatasetSpec| if several { options.output.join(&d.name) } else { options.output.clone() };
    let mut summary = RenderSummary::default();
    let mut backend = Backend::open(options.backend, options.samples, progress)?;
    let wanted = |d: &&DatasetSpec| options.dataset.as_ref().is_none_or(|only| *only == d.name);
    for dataset in recipe.spec.datasets.iter().filter(wanted) {
        let folder = folder(dataset);
        let (mut records, mut budgets) = (Vec::new(), Vec::new());
        for (index, scene) in built.iter().enumerate() {
            let views = scene_views(recipe, dataset, index, scene, &|name| is_wanted(name, &options.views));
            if views.drawn.is_empty() {
                continue;
            }
            let settled = match options.settled.get(&scene.record.name) {
                Some(chosen) => Settled { dataset: with_quality(dataset, chosen), record: None },
                None => settle_for(&mut backend, recipe, dataset, (index, scene), progress)?,
            };
            let views = match settled.dataset.quality == dataset.quality {
                true => views,
                false => scene_views(recipe, &settled.dataset, index, scene, &|name| is_wanted(name, &options.views)),
            };
            budgets.extend(settled.record);
            backend.begin(&views, progress);
            backend.upload(&scene.scene, &views.plan)?;
            let (drawn, idle) = render_views(&mut backend, dataset, scene, &views, &folder, progress)?;
            records.extend(drawn);
            progress.end(&format!(
                "{} views, {:.0} % of the time waiting for the encoder",
                views.drawn.len(),
                100.0 * idle
            ));
        }
        summary.views += records.len();
        summary.images += records.iter().map(|r| r.images.len()).sum::<usize>();
        // Scenes lie beside the folders of several datasets.
        let from_here = |f: &WrittenFile| WrittenFile { path: format!("../{}", f.path), sha256: f.sha256.clone() };
        let files = if several { scene_files.iter().map(from_here).collect() } else { scene_files.clone() };
        let manifest = manifest(recipe, dataset, sources, &backend, built, (records, budgets), files)?;
        write_file(&folder, Path::new("manifest.json"), &manifest.to_bytes())?;
        let prefix = if several { format!("{}/", dataset.name) } else { String::new() };
        summary.other_files.push(format!("{prefix}manifest.json"));
    }
    summary.other_files.extend(scene_files.into_iter().map(|f| f.path));
    Ok(summary)
}

/// A dataset with the quality that a manifest records.
fn with_quality(dataset: &DatasetSpec, chosen: &ChosenRecord) -> DatasetSpec {
    let ChosenRecord { antialiasing, shadow_map, shadow_samples, sky_samples, field_map } = *chosen;
    let supersample = antialiasing.isqrt();
    let quality = QualitySpec { supersample, shadow_map, shadow_samples, sky_samples, field_map, ..dataset.quality };
    DatasetSpec { quality, ..dataset.clone() }
}

/// Budgets are about the GPU's approximations; the reference has none of its knobs, and tells its noise.
fn settle_for(
    backend: &mut Backend,
    recipe: &Recipe,
    dataset: &DatasetSpec,
    (index, scene): (usize, &BuiltScene),
    progress: &dyn Progress,
) -> Result<Settled, PipelineError> {
    match backend {
        Backend::Gpu(renderer) => settle(recipe, dataset, index, scene, Some(renderer), progress),
        Backend::Reference { .. } => {
            if dataset.quality.budget.is_some() {
                progress.warn(
                    "the reference renderer draws: the budget chooses nothing, the manifest says the images' noise",
                );
            }
            Ok(Settled { dataset: dataset.clone(), record: None })
        }
    }
}

/// `reports.csv` and `reports.json` of all scenes, if any rule reports.
fn write_reports(built: &[BuiltScene], folder: &Path) -> Result<Vec<WrittenFile>, DatasetError> {
    let scenes: Vec<SceneReports> = built.iter().map(|scene| scene.reports.clone()).collect();
    if !reports::any(&scenes) {
        return Ok(Vec::new());
    }
    let csv = write_file(folder, Path::new("reports.csv"), &reports::to_csv(&scenes))?;
    Ok(vec![csv, write_file(folder, Path::new("reports.json"), &reports::to_json(&scenes))?])
}

/// Draws views one after another; a second thread encodes and writes the images of the one before. Also gives the share
/// of the time in which nothing was drawn because that thread was not done.
fn render_views(
    backend: &mut Backend,
    dataset: &DatasetSpec,
    scene: &BuiltScene,
    views: &SceneViews,
    folder: &Path,
    progress: &dyn Progress,
) -> Result<(Vec<ViewRecord>, f64), PipelineError> {
    std::thread::scope(|scope| {
        let (send, receive) = sync_channel::<(usize, Drawn)>(1);
        let counts_views = backend.counts_views();
        let writer = scope.spawn(move || -> Result<Vec<ViewRecord>, DatasetError> {
            let mut records = Vec::new();
            for (number, Drawn { frame, errors }) in receive {
                let drawn = &views.drawn[number];
                let spec = &dataset.views[drawn.view];
                let images = write_images(dataset, spec, frame, folder)?;
                let standard_errors = errors.into_iter().collect();
                records.push(ViewRecord { standard_errors, ..view_record(drawn, spec, scene, images) });
                if counts_views {
                    progress.step(1);
                }
            }
            Ok(records)
        });
        let (start, mut waited) = (Instant::now(), Duration::ZERO);
        let drawn = draw(backend, views, progress, &mut |number, drawn| {
            let ready = Instant::now();
            let taken = send.send((number, drawn)).is_ok();
            waited += ready.elapsed();
            taken
        });
        drop(send);
        let last = Instant::now();
        let written = writer.join().expect("the writer does not panic");
        waited += last.elapsed();
        drawn?;
        Ok((written?, waited.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-9)))
    })
}

/// Renders every view and hands its images on; stops early if nobody takes them any more.
fn draw(
    backend: &mut Backend,
    views: &SceneViews,
    progress: &dyn Progress,
    hand_on: &mut dyn FnMut(usize, Drawn) -> bool,
) -> Result<(), PipelineError> {
    let mut plans = views.plan.views.iter();
    for (number, drawn) in views.drawn.iter().enumerate() {
        let mut whole: Option<Drawn> = None;
        for demand in &drawn.demands {
            let part = backend.render(demand, plans.next().expect("one plan per demand"), progress)?;
            match &mut whole {
                Some(whole) => {
                    whole.frame.images.extend(part.frame.images);
                    whole.errors.extend(part.errors);
                }
                None => whole = Some(part),
            }
        }
        let whole = whole.expect("a view has at least one acquisition");
        if !hand_on(number, whole) {
            break;
        }
    }
    Ok(())
}

fn write_images(
    dataset: &DatasetSpec,
    view: &ViewSpec,
    frame: Frame,
    folder: &Path,
) -> Result<BTreeMap<String, WrittenFile>, DatasetError> {
    let size = (frame.width, frame.height);
    let one = |Image { pass, mut pixels }: Image| {
        if let (true, Pixels::Gray8(labels)) = (is_levir_label(&dataset.layout, &pass), &mut pixels) {
            labels.iter_mut().for_each(|label| *label = if *label == 0 { 0 } else { 255 });
        }
        let name = image_path(&dataset.layout, view.split, &view.name, &pass);
        Ok((pass, write_image(folder, &name, size, &pixels)?))
    };
    frame.images.into_iter().map(one).collect()
}

fn view_record(
    drawn: &DrawnView,
    spec: &ViewSpec,
    scene: &BuiltScene,
    images: BTreeMap<String, WrittenFile>,
) -> ViewRecord {
    ViewRecord {
        name: drawn.name.clone(),
        scene: scene.record.name.clone(),
        split: spec.split.name(),
        draws: drawn.draws.iter().map(|d| (d.path.clone(), d.value.into())).collect(),
        acquisitions: drawn.demands.iter().map(acquisition_record).collect(),
        images,
        outputs: outputs(drawn),
        standard_errors: BTreeMap::new(),
    }
}

/// What the images of a view hold.
fn outputs(drawn: &DrawnView) -> BTreeMap<String, &'static str> {
    let word = |output: Output| match output {
        Output::Color => "colour",
        Output::Class => "class",
        Output::Mask => "mask",
        Output::Level => "level",
        Output::Instance => "instance",
        Output::Depth => "depth",
    };
    drawn.demands.iter().flat_map(|demand| &demand.outputs).map(|o| (o.pass.clone(), word(o.output))).collect()
}

fn manifest(
    recipe: &Recipe,
    dataset: &DatasetSpec,
    sources: &SourceMap,
    backend: &Backend,
    built: &[BuiltScene],
    (views, budgets): (Vec<ViewRecord>, Vec<BudgetRecord>),
    files: Vec<WrittenFile>,
) -> Result<Manifest, PipelineError> {
    Ok(Manifest {
        manifest: 1,
        generator: Generator { name: "mansard", version: env!("CARGO_PKG_VERSION") },
        attribution: recipe.attribution().to_owned(),
        dataset: dataset.name.clone(),
        recipe: recipe.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        arguments: recipe.arguments_without_folders(),
        inputs: recipe.inputs(sources, built)?,
        renderer: backend.info(),
        classes: SceneClass::ALL.iter().map(|class| (*class as u8, class.name())).collect(),
        scenes: built.iter().map(|b| b.record.clone()).collect(),
        budgets,
        views,
        files,
    })
}

fn check_wanted(recipe: &Recipe, options: &RenderOptions) -> Result<(), PipelineError> {
    let names: Vec<&str> = recipe.spec.datasets.iter().flat_map(|d| &d.views).map(|v| v.name.as_str()).collect();
    match options.views.iter().find(|pattern| !names.iter().any(|name| glob(pattern, name))) {
        Some(pattern) => Err(PipelineError::NoSuchView(pattern.clone())),
        None => Ok(()),
    }
}

fn is_wanted(name: &str, patterns: &[String]) -> bool {
    patterns.is_empty() || patterns.iter().any(|pattern| glob(pattern, name))
}

/// `*` stands for any run of characters.
fn glob(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, tail)) => name
            .strip_prefix(head)
            .is_some_and(|rest| (0..=rest.len()).any(|i| rest.is_char_boundary(i) && glob(tail, &rest[i..]))),
    }
}

#[cfg(test)]
mod tests {
    use super::glob;

    #[test]
    fn stars_stand_for_anything() {
        assert!(glob("a*c", "abbc") && glob("*", "") && glob("*_1", "town_top_1") && glob("x", "x"));
        assert!(!glob("a*c", "abd") && !glob("x", "xy"));
    }
}
