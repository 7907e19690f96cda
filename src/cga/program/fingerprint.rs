//! What rules, functions and attributes do, as hashes. In: a checked program. Out: one hash per item, equal for equal
//! behaviour: places in the text, comments and the numbers of ids do not count, names do.
//!
//! Items are taken apart without `..`, so that a new field cannot be forgotten. Two programs whose items hash alike give
//! a derivation that uses only those items the same result, as long as it reports no mistake: mistakes tell places.

use std::collections::BTreeSet;
use std::fmt::Debug;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::{
    Annotations, Arg, Attribute, AttributeId, Choices, DrawSite, Expr, ExprKind, ExprSelector, Function, FunctionId,
    Item, Parameter, PerimeterItem, Program, Range, Rule, RuleFile, RuleId, SectionPattern, Selector, Sequence,
    SetTarget, SplitBlock, SplitItem, SplitKind, Successor,
};
use crate::source::{SourceId, Span};

/// 128 bits of SHA-256.
pub type Fingerprint = [u8; 16];

/// The items of a program; positions are ids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprints {
    pub rules: Vec<ItemPrint>,
    pub functions: Vec<ItemPrint>,
    pub attributes: Vec<AttributePrint>,
    /// What any item may depend on: what the program needs and observes, and the main file's folder.
    pub whole: Fingerprint,
}

/// A rule or a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ItemPrint {
    /// As [`Rule::path`].
    pub path: Arc<str>,
    pub print: Fingerprint,
    /// Attributes that its text names or may reach when it is executed.
    pub reads: BTreeSet<AttributeId>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AttributePrint {
    pub name: Arc<str>,
    /// What counts where the host gives a value: type, kind, allowed values.
    pub declared: Fingerprint,
    /// How it is computed where the host gives none.
    pub default: Fingerprint,
    /// The host's value may stand in place of the default: it is no constant and no map.
    pub takes_host: bool,
    /// The default is a number, a truth value or a text: computing it can have no other effect.
    pub is_literal: bool,
    /// Attributes that the default names.
    pub reads: BTreeSet<AttributeId>,
}

impl Program {
    /// The hashes of all items.
    pub fn fingerprints(&self) -> Fingerprints {
        let Program {
            rules,
            functions,
            attributes,
            // The order follows from what attributes read, and each has draws of its own.
            initial_order: _,
            // The host asks for the start rule by its path.
            start_rules: _,
            // Part of the items that instantiate.
            import_attributes: _,
            files,
            observes_tags,
            needs,
        } = self;
        let mut whole = Walk::new(self);
        whole.debug(&(observes_tags, needs));
        if let Some(RuleFile { source: _, folder }) = files.first() {
            whole.text(&folder.to_string_lossy());
        }
        Fingerprints {
            rules: rules.iter().map(|rule| self.rule_print(rule)).collect(),
            functions: functions.iter().map(|function| self.function_print(function)).collect(),
            attributes: attributes.iter().map(|attribute| self.attribute_print(attribute)).collect(),
            whole: whole.finish().0,
        }
    }

    fn rule_print(&self, rule: &Rule) -> ItemPrint {
        // Whether it is a start rule matters to who asks for one, not to what it does.
        let Rule { name, path, parameters, locals, successor, draws, is_start: _, span } = rule;
        let mut walk = Walk::new(self);
        walk.text(name);
        walk.parameters(parameters);
        walk.list(locals, Walk::expr);
        walk.successor(successor);
        walk.debug(draws);
        walk.span(*span);
        let (print, reads) = walk.finish();
        ItemPrint { path: path.clone(), print, reads }
    }

    fn function_print(&self, function: &Function) -> ItemPrint {
        let Function { name, path, parameters, locals, body, draws, span } = function;
        let mut walk = Walk::new(self);
        walk.text(name);
        walk.parameters(parameters);
        walk.list(locals, Walk::expr);
        walk.expr(body);
        walk.debug(draws);
        walk.span(*span);
        let (print, reads) = walk.finish();
        ItemPrint { path: path.clone(), print, reads }
    }

    fn attribute_print(&self, attribute: &Attribute) -> AttributePrint {
        let Attribute { name, kind, is_const, is_map, locals, default, draws, annotations, span } = attribute;
        let mut declared = Walk::new(self);
        declared.debug(&(kind, is_const, is_map));
        declared.annotations(annotations);
        let mut walk = Walk::new(self);
        walk.list(locals, Walk::expr);
        walk.expr(default);
        walk.debug(draws);
        walk.span(*span);
        let (print, reads) = walk.finish();
        let is_value = matches!(default.kind, ExprKind::Number(_) | ExprKind::Bool(_) | ExprKind::String(_));
        AttributePrint {
            name: name.clone(),
            declared: declared.finish().0,
            default: print,
            takes_host: !is_const && !is_map,
            is_literal: is_value && locals.is_empty() && !is_map,
            reads,
        }
    }
}

/// A walk over one item.
struct Walk<'p> {
    program: &'p Program,
    hash: Sha256,
    reads: BTreeSet<AttributeId>,
    /// The text that the walk is in: names of files count from its folder.
    source: Option<SourceId>,
}

