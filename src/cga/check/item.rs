//! In: items of a sequence. Out: resolved operations, rule calls, leaves and blocks.

use std::sync::Arc;

use super::builtin_call::Builtin;
use super::callable::{bare_name, computed_word, fits};
use super::deprecated::REMOVED;
use super::instance::Value;
use super::lower::Body;
use super::names::Meaning;
use crate::cga::ast::{self, Argument, Block, ItemKind, Part, SectionBlock, SectionPart, Text};
use crate::cga::builtins::{Attr, Operation, Word};
use crate::cga::codes;
use crate::cga::program::{
    Arg, Axis, BooleanOperator, Expr, ExprKind, InlineMode, Item, PerimeterItem, Prefix, RuleId, SectionPattern,
    Sequence, SetTarget, SplitBlock, SplitItem, SplitKind, Successor, Type,
};
use crate::diagnostics::{Diagnostic, suggest};
use crate::source::Span;

impl Body<'_, '_> {
    pub fn item(&mut self, item: &ast::Item) -> Item {
        let span = item.span;
        self.block_name(&item.kind);
        match &item.kind {
            ItemKind::Group(body) => Item::Group(Box::new(self.successor(body, false))),
            ItemKind::Nil => Item::Discard,
            ItemKind::Plain { name, args, terminal } => self.symbol(name, args.as_deref(), *terminal, span),
            ItemKind::Split { name, args, block } => self.split(name, args, block),
            ItemKind::Selectors { name, args, selectors } => self.selector_block(name, args, selectors),
            ItemKind::Scatter { name, args, body } => {
                let args = self.block_arguments(Operation::Scatter, args, name.span);
                Item::Scatter { args, body: Box::new(self.successor(body, true)), span: name.span }
            }
            ItemKind::Perimeter { name, args, block, remainder } => {
                let args = self.block_arguments(Operation::SplitAndSetbackPerimeter, args, name.span);
                let pattern = self.section_block(block);
                let remainder = self.selectors(remainder).into_iter().next().map(|s| Box::new(s.body));
                Item::PerimeterSplit { args, pattern, remainder, span: name.span }
            }
            ItemKind::Inline { name, mode, body } => self.inline(name, mode.as_ref(), body),
            ItemKind::Boolean { operator, name, mode, left, right } => {
                self.boolean(*operator, name, mode.as_ref(), left, right.as_deref())
            }
            ItemKind::Dynamic { prefix, overrides, name, args } => {
                self.dynamic_call(prefix, overrides, name, args, span)
            }
        }
    }

    /// Takes down the name of an operation with a block and the word of its mode.
    fn block_name(&self, kind: &ItemKind) {
        let (name, mode) = match kind {
            ItemKind::Split { name, .. } | ItemKind::Selectors { name, .. } | ItemKind::Scatter { name, .. } => {
                (name, None)
            }
            ItemKind::Perimeter { name, .. } => (name, None),
            ItemKind::Inline { name, mode, .. } | ItemKind::Boolean { name, mode, .. } => (name, mode.as_ref()),
            ItemKind::Group(_) | ItemKind::Nil | ItemKind::Plain { .. } | ItemKind::Dynamic { .. } => return,
        };
        if let Some(operation) = Operation::from_name(&name.text) {
            self.note(name.span, Meaning::Operation(operation));
        }
        if let Some((mode, word)) = mode.and_then(|mode| Some((mode, Word::from_text(&mode.text)?))) {
            self.note(mode.span, Meaning::Word(word));
        }
    }

    /// A name in a sequence: a rule of the files, a built-in operation, or a leaf.
    fn symbol(&mut self, name: &Text, args: Option<&[Argument]>, terminal: bool, span: Span) -> Item {
        let given = args.unwrap_or_default();
        if let Some(item) = self.rule_call(name, given, span) {
            if terminal {
                let message = format!("`{}` is a rule, so the dot behind it has no effect", name.text);
                self.diagnostics.push(Diagnostic::warning(codes::NEEDLESS_DOT, name.span, message));
            }
            return item;
        }
        if let Some(operation) = Operation::from_name(&name.text) {
            self.note(name.span, Meaning::Operation(operation));
            return self.operation(operation, given, span);
        }
        if let Some(operation) = Operation::from_deprecated(&name.text) {
            self.deprecated(name, operation.name());
            self.note(name.span, Meaning::Operation(operation));
            return self.operation(operation, given, span);
        }
        let args = given.iter().map(|arg| self.plain_argument(arg)).collect();
        match self.tables.rules_named(self.scope, &name.text).first() {
            Some(other) => self.refer(self.scope, name, Meaning::Rule(self.tables.rules[other.0 as usize].span)),
            None => self.note(name.span, Meaning::Leaf),
        }
        if !terminal {
            self.undefined(name, given);
        }
        let prefix = &self.tables.instances[self.scope].prefix;
        Item::Leaf { symbol: format!("{prefix}{}", name.text).into(), args, span }
    }

