//! Features → parts. In: a scene's features with their rules and changes. Out: one [`FeatureParts`] per feature that
//! has something to show, the ledger, the reports and the mistakes met while deriving. Parallel; order and results do not
//! depend on the number of threads.

use rayon::prelude::*;

use super::build::Checks;
use super::lot::Lot;
use super::neighbours::{derive_all, worlds};
use super::place::Place;
use super::preparation::{Preparation, Prepared, State, road_ends};
use super::progress::Progress;
use super::recipe::Recipe;
use super::validation;
use crate::diagnostics::{Diagnostics, Severity};
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::terrain::Terrain;
use crate::geometry::mesh_checks::Bodies;
use crate::interpreter::Limits;
use crate::interpreter::assets::Assets;
use crate::interpreter::context::Member;
use crate::interpreter::reports::Report;
use crate::interpreter::tree::ShapeTree;
use crate::plan::change::Changed;
use crate::scene::assemble::{FeatureParts, StateParts};
use crate::scene::parts::Parts;
use crate::spec::render_spec::SceneSpec;

/// Warnings after which a feature is there in a simpler form than its rules asked for.
const FALLBACKS: &[&str] = &[
    "cga::roof",
    "cga::roof-fallback",
    "cga::roof-shape",
    "cga::offset",
    "cga::setback",
    "cga::inner-rectangle",
    "cga::missing-asset",
    "cga::missing-texture",
];

/// What derivation gives.
pub struct Derivation {
    pub features: Vec<FeatureParts>,
    /// What became of each feature, in the order of the features.
    pub outcomes: Vec<Outcome>,
    /// Assumptions only.
    pub ledger: Ledger,
    /// By feature, without those that reported nothing, in the order of the features.
    pub reports: Vec<(String, Vec<Report>)>,
    /// By feature with geometry, in the order of the features; empty where no checks are asked for.
    pub checked: Vec<(String, Bodies)>,
    pub diagnostics: Diagnostics,
    /// Lines of `print`, in the order of the features.
    pub prints: Vec<String>,
}

/// What one state of a feature gives.
struct Derived {
    parts: Parts,
    checked: Option<Bodies>,
    reports: Vec<Report>,
    diagnostics: Diagnostics,
    prints: Vec<String>,
}

/// Derives all features of a scene in all their states.
pub fn derive_features(
    recipe: &Recipe,
    scene: &SceneSpec,
    place: &Place,
    (assigned, touched): (&[Option<usize>], &[Option<Changed>]),
    assets: &dyn Assets,
    (limits, checks): (&Limits, Checks),
    progress: &dyn Progress,
) -> Derivation {
    let preparation = Preparation::new(recipe, scene, place);
    let mut prepared: Vec<Prepared> = place
        .features
        .par_iter()
        .zip(road_ends(&place.features))
        .zip(assigned.par_iter().zip(touched))
        .map(|((feature, ends), (rule, touched))| preparation.feature(feature, ends, *rule, *touched))
        .collect();

    // One list of all states, each with the number of its feature.
    let (mut states, mut members) = (Vec::new(), Vec::new());
    for (number, feature) in prepared.iter_mut().enumerate() {
        for (state, program, start) in feature.states.drain(..) {
            let (is_in, sees) = worlds(state.presence);
            members.push(Member { program, start, is_in, sees });
            states.push((number, state));
        }
    }
    progress.begin("derive", Some(members.len() as u64));
    let derived = derive_all(&members, assets, limits, |number, tree| {
        let lot = prepared[states[number].0].lot.as_ref().expect("a feature with states has a lot");
        let derived = derived(tree, lot, &place.terrain, checks);
        progress.step(1);
        derived
    });

    let mut out = Derivation {
        features: Vec::new(),
        outcomes: Vec::new(),
        ledger: Ledger::default(),
        reports: Vec::new(),
        checked: Vec::new(),
        diagnostics: Diagnostics::default(),
        prints: Vec::new(),
    };
    let mut derived = states.into_iter().zip(derived).peekable();
    for (number, (feature, prepared)) in place.features.iter().zip(prepared).enumerate() {
        let own = std::iter::from_fn(|| derived.next_if(|((of, _), _)| *of == number)).map(|((_, s), d)| (s, d));
        let share = share(prepared, own);
        out.outcomes.push(share.outcome);
        out.ledger.merge(share.ledger);
        if !share.reports.is_empty() {
            out.reports.push((feature.id.to_string(), share.reports));
        }
        out.checked.extend(share.checked.map(|bodies| (feature.id.to_string(), bodies)));
        out.diagnostics.extend(share.diagnostics);
        out.prints.extend(share.prints);
        if !share.states.is_empty() {
            let class = feature.class.into();
            out.features.push(FeatureParts { feature: feature.id, class, states: share.states });
        }
    }
    let triangles: usize = out.features.iter().flat_map(|f| &f.states).map(|s| s.parts.solid.triangles.len()).sum();
    progress.end(&format!("{} features, {triangles} triangles", out.features.len()));
    out.diagnostics = out.diagnostics.sorted();
    out
}

fn derived(tree: ShapeTree, lot: &Lot, terrain: &Terrain, checks: Checks) -> Derived {
    let failed = tree.diagnostics.iter().any(|d| d.severity == Severity::Error);
    let parts = if failed { Parts::default() } else { lot.parts(&tree.leaves, terrain) };
    let checked =
        (checks == Checks::All && !failed && !tree.leaves.is_empty()).then(|| validation::check(&tree.leaves));
    let ShapeTree { diagnostics, prints, reports, .. } = tree;
    Derived { parts, checked, reports, diagnostics, prints }
}

/// One feature's share of the scene.
struct Share {
    outcome: Outcome,
    states: Vec<StateParts>,
    ledger: Ledger,
    reports: Vec<Report>,
    checked: Option<Bodies>,
    diagnostics: Diagnostics,
    prints: Vec<String>,
}

/// Puts the states of a feature together. A feature fails as a whole.
fn share(prepared: Prepared, states: impl Iterator<Item = (State, Derived)>) -> Share {
    let mut out = Share {
        outcome: prepared.outcome,
        states: Vec::new(),
        ledger: prepared.ledger,
        reports: Vec::new(),
        checked: None,
        diagnostics: Diagnostics::default(),
        prints: Vec::new(),
    };
    for (state, derived) in states {
        let failed = derived.diagnostics.iter().find(|d| d.severity == Severity::Error);
        if matches!(out.outcome, Outcome::Skipped(_)) {
            continue;
        }
        if let Some(why) = failed.map(|d| format!("its rules failed: {}", d.message)) {
            out.outcome = Outcome::Skipped(why);
            out.diagnostics.extend(derived.diagnostics);
            out.states.clear();
            out.reports.clear();
            out.checked = None;
            out.prints.clear();
            continue;
        }
        let simpler = derived.diagnostics.iter().find(|d| FALLBACKS.contains(&d.code));
        if let (Outcome::Ok, Some(simpler)) = (&out.outcome, simpler) {
            out.outcome = Outcome::FellBack(simpler.message.clone());
        }
        if let Some(bodies) = derived.checked {
            out.checked.get_or_insert_default().add(bodies);
        }
        if state.counts {
            out.reports = derived.reports;
        }
        out.diagnostics.extend(derived.diagnostics);
        out.prints.extend(derived.prints);
        let State { presence, change, level, counts: _ } = state;
        out.states.push(StateParts { presence, change, level, parts: derived.parts });
    }
    out
}
