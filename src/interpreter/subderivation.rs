//! Rules derived inside a rule (reference 4.16): `inline`, `union`, `subtract`, `intersect`, `modify`. In: a block and
//! the current shape. Out: the shapes its derivation ends in, merged to one that takes the current shape's place.
//!
//! What a block makes is no part of the tree of shapes. Its random numbers come from the current shape's seed and the
//! block's place, so operands do not change each other's draws (reference 4.16.3). Reports and prints count.

use super::derivation::{Derivation, Symbol, Task};
use super::environment::Env;
use super::limits::Outcome;
use super::merging::{Dressed, appended, take_common_attributes};
use super::operations::comp;
use super::seed::Seed;
use super::shape::Shape;
use super::solids;
use super::successor::Body;
use crate::cga::program::{BooleanOperator, InlineMode, Item, Successor};
use crate::geometry::solid::Operator;
use crate::source::Span;

/// Kinds of seeds below a shape's, for the first and the second block of an item.
const BLOCK: [u64; 2] = [5 << 40, 6 << 40];

impl<'p> Derivation<'p> {
    /// Runs an item that derives a block completely and works on with the result.
    pub fn execute_inside(
        &mut self,
        item: &'p Item,
        place: u64,
        shape: &mut Shape,
        body: &mut Body<'p>,
    ) -> Outcome<()> {
        let seeds = BLOCK.map(|kind| shape.seed.part(kind + place));
        let span = match item {
            Item::Inline { mode: InlineMode::Recompose, body: block, span } => {
                let outer = self.begin_recomposition(shape);
                let pieces = self.derive_block(block, shape, seeds[0], body, *span)?;
                self.finish_recomposition(outer, pieces, shape);
                *span
            }
            Item::Modify { component, keep_axes, selectors, span } => {
                let outer = self.begin_recomposition(shape);
                let env = Env::new(shape, &body.slots, place);
                let (mut pieces, rest) = comp::pieces_and_rest(self, *component, *keep_axes, selectors, *span, &env)?;
                self.trace_pieces(item, shape, &mut pieces);
                self.enter_block(*span)?;
                let tasks = self.execute_pieces_apart(pieces, seeds[0], body)?;
                let mut leaves = self.finish_tasks(tasks, *span)?;
                self.leave_block();
                leaves.push(self.part(shape, &rest));
                self.finish_recomposition(outer, leaves, shape);
                *span
            }
            Item::Inline { mode, body: block, span } => {
                let pieces = self.derive_block(block, shape, seeds[0], body, *span)?;
                self.inline(*mode, pieces, shape, *span);
                *span
            }
            Item::Boolean { operator, left, right, span } => {
                let left = self.derive_block(left, shape, seeds[0], body, *span)?;
                let right = self.derive_block(right, shape, seeds[1], body, *span)?;
                self.boolean(*operator, left, right, shape, *span);
                *span
            }
            _ => return Ok(()),
        };
        self.count_vertices(shape.form.mesh.positions.len(), span)
    }

    fn inline(&mut self, mode: InlineMode, mut pieces: Vec<Shape>, shape: &mut Shape, span: Span) {
        if pieces.len() == 1 && mode != InlineMode::Unify {
            let (seed, seedian) = (shape.seed, shape.state.seedian);
            *shape = pieces.remove(0);
            shape.seed = seed;
            if shape.state.seedian != seedian {
                shape.state_mut().seedian = seedian;
            }
            return;
        }
        shape.provenance = None;
        let merged = merged(shape, &pieces);
        let merged = if mode == InlineMode::Unify { solids::unified(self, merged, span) } else { merged };
        take_common_attributes(shape, &pieces);
        shape.state_mut().appearance = merged.appearance;
        shape.replace(std::sync::Arc::unwrap_or_clone(merged.form));
    }

    fn boolean(
        &mut self,
        operator: BooleanOperator,
        left: Vec<Shape>,
        right: Vec<Shape>,
        shape: &mut Shape,
        span: Span,
    ) {
        shape.provenance = None;
        let a = solids::unified(self, merged(shape, &left), span);
        let b = solids::unified(self, merged(shape, &right), span);
        let operator = match operator {
            BooleanOperator::Union => Operator::Union,
            BooleanOperator::Subtract => Operator::Subtract,
            BooleanOperator::Intersect => Operator::Intersect,
        };
        let result = solids::combined(self, &a, &b, operator, span);
        take_common_attributes(shape, &left);
        shape.state_mut().appearance = result.appearance;
        shape.replace(std::sync::Arc::unwrap_or_clone(result.form));
    }

    /// Runs a block on a copy of the shape until only leaves are left; leaves without geometry are dropped.
    pub fn derive_block(
        &mut self,
        block: &'p Successor,
        shape: &Shape,
        seed: Seed,
        body: &mut Body<'p>,
        span: Span,
    ) -> Outcome<Vec<Shape>> {
        self.enter_block(span)?;
        let mut copy = Box::new(shape.clone());
        copy.seed = seed;
        self.begin_trail(&mut copy);
        let tasks = self.execute_apart(block, copy, body)?;
        let leaves = self.finish_tasks(tasks, span)?;
        self.leave_block();
        Ok(leaves)
    }

    /// Derives tasks until only leaves are left.
    pub fn finish_tasks(&mut self, mut pending: Vec<Task<'p>>, span: Span) -> Outcome<Vec<Shape>> {
        let running = self.running;
        let mut leaves = Vec::new();
        pending.reverse();
        while let Some(mut task) = pending.pop() {
            match task.symbol {
                Symbol::Leaf(_) => {
                    task.shape.bake();
                    if !task.shape.form.is_empty() {
                        leaves.push(*task.shape);
                    }
                }
                Symbol::Rule(rule) => {
                    self.running = Some(task.step);
                    let children = self.derive_rule(rule, task, Vec::new())?;
                    pending.extend(children.into_iter().rev());
                    self.check_waiting(pending.len(), span)?;
                }
            }
        }
        self.running = running;
        Ok(leaves)
    }
}

/// All pieces behind each other; without pieces nothing, shown as the shape is.
fn merged(shape: &Shape, pieces: &[Shape]) -> Dressed {
    if pieces.is_empty() {
        return Dressed::empty(shape);
    }
    let dressed = |p: &Shape| Dressed { form: p.form.clone(), appearance: p.state.appearance.clone() };
    appended(&pieces.iter().map(dressed).collect::<Vec<_>>())
}
