//! One scene of a recipe, from files to meshes with labels.

use super::derivation::derive_features;
use super::error::PipelineError;
use super::place::{Place, place};
use super::preparation::assign;
use super::progress::Progress;
use super::recipe::Recipe;
use super::record::{asset_files, geometry_hash, report_records};
use super::textures;
use super::validation::{FeatureChecks, Validation};
use super::vegetation;
use crate::dataset::manifest::{ChangeRecord, ChangedFeature, InputFile, SceneRecord};
use crate::dataset::reports::SceneReports;
use crate::diagnostics::Diagnostics;
use crate::geodata::feature::{Feature, FeatureClass, FeatureId};
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::projection::LocalFrame;
use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;
use crate::geometry::roof::CURVE_BANDS;
use crate::interpreter::Limits;
use crate::output::OutputError;
use crate::plan::change::{Changed, draw_changes};
use crate::scene::Scene;
use crate::scene::assemble::{FeatureParts, TERRAIN_INSTANCE, assemble, ground_layers};
use crate::scene::ground::build_ground;
use crate::spec::render_spec::DatasetSpec;

/// Greatest vertical distance allowed between the ground mesh and the elevation data, metres.
pub const TERRAIN_TOLERANCE_M: f64 = 0.5;

/// A scene with everything that is known about how it came to be.
pub struct BuiltScene {
    pub scene: Scene,
    pub frame: LocalFrame,
    pub terrain: Terrain,
    pub record: SceneRecord,
    pub reports: SceneReports,
    /// Of every feature, in the order of their ids.
    pub assignments: Vec<Assignment>,
    /// Only where mesh checks were asked for.
    pub validation: Option<Validation>,
    /// Textures and geometry files that rules named.
    pub files: Vec<InputFile>,
    /// Mistakes met while deriving.
    pub diagnostics: Diagnostics,
    pub prints: Vec<String>,
}

/// What a recipe makes of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assignment {
    pub feature: FeatureId,
    pub class: FeatureClass,
    /// Index into the scene's rules.
    pub rule: Option<usize>,
    pub change: Option<Changed>,
}

/// Whether meshes are checked for defects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checks {
    Off,
    All,
}

/// How finely a scene is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fineness {
    /// Vertical distance, metres, within which the ground keeps to the elevation data where its posts allow it.
    pub terrain_tolerance_m: f64,
    /// Metres: as [`Limits::detail`](crate::interpreter::Limits::detail).
    pub detail_m: f64,
    /// As [`Limits::curve_bands`](crate::interpreter::Limits::curve_bands).
    pub curve_bands: u32,
}

impl Fineness {
    /// What the datasets that show a scene ask for; where they differ, the finest.
    pub fn of(recipe: &Recipe, scene: usize) -> Fineness {
        let detail = datasets_of(recipe, scene).map(|dataset| dataset.quality.detail_m).reduce(f64::min);
        let curves = datasets_of(recipe, scene).map(|dataset| dataset.quality.curves).max();
        Fineness {
            terrain_tolerance_m: TERRAIN_TOLERANCE_M,
            detail_m: detail.unwrap_or(0.0),
            curve_bands: curves.unwrap_or(CURVE_BANDS),
        }
    }
}

fn datasets_of(recipe: &Recipe, scene: usize) -> impl Iterator<Item = &DatasetSpec> {
    recipe.spec.datasets.iter().filter(move |dataset| dataset.views.iter().any(|view| view.scene == scene))
}

/// Builds the scene with this index.
pub fn build_scene(
    recipe: &Recipe,
    index: usize,
    checks: Checks,
    progress: &dyn Progress,
) -> Result<BuiltScene, PipelineError> {
    let usual = Fineness::of(recipe, index);
    let Some(promised_m) = height_budget(recipe, index) else {
        return build_scene_within(recipe, index, usual, checks, progress);
    };
    // The tolerance is aimed at; along borders that are split later a finer one may be needed to keep it.
    let mut best_m = f64::INFINITY;
    for share in [1.0, 0.5, 0.25, 0.125] {
        let built = build_scene_within(
            recipe,
            index,
            Fineness { terrain_tolerance_m: promised_m * share, ..usual },
            checks,
            progress,
        )?;
        if built.record.terrain_error_m <= promised_m {
            return Ok(built);
        }
        best_m = best_m.min(built.record.terrain_error_m);
    }
    Err(PipelineError::HeightBudget { scene: recipe.spec.scenes[index].name.clone(), promised_m, best_m })
}

/// The least height that datasets of a scene promise of its ground.
fn height_budget(recipe: &Recipe, scene: usize) -> Option<f64> {
    datasets_of(recipe, scene).filter_map(|dataset| dataset.quality.budget?.height).reduce(f64::min)
}

