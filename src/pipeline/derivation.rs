//! Features → parts. In: a scene's start shapes. Out: one [`FeatureParts`] per feature that has something to show, the
//! ledger, the reports and the mistakes met while deriving. What the memory has and nothing changed is taken from there.
//! Parallel; order and results do not depend on the number of threads.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::build::Checks;
use super::error::PipelineError;
use super::lot::Lot;
use super::memory::Memory;
use super::memory::questions::Noting;
use super::memory::states::{KeptState, Round, StateKey, States};
use super::neighbours::{derive_some, worlds};
use super::place::Site;
use super::preparation::{Prepared, PreparedScene, PreparedState, State};
use super::progress::Progress;
use super::recipe::Recipe;
use super::validation;
use crate::diagnostics::{Diagnostics, Severity};
use crate::geodata::ledger::Outcome;
use crate::geodata::terrain::Terrain;
use crate::geometry::mesh_checks::Bodies;
use crate::interpreter::context::Member;
use crate::interpreter::limits::ENDLESS;
use crate::interpreter::reports::Report;
use crate::interpreter::tree::ShapeTree;
use crate::interpreter::{FileAssets, Limits};
use crate::scene::assemble::{FeatureParts, StateParts};
use crate::scene::parts::Parts;

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

/// A build that keeps things for the next one is given up once so many derivations met a limit: rules that never end
/// would take minutes on a whole town, and whoever edits them waits.
const MOST_ENDLESS: usize = 8;

/// What derivation gives.
pub struct Derivation {
    pub features: Vec<FeatureParts>,
    /// What became of each feature, in the order of the features.
    pub outcomes: Vec<Outcome>,
    /// By feature, without those that reported nothing, in the order of the features.
    pub reports: Vec<(String, Vec<Report>)>,
    /// By feature with geometry, in the order of the features; empty where no checks are asked for.
    pub checked: Vec<(String, Bodies)>,
    pub diagnostics: Diagnostics,
    /// Lines of `print`, in the order of the features.
    pub prints: Vec<String>,
}

/// What one state of a feature gives.
pub struct Derived {
    pub parts: Arc<Parts>,
    pub checked: Option<Bodies>,
    pub reports: Vec<Report>,
    pub diagnostics: Diagnostics,
    pub prints: Vec<String>,
}

/// A state that the scene has.
struct Wanted<'a> {
    /// Number of its feature.
    feature: usize,
    key: StateKey,
    state: &'a PreparedState,
    lot: &'a Arc<Lot>,
}

/// Derives all features of a scene in all their states, as far as the memory does not have them.
pub(super) fn derive_features(
    recipe: &Recipe,
    (prepared, site): (&PreparedScene, &Site),
    assets: &FileAssets,
    (limits, checks): (&Limits, Checks),
    memory: &mut Memory,
    progress: &dyn Progress,
) -> Result<Derivation, PipelineError> {
    let features = &site.place.features;
    let (mut members, mut wanted) = (Vec::new(), Vec::new());
    for (number, feature) in prepared.features.iter().enumerate() {
        for state in &feature.states {
            let (is_in, sees) = worlds(state.state.presence);
            let program = recipe.programs.with_key(&state.program);
            members.push(Member { program, start: state.start.clone(), is_in, sees });
            let lot = feature.lot.as_ref().expect("a feature with states has a lot");
            wanted.push(Wanted { feature: number, key: (features[number].id, state.state.presence), state, lot });
        }
    }
    let each =
        |number: usize, tree: ShapeTree| Arc::new(derived(tree, wanted[number].lot, &site.place.terrain, checks));
    let made = if memory.keeps {
        let round = memory.states.begin(&recipe.programs, limits, checks);
        let valid = valid(&members, &wanted, &memory.states, &round);
        let kept = completed(&members, &wanted, valid, (assets, limits), memory, progress, &each)?;
        let made = kept.iter().map(|state| state.derived.clone()).collect();
        let keys = wanted.iter().map(|wanted| wanted.key);
        memory.states.finish(keys.zip(kept).collect(), round, assets, &mut memory.files);
        made
    } else {
        progress.begin("derive", Some(members.len() as u64));
        let all: Vec<usize> = (0..members.len()).collect();
        derive_some(&members, &all, assets, limits, |number, derive| {
            let made = each(number, derive(assets));
            progress.step(1);
            made
        })
    };
    let out = gathered(prepared, site, &wanted, made);
    let triangles: usize = out.features.iter().flat_map(|f| &f.states).map(|s| s.parts.solid.triangles.len()).sum();
    progress.end(&format!("{} features, {triangles} triangles", out.features.len()));
    Ok(out)
}

/// The derivations that are still valid. Programs that ask about other shapes are derived again unless nothing changed
/// at all.
fn valid(members: &[Member], wanted: &[Wanted], states: &States, round: &Round) -> Vec<Option<KeptState>> {
    let asks = |number: usize| members[number].program.needs().asks();
    let one =
        |(number, wanted): (usize, &Wanted)| states.valid(&wanted.key, wanted.state, wanted.lot, asks(number), round);
    let mut valid: Vec<Option<KeptState>> = wanted.par_iter().enumerate().map(one).collect();
    let quiet = states.len() == wanted.len() && !states.has_new_answers() && valid.iter().all(Option::is_some);
    if !quiet {
        (0..valid.len()).filter(|&number| asks(number)).for_each(|number| valid[number] = None);
    }
    valid
}

