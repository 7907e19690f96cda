//! What accuracy costs in a recipe's own scene. In: a recipe. Out: `cost.csv`, plots and `cost.html` in a folder.

use std::path::{Path, PathBuf};

use super::budget::settings;
use super::build::{BuiltScene, Checks, Fineness, TERRAIN_TOLERANCE_M, build_scene, build_scene_within};
use super::error::PipelineError;
use super::progress::Progress;
use super::recipe::Recipe;
use super::views::scene_views;
use crate::cost::bench::{Bench, Setting, Windows};
use crate::cost::errors::{Metric, digits};
use crate::cost::knobs::{Subject, Unswept};
use crate::cost::report::page::{About, Panel, frontier_plot, html, knob_plot};
use crate::cost::report::picture::{AMPLIFIED, Picture};
use crate::cost::report::table::to_csv;
use crate::cost::sweep::{Kind, KnobText, Row, Sweep, Work};
use crate::dataset::writer::write_file;
use crate::geometry::roof::CURVE_BANDS;
use crate::gpu::Renderer;
use crate::output::prepare_folder;
use crate::plan::demand::{Camera, Output, Projection, Quality, ViewDemand};
use crate::scene::Scene;
use crate::spec::PRESETS;
use crate::spec::render_spec::{DatasetSpec, OutputSpec};

/// Metres; the last is the truth of the others.
const TOLERANCES: [f64; 6] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125];
/// Facade detail left out, in pixels; the last is the truth of the others.
const DETAILS: [f64; 6] = [8.0, 4.0, 2.0, 1.0, 0.5, 0.0];
/// Bands of round roofs; the last is the truth of the others.
const CURVES: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// What the command line says.
#[derive(Clone, Debug)]
pub struct CostOptions {
    pub output: PathBuf,
    /// Name of the view; the first one with a colour image otherwise.
    pub view: Option<String>,
    /// Runs that each time is the median of.
    pub repeats: usize,
    /// Windows that are compared with the reference, and their size in pixels.
    pub windows: usize,
    pub side: u32,
    /// Mean standard error of the reference, of white, at which it stops.
    pub noise: f64,
}

/// What was made.
#[derive(Clone, Debug, Default)]
pub struct CostSummary {
    pub settings: usize,
    pub files: Vec<String>,
    /// Time and errors of the presets and of the recipe's own quality, for people.
    pub lines: Vec<String>,
}

/// The view that is measured.
struct Subjected<'a> {
    dataset: &'a DatasetSpec,
    scene: usize,
    name: String,
}

/// Measures every knob. `told` hears of the scene when its geometry is done.
pub fn measure_cost(
    recipe: &Recipe,
    options: &CostOptions,
    progress: &dyn Progress,
    told: &dyn Fn(&BuiltScene),
) -> Result<CostSummary, PipelineError> {
    let subject = subject(recipe, options)?;
    prepare_folder(&options.output)?;
    let built = build_scene(recipe, subject.scene, Checks::Off, progress)?;
    told(&built);
    let demand = demand(recipe, &subject, &built);
    let mut renderer = Renderer::new()?;
    let facts = facts(&renderer, &built, &demand, options);
    let (sweep, panels, samples) = sweep(recipe, &subject, options, &built, &demand, &mut renderer, progress)?;
    let own = own_name(&Quality::from(&subject.dataset.quality));
    let about = About {
        recipe: recipe.path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        facts,
        method: method(options, samples),
        own,
    };
    let files = write(&options.output, &sweep, &about, &panels)?;
    Ok(CostSummary { settings: sweep.rows.len(), files, lines: in_short(&sweep) })
}

fn subject<'a>(recipe: &'a Recipe, options: &CostOptions) -> Result<Subjected<'a>, PipelineError> {
    if recipe.spec.datasets.is_empty() {
        return Err(PipelineError::NoDataset);
    }
    let colored = |dataset: &DatasetSpec| {
        let mut outputs = dataset.passes.iter().flat_map(|&pass| &recipe.spec.passes[pass].outputs);
        outputs.any(|(output, _)| *output == OutputSpec::Colour)
    };
    let views = recipe.spec.datasets.iter().flat_map(|dataset| dataset.views.iter().map(move |view| (dataset, view)));
    let wanted = |name: &str| options.view.as_ref().is_none_or(|wanted| wanted == name);
    let named: Vec<_> = views.filter(|(_, view)| wanted(&view.name)).collect();
    if let (Some(name), true) = (&options.view, named.is_empty()) {
        return Err(PipelineError::NoSuchView(name.clone()));
    }
    let found = named.into_iter().find(|(dataset, _)| colored(dataset)).ok_or(PipelineError::NoColor)?;
    Ok(Subjected { dataset: found.0, scene: found.1.scene, name: found.1.name.clone() })
}

