//! Walks over the checked program. In: an expression or a successor. Out: a call for every part of it.

use crate::cga::program::{
    Arg, Expr, ExprKind, Item, PerimeterItem, SectionPattern, SetTarget, SplitBlock, SplitItem, Successor,
};

/// Calls `visit` for an expression and everything in it, in the order of the text.
pub fn expressions<'p>(expr: &'p Expr, visit: &mut dyn FnMut(&'p Expr)) {
    visit(expr);
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Bool(_) | ExprKind::String(_) | ExprKind::Slot(_) => {}
        ExprKind::Attribute(_) | ExprKind::BuiltinAttribute(_) | ExprKind::Selector(_) => {}
        ExprKind::Call { args, .. } => args.iter().for_each(|e| expressions(e, visit)),
        ExprKind::Builtin { args, .. } => arguments(args, visit),
        ExprKind::Array(rows) => rows.iter().flatten().for_each(|e| expressions(e, visit)),
        ExprKind::Range { from, step, to } => {
            expressions(from, visit);
            step.iter().for_each(|e| expressions(e, visit));
            expressions(to, visit);
        }
        ExprKind::Unary(_, a) => expressions(a, visit),
        ExprKind::Binary(_, a, b) => [a, b].into_iter().for_each(|e| expressions(e, visit)),
        ExprKind::Index { array, row, column } => {
            [array, row].into_iter().chain(column).for_each(|e| expressions(e, visit));
        }
        ExprKind::Case { branches, otherwise } | ExprKind::Stochastic { branches, otherwise, .. } => {
            branches.iter().for_each(|(a, b)| [a, b].into_iter().for_each(|e| expressions(e, visit)));
            expressions(otherwise, visit);
        }
        ExprKind::Comp { selectors, .. } => {
            selectors.iter().for_each(|s| [&s.test, &s.value].into_iter().for_each(|e| expressions(e, visit)));
        }
    }
}

fn arguments<'p>(args: &'p [Arg], visit: &mut dyn FnMut(&'p Expr)) {
    for arg in args {
        match arg {
            Arg::Value(_, e) | Arg::ComputedWord(e) => expressions(e, visit),
            Arg::Word(..) => {}
        }
    }
}

/// The successors directly inside an item.
pub fn bodies(item: &Item) -> Vec<&Successor> {
    match item {
        Item::Operation { .. } | Item::Set { .. } | Item::Discard => Vec::new(),
        Item::Call { .. } | Item::Instantiate { .. } | Item::Leaf { .. } => Vec::new(),
        Item::Group(body) | Item::Scatter { body, .. } | Item::Inline { body, .. } => vec![body],
        Item::Split { block, .. } => {
            let mut out = Vec::new();
            pieces(block, &mut out);
            out
        }
        Item::Comp { selectors, .. } | Item::Regions { selectors, .. } | Item::Modify { selectors, .. } => {
            selectors.iter().map(|s| &s.body).collect()
        }
        Item::PerimeterSplit { pattern, remainder, .. } => {
            let mut out = Vec::new();
            sections(pattern, &mut out);
            out.extend(remainder.as_deref());
            out
        }
        Item::Boolean { left, right, .. } => vec![left, right],
    }
}

fn pieces<'p>(block: &'p SplitBlock, out: &mut Vec<&'p Successor>) {
    for item in &block.items {
        match item {
            SplitItem::Piece { body, .. } => out.push(body),
            SplitItem::Group(block) => pieces(block, out),
        }
    }
}

fn sections<'p>(pattern: &'p SectionPattern, out: &mut Vec<&'p Successor>) {
    for item in &pattern.items {
        match item {
            PerimeterItem::Section { body, .. } => out.push(body),
            PerimeterItem::Group(pattern) => sections(pattern, out),
        }
    }
}

/// Calls `visit` for every item of a successor, outer ones first.
pub fn items<'p>(successor: &'p Successor, visit: &mut dyn FnMut(&'p Item)) {
    match successor {
        Successor::Sequence(sequence) => {
            for item in &sequence.items {
                visit(item);
                bodies(item).into_iter().for_each(|body| items(body, visit));
            }
        }
        Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise, .. } => {
            branches.iter().for_each(|(_, body)| items(body, visit));
            items(otherwise, visit);
        }
    }
}

/// The expressions directly in an item, without those of the successors inside it.
pub fn expressions_of(item: &Item) -> Vec<&Expr> {
    fn values(args: &[Arg]) -> impl Iterator<Item = &Expr> {
        args.iter().filter_map(|arg| match arg {
            Arg::Value(_, e) | Arg::ComputedWord(e) => Some(e),
            Arg::Word(..) => None,
        })
    }
    match item {
        Item::Discard | Item::Group(_) | Item::Inline { .. } | Item::Boolean { .. } => Vec::new(),
        Item::Operation { args, .. } | Item::Scatter { args, .. } => values(args).collect(),
        Item::Set { target: SetTarget::Computed(name), value, .. } => vec![name, value],
        Item::Set { value, .. } => vec![value],
        Item::Call { args, .. } | Item::Leaf { args, .. } => args.iter().collect(),
        Item::Instantiate { overrides, args, .. } => overrides.iter().map(|(_, e)| e).chain(args).collect(),
        Item::Comp { selectors, .. } | Item::Modify { selectors, .. } => selectors.iter().map(|s| &s.test).collect(),
        Item::Regions { args, selectors, .. } => values(args).chain(selectors.iter().map(|s| &s.test)).collect(),
        Item::Split { block, .. } => sizes(block),
        Item::PerimeterSplit { args, pattern, .. } => {
            let mut out: Vec<&Expr> = values(args).collect();
            lengths(pattern, &mut out);
            out
        }
    }
}

fn sizes(block: &SplitBlock) -> Vec<&Expr> {
    let mut out = Vec::new();
    for item in &block.items {
        match item {
            SplitItem::Piece { size, .. } => out.push(size),
            SplitItem::Group(block) => out.extend(sizes(block)),
        }
    }
    out
}

fn lengths<'p>(pattern: &'p SectionPattern, out: &mut Vec<&'p Expr>) {
    for item in &pattern.items {
        match item {
            PerimeterItem::Section { length, depth, .. } => out.extend([length, depth]),
            PerimeterItem::Group(pattern) => lengths(pattern, out),
        }
    }
}
