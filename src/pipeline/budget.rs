//! Error budgets. In: a built scene and a dataset that promises errors. Out: the dataset with the cheapest quality that
//! keeps them, and the record of what was promised, chosen and achieved.

use super::build::BuiltScene;
use super::error::PipelineError;
use super::progress::Progress;
use super::recipe::Recipe;
use super::views::scene_views;
use crate::cost::bench::{Bench, Windows};
use crate::cost::budget::{Choice, Outcome, Promise, choose};
use crate::cost::errors::{Errors, Metric};
use crate::cost::knobs::Subject;
use crate::dataset::manifest::{BudgetRecord, ChosenRecord, LimitRecord};
use crate::gpu::Renderer;
use crate::plan::demand::{Output, Quality, ViewDemand};
use crate::spec::render_spec::{BudgetSpec, DatasetSpec, QualitySpec};

/// Pixels per side of the windows, and how many each view has; every other one checks.
const SIDE: u32 = 128;
const WINDOWS: usize = 4;
/// Views that are looked at: the first and the last of the scene.
const VIEWS: usize = 2;

/// A dataset whose quality is settled.
pub struct Settled {
    pub dataset: DatasetSpec,
    /// `None` without a budget.
    pub record: Option<BudgetRecord>,
}

/// Settles the quality of a dataset for one scene. Without a renderer one is opened, if there is something to measure.
pub fn settle(
    recipe: &Recipe,
    dataset: &DatasetSpec,
    index: usize,
    built: &BuiltScene,
    renderer: Option<&mut Renderer>,
    progress: &dyn Progress,
) -> Result<Settled, PipelineError> {
    let unsettled = Settled { dataset: dataset.clone(), record: None };
    let Some(budget) = dataset.quality.budget else { return Ok(unsettled) };
    let promise = Promise::new(&budget);
    let all = scene_views(recipe, dataset, index, built, &|_| true);
    let drawn: Vec<&[ViewDemand]> = all.drawn.iter().map(|view| view.demands.as_slice()).collect();
    let ends = drawn.first().into_iter().chain(drawn.last().filter(|_| drawn.len() > 1)).take(VIEWS);
    let demands: Vec<ViewDemand> = ends.flat_map(|demands| demands.iter().cloned()).collect();
    let height = height(recipe, built);
    let own = Quality::from(&dataset.quality);
    let colored = demands.iter().find_map(|view| {
        let output = view.outputs.iter().find(|output| output.output == Output::Color)?;
        Some((view, output))
    });
    let Some((view, output)) = colored.filter(|_| !promise.is_empty()) else {
        let record = record(built, &budget, own, None, height);
        return Ok(Settled { record: Some(record), ..unsettled });
    };
    progress.begin("budget", None);
    let mut opened = None;
    let renderer = match renderer {
        Some(renderer) => renderer,
        None => opened.insert(Renderer::new()?),
    };
    let wanted = Windows { side: SIDE, count: WINDOWS, enough: promise.enough() };
    let mut bench = Bench::new(renderer, &built.scene, &demands, height, wanted, &|_| {})?;
    let subject = Subject {
        look: &output.look,
        sun: view.sun.is_some_and(|sun| sun.direction.y > 0.0),
        textures: !built.scene.textures.is_empty(),
    };
    let triangles = built.record.triangles as u64;
    let choice = match choose(&mut bench, subject, &demands, triangles, own, &budget)? {
        Outcome::Kept(choice) => choice,
        Outcome::Missed(best) => {
            return Err(PipelineError::Budget {
                promised: promised(&promise),
                dataset: dataset.name.clone(),
                scene: built.record.name.clone(),
                best: achieved(&promise, &best),
                settings: settings(&best.quality),
            });
        }
    };
    progress.end(&format!("{}, {} combinations tried", settings(&choice.quality), choice.tried));
    let record = record(built, &budget, choice.quality, Some(&choice), height);
    let Quality { supersample, shadow_map, shadow_samples, sky_samples, field_map } = choice.quality;
    let quality = QualitySpec { supersample, shadow_map, shadow_samples, sky_samples, field_map, ..dataset.quality };
    Ok(Settled { dataset: DatasetSpec { quality, ..dataset.clone() }, record: Some(record) })
}