impl<'p> Walk<'p> {
    fn new(program: &'p Program) -> Walk<'p> {
        Walk { program, hash: Sha256::new(), reads: BTreeSet::new(), source: None }
    }

    fn finish(self) -> (Fingerprint, BTreeSet<AttributeId>) {
        let digest: [u8; 32] = self.hash.finalize().into();
        (digest[..16].try_into().expect("half of 32 bytes"), self.reads)
    }

    fn text(&mut self, text: &str) {
        self.hash.update((text.len() as u64).to_le_bytes());
        self.hash.update(text.as_bytes());
    }

    /// Words, types, numbers: what has neither spans nor ids.
    fn debug(&mut self, value: &impl Debug) {
        self.text(&format!("{value:?}"));
    }

    fn number(&mut self, x: f64) {
        self.hash.update(x.to_bits().to_le_bytes());
    }

    fn list<T>(&mut self, list: &[T], each: impl Fn(&mut Self, &T)) {
        self.hash.update((list.len() as u64).to_le_bytes());
        list.iter().for_each(|item| each(self, item));
    }

    fn optional<T>(&mut self, item: Option<&T>, each: impl Fn(&mut Self, &T)) {
        self.debug(&item.is_some());
        if let Some(item) = item {
            each(self, item);
        }
    }

    /// Of a place only the folder counts.
    fn span(&mut self, span: Span) {
        let Span { source, start: _, end: _ } = span;
        if self.source != Some(source) {
            self.source = Some(source);
            let folder = self.program.folder(source).to_string_lossy().into_owned();
            self.text(&folder);
        }
    }

    fn rule(&mut self, id: RuleId) {
        self.text(&self.program.rule(id).path);
    }

    fn function(&mut self, id: FunctionId) {
        self.text(&self.program.function(id).path);
    }

    fn attribute(&mut self, id: AttributeId) {
        self.reads.insert(id);
        self.text(&self.program.attribute(id).name);
    }

    fn site(&mut self, site: &DrawSite) {
        let DrawSite(number) = site;
        self.debug(number);
    }

    fn parameters(&mut self, parameters: &[Parameter]) {
        // A parameter is its place; the name is seen in messages alone.
        self.list(parameters, |walk, Parameter { name: _, kind }| walk.debug(kind));
    }

    /// What restricts the host's values; the rest is for people.
    fn annotations(&mut self, annotations: &Annotations) {
        let Annotations { hidden: _, range, choices, groups: _, order: _, color: _, description: _, display_name: _ } =
            annotations;
        if let Some(Range { min, max, step: _, restricted: true }) = range {
            self.debug(&(min, max));
        }
        if let Some(Choices { values, restricted: true }) = choices {
            self.debug(values);
        }
    }

    fn exprs(&mut self, list: &[Expr]) {
        self.list(list, Walk::expr);
    }

    fn expr(&mut self, expr: &Expr) {
        let Expr { kind, value, span } = expr;
        self.span(*span);
        self.debug(value);
        match kind {
            ExprKind::Number(x) => {
                self.text("number");
                self.number(*x);
            }
            ExprKind::Bool(b) => self.debug(b),
            ExprKind::String(text) => {
                self.text("string");
                self.text(text);
            }
            ExprKind::Array(rows) => {
                self.text("array");
                self.list(rows, |walk, row| walk.exprs(row));
            }
            ExprKind::Range { from, step, to } => {
                self.text("range");
                self.expr(from);
                self.optional(step.as_deref(), Walk::expr);
                self.expr(to);
            }
            ExprKind::Slot(slot) => self.debug(&("slot", slot)),
            ExprKind::Attribute(id) => {
                self.text("attribute");
                self.attribute(*id);
            }
            ExprKind::Call { function, args } => {
                self.text("call");
                self.function(*function);
                self.exprs(args);
            }
            ExprKind::BuiltinAttribute(attr) => self.debug(&("built-in", attr)),
            ExprKind::Builtin { function, args, site } => {
                self.debug(&("built-in", function));
                self.args(args);
                self.optional(site.as_ref(), Walk::site);
            }
            ExprKind::Unary(operator, operand) => {
                self.debug(&("unary", operator));
                self.expr(operand);
            }
            ExprKind::Binary(operator, left, right) => {
                self.debug(&("binary", operator));
                self.expr(left);
                self.expr(right);
            }
            ExprKind::Case { branches, otherwise } => {
                self.text("case");
                self.branches(branches, Walk::expr);
                self.expr(otherwise);
            }
            ExprKind::Stochastic { branches, otherwise, site } => {
                self.text("stochastic");
                self.branches(branches, Walk::expr);
                self.expr(otherwise);
                self.site(site);
            }
            ExprKind::Index { array, row, column } => {
                self.text("index");
                self.expr(array);
                self.expr(row);
                self.optional(column.as_deref(), Walk::expr);
            }
            ExprKind::Comp { component, keep_axes, selectors } => {
                self.debug(&("comp", component, keep_axes));
                self.list(selectors, |walk, ExprSelector { test, operator, text, value }| {
                    walk.expr(test);
                    walk.debug(operator);
                    walk.text(text);
                    walk.expr(value);
                });
            }
            ExprKind::Selector(word) => self.debug(&("selector", word)),
        }
    }

    fn branches<T>(&mut self, branches: &[(Expr, T)], each: impl Fn(&mut Self, &T)) {
        self.list(branches, |walk, (condition, branch)| {
            walk.expr(condition);
            each(walk, branch);
        });
    }

    fn args(&mut self, args: &[Arg]) {
        self.list(args, |walk, arg| match arg {
            Arg::Value(prefix, expr) => {
                walk.debug(prefix);
                walk.expr(expr);
            }
            Arg::Word(word, span) => {
                walk.debug(word);
                walk.span(*span);
            }
            Arg::ComputedWord(expr) => {
                walk.text("computed");
                walk.expr(expr);
            }
        });
    }
}

mod bodies;
#[cfg(test)]
mod tests;
