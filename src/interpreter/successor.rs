//! Rule bodies. In: a rule and the shape it rewrites. Out: the shapes it makes, in order.
//!
//! Seeds: a child's comes from the shape it was copied from and the place of its symbol in the sequence, a piece's
//! from the operation's place and the piece's number, a group's from its place. So what one branch draws or makes
//! never moves the draws of another (reference 2.9).

use std::sync::Arc;

use super::choice;
use super::derivation::{Derivation, Symbol, Task};
use super::dynamic_import;
use super::environment::Env;
use super::expression::EvaluatedArgs;
use super::limits::Outcome;
use super::operations::{self, Pieces};
use super::seed::Seed;
use super::shape::{Scope, Shape};
use super::steps::StepId;
use super::value::Value;
use crate::cga::builtins::Attr;
use crate::cga::program::{Expr, Item, RuleId, Sequence, SetTarget, Successor};
use crate::source::Span;

/// A rule while it runs.
pub struct Body<'p> {
    pub slots: Vec<Value>,
    children: Vec<Task<'p>>,
    step: StepId,
    span: Span,
}

/// Kinds of seeds below a shape's.
const CHILD: u64 = 1 << 40;
const PIECES: u64 = 2 << 40;
const GROUP: u64 = 3 << 40;

impl<'p> Derivation<'p> {
    /// Runs a rule on a shape. `children` is an empty list to fill.
    pub fn derive_rule(&mut self, id: RuleId, task: Task<'p>, children: Vec<Task<'p>>) -> Outcome<Vec<Task<'p>>> {
        let rule = self.program.rule(id);
        self.used.rule(id);
        let Task { mut shape, args, step, .. } = task;
        self.begin_trail(&mut shape);
        let mut body = Body { slots: args, children, step, span: rule.span };
        for (i, local) in rule.locals.iter().enumerate() {
            let value = self.eval(local, &Env::new(&shape, &body.slots, GROUP + i as u64))?;
            body.slots.push(value);
        }
        let reference = shape.scope;
        self.execute(&rule.successor, shape, &reference, &mut body)?;
        Ok(body.children)
    }

    /// Runs a successor on a shape that nobody needs afterwards: its last child takes the shape itself.
    fn execute(
        &mut self,
        successor: &'p Successor,
        shape: Box<Shape>,
        reference: &Scope,
        body: &mut Body<'p>,
    ) -> Outcome<()> {
        match successor {
            Successor::Sequence(sequence) => self.execute_sequence(sequence, shape, reference, body),
            Successor::Case { branches, otherwise } => {
                for (condition, branch) in branches {
                    if self.eval_bool(condition, &Env::new(&shape, &body.slots, 0))? {
                        return self.execute(branch, shape, reference, body);
                    }
                }
                self.execute(otherwise, shape, reference, body)
            }
            Successor::Stochastic { branches, otherwise, site } => {
                let chosen = choice::choose(self, branches, *site, &Env::new(&shape, &body.slots, 0))?;
                self.execute(chosen.unwrap_or(otherwise), shape, reference, body)
            }
        }
    }

    fn execute_sequence(
        &mut self,
        sequence: &'p Sequence,
        mut shape: Box<Shape>,
        reference: &Scope,
        body: &mut Body<'p>,
    ) -> Outcome<()> {
        let Some((last, before)) = sequence.items.split_last().filter(|_| !sequence.implicit_leaf) else {
            for (place, item) in sequence.items.iter().enumerate() {
                self.execute_item(item, place as u64 + 1, &mut shape, reference, body)?;
            }
            if sequence.implicit_leaf {
                let name = self.steps.name(body.step);
                let place = sequence.items.len() as u64 + 1;
                self.add_child(Symbol::Leaf(name), Vec::new(), place, shape, body, body.span)?;
            }
            return Ok(());
        };
        for (place, item) in before.iter().enumerate() {
            self.execute_item(item, place as u64 + 1, &mut shape, reference, body)?;
        }
        self.execute_last(last, sequence.items.len() as u64, shape, reference, body)
    }

    /// As [`Derivation::execute_item`], on a shape that nobody needs afterwards.
    fn execute_last(
        &mut self,
        item: &'p Item,
        place: u64,
        mut shape: Box<Shape>,
        reference: &Scope,
        body: &mut Body<'p>,
    ) -> Outcome<()> {
        let (symbol, args, span) = match item {
            Item::Call { rule, args, span } => (Symbol::Rule(*rule), args, span),
            Item::Leaf { symbol, args, span } => (Symbol::Leaf(symbol), args, span),
            Item::Group(inner) => {
                shape.seed = shape.seed.part(GROUP + place);
                self.begin_trail(&mut shape);
                let reference = shape.scope;
                return self.execute(inner, shape, &reference, body);
            }
            other => return self.execute_item(other, place, &mut shape, reference, body),
        };
        let args = self.eval_values(args, place, &shape, body)?;
        self.add_child(symbol, args, place, shape, body, *span)
    }

    fn execute_item(
        &mut self,
        item: &'p Item,
        place: u64,
        shape: &mut Box<Shape>,
        reference: &Scope,
        body: &mut Body<'p>,
    ) -> Outcome<()> {
        self.note_before(item, shape);
        match item {
            Item::Operation { operation, args, span } => {
                let mut list = EvaluatedArgs::new();
                self.eval_args_into(args, &Env::new(shape, &body.slots, place), &mut list)?;
                let before = Arc::as_ptr(&shape.form);
                let edited = self.before_edit(shape);
                operations::apply(self, *operation, &list, *span, shape, reference)?;
                self.after_edit(edited, *operation, shape);
                if !std::ptr::eq(before, Arc::as_ptr(&shape.form)) {
                    self.count_vertices(shape.form.mesh.positions.len(), *span)?;
                }
                Ok(())
            }
            Item::Set { target, value, span } => {
                let value = self.eval(value, &Env::new(shape, &body.slots, place))?;
                self.set(target, value, *span, place, shape, body)
            }
            Item::Call { rule, args, span } => {
                let args = self.eval_values(args, place, shape, body)?;
                self.add_child(Symbol::Rule(*rule), args, place, shape.clone(), body, *span)
            }
            Item::Instantiate { import, overrides, rule, args, span } => {
                let args = self.eval_values(args, place, shape, body)?;
                let env = Env::new(shape, &body.slots, place);
                let given: Outcome<Vec<_>> = overrides.iter().map(|(id, e)| Ok((*id, self.eval(e, &env)?))).collect();
                let mut anew = shape.clone();
                dynamic_import::instantiate(self, *import, given?, &mut anew)?;
                self.add_child(Symbol::Rule(*rule), args, place, anew, body, *span)
            }
            Item::Leaf { symbol, args, span } => {
                let args = self.eval_values(args, place, shape, body)?;
                self.add_child(Symbol::Leaf(symbol), args, place, shape.clone(), body, *span)
            }
            Item::Discard => {
                self.note_discarded(shape);
                Ok(())
            }
            Item::Group(inner) => {
                let mut copy = shape.clone();
                copy.seed = shape.seed.part(GROUP + place);
                self.begin_trail(&mut copy);
                let reference = copy.scope;
                self.execute(inner, copy, &reference, body)
            }
            Item::Inline { .. } | Item::Boolean { .. } | Item::Modify { .. } => {
                self.execute_inside(item, place, shape, body)
            }
            other => {
                let seed = shape.seed.part(PIECES + place);
                let mut pieces = operations::pieces(self, other, &Env::new(shape, &body.slots, place))?;
                self.trace_pieces(other, shape, &mut pieces);
                self.execute_pieces(pieces, seed, body)
            }
        }
    }

    /// Runs the blocks of pieces; what they make is given back, and no child of the running rule.
    pub fn execute_pieces_apart(
        &mut self,
        pieces: Pieces<'p>,
        seed: Seed,
        body: &mut Body<'p>,
    ) -> Outcome<Vec<Task<'p>>> {
        let children = std::mem::take(&mut body.children);
        let done = self.execute_pieces(pieces, seed, body);
        let made = std::mem::replace(&mut body.children, children);
        done.map(|()| made)
    }

    /// Runs a block on a shape; what it makes is given back, and no child of the running rule.
    pub fn execute_apart(
        &mut self,
        block: &'p Successor,
        shape: Box<Shape>,
        body: &mut Body<'p>,
    ) -> Outcome<Vec<Task<'p>>> {
        let children = std::mem::take(&mut body.children);
        let reference = shape.scope;
        let done = self.execute(block, shape, &reference, body);
        let made = std::mem::replace(&mut body.children, children);
        done.map(|()| made)
    }

    /// Runs each piece's block on the piece.
    fn execute_pieces(&mut self, pieces: Pieces<'p>, seed: Seed, body: &mut Body<'p>) -> Outcome<()> {
        body.children.reserve(pieces.len());
        for (number, (mut piece, successor)) in pieces.into_iter().enumerate() {
            piece.seed = seed.part(number as u64);
            self.begin_trail(&mut piece);
            let reference = piece.scope;
            self.count_vertices(piece.form.mesh.positions.len(), body.span)?;
            self.execute(successor, piece, &reference, body)?;
        }
        Ok(())
    }

    fn eval_values(&mut self, args: &'p [Expr], place: u64, shape: &Shape, body: &Body<'p>) -> Outcome<Vec<Value>> {
        if args.is_empty() {
            return Ok(Vec::new());
        }
        let env = Env::new(shape, &body.slots, place);
        args.iter().map(|arg| self.eval(arg, &env)).collect()
    }

    /// Lets the shape itself wait for its symbol.
    fn add_child(
        &mut self,
        symbol: Symbol<'p>,
        args: Vec<Value>,
        place: u64,
        mut shape: Box<Shape>,
        body: &mut Body<'p>,
        span: Span,
    ) -> Outcome<()> {
        self.count_shapes(1, span)?;
        let name = match symbol {
            Symbol::Rule(rule) => &self.program.rule(rule).name,
            Symbol::Leaf(name) => name,
        };
        let step = self.step(body.step, body.children.len() as u32, name, span)?;
        shape.seed = shape.seed.part(CHILD + place);
        if shape.state.seedian.is_some() {
            shape.state_mut().seedian = None;
        }
        body.children.push(Task { shape, symbol, args, step });
        Ok(())
    }

    fn set(
        &mut self,
        target: &'p SetTarget,
        value: Value,
        span: Span,
        place: u64,
        shape: &mut Shape,
        body: &Body<'p>,
    ) -> Outcome<()> {
        let attr = match target {
            SetTarget::Attribute(id) => {
                let kind = self.program.attribute(*id).kind;
                let value = kind.map_or(value.clone(), |kind| value.converted(kind));
                Arc::make_mut(&mut shape.state_mut().attributes)[id.0 as usize] = value;
                return Ok(());
            }
            SetTarget::Builtin(attr) => *attr,
            SetTarget::Computed(name) => {
                let name = self.eval(name, &Env::new(shape, &body.slots, place))?.to_text();
                match self.program.attribute_named(&name) {
                    Some(id) => {
                        Arc::make_mut(&mut shape.state_mut().attributes)[id.0 as usize] = value;
                        return Ok(());
                    }
                    None => match Attr::from_name(&name).filter(|info| info.writable) {
                        Some(info) => info.attr,
                        None => {
                            self.warn("cga::unknown-attribute", span, || {
                                format!("there is no attribute `{name}` to set")
                            });
                            return Ok(());
                        }
                    },
                }
            }
        };
        operations::set(self, attr, value, span, shape);
        Ok(())
    }
}
