//! Recomposition while rules run (reference 4.2, 4.16.5). In: the running derivation and the shapes it works on. Out:
//! sources kept beside their vertices, and the shape put together again.

use std::sync::Arc;

use super::derivation::Derivation;
use super::form::Form;
use super::merging::take_common_attributes;
use super::operations::Pieces;
use super::provenance::{NONE, Sources};
use super::recompose::recompose;
use super::shape::Shape;
use crate::cga::builtins::Operation;
use crate::cga::program::{Item, SplitKind};

/// What to go back to when a shape is put together.
pub struct Outer {
    sources: Option<Sources>,
    provenance: Option<Arc<[u32]>>,
}

impl<'p> Derivation<'p> {
    /// Makes every vertex of the shape a source.
    pub fn begin_recomposition(&mut self, shape: &mut Shape) -> Outer {
        shape.bake();
        let provenance = shape.provenance.replace((0..shape.form.mesh.positions.len() as u32).collect());
        Outer { sources: self.sources.replace(Sources::of(&shape.form)), provenance }
    }

    /// Puts the shape together from what its parts have become. A stopped derivation does not get here.
    pub fn finish_recomposition(&mut self, outer: Outer, mut pieces: Vec<Shape>, shape: &mut Shape) {
        let Some(mut sources) = std::mem::replace(&mut self.sources, outer.sources) else { return };
        pieces.iter_mut().chain(&mut sources.discarded).for_each(|piece| {
            piece.bake();
        });
        let made = recompose(&sources, &pieces);
        take_common_attributes(shape, &pieces);
        shape.state_mut().appearance = made.dressed.appearance;
        shape.replace(Arc::unwrap_or_clone(made.dressed.form));
        // What the vertices are to the shape around this one.
        let outer_source = |old: &Arc<[u32]>, source: u32| old.get(source as usize).copied().unwrap_or(NONE);
        shape.provenance =
            outer.provenance.map(|old| made.sources.iter().map(|&source| outer_source(&old, source)).collect());
    }

    /// The faces of a shape with these numbers, as they are.
    pub fn part(&mut self, shape: &Shape, faces: &[usize]) -> Shape {
        let mut part = shape.clone();
        part.form = Arc::new(shape.form.part(faces));
        self.trace(shape, &mut part);
        part
    }

    fn trace(&mut self, before: &Shape, after: &mut Shape) {
        let (Some(sources), Some(own)) = (&mut self.sources, &before.provenance) else { return };
        after.bake();
        after.provenance = Some(sources.carried(&before.world_form(), own, &after.form));
    }

    /// Passes sources on to the pieces of a component or scope split; other pieces have none (reference 4.16.5).
    pub fn trace_pieces(&mut self, item: &Item, shape: &Shape, pieces: &mut Pieces<'p>) {
        if self.sources.is_none() || shape.provenance.is_none() {
            return;
        }
        let traces = match item {
            Item::Comp { .. } | Item::Modify { .. } => true,
            Item::Split { kind, .. } => !matches!(kind, SplitKind::Area { .. }),
            _ => false,
        };
        for (piece, _) in pieces {
            piece.provenance = None;
            if traces {
                self.trace(shape, piece);
            }
        }
    }

    /// The form in world positions before an operation, where it matters.
    pub fn before_edit(&self, shape: &Shape) -> Option<(Arc<Form>, Shape)> {
        let matters = self.sources.is_some() && shape.provenance.is_some();
        matters.then(|| (shape.form.clone(), shape.clone()))
    }

    /// Passes sources on to the result of an operation.
    pub fn after_edit(&mut self, before: Option<(Arc<Form>, Shape)>, operation: Operation, shape: &mut Shape) {
        let Some((form, before)) = before else { return };
        if Arc::ptr_eq(&form, &shape.form) || operation == Operation::Mirror {
            return;
        }
        let replaced = operation.inserts() || matches!(operation, Operation::Envelope | Operation::ResetGeometry);
        shape.provenance = None;
        if !replaced {
            self.trace(&before, shape);
        }
    }

    /// NIL: the shape's vertices still move.
    pub fn note_discarded(&mut self, shape: &Shape) {
        if let Some(sources) = self.sources.as_mut().filter(|_| shape.provenance.is_some()) {
            sources.discarded.push(shape.clone());
        }
    }
}
