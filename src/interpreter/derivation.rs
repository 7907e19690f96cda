//! One derivation in progress. In: a program, a start shape, assets, limits. Out: the [`ShapeTree`].
//!
//! Rules run from an explicit work list, children before later siblings, so leaves come out depth first in the order
//! of creation. Nothing here recurses on the depth of rules.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Instant;

use super::StartShape;
use super::assets::Assets;
use super::context::{Context, Surroundings, Survey};
use super::leaves::Leaves;
use super::limits::{Limits, Outcome, Stop};
use super::outline::Outline;
use super::palette::Palette;
use super::placement::Frame;
use super::provenance::Sources;
use super::reports::Reports;
use super::shape::{Scope, Shape};
use super::start;
use super::steps::{Path, StepId, Steps};
use super::streets::Streets;
use super::tree::ShapeTree;
use super::used::Used;
use super::value::Value;
use super::watch::Watch;
use crate::cga::program::{Program, RuleId};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

/// Rise of the normal of a face that counts as upright, per metre.
const UPRIGHT: f64 = 0.5;

/// State of one run.
pub struct Derivation<'p> {
    pub program: &'p Program,
    pub start: &'p StartShape,
    pub assets: &'p dyn Assets,
    pub limits: &'p Limits,
    /// The initial shape's frame (reference 3.2).
    pub object: Frame,
    /// The initial shape's edges, where the host has data about them.
    pub outline: Option<Outline>,
    /// What it has to do with other shapes.
    pub context: Context<'p>,
    /// Where the initial shape has streets, as the host or `streetWidth(edge)` says.
    pub streets: Option<Streets>,
    /// Name of the rule the initial shape was derived with.
    pub start_rule: Option<&'p Arc<str>>,
    /// What the derivation began with, before its attributes were known.
    pub initial: Option<Box<Shape>>,
    pub palette: Palette,
    pub leaves: Leaves<'p>,
    pub reports: Reports,
    pub prints: Vec<String>,
    printed: usize,
    diagnostics: Diagnostics,
    warned: BTreeSet<(&'static str, Span)>,
    pending: Vec<Task<'p>>,
    /// An empty list that has held the children of a rule.
    spare: Vec<Task<'p>>,
    shapes: usize,
    vertices: usize,
    expression_depth: u32,
    /// Where in the tree the running rule is, for messages about limits.
    pub running: Option<StepId>,
    /// Blocks within blocks that are being derived completely.
    blocks: u32,
    /// Of the shape that is being recomposed.
    pub sources: Option<Sources>,
    pub steps: Steps<'p>,
    pub used: Used,
    /// What is noted of each leaf and rule; most derivations are not watched.
    pub watch: Option<Box<Watch>>,
}

/// A shape waiting for its rule.
pub struct Task<'p> {
    pub shape: Box<Shape>,
    pub symbol: Symbol<'p>,
    pub args: Vec<Value>,
    pub step: StepId,
}

/// What a shape is called.
#[derive(Clone, Copy, Debug)]
pub enum Symbol<'p> {
    Rule(RuleId),
    /// No rule: a leaf.
    Leaf(&'p Arc<str>),
}

impl<'p> Derivation<'p> {
    pub fn new(program: &'p Program, start: &'p StartShape, assets: &'p dyn Assets, limits: &'p Limits) -> Self {
        Derivation {
            program,
            start,
            assets,
            limits,
            object: Frame::WORLD,
            outline: None,
            context: Context::default(),
            streets: None,
            start_rule: None,
            initial: None,
            palette: Palette::default(),
            leaves: Leaves::default(),
            reports: Reports::default(),
            prints: Vec::new(),
            printed: 0,
            diagnostics: Diagnostics::default(),
            warned: BTreeSet::new(),
            pending: Vec::new(),
            spare: Vec::new(),
            shapes: 0,
            vertices: 0,
            expression_depth: 0,
            running: None,
            blocks: 0,
            sources: None,
            steps: Steps::default(),
            used: Used::default(),
            watch: None,
        }
    }

    /// Notes where leaves come from and what rules cost.
    pub fn watched(mut self) -> Self {
        self.watch = Some(Box::default());
        self
    }