    /// A call of a rule with this number of arguments whose types fit.
    fn rule_call(&mut self, name: &Text, given: &[Argument], span: Span) -> Option<Item> {
        let rules = self.tables.rules_named(self.scope, &name.text);
        let arity = |id: &RuleId| self.tables.rules[id.0 as usize].parameters.len();
        let fitting: Vec<RuleId> = rules.iter().copied().filter(|id| arity(id) == given.len()).collect();
        let builtin = Operation::from_name(&name.text).is_some();
        let prefixed = given.iter().any(|arg| arg.prefix != Prefix::Absolute);
        let first = *fitting.first().filter(|_| !(builtin && prefixed))?;
        let args: Vec<Expr> = given.iter().map(|arg| self.plain_argument(arg)).collect();
        let types = self.types;
        let chosen = fitting.into_iter().find(|id| fits(&types.rules[id.0 as usize], &args));
        let rule = chosen.unwrap_or(first);
        self.refer(self.scope, name, Meaning::Rule(self.tables.rules[rule.0 as usize].span));
        self.check_arguments(&types.rules[rule.0 as usize], &args);
        Some(Item::Call { rule, args, span })
    }

    /// A symbol that nothing defines: probably a slip, certainly worth a word.
    fn undefined(&mut self, name: &Text, args: &[Argument]) {
        if self.quiet {
            return;
        }
        let rules = self.tables.rules_named(self.scope, &name.text);
        if let Some(id) = rules.first() {
            let takes = self.tables.rules[id.0 as usize].parameters.len();
            let message = format!("no rule `{}` takes {} arguments; it becomes a leaf", name.text, args.len());
            let warning = Diagnostic::warning(codes::UNDEFINED_RULE, name.span, message);
            self.diagnostics.push(warning.help(format!("`{}` is defined with {takes}", name.text)));
            return;
        }
        if let Some((_, now)) = REMOVED.iter().find(|(old, _)| !args.is_empty() && *old == &*name.text) {
            let message = format!("`{}` is no operation any more", name.text);
            return self
                .diagnostics
                .push(Diagnostic::error(codes::REMOVED, name.span, message).help(format!("use {now}")));
        }
        let operation = self.tables.meant(&name.text, Operation::ALL.iter().map(|o| o.name()));
        if let Some(near) = operation.filter(|_| !args.is_empty()) {
            let message = format!("no operation or rule `{}`; it becomes a leaf", name.text);
            let warning = Diagnostic::warning(codes::UNKNOWN_OPERATION, name.span, message);
            let leaf = format!("{}(…).", name.text);
            self.diagnostics.push(warning.help(format!("did you mean `{near}`? For a leaf write `{leaf}`")));
            return;
        }
        let own = self.tables.instances[self.scope].rules.keys().map(|k| &**k);
        let near = self.tables.meant(&name.text, own).or(operation);
        let message = format!("no rule `{}`; it becomes a leaf", name.text);
        let warning = Diagnostic::warning(codes::UNDEFINED_RULE, name.span, message);
        self.diagnostics.push(warning.help(match near {
            Some(near) => format!("did you mean `{near}`? For a leaf write `{}.`", name.text),
            None => format!("for a leaf write `{}.`", name.text),
        }));
    }

    fn operation(&mut self, operation: Operation, given: &[Argument], span: Span) -> Item {
        if operation == Operation::Set {
            return self.set(given, span);
        }
        if needs_block(operation) {
            let message = format!("`{}` needs a block in braces", operation.name());
            self.error(codes::MISSING_BLOCK, span, message);
            return Item::Discard;
        }
        let args = self.block_arguments(operation, given, span);
        self.deprecated_form(operation, &args, span);
        Item::Operation { operation, args, span }
    }