/// Derives what is not valid.
fn completed(
    members: &[Member],
    wanted: &[Wanted],
    mut valid: Vec<Option<KeptState>>,
    (assets, limits): (&FileAssets, &Limits),
    memory: &mut Memory,
    progress: &dyn Progress,
    each: &(dyn Fn(usize, ShapeTree) -> Arc<Derived> + Sync),
) -> Result<Vec<KeptState>, PipelineError> {
    let missing: Vec<usize> = (0..valid.len()).filter(|&number| valid[number].is_none()).collect();
    progress.begin("derive", Some(missing.len() as u64));
    let endless = AtomicUsize::new(0);
    let questions = &memory.states.questions;
    let made = derive_some(members, &missing, assets, limits, |number, derive| {
        if progress.is_stopped() || endless.load(Ordering::Relaxed) >= MOST_ENDLESS {
            return None;
        }
        let (noting, start) = (Noting::new(assets, questions), Instant::now());
        let mut tree = derive(&noting);
        let used = std::mem::take(&mut tree.used);
        let seconds = start.elapsed().as_secs_f64();
        let is_endless = tree.diagnostics.iter().any(|d| d.severity == Severity::Error && ENDLESS.contains(&d.code));
        endless.fetch_add(usize::from(is_endless), Ordering::Relaxed);
        let derived = each(number, tree);
        progress.step(1);
        let Wanted { state: PreparedState { state, program, start }, lot, .. } = wanted[number];
        let (state, start, lot, program, asked) = (*state, start.clone(), lot.clone(), program.clone(), noting.asked());
        Some(KeptState { state, start, lot, program, derived, asked, used, seconds })
    });
    if progress.is_stopped() {
        return Err(PipelineError::Stopped);
    }
    if endless.into_inner() >= MOST_ENDLESS {
        let mut all = Diagnostics::default();
        made.into_iter().flatten().for_each(|state| all.extend(state.derived.diagnostics.clone()));
        return Err(PipelineError::Endless(all.sorted()));
    }
    memory.note_derived(missing.len(), valid.len() - missing.len());
    for (number, state) in missing.into_iter().zip(made) {
        valid[number] = state;
    }
    Ok(valid.into_iter().map(|state| state.expect("what was not valid was derived")).collect())
}

/// Puts the features together.
fn gathered(prepared: &PreparedScene, site: &Site, wanted: &[Wanted], made: Vec<Arc<Derived>>) -> Derivation {
    let mut out = Derivation {
        features: Vec::new(),
        outcomes: Vec::new(),
        reports: Vec::new(),
        checked: Vec::new(),
        diagnostics: Diagnostics::default(),
        prints: Vec::new(),
    };
    let mut derived = wanted.iter().zip(made).peekable();
    for (number, (feature, prepared)) in site.place.features.iter().zip(&prepared.features).enumerate() {
        let own = std::iter::from_fn(|| derived.next_if(|(wanted, _)| wanted.feature == number));
        let share = share(prepared, own.map(|(wanted, derived)| (wanted.state.state, derived)));
        out.outcomes.push(share.outcome);
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
    out.diagnostics = out.diagnostics.sorted();
    out
}

fn derived(tree: ShapeTree, lot: &Lot, terrain: &Terrain, checks: Checks) -> Derived {
    let failed = tree.diagnostics.iter().any(|d| d.severity == Severity::Error);
    let parts = if failed { Parts::default() } else { lot.parts(&tree.leaves, terrain) };
    let checked =
        (checks == Checks::All && !failed && !tree.leaves.is_empty()).then(|| validation::check(&tree.leaves));
    let ShapeTree { leaves: _, diagnostics, prints, reports, used: _ } = tree;
    Derived { parts: parts.into(), checked, reports, diagnostics, prints }
}

/// One feature's share of the scene.
struct Share {
    outcome: Outcome,
    states: Vec<StateParts>,
    reports: Vec<Report>,
    checked: Option<Bodies>,
    diagnostics: Diagnostics,
    prints: Vec<String>,
}

/// Puts the states of a feature together. A feature fails as a whole.
fn share(prepared: &Prepared, states: impl Iterator<Item = (State, Arc<Derived>)>) -> Share {
    let mut out = Share {
        outcome: prepared.outcome.clone(),
        states: Vec::new(),
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
            out.diagnostics.extend(derived.diagnostics.clone());
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
        if let Some(bodies) = &derived.checked {
            out.checked.get_or_insert_default().add(bodies.clone());
        }
        if state.counts {
            out.reports = derived.reports.clone();
        }
        out.diagnostics.extend(derived.diagnostics.clone());
        out.prints.extend(derived.prints.iter().cloned());
        let State { presence, change, level, counts: _ } = state;
        // A cold build has the only reference: the scene then takes the mesh itself.
        let parts = Arc::try_unwrap(derived).map_or_else(|kept| kept.parts.clone(), |derived| derived.parts);
        out.states.push(StateParts { presence, change, level, parts });
    }
    out
}
