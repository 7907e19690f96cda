//! One scene of a recipe, from files to meshes with labels.

use std::sync::Arc;

use super::derivation::{Derivation, derive_features};
use super::error::PipelineError;
use super::memory::Memory;
use super::place::{Place, Site, site};
use super::preparation::{Assignment, PreparedScene, prepare};
use super::progress::Progress;
use super::recipe::Recipe;
use super::record::{asset_files, geometry_hash, report_records};
use super::textures;
use super::validation::{FeatureChecks, Validation};
use super::vegetation;
use crate::dataset::manifest::{ChangeRecord, ChangedFeature, InputFile, SceneRecord};
use crate::dataset::reports::SceneReports;
use crate::diagnostics::Diagnostics;
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::projection::LocalFrame;
use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;
use crate::geometry::roof::CURVE_BANDS;
use crate::interpreter::{FileAssets, Limits};
use crate::output::OutputError;
use crate::scene::Scene;
use crate::scene::assemble::{FeatureParts, TERRAIN_INSTANCE, assemble, ground_layers};
use crate::scene::ground::GroundMesh;
use crate::spec::render_spec::{DatasetSpec, SceneSpec};

/// Greatest vertical distance allowed between the ground mesh and the elevation data, metres.
pub const TERRAIN_TOLERANCE_M: f64 = 0.5;

/// A scene with everything that is known about how it came to be.
pub struct BuiltScene {
    pub scene: Scene,
    pub frame: LocalFrame,
    pub terrain: Arc<Terrain>,
    pub record: SceneRecord,
    pub reports: SceneReports,
    /// Of every feature, in the order of their ids.
    pub assignments: Vec<Assignment>,
    /// Only where mesh checks were asked for.
    pub validation: Option<Validation>,
    /// Textures and geometry files that rules named; with a memory those that were read since any of them changed.
    pub files: Vec<InputFile>,
    /// Mistakes met while deriving.
    pub diagnostics: Diagnostics,
    pub prints: Vec<String>,
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
    Ok(alone(rebuild_scene(recipe, index, checks, &mut Memory::default(), progress)?))
}

/// A scene that no memory keeps.
fn alone(built: Arc<BuiltScene>) -> BuiltScene {
    Arc::into_inner(built).expect("a memory that keeps nothing has no reference")
}

/// As [`build_scene`], with what the memory still has of the builds before of the same scene; the same `Arc` as before
/// where nothing changed.
pub fn rebuild_scene(
    recipe: &Recipe,
    index: usize,
    checks: Checks,
    memory: &mut Memory,
    progress: &dyn Progress,
) -> Result<Arc<BuiltScene>, PipelineError> {
    memory.begin();
    let built = rebuild(recipe, index, checks, memory, progress);
    memory.end();
    built
}

fn rebuild(
    recipe: &Recipe,
    index: usize,
    checks: Checks,
    memory: &mut Memory,
    progress: &dyn Progress,
) -> Result<Arc<BuiltScene>, PipelineError> {
    let usual = Fineness::of(recipe, index);
    let Some(promised_m) = height_budget(recipe, index) else {
        return build(recipe, index, usual, checks, memory, progress);
    };
    let built = within_height(promised_m, |terrain_tolerance_m| {
        let built = build(recipe, index, Fineness { terrain_tolerance_m, ..usual }, checks, memory, progress)?;
        let error_m = built.record.terrain_error_m;
        Ok::<_, PipelineError>((built, error_m))
    })?;
    let name = || recipe.spec.scenes[index].name.clone();
    built.map_err(|best_m| PipelineError::HeightBudget { scene: name(), promised_m, best_m })
}

/// The first of what `build` makes of ever finer tolerances whose error keeps a promise, metres, or else the least error.
/// The tolerance is aimed at; along borders that are split later a finer one may be needed to keep it.
fn within_height<T, E>(
    promised_m: f64,
    mut build: impl FnMut(f64) -> Result<(T, f64), E>,
) -> Result<Result<T, f64>, E> {
    let mut best_m = f64::INFINITY;
    for share in [1.0, 0.5, 0.25, 0.125] {
        let (built, error_m) = build(promised_m * share)?;
        if error_m <= promised_m {
            return Ok(Ok(built));
        }
        best_m = best_m.min(error_m);
    }
    Ok(Err(best_m))
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
    Ok(alone(build(recipe, index, fineness, checks, &mut Memory::default(), progress)?))
}

