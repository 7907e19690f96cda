//! Notes of a derivation that is watched. In: steps, rules and leaves as they come. Out: where each leaf comes from, and
//! what each rule cost.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use super::steps::{StepId, Steps};
use crate::cga::program::RuleId;
use crate::source::Span;

/// What was noted.
#[derive(Debug, Default)]
pub struct Watch {
    /// One for each leaf of the tree, in its order.
    pub origins: Vec<Origin>,
    pub costs: BTreeMap<RuleId, RuleCost>,
    /// By step: the place of the symbol that made it, and its parent.
    steps: BTreeMap<StepId, (Span, StepId)>,
    /// The rule that ran at a step.
    rules: BTreeMap<StepId, RuleId>,
}

/// Where a leaf comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// From the start rule to the leaf's own name.
    pub rules: Vec<Arc<str>>,
    /// Place of the symbol that made it; `None` where the start rule itself is the leaf.
    pub span: Option<Span>,
}

/// What the calls of one rule came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RuleCost {
    pub calls: u64,
    /// Leaves that its body made.
    pub leaves: u64,
    /// Without the rules that it calls; with those of its blocks (`inline`, `modify`, booleans).
    pub time: Duration,
}

impl RuleCost {
    pub fn add(&mut self, other: RuleCost) {
        self.calls += other.calls;
        self.leaves += other.leaves;
        self.time += other.time;
    }
}

impl Watch {
    pub(super) fn step(&mut self, step: StepId, parent: StepId, span: Span) {
        self.steps.insert(step, (span, parent));
    }

    pub(super) fn rule(&mut self, rule: RuleId, step: StepId, time: Duration) {
        self.rules.insert(step, rule);
        self.costs.entry(rule).or_default().add(RuleCost { calls: 1, leaves: 0, time });
    }

    pub(super) fn leaves(&mut self, steps: &Steps, step: StepId, count: usize) {
        let made = self.steps.get(&step).copied();
        let origin = Origin { rules: steps.names(step), span: made.map(|(span, _)| span) };
        self.origins.extend(std::iter::repeat_n(origin, count));
        if let Some(rule) = made.and_then(|(_, parent)| self.rules.get(&parent)) {
            self.costs.entry(*rule).or_default().leaves += count as u64;
        }
    }
}