/// What the view asks for, in its first acquisition with a colour image.
fn demand(recipe: &Recipe, subject: &Subjected, built: &BuiltScene) -> ViewDemand {
    let views = scene_views(recipe, subject.dataset, subject.scene, built, &|name| name == subject.name);
    let mut demands = views.drawn.into_iter().flat_map(|view| view.demands);
    demands.find(has_color).expect("the dataset has a colour image")
}

fn has_color(demand: &ViewDemand) -> bool {
    demand.outputs.iter().any(|output| output.output == Output::Color)
}

fn windows(options: &CostOptions) -> Windows {
    Windows { side: options.side, count: options.windows, enough: options.noise }
}

fn sweep(
    recipe: &Recipe,
    subject: &Subjected,
    options: &CostOptions,
    built: &BuiltScene,
    demand: &ViewDemand,
    renderer: &mut Renderer,
    progress: &dyn Progress,
) -> Result<(Sweep, Vec<Panel>, u32), PipelineError> {
    let own = Quality::from(&subject.dataset.quality);
    let has_elevation = !recipe.spec.scenes[subject.scene].elevations.is_empty();
    let height = has_elevation.then_some(built.record.terrain_error_m);
    let look = demand.outputs.iter().find(|o| o.output == Output::Color).expect("it was chosen for that").look.clone();
    let what = Subject {
        look: &look,
        sun: demand.sun.is_some_and(|sun| sun.direction.y > 0.0),
        textures: !built.scene.textures.is_empty(),
    };
    progress.begin("reference", Some(options.windows as u64));
    let demands = std::slice::from_ref(demand);
    let mut bench = Bench::new(renderer, &built.scene, demands, height, windows(options), &|_| progress.step(1))?;
    let samples = bench.truths().map(|(_, truth)| truth.samples).max().unwrap_or(0);
    progress.end(&format!("{samples} samples a pixel"));
    progress.begin("sweep", None);
    let mut sweep = Sweep::default();
    let work = Work { repeats: options.repeats, told: &|_| progress.step(1) };
    sweep.measure(&mut bench, what, &presets(own), own, &work)?;
    let panels = panels(&mut bench, own)?;
    drop(bench);
    for knob in scene_knobs(recipe, subject.scene, gsd(&demand.camera, &built.scene), has_elevation) {
        scene_knob(&mut sweep, &knob, recipe, subject, options, renderer, &work, progress)?;
    }
    progress.end(&format!("{} settings", sweep.rows.len()));
    Ok((sweep, panels, samples))
}

/// A knob that changes the scene: what it is called, and how finely each of its values builds; the last is the truth.
struct SceneKnob {
    text: KnobText,
    values: Vec<(String, Fineness)>,
}

fn scene_knobs(recipe: &Recipe, scene: usize, gsd: f64, has_elevation: bool) -> Vec<SceneKnob> {
    let own = Fineness::of(recipe, scene);
    let usual = |is: bool| if is { " (usual)" } else { "" };
    let tolerance = |terrain_tolerance_m: f64| {
        let name = format!("{terrain_tolerance_m} m{}", usual(terrain_tolerance_m == TERRAIN_TOLERANCE_M));
        (name, Fineness { terrain_tolerance_m, ..own })
    };
    let detail = |pixels: f64| {
        let detail_m = (pixels * gsd * 1000.0).round() / 1000.0;
        let name = if pixels == 0.0 { "all".to_owned() } else { format!("none below {pixels} px, {detail_m} m") };
        (name, Fineness { detail_m, ..own })
    };
    let bands = |curve_bands: u32| {
        let name = format!("{curve_bands} bands{}", usual(curve_bands == CURVE_BANDS));
        (name, Fineness { curve_bands, ..own })
    };
    let knob = |name, metric, about, values: [(String, Fineness); 6]| SceneKnob {
        text: KnobText { name, metric, about },
        values: values.to_vec(),
    };
    let terrain = knob(
        "terrain tolerance",
        Metric::Height,
        "how far the ground mesh may lie beside the elevation data; the truth is the finest",
        TOLERANCES.map(tolerance),
    );
    let detail = knob(
        "geometry detail",
        Metric::Light,
        "which facade detail is left out, against the size of a pixel (`detail` of a recipe)",
        DETAILS.map(detail),
    );
    let curves = knob(
        "curve tessellation",
        Metric::Light,
        "bands of planes from the eaves to the top of round roofs (`curves` of a recipe)",
        CURVES.map(bands),
    );
    [has_elevation.then_some(terrain), Some(detail), Some(curves)].into_iter().flatten().collect()
}