fn build(
    recipe: &Recipe,
    index: usize,
    fineness: Fineness,
    checks: Checks,
    memory: &mut Memory,
    progress: &dyn Progress,
) -> Result<Arc<BuiltScene>, PipelineError> {
    let spec = &recipe.spec.scenes[index];

    // Read the map and the elevation, and draw what changes.
    let site = memory.timed("place", |memory| site(recipe, spec, memory, progress))?;
    let prepared = memory.timed("prepare", |memory| prepare(recipe, spec, &site, memory));

    // Derive every feature in every state.
    let assets = memory.assets(recipe);
    if let Some(built) = memory.settled(recipe, fineness, &prepared, &assets) {
        return Ok(built);
    }
    let limits = Limits { detail: fineness.detail_m, curve_bands: fineness.curve_bands, ..Limits::default() };
    let derived = memory.timed("derive", |memory| {
        derive_features(recipe, (&prepared, &site), &assets, (&limits, checks), memory, progress)
    })?;

    // Lay the ground under them and put everything together.
    progress.begin("scene", None);
    let place = &site.place;
    let layers = ground_layers(&derived.features);
    let area = Polygon { outer: place.area.clone(), holes: Vec::new() };
    let ground = memory
        .timed("ground", |memory| memory.ground(area, &place.terrain, fineness.terrain_tolerance_m, layers))
        .map_err(|source| PipelineError::Ground { scene: spec.name.clone(), source })?;
    if progress.is_stopped() {
        return Err(PipelineError::Stopped);
    }
    if let Some(built) = memory.unchanged(spec, fineness, &prepared, &assets) {
        progress.end(&format!("{} triangles", built.record.triangles));
        return Ok(built);
    }
    let parts = Parts { recipe, spec, site: &site, prepared: &prepared, assets: &assets, ground: &ground };
    let built = Arc::new(memory.timed("assemble", |memory| put_together(parts, derived, (fineness, checks), memory))?);
    progress.end(&format!("{} triangles", built.record.triangles));
    memory.keep_scene(&built, fineness, prepared, assets);
    Ok(built)
}

/// What a scene is put together from, besides its derivations.
struct Parts<'a> {
    recipe: &'a Recipe,
    spec: &'a SceneSpec,
    site: &'a Site,
    prepared: &'a PreparedScene,
    assets: &'a FileAssets,
    ground: &'a Arc<GroundMesh>,
}

fn put_together(
    Parts { recipe, spec, site, prepared, assets, ground }: Parts,
    derived: Derivation,
    (fineness, checks): (Fineness, Checks),
    memory: &mut Memory,
) -> Result<BuiltScene, PipelineError> {
    let Place { frame, terrain, ledger, features, greenery, .. } = &site.place;
    let sites = greenery.as_ref().map(|_| vegetation::sites(features, &derived.features));
    let changed = change_records(recipe, &derived.features, &prepared.drawn);
    let mut scene = assemble(derived.features, ground, &mut memory.meshes);
    let textures = textures::load(&mut scene, assets, &mut memory.textures)?;
    let mut files = textures.files;
    files.extend(asset_files(assets).map_err(|e| OutputError::new(&recipe.path, e))?);
    let mut ledger = ledger.clone();
    if let (Some(greenery), Some(sites)) = (greenery, &sites) {
        vegetation::plant(&mut scene, greenery, sites, terrain, spec.seed, &mut ledger);
    }
    ledger.revise(features.iter().map(|f| f.id.to_string()).zip(derived.outcomes));
    ledger.merge(prepared.ledger.clone());
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
        frame,
        (fineness, ground.worst_error_m),
        changed,
        &reports,
        ledger,
        features.len(),
    );
    let (frame, terrain) = (*frame, terrain.clone());
    let (diagnostics, prints) = (derived.diagnostics, derived.prints);
    let assignments = prepared.assignments.clone();
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

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    #[test]
    fn a_height_is_kept_by_the_coarsest_tolerance_that_does_or_the_least_error_is_named() {
        let mut tried = Vec::new();
        let kept = within_height(0.5, |tolerance| {
            tried.push(tolerance);
            Ok::<_, Infallible>((tolerance, 3.0 * tolerance))
        });
        assert_eq!((kept, tried), (Ok(Ok(0.125)), vec![0.5, 0.25, 0.125]));
        let never = within_height(0.5, |tolerance| Ok::<_, Infallible>(((), 2.0 - tolerance)));
        assert_eq!(never, Ok(Err(1.5)));
        assert_eq!(within_height(0.5, |_| Err::<((), f64), _>("no elevation")), Err("no elevation"));
        let error = PipelineError::HeightBudget { scene: "town".to_owned(), promised_m: 0.5, best_m: 1.5 };
        assert!(error.to_string().contains("1.5"), "{error}");
    }
}
