//! The part of the walk that goes through rule bodies.

use super::*;

impl Walk<'_> {
    pub(super) fn successor(&mut self, successor: &Successor) {
        match successor {
            Successor::Sequence(Sequence { items, implicit_leaf }) => {
                self.debug(&("sequence", implicit_leaf));
                self.list(items, Walk::item);
            }
            Successor::Case { branches, otherwise } => {
                self.text("case");
                self.branches(branches, Walk::successor);
                self.successor(otherwise);
            }
            Successor::Stochastic { branches, otherwise, site } => {
                self.text("stochastic");
                self.branches(branches, Walk::successor);
                self.successor(otherwise);
                self.site(site);
            }
        }
    }

    fn item(&mut self, item: &Item) {
        match item {
            Item::Operation { operation, args, span } => {
                self.debug(&("operation", operation));
                self.args(args);
                self.span(*span);
            }
            Item::Set { target, value, span } => {
                self.text("set");
                self.target(target);
                self.expr(value);
                self.span(*span);
            }
            Item::Call { rule, args, span } => {
                self.text("call");
                self.rule(*rule);
                self.exprs(args);
                self.span(*span);
            }
            Item::Instantiate { import, overrides, rule, args, span } => {
                self.text("instantiate");
                self.list(self.program.import_attributes(*import), |walk, id| walk.attribute(*id));
                self.list(overrides, |walk, (id, value)| {
                    walk.attribute(*id);
                    walk.expr(value);
                });
                self.rule(*rule);
                self.exprs(args);
                self.span(*span);
            }
            Item::Leaf { symbol, args, span } => {
                self.text("leaf");
                self.text(symbol);
                self.exprs(args);
                self.span(*span);
            }
            Item::Discard => self.text("discard"),
            Item::Group(inner) => {
                self.text("group");
                self.successor(inner);
            }
            Item::Split { kind, block, span } => {
                self.text("split");
                self.split_kind(kind);
                self.split_block(block);
                self.span(*span);
            }
            Item::Comp { component, keep_axes, selectors, span } => {
                self.debug(&("comp", component, keep_axes));
                self.list(selectors, Walk::selector);
                self.span(*span);
            }
            Item::Regions { operation, args, selectors, span } => {
                self.debug(&("regions", operation));
                self.args(args);
                self.list(selectors, Walk::selector);
                self.span(*span);
            }
            Item::Scatter { args, body, span } => {
                self.text("scatter");
                self.args(args);
                self.successor(body);
                self.span(*span);
            }
            Item::PerimeterSplit { args, pattern, remainder, span } => {
                self.text("perimeter");
                self.args(args);
                self.pattern(pattern);
                self.optional(remainder.as_deref(), Walk::successor);
                self.span(*span);
            }
            Item::Modify { component, keep_axes, selectors, span } => {
                self.debug(&("modify", component, keep_axes));
                self.list(selectors, Walk::selector);
                self.span(*span);
            }
            Item::Inline { mode, body, span } => {
                self.debug(&("inline", mode));
                self.successor(body);
                self.span(*span);
            }
            Item::Boolean { operator, left, right, span } => {
                self.debug(&("boolean", operator));
                self.successor(left);
                self.successor(right);
                self.span(*span);
            }
        }
    }

    fn target(&mut self, target: &SetTarget) {
        match target {
            SetTarget::Attribute(id) => {
                self.text("attribute");
                self.attribute(*id);
            }
            SetTarget::Builtin(attr) => self.debug(&("built-in", attr)),
            SetTarget::Computed(name) => {
                self.text("computed");
                // It may name any attribute that is there.
                let names = self.program.attributes().iter().filter(|a| !a.is_const).map(|a| &a.name);
                self.debug(&names.collect::<Vec<_>>());
                self.expr(name);
            }
        }
    }

    fn selector(&mut self, selector: &Selector) {
        let Selector { test, operator, text, body } = selector;
        self.expr(test);
        self.debug(operator);
        self.text(text);
        self.successor(body);
    }

    fn split_kind(&mut self, kind: &SplitKind) {
        match kind {
            SplitKind::Scope { axis, adjust } => self.debug(&("scope", axis, adjust)),
            SplitKind::Area { axis, adjust } => self.debug(&("area", axis, adjust)),
            SplitKind::Uv { v, metres, set } => {
                self.debug(&("uv", v, metres));
                self.expr(set);
            }
        }
    }

    fn split_block(&mut self, block: &SplitBlock) {
        let SplitBlock { items, repeat } = block;
        self.debug(repeat);
        self.list(items, |walk, item| match item {
            SplitItem::Piece { prefix, size, body } => {
                walk.debug(&("piece", prefix));
                walk.expr(size);
                walk.successor(body);
            }
            SplitItem::Group(block) => {
                walk.text("group");
                walk.split_block(block);
            }
        });
    }

    fn pattern(&mut self, pattern: &SectionPattern) {
        let SectionPattern { items, repeat } = pattern;
        self.debug(repeat);
        self.list(items, |walk, item| match item {
            PerimeterItem::Section { prefix, length, depth, body } => {
                walk.debug(&("section", prefix));
                walk.expr(length);
                walk.expr(depth);
                walk.successor(body);
            }
            PerimeterItem::Group(pattern) => {
                walk.text("group");
                walk.pattern(pattern);
            }
        });
    }
}