/// Metres of a pixel at the distance of the scene's middle.
fn gsd(camera: &Camera, scene: &Scene) -> f64 {
    let middle = (scene.bounds.0 + scene.bounds.1) / 2.0;
    let half = match camera.projection {
        Projection::Perspective { tan_x, .. } => tan_x * (middle - camera.position).dot(camera.forward),
        Projection::Orthographic { half_x, .. } => half_x,
    };
    2.0 * half / f64::from(camera.width)
}

#[expect(clippy::too_many_arguments, reason = "one loop taken out of the sweep")]
fn scene_knob(
    sweep: &mut Sweep,
    knob: &SceneKnob,
    recipe: &Recipe,
    subject: &Subjected,
    options: &CostOptions,
    renderer: &mut Renderer,
    work: &Work,
    progress: &dyn Progress,
) -> Result<(), PipelineError> {
    let own = Quality::from(&subject.dataset.quality);
    let build = |fineness| build_scene_within(recipe, subject.scene, fineness, Checks::Off, progress);
    let (Some((_, coarsest)), Some((_, finest))) = (knob.values.first(), knob.values.last()) else { return Ok(()) };
    let (coarsest, truth) = (build(*coarsest)?, build(*finest)?);
    if coarsest.record.geometry_sha256 == truth.record.geometry_sha256 {
        sweep.unswept.push(Unswept { knob: knob.text.name, reason: "it changes nothing in this scene" });
        return Ok(());
    }
    let true_demand = demand(recipe, subject, &truth);
    let mut bench = Bench::new(renderer, &truth.scene, &[true_demand], None, windows(options), &|_| {})?;
    let of_ground = knob.text.metric == Metric::Height;
    let last = knob.values.len() - 1;
    for (number, (name, fineness)) in knob.values.iter().enumerate() {
        let between;
        let built = match number {
            0 => &coarsest,
            _ if number == last => &truth,
            _ => {
                between = build(*fineness)?;
                &between
            }
        };
        let demand = demand(recipe, subject, built);
        bench.replace(&built.scene, &[demand], of_ground.then_some(built.record.terrain_error_m))?;
        let value = format!("{name}, {} triangles", built.record.triangles);
        sweep.scene_value(&mut bench, &knob.text, &value, own, work)?;
    }
    Ok(())
}

/// The presets, and the recipe's own quality where it is none of them.
fn presets(own: Quality) -> Vec<(String, Quality)> {
    let mut all: Vec<(String, Quality)> =
        PRESETS.iter().map(|(name, spec)| ((*name).to_owned(), Quality::from(spec))).collect();
    if all.iter().all(|(_, quality)| *quality != own) {
        all.push((own_name(&own), own));
    }
    all
}

fn own_name(own: &Quality) -> String {
    let preset = PRESETS.iter().find(|(_, spec)| Quality::from(spec) == *own);
    preset.map_or_else(|| "the recipe’s own".to_owned(), |(name, _)| (*name).to_owned())
}

/// Pictures of every window with the recipe's own quality.
fn panels(bench: &mut Bench, own: Quality) -> Result<Vec<Panel>, PipelineError> {
    let drawn = bench.pictures(&Setting::of(own))?;
    let mut panels = Vec::new();
    for (images, (view, truth)) in drawn.iter().zip(bench.truths()) {
        let mut pictures = vec![
            (Picture::light(images), "drawn with the recipe’s own quality".to_owned()),
            (Picture::light(&truth.images), format!("reference, {} samples a pixel", truth.samples)),
            (
                Picture::difference(images, truth),
                format!(
                    "difference in linear light, {AMPLIFIED:.0} times; grey is none, light too bright, dark too dark"
                ),
            ),
        ];
        if let Some(shadows) = Picture::shadows(images, truth) {
            let text = "masks of shadow: red is missing, blue too much, mid-grey looks away from the sun";
            pictures.push((shadows, text.to_owned()));
        }
        pictures.push((Picture::labels(images, truth), "labels: red is another object than the true one".to_owned()));
        let w = truth.images.window;
        let title = format!("{view}, {} × {} pixels from column {}, row {}", w.width, w.height, w.x, w.y);
        panels.push(Panel { title, pictures });
    }
    Ok(panels)
}

