//! The syntax tree of one rule file: what was written and where, nothing resolved.
//!
//! In: pest pairs, through `parse`. Out: declarations with their annotations; every node that a message may point at
//! carries a span. Only text that changes no meaning (layout, comments) is left out.

use std::sync::Arc;

use super::program::{BinaryOperator, BooleanOperator, Constant, Prefix, SelectorOperator, UnaryOperator};
use crate::source::{SourceId, Span};

#[derive(Clone, Debug, PartialEq)]
pub struct Ast {
    pub source: SourceId,
    /// `version "..."`.
    pub version: Option<Text>,
    /// In source order.
    pub declarations: Vec<Declaration>,
    /// Annotations after the last declaration, such as a closing `@Group`.
    pub trailing: Vec<Annotation>,
}

/// A name or literal text and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    pub text: Arc<str>,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    pub annotations: Vec<Annotation>,
    pub kind: DeclarationKind,
    /// Without the annotations.
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum DeclarationKind {
    Import(Import),
    Style(Style),
    Definition(Definition),
    Rule(Rule),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Annotation {
    pub name: Text,
    pub args: Vec<AnnotationArg>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct AnnotationArg {
    pub key: Option<Text>,
    pub value: AnnotationValue,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum AnnotationValue {
    Constant(Constant),
    Name(Arc<str>),
    /// Anything else, as written.
    Text(Arc<str>),
}

/// `import prefix (styles) : "path" (overrides)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    pub prefix: Text,
    pub styles: Vec<Text>,
    pub path: Text,
    pub overrides: Option<Vec<Override>>,
}

/// An item in the parentheses of an import.
#[derive(Clone, Debug, PartialEq)]
pub enum Override {
    /// A bare name: not overridden by the importing file's attribute of the same name.
    Keep(Text),
    Value(Text, Expr),
    Rule {
        name: Text,
        parameters: Vec<Text>,
        successor: Successor,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    pub name: Text,
    pub base: Option<Text>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DefinitionKind {
    Attr,
    Const,
    Function,
}

/// `attr`, `const` or a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    pub kind: DefinitionKind,
    pub name: Text,
    /// `None` without parentheses.
    pub parameters: Option<Vec<Text>>,
    pub locals: Vec<(Text, Expr)>,
    pub value: Expr,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modifier {
    Start,
    Extension,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    pub modifier: Option<Modifier>,
    pub name: Text,
    pub parameters: Vec<Text>,
    pub locals: Vec<(Text, Expr)>,
    pub successor: Successor,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    Number(f64),
    Bool(bool),
    /// Escapes resolved.
    String(Arc<str>),
    Array(Vec<Vec<Expr>>),
    /// Only as an element of an array or index.
    Range {
        from: Box<Expr>,
        step: Option<Box<Expr>>,
        to: Box<Expr>,
    },
    /// A name with or without arguments.
    Call {
        name: Text,
        args: Option<Vec<Argument>>,
    },
    Comp {
        args: Vec<Argument>,
        selectors: Vec<Selector<Expr>>,
    },
    Unary(UnaryOperator, Box<Expr>),
    Binary(BinaryOperator, Box<Expr>, Box<Expr>),
    Index {
        array: Box<Expr>,
        row: Box<Expr>,
        column: Option<Box<Expr>>,
    },
    Case {
        branches: Vec<(Expr, Expr)>,
        otherwise: Box<Expr>,
    },
    Stochastic {
        branches: Vec<(Expr, Expr)>,
        otherwise: Box<Expr>,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    pub prefix: Prefix,
    pub value: Expr,
    /// With the prefix.
    pub span: Span,
}

/// `test operator body`.
#[derive(Clone, Debug, PartialEq)]
pub struct Selector<T> {
    pub test: Expr,
    pub operator: SelectorOperator,
    pub body: T,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Successor {
    Sequence(Vec<Item>),
    Case { branches: Vec<(Expr, Successor)>, otherwise: Box<Successor> },
    Stochastic { branches: Vec<(Expr, Successor)>, otherwise: Box<Successor> },
}

#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    pub kind: ItemKind,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    Group(Successor),
    Nil,
    /// An operation without a block, a rule, or a leaf. `terminal` where a dot follows the name.
    Plain {
        name: Text,
        args: Option<Vec<Argument>>,
        terminal: bool,
    },
    /// `split` and `splitArea`.
    Split {
        name: Text,
        args: Vec<Argument>,
        block: Block,
    },
    /// `comp`, `modify`, `setback` and the like.
    Selectors {
        name: Text,
        args: Vec<Argument>,
        selectors: Vec<Selector<Successor>>,
    },
    Scatter {
        name: Text,
        args: Vec<Argument>,
        body: Box<Successor>,
    },
    Perimeter {
        name: Text,
        args: Vec<Argument>,
        block: SectionBlock,
        remainder: Vec<Selector<Successor>>,
    },
    Inline {
        name: Text,
        mode: Option<Text>,
        body: Box<Successor>,
    },
    /// `right` is absent in the old form `subtract Rule`; `swap` as in `subtract(swap) Rule`.
    Boolean {
        operator: BooleanOperator,
        name: Text,
        mode: Option<Text>,
        left: Box<Successor>,
        right: Option<Box<Successor>>,
    },
    /// `prefix( overrides ).Rule(args)`.
    Dynamic {
        prefix: Text,
        overrides: Vec<Override>,
        name: Text,
        args: Vec<Argument>,
    },
}

/// A split block, perhaps repeated.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    pub parts: Vec<Part>,
    pub repeat: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    Group(Block),
    Piece {
        prefix: Prefix,
        size: Expr,
        body: Successor,
    },
    /// Without a size, as before version 2015: `~1`.
    Unsized(Successor, Span),
}

/// A block of splitAndSetbackPerimeter.
#[derive(Clone, Debug, PartialEq)]
pub struct SectionBlock {
    pub parts: Vec<SectionPart>,
    pub repeat: bool,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SectionPart {
    Group(SectionBlock),
    Section { prefix: Prefix, length: Expr, depth: Expr, body: Successor },
}