/// The ground's greatest error, where there is elevation.
fn height(recipe: &Recipe, built: &BuiltScene) -> Option<f64> {
    let scene = recipe.spec.scenes.iter().find(|scene| scene.name == built.record.name)?;
    (!scene.elevations.is_empty()).then_some(built.record.terrain_error_m)
}

fn promised(promise: &Promise) -> String {
    let one = |&(metric, limit): &(Metric, f64)| format!("{} {}", word(metric), text(metric, limit));
    promise.limits().iter().map(one).collect::<Vec<_>>().join(", ")
}

/// The larger error of both halves, by what was promised.
fn achieved(promise: &Promise, best: &Choice) -> String {
    let worse = |metric: Metric| {
        let both = [best.calibrated.get(metric), best.achieved.get(metric)];
        both.into_iter().flatten().reduce(f64::max)
    };
    let one = |&(metric, _): &(Metric, f64)| Some(format!("{} {}", word(metric), text(metric, worse(metric)?)));
    promise.limits().iter().filter_map(one).collect::<Vec<_>>().join(", ")
}

/// As recipes name it.
fn word(metric: Metric) -> &'static str {
    match metric {
        Metric::Edge => "edge",
        Metric::Shadow => "shadow",
        Metric::Height => "height",
        Metric::Light | Metric::Worst | Metric::Label => "error",
    }
}

/// As recipes write it: shadows by what overlaps.
fn text(metric: Metric, value: f64) -> String {
    match metric {
        Metric::Shadow => format!("{:.2} %", 100.0 * (1.0 - value)),
        _ => metric.text(value),
    }
}

/// Knobs as recipes write them.
pub fn settings(quality: &Quality) -> String {
    let Quality { supersample, shadow_map, shadow_samples, sky_samples, field_map } = quality;
    format!(
        "antialiasing {}, shadow_map {shadow_map}, shadow_samples {shadow_samples}, sky_samples {sky_samples}, \
         field_map {field_map}",
        supersample * supersample
    )
}

fn record(
    built: &BuiltScene,
    budget: &BudgetSpec,
    quality: Quality,
    choice: Option<&Choice>,
    height: Option<f64>,
) -> BudgetRecord {
    let of = |metric: Metric, promised: Option<f64>, error: &dyn Fn(&Errors) -> Option<f64>| {
        let promised = promised?;
        let round = |value: f64| (value * 1e6).round() / 1e6;
        let found = |errors: Option<&Errors>| errors.and_then(error).map(round);
        Some(LimitRecord {
            of: word(metric),
            promised,
            calibrated: found(choice.map(|c| &c.calibrated)),
            achieved: found(choice.map(|c| &c.achieved)),
        })
    };
    let ground =
        budget.height.map(|promised| LimitRecord { of: "height", promised, calibrated: None, achieved: height });
    let limits = [
        of(Metric::Light, budget.error, &|errors| Some(errors.light)),
        of(Metric::Edge, budget.edge, &|errors| errors.edge),
        of(Metric::Shadow, budget.shadow, &|errors| errors.shadow.map(|miss| 1.0 - miss)),
        ground,
    ];
    BudgetRecord {
        scene: built.record.name.clone(),
        chosen: ChosenRecord {
            antialiasing: quality.supersample * quality.supersample,
            shadow_map: quality.shadow_map,
            shadow_samples: quality.shadow_samples,
            sky_samples: quality.sky_samples,
            field_map: quality.field_map,
        },
        limits: limits.into_iter().flatten().collect(),
    }
}

/// A record as lines of a plan.
pub fn lines(record: &BudgetRecord) -> Vec<String> {
    let c = &record.chosen;
    let mut lines = vec![format!(
        "quality chosen by its budget: antialiasing {}, shadow_map {}, shadow_samples {}, sky_samples {}, field_map {}",
        c.antialiasing, c.shadow_map, c.shadow_samples, c.sky_samples, c.field_map
    )];
    lines.extend(record.limits.iter().map(|limit| {
        let (scale, unit) = match limit.of {
            "edge" => (1.0, "px"),
            "height" => (1.0, "m"),
            _ => (100.0, "%"),
        };
        let number = |value: f64| format!("{:.3} {unit}", value * scale);
        let achieved = limit.achieved.map_or("nothing to measure".to_owned(), |a| format!("{} achieved", number(a)));
        format!("budget {}: {} promised, {achieved}", limit.of, number(limit.promised))
    }));
    lines
}
