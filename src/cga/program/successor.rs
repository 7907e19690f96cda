//! In: resolved rule bodies. Out: the sequences, blocks and choices the interpreter executes.

use std::sync::Arc;

use super::{Arg, AttributeId, Component, DrawSite, Expr, Prefix, RuleId, SelectorOperator};
use crate::cga::builtins::{Attr, Operation};
use crate::source::Span;

/// The right side of a rule, a branch, or a block.
#[derive(Clone, Debug, PartialEq)]
pub enum Successor {
    Sequence(Sequence),
    /// The first branch whose condition holds, else `otherwise`.
    Case {
        branches: Vec<(Expr, Successor)>,
        otherwise: Box<Successor>,
    },
    /// Weights in percent; `otherwise` takes the rest.
    Stochastic {
        branches: Vec<(Expr, Successor)>,
        otherwise: Box<Successor>,
        site: DrawSite,
    },
}

/// Items executed from left to right.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    pub items: Vec<Item>,
    /// Nothing in `items` creates or discards a shape, so the shape at the end becomes an anonymous leaf
    /// (reference 2.1). Always false directly inside `[ ]`.
    pub implicit_leaf: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// An operation without a block. Its arguments fit one of [`Operation::signatures`].
    Operation {
        operation: Operation,
        args: Vec<Arg>,
        span: Span,
    },
    Set {
        target: SetTarget,
        value: Expr,
        span: Span,
    },
    /// A shape with a rule.
    Call {
        rule: RuleId,
        args: Vec<Expr>,
        span: Span,
    },
    /// `import( a = expr ).Rule(args)`: gives the shape the import's attributes anew, those of `overrides` first and
    /// as given there, then calls the rule (reference 1.12, dynamic import).
    Instantiate {
        /// For [`super::Program::import_attributes`].
        import: u32,
        overrides: Vec<(AttributeId, Expr)>,
        rule: RuleId,
        args: Vec<Expr>,
        span: Span,
    },
    /// A shape without a rule: a leaf.
    Leaf {
        symbol: Arc<str>,
        args: Vec<Expr>,
        span: Span,
    },
    /// `NIL`.
    Discard,
    /// `[ ... ]`.
    Group(Box<Successor>),
    Split {
        kind: SplitKind,
        block: SplitBlock,
        span: Span,
    },
    Comp {
        component: Component,
        keep_axes: bool,
        selectors: Vec<Selector>,
        span: Span,
    },
    /// `setback`, `setbackPerEdge`, `setbackToArea`, `shapeL`, `shapeU`, `shapeO`, `innerRectangle`.
    Regions {
        operation: Operation,
        args: Vec<Arg>,
        selectors: Vec<Selector>,
        span: Span,
    },
    Scatter {
        args: Vec<Arg>,
        body: Box<Successor>,
        span: Span,
    },
    PerimeterSplit {
        args: Vec<Arg>,
        pattern: SectionPattern,
        remainder: Option<Box<Successor>>,
        span: Span,
    },
    Modify {
        component: Component,
        keep_axes: bool,
        selectors: Vec<Selector>,
        span: Span,
    },
    Inline {
        mode: InlineMode,
        body: Box<Successor>,
        span: Span,
    },
    Boolean {
        operator: BooleanOperator,
        left: Box<Successor>,
        right: Box<Successor>,
        span: Span,
    },
}

/// What `set` writes.
#[derive(Clone, Debug, PartialEq)]
pub enum SetTarget {
    Attribute(AttributeId),
    Builtin(Attr),
    /// `set(sel(text), value)`: the name is only known when running.
    Computed(Expr),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    X,
    Y,
    Z,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SplitKind {
    /// `split(x)`; `adjust` fits the pieces' scopes to their geometry.
    Scope { axis: Axis, adjust: bool },
    /// `splitArea(x)`.
    Area { axis: Axis, adjust: bool },
    /// `split(u, unitSpace, 0)`; `v` for the second direction, `metres` for unitSpace.
    Uv { v: bool, metres: bool, set: Expr },
}

/// `{ ... | ... }` with or without `*`.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitBlock {
    pub items: Vec<SplitItem>,
    pub repeat: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SplitItem {
    Piece { prefix: Prefix, size: Expr, body: Successor },
    Group(SplitBlock),
}

/// `test op body` of a selector block.
#[derive(Clone, Debug, PartialEq)]
pub struct Selector {
    /// Evaluated with the component as current shape. A float selects by index, a bool tests the component;
    /// `ExprKind::Selector(word)` inside asks whether the component matches the word. A test that is just
    /// `Selector(Word::Remainder)` or `Selector(Word::Shape)` names that region.
    pub test: Expr,
    pub operator: SelectorOperator,
    /// The selector as written, for `comp.sel`.
    pub text: Arc<str>,
    pub body: Successor,
}

/// `{ length : depth : body | ... }` of splitAndSetbackPerimeter.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionPattern {
    pub items: Vec<PerimeterItem>,
    pub repeat: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum PerimeterItem {
    Section { prefix: Prefix, length: Expr, depth: Expr, body: Successor },
    Group(SectionPattern),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InlineMode {
    Append,
    Unify,
    Recompose,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BooleanOperator {
    Union,
    Subtract,
    Intersect,
}