    /// As [`Derivation::run`], with what was noted.
    pub fn run_watched(mut self) -> (ShapeTree, Watch) {
        let _stopped = self.work();
        let watch = self.watch.take().map_or_else(Watch::default, |watch| *watch);
        (self.into_tree(), watch)
    }

    /// As a first derivation.
    pub fn noting(mut self) -> Self {
        self.context = Context::noting();
        self
    }

    /// As a second derivation.
    pub fn among(mut self, surroundings: &'p Surroundings<'p>) -> Self {
        self.context = Context::among(surroundings);
        self
    }

    /// Derives the start shape and everything that follows from it.
    pub fn run(mut self) -> ShapeTree {
        // A stop has left its reason in the diagnostics; what was made before it stays.
        let _stopped = self.work();
        self.into_tree()
    }

    fn into_tree(self) -> ShapeTree {
        ShapeTree {
            leaves: self.leaves.into_list(),
            reports: self.reports.into_list(),
            prints: self.prints,
            diagnostics: self.diagnostics,
            used: self.used,
        }
    }

    /// Derives as well, and keeps what others may ask about.
    pub fn survey(mut self) -> Survey {
        let _stopped = self.work();
        self.context.into_survey()
    }

    fn work(&mut self) -> Outcome<()> {
        let Some(first) = start::prepare(self)? else { return Ok(()) };
        self.pending.push(first);
        while let Some(task) = self.pending.pop() {
            match task.symbol {
                Symbol::Leaf(name) => {
                    self.note_leaf(&task);
                    self.push_leaf(name, task);
                }
                Symbol::Rule(rule) if self.is_small_detail(&task.shape) => {
                    let name = &self.program.rule(rule).name;
                    self.push_leaf(name, task);
                }
                Symbol::Rule(rule) => {
                    self.running = Some(task.step);
                    let children = std::mem::take(&mut self.spare);
                    let mut children = self.watched_rule(rule, task, children)?;
                    self.pending.extend(children.drain(..).rev());
                    self.spare = children;
                    self.check_pending(rule)?;
                }
            }
        }
        Ok(())
    }

    fn push_leaf(&mut self, name: &'p Arc<str>, task: Task<'p>) {
        let before = self.leaves.len();
        self.leaves.push(name, task.shape, &self.steps, task.step);
        if let Some(watch) = &mut self.watch {
            watch.leaves(&self.steps, task.step, self.leaves.len() - before);
        }
    }

