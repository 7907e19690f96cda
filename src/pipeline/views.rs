//! Views and their plan. In: a built scene and a dataset block. Out: what every view asks for and the passes that serve
//! it; no GPU.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};

use super::budget::{self, settle};
use super::build::{BuiltScene, Checks, build_scene};
use super::error::PipelineError;
use super::progress::Progress;
use super::recipe::Recipe;
use crate::dataset::manifest::BudgetRecord;
use crate::plan::demand::OutputDemand;
use crate::plan::effects::{Ambient, Bands, BitDepth, Look};
use crate::plan::view::{DrawnView, SceneSummary, views};
use crate::plan::{RenderPlan, dump, schedule, summarize};
use crate::spec::render_spec::DatasetSpec;

/// The views that a dataset has of one scene. `plan.views` holds one entry per demand, in the order of `drawn`.
pub struct SceneViews {
    pub drawn: Vec<DrawnView>,
    pub plan: RenderPlan,
}

/// Draws and schedules the views of a scene; `wanted` filters them by name.
pub fn scene_views(
    recipe: &Recipe,
    dataset: &DatasetSpec,
    scene: usize,
    built: &BuiltScene,
    wanted: &dyn Fn(&str) -> bool,
) -> SceneViews {
    let mut drawn = drawn_views(recipe, dataset, scene, built);
    drawn.retain(|view| wanted(&view.name));
    let demands: Vec<_> = drawn.iter().flat_map(|view| view.demands.iter().cloned()).collect();
    let plan = schedule(&demands, &summarize(&built.scene));
    SceneViews { drawn, plan }
}

/// Draws the views that a dataset has of a scene, without passes.
pub fn drawn_views(recipe: &Recipe, dataset: &DatasetSpec, scene: usize, built: &BuiltScene) -> Vec<DrawnView> {
    let ground = built.terrain.height(DVec2::ZERO).unwrap_or(built.scene.bounds.0.y);
    let summary = SceneSummary::new(&built.scene, DVec3::new(0.0, ground, 0.0));
    views(&recipe.spec, dataset, scene, &summary)
}

/// One dataset's views of one scene, for `mansard plan`.
pub struct PlannedScene {
    pub dataset: String,
    pub scene: String,
    /// Lines on what was derived and what was not.
    pub derivation: Vec<String>,
    /// What an error budget came to.
    pub budget: Option<BudgetRecord>,
    /// Lines on what lights and takes an image besides sun and ambient light.
    pub effects: Vec<String>,
    pub plan: RenderPlan,
}

/// Everything that rendering a recipe would do.
pub struct PlannedRecipe {
    pub scenes: Vec<PlannedScene>,
}

/// Builds the scenes of a recipe and plans all views of all its datasets.
pub fn plan_views(recipe: &Recipe, progress: &dyn Progress) -> Result<PlannedRecipe, PipelineError> {
    let mut scenes = Vec::new();
    for index in 0..recipe.spec.scenes.len() {
        let built = build_scene(recipe, index, Checks::Off, progress)?;
        for dataset in &recipe.spec.datasets {
            let settled = settle(recipe, dataset, index, &built, None, progress)?;
            let views = scene_views(recipe, &settled.dataset, index, &built, &|_| true);
            scenes.push(PlannedScene {
                dataset: dataset.name.clone(),
                scene: built.record.name.clone(),
                derivation: derivation(&built),
                budget: settled.record,
                effects: views.drawn.iter().flat_map(effects).collect(),
                plan: views.plan,
            });
        }
    }
    Ok(PlannedRecipe { scenes })
}

/// A line for each image that has more than sun and ambient light.
fn effects(view: &DrawnView) -> Vec<String> {
    let outputs = view.demands.iter().flat_map(|demand| &demand.outputs);
    let line = |output: &OutputDemand| {
        let terms = terms(&output.look);
        (!terms.is_empty()).then(|| format!("effects of {} {}: {}", view.name, output.pass, terms.join("; ")))
    };
    outputs.filter_map(line).collect()
}