    /// The arguments of an operation.
    fn block_arguments(&mut self, operation: Operation, given: &[Argument], span: Span) -> Vec<Arg> {
        if operation.observes_tags() {
            self.tables.observes_tags.set(true);
        }
        self.tables.needs.set(self.tables.needs.get().with_operation(operation));
        self.overload(Builtin::Operation(operation), given, span).0
    }

    /// `set(name, value)`.
    fn set(&mut self, given: &[Argument], span: Span) -> Item {
        let [target, value] = given else {
            let form = || "its form is set(attribute, any value)".to_owned();
            self.argument_count("set", &[2], given.len(), span, form);
            return Item::Discard;
        };
        let value = self.plain_argument(value);
        let unused = SetTarget::Builtin(Attr::Seedian);
        let target = if let Some(text) = computed_word(&target.value) {
            let text = self.expression(text);
            self.require(&text, Type::String);
            SetTarget::Computed(text)
        } else if let Some(name) = bare_name(&target.value) {
            self.set_target(name, &value).unwrap_or(unused)
        } else {
            self.error(
                codes::UNKNOWN_ATTRIBUTE,
                target.span,
                "the first argument of `set` is the name of an attribute",
            );
            unused
        };
        Item::Set { target, value, span }
    }

    fn set_target(&mut self, name: &Text, value: &Expr) -> Option<SetTarget> {
        let attribute = self.tables.values(self.scope, &name.text).iter().find_map(|v| match v {
            Value::Attribute(id) => Some(*id),
            Value::Function(_) => None,
        });
        if let Some(id) = attribute {
            self.refer(self.scope, name, Meaning::Value(self.tables.attributes[id.0 as usize].span));
            if self.tables.attributes[id.0 as usize].is_const {
                self.error(codes::READ_ONLY, name.span, format!("`{}` is a constant", name.text));
                return None;
            }
            if let Some(kind) = self.types.attributes[id.0 as usize] {
                self.require(value, kind);
            }
            return Some(SetTarget::Attribute(id));
        }
        let Some(row) = Attr::from_name(&name.text) else {
            let diagnostic = Diagnostic::error(
                codes::UNKNOWN_ATTRIBUTE,
                name.span,
                format!("there is no attribute `{}`", name.text),
            );
            let own = self.tables.instances[self.scope].values.keys().map(|k| &**k);
            let names = own.chain(Attr::table().filter(|row| row.writable).map(|row| row.name));
            let help = suggest(&name.text, names).map(|near| format!("did you mean `{near}`?"));
            self.diagnostics.push(Diagnostic { help, ..diagnostic });
            return None;
        };
        self.note(name.span, Meaning::BuiltinAttribute(row.name));
        if row.deprecated {
            self.deprecated(name, row.attr.info().name);
        }
        if !row.writable {
            self.error(codes::READ_ONLY, name.span, format!("`{}` cannot be set", name.text));
            return None;
        }
        self.require(value, row.kind);
        Some(SetTarget::Builtin(row.attr))
    }

    fn selector_block(&mut self, name: &Text, args: &[Argument], selectors: &[ast::Selector<ast::Successor>]) -> Item {
        let operation = Operation::from_name(&name.text).expect("the grammar names known operations");
        let span = name.span;
        if operation == Operation::Comp || operation == Operation::Modify {
            let (component, keep_axes) = self.component(operation, args, span);
            let selectors = self.selectors(selectors);
            return match operation {
                Operation::Comp => Item::Comp { component, keep_axes, selectors, span },
                _ => Item::Modify { component, keep_axes, selectors, span },
            };
        }
        let args = self.block_arguments(operation, args, span);
        let selectors = self.selectors(selectors);
        if matches!(operation, Operation::ShapeL | Operation::ShapeU | Operation::ShapeO | Operation::InnerRectangle) {
            for selector in &selectors {
                if !matches!(selector.test.kind, ExprKind::Selector(Word::Shape | Word::Remainder)) {
                    let message = format!("`{}` knows only `shape` and `remainder`", name.text);
                    self.error(codes::UNKNOWN_SELECTOR, selector.test.span, message);
                }
            }
        }
        Item::Regions { operation, args, selectors, span }
    }