    /// Runs a rule; its time is noted where the derivation is watched.
    fn watched_rule(&mut self, rule: RuleId, task: Task<'p>, children: Vec<Task<'p>>) -> Outcome<Vec<Task<'p>>> {
        if self.watch.is_none() {
            return self.derive_rule(rule, task, children);
        }
        let start = Instant::now();
        let step = task.step;
        let made = self.derive_rule(rule, task, children);
        if let Some(watch) = &mut self.watch {
            watch.rule(rule, step, start.elapsed());
        }
        made
    }

    /// Whether a shape is a piece of a facade too small for its rule to matter.
    fn is_small_detail(&self, shape: &Shape) -> bool {
        let Scope { frame, size } = shape.scope;
        let upright = libm::fabs(frame.axes.z_axis.y) < UPRIGHT;
        self.limits.detail > 0.0 && upright && size.z == 0.0 && size.abs().max_element() < self.limits.detail
    }

    /// Child numbers from the root to the shape whose rule runs; none before the first rule.
    pub fn path(&self) -> Path {
        self.running.map_or_else(Path::new, |step| self.steps.path(step))
    }

    fn check_pending(&mut self, rule: RuleId) -> Outcome<()> {
        let span = self.program.rule(rule).span;
        self.check_waiting(self.pending.len(), span)
    }

    /// Starts to derive a block inside a rule.
    pub fn enter_block(&mut self, span: Span) -> Outcome<()> {
        self.blocks += 1;
        let limit = self.limits.max_blocks;
        if self.blocks > limit {
            return self.stop("cga::limit-depth", span, format!("`inline` and booleans go deeper than {limit}"));
        }
        Ok(())
    }

    pub fn leave_block(&mut self) {
        self.blocks -= 1;
    }

    pub fn check_waiting(&mut self, waiting: usize, span: Span) -> Outcome<()> {
        let limit = self.limits.max_pending;
        if waiting > limit {
            return self.stop("cga::limit-shapes", span, format!("more than {limit} shapes wait at the same time"));
        }
        Ok(())
    }

    /// Counts shapes about to be made.
    pub fn count_shapes(&mut self, more: usize, span: Span) -> Outcome<()> {
        self.shapes = self.shapes.saturating_add(more);
        let limit = self.limits.max_shapes;
        if self.shapes > limit {
            return self.stop("cga::limit-shapes", span, format!("the shape grows past {limit} shapes"));
        }
        Ok(())
    }

    /// How many more shapes may be made.
    pub fn shapes_left(&self) -> usize {
        self.limits.max_shapes.saturating_sub(self.shapes)
    }

    /// Refuses to make vertices that would pass the limit.
    pub fn allow_vertices(&mut self, more: usize, span: Span) -> Outcome<()> {
        let before = self.vertices;
        let allowed = self.count_vertices(more, span);
        self.vertices = before;
        allowed
    }

    /// Counts vertices just made.
    pub fn count_vertices(&mut self, more: usize, span: Span) -> Outcome<()> {
        self.vertices = self.vertices.saturating_add(more);
        let limit = self.limits.max_vertices;
        if self.vertices > limit {
            return self.stop("cga::limit-vertices", span, format!("the shape grows past {limit} vertices"));
        }
        Ok(())
    }

    /// A child's place in the tree; refuses to go too deep.
    pub fn step(&mut self, parent: StepId, index: u32, name: &'p Arc<str>, span: Span) -> Outcome<StepId> {
        let limit = self.limits.max_depth;
        if self.steps.depth(parent) >= limit {
            return self.stop("cga::limit-depth", span, format!("rules go deeper than {limit} in `{name}`"));
        }
        let child = self.steps.child(parent, index, name);
        if let Some(watch) = &mut self.watch {
            watch.step(child, parent, span);
        }
        Ok(child)
    }

    pub fn enter_expression(&mut self, span: Span) -> Outcome<()> {
        self.expression_depth += 1;
        let limit = self.limits.max_expression_depth;
        if self.expression_depth > limit {
            return self.stop("cga::limit-calls", span, format!("functions and expressions go deeper than {limit}"));
        }
        Ok(())
    }

    pub fn leave_expression(&mut self) {
        self.expression_depth -= 1;
    }

    /// Refuses a text too long to keep.
    pub fn check_text(&mut self, length: usize, span: Span) -> Outcome<()> {
        let limit = self.limits.max_text;
        if length > limit {
            return self.stop("cga::limit-text", span, format!("a text grows past {limit} bytes"));
        }
        Ok(())
    }

    pub fn print(&mut self, text: &str, span: Span) -> Outcome<()> {
        self.printed += text.len() + 1;
        self.check_text(self.printed, span)?;
        self.prints.push(text.to_owned());
        Ok(())
    }

    /// An error that ends the derivation, with the chain of rules that led to it.
    fn stop<T>(&mut self, code: &'static str, span: Span, message: String) -> Outcome<T> {
        let mut diagnostic = Diagnostic::error(code, span, message);
        if let Some(step) = self.running {
            diagnostic = diagnostic.help(format!("rules: {}", self.steps.chain(step)));
        }
        self.diagnostics.push(diagnostic);
        Err(Stop)
    }

    /// Reports an error once per code and place.
    pub fn error(&mut self, code: &'static str, span: Span, message: String) {
        if self.warned.insert((code, span)) {
            self.diagnostics.push(Diagnostic::error(code, span, message));
        }
    }

    /// Reports a warning once per code and place.
    pub fn warn(&mut self, code: &'static str, span: Span, message: impl FnOnce() -> String) {
        if self.warned.insert((code, span)) {
            self.diagnostics.push(Diagnostic::warning(code, span, message()));
        }
    }

    /// NaN and infinity become 0 with a warning (reference 2.11).
    pub fn finite(&mut self, x: f64, span: Span) -> f64 {
        if x.is_finite() {
            return x;
        }
        self.warn("cga::not-finite", span, || format!("this is {}, 0 is used", super::value::format_float(x)));
        0.0
    }
}
