//! Taking notes during a first derivation. In: shapes as they are made, labelled and taken apart. Out: a [`Survey`].

use std::sync::{Arc, OnceLock};

use super::super::derivation::{Derivation, Task};
use super::super::seed::Seed;
use super::super::shape::Shape;
use super::{ContextShape, Surroundings, Survey};
use crate::cga::builtins::Operation;
use crate::cga::program::{Arg, Item};

/// The shapes a shape was made from: rules' shapes, pushed copies and pieces, newest first.
#[derive(Debug)]
pub struct Trail {
    seed: Seed,
    parent: Option<Arc<Trail>>,
}

impl Trail {
    fn list(trail: Option<&Arc<Trail>>) -> Vec<Seed> {
        let mut list = Vec::new();
        let mut at = trail;
        while let Some(trail) = at {
            list.push(trail.seed);
            at = trail.parent.as_ref();
        }
        list.reverse();
        list
    }
}

/// What a derivation has to do with other shapes; most have nothing.
#[derive(Default)]
pub struct Context<'p> {
    /// Shapes noted so far, in a first derivation.
    notes: Option<Vec<ContextShape>>,
    /// What queries are answered from, in a second one.
    pub surroundings: Option<&'p Surroundings<'p>>,
}

impl<'p> Context<'p> {
    /// For a first derivation.
    pub fn noting() -> Self {
        Context { notes: Some(Vec::new()), surroundings: None }
    }

    /// For a second derivation.
    pub fn among(surroundings: &'p Surroundings<'p>) -> Self {
        Context { notes: None, surroundings: Some(surroundings) }
    }

    pub fn into_survey(self) -> Survey {
        Survey::new(self.notes.unwrap_or_default())
    }

    fn note(&mut self, shape: &Shape, label: Option<Arc<str>>, own: Option<Seed>) {
        let Some(notes) = &mut self.notes else { return };
        let trail = Trail::list(shape.trail.as_ref()).into_iter().chain(own).collect();
        let (scope, form) = (shape.scope, shape.world_form());
        notes.push(ContextShape { label, trail, scope, form, solid: OnceLock::new() });
    }
}

impl Derivation<'_> {
    /// Where a shape stands in the order of descent, once it starts a life of its own. Free without queries.
    pub fn begin_trail(&self, shape: &mut Shape) {
        if self.context.notes.is_some() || self.context.surroundings.is_some() {
            shape.trail = Some(Arc::new(Trail { seed: shape.seed, parent: shape.trail.take() }));
        }
    }

    /// The shapes the current one was made from, then itself.
    pub fn trail(&self, shape: &Shape) -> Vec<Seed> {
        Trail::list(shape.trail.as_ref())
    }

    /// Notes a leaf.
    pub fn note_leaf(&mut self, task: &Task) {
        self.context.note(&task.shape, None, Some(task.shape.seed));
    }

    /// Notes a labelled copy of the current shape.
    pub fn note_label(&mut self, shape: &Shape, label: Arc<str>) {
        self.context.note(shape, Some(label), None);
    }

    /// Notes the current shape before it is taken apart by `comp`, or by `offset` with a word of what to keep.
    pub fn note_before(&mut self, item: &Item, shape: &Shape) {
        if self.context.notes.is_none() {
            return;
        }
        let noted = match item {
            Item::Comp { .. } => true,
            Item::Operation { operation: Operation::Offset, args, .. } => matches!(args[..], [_, Arg::Word(..)]),
            _ => false,
        };
        if noted {
            self.context.note(shape, None, None);
        }
    }
}
