//! What every rule costs. In: a recipe. Out: calls, leaves and time per rule of one derivation of a scene, watched.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::build::Fineness;
use super::error::PipelineError;
use super::memory::Memory;
use super::place::site;
use super::preparation::prepare;
use super::progress::Silent;
use super::recipe::Recipe;
use crate::cga::program::RuleId;
use crate::interpreter::watch::RuleCost;
use crate::interpreter::{Limits, derive_watched};

/// One rule of one program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleTotal {
    /// Key of the program ([`super::rules::Programs`]).
    pub program: Arc<str>,
    pub rule: RuleId,
    pub cost: RuleCost,
}

/// Derives all features of a scene in all their states, each alone; rules that never ran are left out.
pub fn rule_totals(recipe: &Recipe, index: usize) -> Result<Vec<RuleTotal>, PipelineError> {
    let mut memory = Memory::default();
    let scene = &recipe.spec.scenes[index];
    let site = site(recipe, scene, &mut memory, &Silent)?;
    let prepared = prepare(recipe, scene, &site, &mut memory);
    let fineness = Fineness::of(recipe, index);
    let limits = Limits { detail: fineness.detail_m, curve_bands: fineness.curve_bands, ..Limits::default() };
    let assets = recipe.assets();
    let states: Vec<_> = prepared.features.iter().flat_map(|feature| &feature.states).collect();
    let watched = |state: &&super::preparation::PreparedState| {
        let program = recipe.programs.with_key(&state.program);
        derive_watched(program, &state.start, &assets, &limits, None).1.costs
    };
    let costs: Vec<BTreeMap<RuleId, RuleCost>> = states.par_iter().map(watched).collect();
    let mut totals: BTreeMap<(Arc<str>, RuleId), RuleCost> = BTreeMap::new();
    for (state, costs) in states.iter().zip(costs) {
        for (rule, cost) in costs {
            totals.entry((state.program.clone(), rule)).or_default().add(cost);
        }
    }
    Ok(totals.into_iter().map(|((program, rule), cost)| RuleTotal { program, rule, cost }).collect())
}
