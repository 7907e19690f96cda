//! The checked program: what the checker gives and the interpreter runs.
//!
//! In: nothing (only `cga::check` makes one). Out: rules, functions and attributes under integer ids, every name
//! resolved, every overload chosen; running it compares no strings. Imports are flattened: each `import` is an
//! instance with its own rules and attributes, named with its prefix (`lib.Wall`). A style is chosen at compile time.

mod expression;
pub mod fingerprint;
mod needs;
mod successor;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use expression::{
    Arg, BinaryOperator, Component, Expr, ExprKind, ExprSelector, Prefix, SelectorOperator, Type, UnaryOperator,
};
pub use needs::Needs;
pub use successor::{
    Axis, BooleanOperator, InlineMode, Item, PerimeterItem, SectionPattern, Selector, Sequence, SetTarget, SplitBlock,
    SplitItem, SplitKind, Successor,
};

use crate::source::{SourceId, Span};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RuleId(pub u32);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FunctionId(pub u32);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AttributeId(pub u32);

/// A place in the text where a random number may be drawn, counted from 0 within its rule, function or attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DrawSite(pub u32);

/// A whole rule file with everything it imports, checked and resolved for one style.
#[derive(Clone, Debug)]
pub struct Program {
    pub(in crate::cga) rules: Vec<Rule>,
    pub(in crate::cga) functions: Vec<Function>,
    pub(in crate::cga) attributes: Vec<Attribute>,
    pub(in crate::cga) initial_order: Vec<AttributeId>,
    pub(in crate::cga) start_rules: Vec<RuleId>,
    pub(in crate::cga) import_attributes: Vec<Vec<AttributeId>>,
    pub(in crate::cga) files: Vec<RuleFile>,
    pub(in crate::cga) observes_tags: bool,
    pub(in crate::cga) needs: Needs,
}

/// One text of the program; asset paths written in it are relative to `folder`.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleFile {
    pub source: SourceId,
    /// Folder that holds the file.
    pub folder: PathBuf,
}

/// A parameter of a rule or function. Its value lies in the frame slot of its position.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub name: Arc<str>,
    /// `None` where inference found no type: any value is taken.
    pub kind: Option<Type>,
}

/// `Name(parameters) with(locals) --> successor`.
#[derive(Clone, Debug)]
pub struct Rule {
    /// With import prefixes, such as `lib.Wall`.
    pub name: Arc<str>,
    /// Stable key for seeds: qualified name and number of parameters, such as `lib.Wall/2`.
    pub path: Arc<str>,
    pub parameters: Vec<Parameter>,
    /// Evaluated in order when the rule is entered, into the slots after the parameters'.
    pub locals: Vec<Expr>,
    pub successor: Successor,
    /// Draw sites are `0..draws`.
    pub draws: u32,
    /// `@StartRule` or `start`.
    pub is_start: bool,
    /// The name, where the rule is declared.
    pub span: Span,
}

/// `name(parameters) with(locals) = body`; evaluated at every call.
#[derive(Clone, Debug)]
pub struct Function {
    pub name: Arc<str>,
    /// Stable key for seeds, as [`Rule::path`].
    pub path: Arc<str>,
    pub parameters: Vec<Parameter>,
    pub locals: Vec<Expr>,
    pub body: Expr,
    pub draws: u32,
    pub span: Span,
}

/// `attr name = default` or `const name = default`; evaluated once per start shape in [`Program::initial_order`].
#[derive(Clone, Debug)]
pub struct Attribute {
    /// With import prefixes, such as `lib.height`; also the stable key for seeds.
    pub name: Arc<str>,
    pub kind: Option<Type>,
    /// A `const` takes neither host values nor `set`.
    pub is_const: bool,
    /// `attr streetWidth(edge)`: the value is a list with one number per edge of the initial shape.
    pub is_map: bool,
    pub locals: Vec<Expr>,
    pub default: Expr,
    pub draws: u32,
    pub annotations: Annotations,
    pub span: Span,
}