fn terms(look: &Look) -> Vec<String> {
    let mut terms = Vec::new();
    if let Ambient::Sky { occluded: true, .. } = look.ambient {
        terms.push("the scene hides the sky".to_owned());
    }
    if let Some(haze) = &look.haze {
        terms.push(format!("haze {:.2e} per m, scale height {:.0} m", haze.extinction[1], haze.scale_height));
    }
    if let Some(clouds) = &look.clouds {
        let (cover, depth) = (100.0 * clouds.cover, clouds.depth);
        terms.push(format!("clouds {cover:.0} % at {:.0} m, optical depth {depth:.1}", clouds.height));
    }
    if let Some(ground) = &look.ground {
        let (kind, share) = (format!("{:?}", ground.kind).to_lowercase(), 100.0 * ground.strength);
        terms.push(format!("{kind} {share:.0} % within {:.0} m of {} discs", ground.reach, ground.around.len()));
    }
    if let Some(sensor) = &look.sensor {
        let bands = match sensor.bands {
            Bands::Rgb => "rgb",
            Bands::Nir(_) => "nir",
            Bands::Panchromatic(_) => "panchromatic",
            Bands::FalseColor(_) => "false colour",
        };
        let bits = if sensor.depth == BitDepth::Sixteen { 16 } else { 8 };
        let noise = 100.0 * sensor.read_noise;
        terms.push(format!(
            "sensor {bands}, {bits} bit, psf {:.2} px, exposure {:.3}, noise {noise:.1} %, full well {:.0}",
            sensor.psf, sensor.exposure, sensor.full_well
        ));
    }
    terms
}

fn derivation(built: &BuiltScene) -> Vec<String> {
    let ledger = &built.record.ledger;
    let mut lines = vec![
        format!("derive {} objects, {} triangles", built.scene.objects.len(), built.record.triangles),
        format!("{} textures, {} materials", built.scene.textures.len(), built.scene.materials.len()),
        format!("ground within {:.3} m of the elevation data", built.record.terrain_error_m),
        match built.record.detail_m {
            0.0 => "all detail of facades: the recipe leaves none out".to_owned(),
            detail => format!("no detail of facades below {detail} m: the recipe leaves it out"),
        },
    ];
    let mut reasons: Vec<(String, usize)> = Vec::new();
    for entry in &ledger.entries {
        if let crate::geodata::ledger::Outcome::Skipped(why) = &entry.outcome {
            match reasons.iter_mut().find(|(r, _)| r == why) {
                Some((_, count)) => *count += 1,
                None => reasons.push((why.clone(), 1)),
            }
        }
    }
    lines.extend(reasons.into_iter().map(|(why, count)| format!("not derived: {count} features, {why}")));
    lines
}

impl PlannedRecipe {
    pub fn text(&self) -> String {
        let scene = |s: &PlannedScene| {
            let budget = s.budget.as_ref().map(budget::lines).unwrap_or_default();
            let lines = s.derivation.iter().chain(&s.effects).chain(&budget);
            let derivation: String = lines.map(|line| format!("  {line}\n")).collect();
            format!("dataset {}, scene {}\n{derivation}{}", s.dataset, s.scene, dump::text(&s.plan))
        };
        self.scenes.iter().map(scene).collect()
    }

    pub fn json(&self) -> Value {
        let scene = |s: &PlannedScene| {
            let mut value = json!({
                "dataset": s.dataset,
                "scene": s.scene,
                "derivation": s.derivation,
                "effects": s.effects,
                "plan": dump::json(&s.plan),
            });
            if let Some(budget) = &s.budget {
                value["budget"] = json!(budget);
            }
            value
        };
        json!({ "datasets": self.scenes.iter().map(scene).collect::<Vec<_>>() })
    }

    pub fn dot(&self) -> String {
        self.scenes.iter().map(|s| dump::dot(&s.plan)).collect()
    }
}