    fn split(&mut self, name: &Text, args: &[Argument], block: &Block) -> Item {
        let area = &*name.text == "splitArea";
        let operation = if area { Operation::SplitArea } else { Operation::Split };
        let args = self.block_arguments(operation, args, name.span);
        self.no_computed_words(&args);
        let word = |i: usize| match args.get(i) {
            Some(Arg::Word(word, _)) => Some(*word),
            _ => None,
        };
        let adjust = word(1) != Some(Word::NoAdjust);
        let axis = match word(0) {
            Some(Word::Y) => Axis::Y,
            Some(Word::Z) => Axis::Z,
            _ => Axis::X,
        };
        let kind = match (word(0), args.get(2)) {
            (Some(Word::U | Word::V), Some(Arg::Value(_, set))) => {
                let (v, metres) = (word(0) == Some(Word::V), word(1) == Some(Word::UnitSpace));
                SplitKind::Uv { v, metres, set: set.clone() }
            }
            _ if area => SplitKind::Area { axis, adjust },
            _ => SplitKind::Scope { axis, adjust },
        };
        Item::Split { kind, block: self.split_block(block), span: name.span }
    }

    fn split_block(&mut self, block: &Block) -> SplitBlock {
        let part = |b: &mut Self, part: &Part| match part {
            Part::Group(block) => SplitItem::Group(b.split_block(block)),
            Part::Piece { prefix, size, body } => {
                let size = b.number(size);
                SplitItem::Piece { prefix: *prefix, size, body: b.successor(body, true) }
            }
            Part::Unsized(body, span) => {
                let warning =
                    Diagnostic::warning(codes::MISSING_SIZE, *span, "this part has no size; it is read as `~1`");
                b.diagnostics.push(warning.help("write `~1 :` in front of it"));
                let size = super::expression::typed(ExprKind::Number(1.0), Type::Float, *span);
                SplitItem::Piece { prefix: Prefix::Floating, size, body: b.successor(body, true) }
            }
        };
        SplitBlock { items: block.parts.iter().map(|p| part(self, p)).collect(), repeat: block.repeat }
    }

    fn section_block(&mut self, block: &SectionBlock) -> SectionPattern {
        let part = |b: &mut Self, part: &SectionPart| match part {
            SectionPart::Group(block) => PerimeterItem::Group(b.section_block(block)),
            SectionPart::Section { prefix, length, depth, body } => {
                let (length, depth) = (b.number(length), b.number(depth));
                PerimeterItem::Section { prefix: *prefix, length, depth, body: b.successor(body, true) }
            }
        };
        SectionPattern { items: block.parts.iter().map(|p| part(self, p)).collect(), repeat: block.repeat }
    }

    fn inline(&mut self, name: &Text, mode: Option<&Text>, body: &ast::Successor) -> Item {
        let mode = match mode.map(|m| (&*m.text, m.span)) {
            None | Some(("append", _)) => InlineMode::Append,
            Some(("unify", _)) => InlineMode::Unify,
            Some(("recompose", _)) => InlineMode::Recompose,
            Some((other, span)) => {
                let message = format!("`{other}` does not fit here");
                let error = Diagnostic::error(codes::UNKNOWN_KEYWORD, span, message);
                self.diagnostics.push(error.help("expected `append`, `unify` or `recompose`"));
                InlineMode::Append
            }
        };
        Item::Inline { mode, body: Box::new(self.successor(body, true)), span: name.span }
    }

    /// The old form with one operand, `subtract Rule`, works on the current shape.
    fn boolean(
        &mut self,
        operator: BooleanOperator,
        name: &Text,
        mode: Option<&Text>,
        left: &ast::Successor,
        right: Option<&ast::Successor>,
    ) -> Item {
        let left = Box::new(self.successor(left, true));
        let Some(right) = right else {
            let modern = format!("{0} {{ … | … }}", name.text);
            self.old_form(name.span, &format!("`{}` with one operand is an old form", name.text), &modern);
            let current = Item::Leaf { symbol: Arc::from("Current"), args: Vec::new(), span: name.span };
            let current = Box::new(Successor::Sequence(Sequence { items: vec![current], implicit_leaf: false }));
            let swap = mode.is_some_and(|m| &*m.text == "swap");
            let (left, right) = if swap { (left, current) } else { (current, left) };
            return Item::Boolean { operator, left, right, span: name.span };
        };
        Item::Boolean { operator, left, right: Box::new(self.successor(right, true)), span: name.span }
    }
}

fn needs_block(operation: Operation) -> bool {
    use Operation as O;
    operation.makes_shapes() || matches!(operation, O::Modify | O::Inline | O::Union | O::Subtract | O::Intersect)
}