fn facts(renderer: &Renderer, built: &BuiltScene, demand: &ViewDemand, options: &CostOptions) -> Vec<(String, String)> {
    let adapter = renderer.adapter();
    let sun = demand.sun.map(|sun| crate::plan::sun::to_angles(sun.direction));
    let mut facts = vec![
        ("view", format!("{}, {} × {} pixels", demand.name, demand.camera.width, demand.camera.height)),
        ("images", demand.outputs.iter().map(|output| output.pass.as_str()).collect::<Vec<_>>().join(", ")),
        (
            "scene",
            format!(
                "{}: {} objects, {} triangles",
                built.record.name,
                built.scene.objects.len(),
                built.record.triangles
            ),
        ),
        ("own quality", settings(&demand.quality)),
        ("adapter", format!("{} ({}, {})", adapter.name, adapter.backend, adapter.driver)),
        ("windows", format!("{} of {} × {} pixels", options.windows, options.side, options.side)),
    ];
    if let Some((elevation, azimuth)) = sun {
        facts.insert(2, ("sun", format!("{elevation:.1}° above the horizon, azimuth {azimuth:.0}°")));
    }
    facts.into_iter().map(|(what, value)| (what.to_owned(), value)).collect()
}

fn method(options: &CostOptions, samples: u32) -> Vec<String> {
    vec![
        format!(
            "Errors are those of {} windows of the view: the cells of a grid with the most buildings, the same on every machine. The truth \
             comes from the reference renderer, which traces rays in 64-bit numbers and shares no shading and no shadows with the one \
             that is measured. It took up to {samples} samples a pixel, until its own mean standard error was at most {} of white; what \
             is left of it is taken off the root mean squares.",
            options.windows,
            Metric::Light.text(options.noise)
        ),
        "Light is linear, before encoding; 100 % is white. Edges are outlines of objects without shadows, shifted by what their light says; \
         shadows are pixels that lost more than half of their sunlight; labels are numbers of objects at pixel centres."
            .to_owned(),
        format!(
            "Times are of all images of the view by the wall, medians of {} runs after one that compiles; the spread is the fastest and the \
             slowest.",
            options.repeats
        ),
    ]
}

fn write(folder: &Path, sweep: &Sweep, about: &About, panels: &[Panel]) -> Result<Vec<String>, PipelineError> {
    let mut files = vec![("cost.csv".to_owned(), to_csv(sweep))];
    for metric in Metric::ALL {
        if let Some(plot) = frontier_plot(sweep, about, metric) {
            files.push((format!("frontier-{}.svg", metric.key()), plot.into_bytes()));
        }
    }
    for knob in &sweep.knobs {
        if let Some(plot) = knob_plot(sweep, knob.name, knob.metric) {
            files.push((format!("knob-{}.svg", knob.name.replace([' ', '_'], "-")), plot.into_bytes()));
        }
    }
    files.push(("cost.html".to_owned(), html(sweep, about, panels).into_bytes()));
    let written = |(name, bytes): &(String, Vec<u8>)| Ok(write_file(folder, Path::new(name), bytes)?.path);
    files.iter().map(written).collect()
}

/// Lines for the terminal: what the recipe's own quality gives up.
fn in_short(sweep: &Sweep) -> Vec<String> {
    let line = |row: &Row| {
        let errors: Vec<String> = Metric::ALL
            .into_iter()
            .filter_map(|metric| Some(format!("{} {}", metric.key(), metric.text(row.errors.get(metric)?))))
            .collect();
        format!("{}: {} ms, {}", row.value, digits(row.times.median), errors.join(", "))
    };
    sweep.rows.iter().filter(|row| row.kind == Kind::Preset).map(line).collect()
}
