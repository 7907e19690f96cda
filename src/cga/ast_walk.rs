//! Walks over the syntax tree. In: a file's tree or a part of it. Out: calls for every item and expression in it.

use super::ast::{Argument, Ast, Block, DeclarationKind, Expr, ExprKind, Item, ItemKind, Override, Part, SectionBlock};
use super::ast::{SectionPart, Selector, Successor, Text};

/// What a walk tells about; outer parts come before inner ones.
pub trait Visitor<'a> {
    fn item(&mut self, _item: &'a Item) {}

    fn expression(&mut self, _expression: &'a Expr) {}

    /// The first weight of a chain of percentages between successors.
    fn choice(&mut self, _weight: &'a Expr) {}
}

/// Walks over a whole file.
pub fn file<'a>(ast: &'a Ast, visitor: &mut impl Visitor<'a>) {
    for declaration in &ast.declarations {
        match &declaration.kind {
            DeclarationKind::Import(import) => overrides(import.overrides.as_deref().unwrap_or_default(), visitor),
            DeclarationKind::Style(_) => {}
            DeclarationKind::Definition(definition) => {
                locals(&definition.locals, visitor);
                expression(&definition.value, visitor);
            }
            DeclarationKind::Rule(rule) => {
                locals(&rule.locals, visitor);
                successor(&rule.successor, visitor);
            }
        }
    }
}

fn locals<'a>(locals: &'a [(Text, Expr)], visitor: &mut impl Visitor<'a>) {
    locals.iter().for_each(|(_, value)| expression(value, visitor));
}

fn overrides<'a>(overrides: &'a [Override], visitor: &mut impl Visitor<'a>) {
    for item in overrides {
        match item {
            Override::Keep(_) => {}
            Override::Value(_, value) => expression(value, visitor),
            Override::Rule { successor: body, .. } => successor(body, visitor),
        }
    }
}

pub fn successor<'a>(body: &'a Successor, visitor: &mut impl Visitor<'a>) {
    match body {
        Successor::Sequence(items) => items.iter().for_each(|i| item(i, visitor)),
        Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise } => {
            if let (Successor::Stochastic { .. }, Some((weight, _))) = (body, branches.first()) {
                visitor.choice(weight);
            }
            for (test, body) in branches {
                expression(test, visitor);
                successor(body, visitor);
            }
            successor(otherwise, visitor);
        }
    }
}

fn item<'a>(item: &'a Item, visitor: &mut impl Visitor<'a>) {
    visitor.item(item);
    match &item.kind {
        ItemKind::Nil => {}
        ItemKind::Group(body) => successor(body, visitor),
        ItemKind::Inline { body, .. } => successor(body, visitor),
        ItemKind::Plain { args, .. } => arguments(args.as_deref().unwrap_or_default(), visitor),
        ItemKind::Split { args, block, .. } => {
            arguments(args, visitor);
            split_block(block, visitor);
        }
        ItemKind::Selectors { args, selectors: list, .. } => {
            arguments(args, visitor);
            selectors(list, visitor);
        }
        ItemKind::Scatter { args, body, .. } => {
            arguments(args, visitor);
            successor(body, visitor);
        }
        ItemKind::Perimeter { args, block, remainder, .. } => {
            arguments(args, visitor);
            section_block(block, visitor);
            selectors(remainder, visitor);
        }
        ItemKind::Boolean { left, right, .. } => {
            successor(left, visitor);
            right.iter().for_each(|right| successor(right, visitor));
        }
        ItemKind::Dynamic { overrides: list, args, .. } => {
            overrides(list, visitor);
            arguments(args, visitor);
        }
    }
}

fn arguments<'a>(arguments: &'a [Argument], visitor: &mut impl Visitor<'a>) {
    arguments.iter().for_each(|arg| expression(&arg.value, visitor));
}

fn selectors<'a>(selectors: &'a [Selector<Successor>], visitor: &mut impl Visitor<'a>) {
    for selector in selectors {
        expression(&selector.test, visitor);
        successor(&selector.body, visitor);
    }
}

fn split_block<'a>(block: &'a Block, visitor: &mut impl Visitor<'a>) {
    for part in &block.parts {
        match part {
            Part::Group(block) => split_block(block, visitor),
            Part::Piece { size, body, .. } => {
                expression(size, visitor);
                successor(body, visitor);
            }
            Part::Unsized(body, _) => successor(body, visitor),
        }
    }
}

fn section_block<'a>(block: &'a SectionBlock, visitor: &mut impl Visitor<'a>) {
    for part in &block.parts {
        match part {
            SectionPart::Group(block) => section_block(block, visitor),
            SectionPart::Section { length, depth, body, .. } => {
                expression(length, visitor);
                expression(depth, visitor);
                successor(body, visitor);
            }
        }
    }
}

pub fn expression<'a>(expr: &'a Expr, visitor: &mut impl Visitor<'a>) {
    visitor.expression(expr);
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Bool(_) | ExprKind::String(_) => {}
        ExprKind::Array(rows) => rows.iter().flatten().for_each(|e| expression(e, visitor)),
        ExprKind::Range { from, step, to } => {
            [Some(from), step.as_ref(), Some(to)].into_iter().flatten().for_each(|e| expression(e, visitor));
        }
        ExprKind::Call { args, .. } => arguments(args.as_deref().unwrap_or_default(), visitor),
        ExprKind::Comp { args, selectors } => {
            arguments(args, visitor);
            for selector in selectors {
                expression(&selector.test, visitor);
                expression(&selector.body, visitor);
            }
        }
        ExprKind::Unary(_, inner) => expression(inner, visitor),
        ExprKind::Binary(_, left, right) => [left, right].into_iter().for_each(|e| expression(e, visitor)),
        ExprKind::Index { array, row, column } => {
            [Some(array), Some(row), column.as_ref()].into_iter().flatten().for_each(|e| expression(e, visitor));
        }
        ExprKind::Case { branches, otherwise } | ExprKind::Stochastic { branches, otherwise } => {
            branches.iter().for_each(|(a, b)| [a, b].into_iter().for_each(|e| expression(e, visitor)));
            expression(otherwise, visitor);
        }
    }
}
