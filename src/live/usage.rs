//! What every rule cost. In: a recipe. Out: calls, leaves and time per rule of one derivation of a scene.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;

use crate::interpreter::watch::RuleCost;
use crate::pipeline::{PipelineError, Recipe, RuleTotal, rule_totals};
use crate::source::Span;

/// One rule in the derivation of all features in all states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RuleUsage {
    /// With import prefixes.
    pub rule: String,
    /// Its name where it is declared, in the run's [`SourceMap`](crate::source::SourceMap).
    #[serde(skip)]
    pub span: Span,
    /// Shapes that it rewrote.
    pub calls: u64,
    /// Leaves that its body made.
    pub leaves: u64,
    /// Its own time, without the rules it calls, on one thread.
    pub milliseconds: f64,
}

/// Derives a scene of a recipe, each feature alone and watched. In the order of the sources; rules without calls are there
/// with zeros.
pub fn usage(recipe: &Recipe, scene: usize) -> Result<Vec<RuleUsage>, PipelineError> {
    let mut costs: BTreeMap<Span, (Arc<str>, RuleCost)> = BTreeMap::new();
    for program in recipe.programs.all() {
        for rule in program.rules() {
            costs.entry(rule.span).or_insert_with(|| (rule.name.clone(), RuleCost::default()));
        }
    }
    for RuleTotal { program, rule, cost } in rule_totals(recipe, scene)? {
        let rule = recipe.programs.with_key(&program).rule(rule);
        costs.entry(rule.span).or_insert_with(|| (rule.name.clone(), RuleCost::default())).1.add(cost);
    }
    let usage = |(span, (rule, cost)): (Span, (Arc<str>, RuleCost))| {
        let RuleCost { calls, leaves, time } = cost;
        RuleUsage { rule: rule.to_string(), span, calls, leaves, milliseconds: 1e3 * time.as_secs_f64() }
    };
    Ok(costs.into_iter().map(usage).collect())
}