/// What annotations say about a declaration. They never change the model, except that `range` and `choices`
/// restrict values the host gives where `restricted` is set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Annotations {
    pub hidden: bool,
    /// `@Range(min, max, stepsize, restricted)`.
    pub range: Option<Range>,
    /// `@Enum(...)` or a legacy `@Range` list of values.
    pub choices: Option<Choices>,
    /// Nested groups, outermost first.
    pub groups: Vec<Arc<str>>,
    pub order: Option<f64>,
    /// `@Color`: the text is a colour, `#rrggbb`.
    pub color: bool,
    pub description: Option<Arc<str>>,
    pub display_name: Option<Arc<str>>,
}

/// Inclusive numeric range.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// 0 for continuous; steps start at `min`.
    pub step: f64,
    pub restricted: bool,
}

/// Allowed values.
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    pub values: Vec<Constant>,
    pub restricted: bool,
}

/// A literal in an annotation.
#[derive(Clone, Debug, PartialEq)]
pub enum Constant {
    Float(f64),
    Bool(bool),
    String(Arc<str>),
}

impl Program {
    pub fn rule(&self, id: RuleId) -> &Rule {
        &self.rules[id.0 as usize]
    }

    pub fn function(&self, id: FunctionId) -> &Function {
        &self.functions[id.0 as usize]
    }

    pub fn attribute(&self, id: AttributeId) -> &Attribute {
        &self.attributes[id.0 as usize]
    }

    /// All rules; the position is the [`RuleId`].
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// All functions; the position is the [`FunctionId`].
    pub fn functions(&self) -> &[Function] {
        &self.functions
    }

    /// All attributes and constants; the position is the [`AttributeId`].
    pub fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }

    /// The order in which attributes and constants must be evaluated: each after those its default reads.
    pub fn initial_order(&self) -> &[AttributeId] {
        &self.initial_order
    }

    /// What a dynamic import call ([`Item::Instantiate`]) evaluates again: the attributes and constants of the import
    /// and of what it imports, each after those its default reads.
    pub fn import_attributes(&self, import: u32) -> &[AttributeId] {
        &self.import_attributes[import as usize]
    }

    /// Rules marked as start rules, in source order; the first is the host's default.
    pub fn start_rules(&self) -> &[RuleId] {
        &self.start_rules
    }

    /// The rule that a derivation starts with: the one the host names, without parameters, else the first start rule,
    /// else the first rule without parameters.
    pub fn start(&self, wanted: Option<&str>) -> Option<RuleId> {
        if let Some(name) = wanted {
            return self.rule_named(name, 0);
        }
        let first = || self.rules.iter().position(|rule| rule.parameters.is_empty());
        self.start_rules.first().copied().or_else(|| first().map(|number| RuleId(number as u32)))
    }

    /// The rule a host names, with this number of parameters.
    pub fn rule_named(&self, name: &str, parameters: usize) -> Option<RuleId> {
        let found = self.rules.iter().position(|r| &*r.name == name && r.parameters.len() == parameters)?;
        Some(RuleId(found as u32))
    }

    /// The attribute a host names.
    pub fn attribute_named(&self, name: &str) -> Option<AttributeId> {
        self.attributes.iter().position(|a| &*a.name == name && !a.is_const).map(|i| AttributeId(i as u32))
    }

    /// What it asks of other start shapes and of its host.
    pub fn needs(&self) -> Needs {
        self.needs
    }

    /// Whether anything in the program can tell if a component has a tag. Where nothing can, none are made.
    pub fn observes_tags(&self) -> bool {
        self.observes_tags
    }

    /// The texts the program was made of; the first is the main file.
    pub fn files(&self) -> &[RuleFile] {
        &self.files
    }

    /// The folder against which paths written in this text are resolved.
    pub fn folder(&self, source: SourceId) -> &Path {
        let file = self.files.iter().find(|f| f.source == source);
        &file.expect("spans of a program lie in its files").folder
    }
}
