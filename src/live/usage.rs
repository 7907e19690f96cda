//! What every rule cost. In: a recipe. Out: calls, leaves and time per rule of one derivation of a scene.

use std::sync::Arc;

use serde::Serialize;

use crate::pipeline::{PipelineError, Recipe};
use crate::source::Span;

/// One rule in the derivation of all features in all states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RuleUsage {
    /// With import prefixes.
    pub rule: Arc<str>,
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

/// Derives a scene of a recipe, watched; rules in the order of the sources, those without calls included.
pub fn usage(recipe: &Recipe, scene: usize) -> Result<Vec<RuleUsage>, PipelineError>;