/// Builds a scene this finely.
pub fn build_scene_within(
    recipe: &Recipe,
    index: usize,
    fineness: Fineness,
    checks: Checks,
    progress: &dyn Progress,
) -> Result<BuiltScene, PipelineError> {
    let spec = &recipe.spec.scenes[index];

    // Read the map and the elevation.
    let place = place(recipe, spec, progress)?;

    // Draw what changes.
    let assigned = assign(&spec.rules, &place.features);
    let with_rules: Vec<usize> = (0..place.features.len()).filter(|&i| assigned[i].is_some()).collect();
    let candidate = |&i: &usize| (place.features[i].id, place.features[i].class, &place.features[i].tags);
    let candidates: Vec<_> = with_rules.iter().map(candidate).collect();
    let (changed, drawn) = draw_changes(&recipe.spec, spec, &candidates);
    let mut touched = vec![None; place.features.len()];
    for (i, change) in with_rules.into_iter().zip(changed) {
        touched[i] = change;
    }

    let assignment =
        |(i, f): (usize, &Feature)| Assignment { feature: f.id, class: f.class, rule: assigned[i], change: touched[i] };
    let assignments = place.features.iter().enumerate().map(assignment).collect();

    // Derive every feature in every state.
    let assets = recipe.assets();
    let limits = Limits { detail: fineness.detail_m, curve_bands: fineness.curve_bands, ..Limits::default() };
    let derived = derive_features(recipe, spec, &place, (&assigned, &touched), &assets, (&limits, checks), progress);

    // Lay the ground under them and put everything together.
    progress.begin("scene", None);
    let layers = ground_layers(&derived.features);
    let sites = place.greenery.as_ref().map(|_| vegetation::sites(&place.features, &derived.features));
    let area = Polygon { outer: place.area.clone(), holes: Vec::new() };
    let ground = build_ground(&area, &place.terrain, fineness.terrain_tolerance_m, &layers)
        .map_err(|source| PipelineError::Ground { scene: spec.name.clone(), source })?;
    let changed = change_records(recipe, &derived.features, &drawn);
    let mut scene = assemble(derived.features, &ground);
    let textures = textures::load(&mut scene, &assets)?;
    let mut files = textures.files;
    files.extend(asset_files(&assets).map_err(|e| OutputError::new(&recipe.path, e))?);
    let Place { frame, terrain, mut ledger, features, greenery, .. } = place;
    if let (Some(greenery), Some(sites)) = (&greenery, &sites) {
        vegetation::plant(&mut scene, greenery, sites, &terrain, spec.seed, &mut ledger);
    }
    ledger.revise(features.iter().map(|f| f.id.to_string()).zip(derived.outcomes));
    ledger.merge(derived.ledger);
    if ground.without_height > 0 {
        let what = "elevation: ground triangles outside the files, left open";
        *ledger.assumptions.entry(what.to_owned()).or_default() += ground.without_height;
    }
    for missing in textures.missing {
        ledger.record(format!("texture {missing}"), Outcome::FellBack("drawn without texture".to_owned()));
    }
    let validation = (checks == Checks::All).then(|| {
        let features = derived.checked.into_iter().map(|(feature, bodies)| FeatureChecks::new(feature, bodies));
        Validation { scene: spec.name.clone(), features: features.collect() }
    });
    if let Some(validation) = &validation {
        ledger.revise(validation.features.iter().map(|f| (f.feature.clone(), f.outcome())));
    }
    let reports = SceneReports { scene: spec.name.clone(), features: derived.reports };
    let record = record(
        &scene,
        spec.name.clone(),
        spec.seed,
        &frame,
        (fineness, ground.worst_error_m),
        changed,
        &reports,
        ledger,
        features.len(),
    );
    progress.end(&format!("{} triangles", record.triangles));
    let (diagnostics, prints) = (derived.diagnostics, derived.prints);
    Ok(BuiltScene { scene, frame, terrain, record, reports, assignments, validation, files, diagnostics, prints })
}

#[expect(clippy::too_many_arguments, reason = "the fields of one record")]
fn record(
    scene: &Scene,
    name: String,
    seed: u64,
    frame: &LocalFrame,
    (fineness, terrain_error_m): (Fineness, f64),
    changes: Vec<ChangeRecord>,
    reports: &SceneReports,
    ledger: Ledger,
    features: usize,
) -> SceneRecord {
    let (lon, lat) = frame.centre();
    SceneRecord {
        name,
        seed,
        origin: [lon, lat],
        geometry_sha256: geometry_hash(scene),
        features,
        triangles: scene.objects.iter().map(|o| o.mesh.triangles.len()).sum(),
        terrain_error_m,
        detail_m: fineness.detail_m,
        changes,
        reports: report_records(&reports.totals()),
        ledger,
    }
}

fn change_records(
    recipe: &Recipe,
    features: &[FeatureParts],
    drawn: &[crate::plan::change::ChangeRecord],
) -> Vec<ChangeRecord> {
    let mut records: Vec<ChangeRecord> = recipe
        .spec
        .changes
        .iter()
        .zip(drawn)
        .map(|(change, drawn)| ChangeRecord {
            name: change.name.clone(),
            non_target: change.non_target,
            candidates: drawn.candidates,
            share: drawn.share,
            changed: Vec::new(),
        })
        .collect();
    for (number, feature) in features.iter().enumerate() {
        let Some(state) = feature.states.iter().find(|s| s.change > 0) else { continue };
        records[state.change as usize - 1].changed.push(ChangedFeature {
            feature: feature.feature.to_string(),
            instance: TERRAIN_INSTANCE + 1 + number as u32,
            level: state.level,
        });
    }
    records
}
