//! In: expressions of the tree. Out: resolved, typed expressions of the program.

use std::sync::Arc;

use super::lower::Body;
use super::types::{array_of, element_of, is_array, type_name};
use crate::cga::ast;
use crate::cga::codes;
use crate::cga::program::{BinaryOperator as B, DrawSite, Expr, ExprKind, Type, UnaryOperator as U};
use crate::diagnostics::Diagnostic;
use crate::source::Span;

impl Body<'_, '_> {
    pub fn expression(&mut self, expr: &ast::Expr) -> Expr {
        let span = expr.span;
        match &expr.kind {
            ast::ExprKind::Number(number) => typed(ExprKind::Number(*number), Type::Float, span),
            ast::ExprKind::Bool(value) => typed(ExprKind::Bool(*value), Type::Bool, span),
            ast::ExprKind::String(text) => typed(ExprKind::String(text.clone()), Type::String, span),
            ast::ExprKind::Call { name, args } => self.call(name, args.as_deref(), span),
            ast::ExprKind::Unary(operator, inner) => self.unary(*operator, inner, span),
            ast::ExprKind::Binary(operator, left, right) => self.binary(*operator, left, right, span),
            ast::ExprKind::Array(rows) => self.array(rows, span),
            ast::ExprKind::Range { from, step, to } => {
                let from = Box::new(self.number(from));
                let step = step.as_ref().map(|step| Box::new(self.number(step)));
                let to = Box::new(self.number(to));
                typed(ExprKind::Range { from, step, to }, Type::Floats, span)
            }
            ast::ExprKind::Index { array, row, column } => self.index(array, row, column.as_deref(), span),
            ast::ExprKind::Case { branches, otherwise } => {
                let make = |b: &mut Self, (test, value): &(ast::Expr, ast::Expr)| {
                    let test = b.plain(|b| b.condition(test));
                    (test, b.expression(value))
                };
                let branches: Vec<(Expr, Expr)> = branches.iter().map(|branch| make(self, branch)).collect();
                let otherwise = Box::new(self.expression(otherwise));
                let value = self.common(branches.iter().map(|(_, value)| value).chain([&*otherwise]));
                Expr { kind: ExprKind::Case { branches, otherwise }, value, span }
            }
            ast::ExprKind::Stochastic { branches, otherwise } => {
                let site = self.draw();
                self.weights(branches.iter().map(|(weight, _)| weight), span);
                let make = |b: &mut Self, (weight, value): &(ast::Expr, ast::Expr)| {
                    let weight = b.plain(|b| b.number(weight));
                    (weight, b.expression(value))
                };
                let branches: Vec<(Expr, Expr)> = branches.iter().map(|branch| make(self, branch)).collect();
                let otherwise = Box::new(self.expression(otherwise));
                let value = self.common(branches.iter().map(|(_, value)| value).chain([&*otherwise]));
                Expr { kind: ExprKind::Stochastic { branches, otherwise, site }, value, span }
            }
            ast::ExprKind::Comp { args, selectors } => self.comp_function(args, selectors, span),
        }
    }

    /// Runs outside selectors: names are values first.
    pub fn plain<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.in_selector, false);
        let out = work(self);
        self.in_selector = before;
        out
    }

    /// The next draw site.
    pub fn draw(&mut self) -> DrawSite {
        self.draws += 1;
        DrawSite(self.draws - 1)
    }

    pub fn number(&mut self, expr: &ast::Expr) -> Expr {
        let out = self.expression(expr);
        self.require(&out, Type::Float);
        out
    }

    pub fn condition(&mut self, expr: &ast::Expr) -> Expr {
        let out = self.expression(expr);
        self.require(&out, Type::Bool);
        out
    }

    /// Reports a value of another type; where nothing is known of a parameter, learns from its use.
    pub fn require(&mut self, expr: &Expr, wanted: Type) {
        match expr.value {
            Some(found) if found != wanted => {
                let message = format!("expected {}, found {}", type_name(wanted), type_name(found));
                self.error(codes::TYPE_MISMATCH, expr.span, message);
            }
            Some(_) => {}
            None => self.learn(expr, wanted),
        }
    }

    /// A parameter without a type gets the one it is used with first.
    pub fn learn(&mut self, expr: &Expr, kind: Type) {
        if let ExprKind::Slot(slot) = expr.kind {
            self.slots[slot as usize].1.get_or_insert(kind);
        }
    }

    /// Constant percentages must not pass 100 (reference 2.2).
    pub fn weights<'e>(&mut self, weights: impl Iterator<Item = &'e ast::Expr>, span: Span) {
        let constants = weights.filter_map(|w| match w.kind {
            ast::ExprKind::Number(number) => Some(number),
            _ => None,
        });
        let sum: f64 = constants.sum();
        if sum > 100.0 + 1e-9 {
            let message = format!("these percentages add up to {sum}, more than 100");
            self.error(codes::WEIGHTS_OVER_100, span, message);
        }
    }

    /// The type all branches share; branches of different types are a mistake.
    pub fn common<'e>(&mut self, values: impl Iterator<Item = &'e Expr>) -> Option<Type> {
        let mut first: Option<Type> = None;
        let mut wrong: Vec<(Span, Type, Type)> = Vec::new();
        for value in values {
            match (first, value.value) {
                (None, Some(kind)) => first = Some(kind),
                (Some(wanted), Some(found)) if wanted != found => wrong.push((value.span, wanted, found)),
                _ => {}
            }
        }
        for (span, wanted, found) in wrong {
            let message = format!("this branch is {}, the first one {}", type_name(found), type_name(wanted));
            self.error(codes::TYPE_MISMATCH, span, message);
        }
        // A branch of unknown type is mostly the function calling itself; the known branches decide.
        first
    }

    fn unary(&mut self, operator: U, inner: &ast::Expr, span: Span) -> Expr {
        let inner = if operator == U::Not { self.expression(inner) } else { self.plain(|b| b.expression(inner)) };
        let value = match operator {
            U::Not => {
                self.require(&inner, Type::Bool);
                Some(Type::Bool)
            }
            U::Plus | U::Minus => {
                self.require(&inner, Type::Float);
                Some(Type::Float)
            }
            U::ElementNot => self.elements(&inner, Type::Bool),
            U::ElementPlus | U::ElementMinus => self.elements(&inner, Type::Float),
        };
        Expr { kind: ExprKind::Unary(operator, Box::new(inner)), value, span }
    }

    /// An operand of an element-wise operator: an array of `element` or one such value.
    fn elements(&mut self, expr: &Expr, element: Type) -> Option<Type> {
        if let Some(found) = expr.value.filter(|k| element_of(*k) != element) {
            let wanted = type_name(array_of(element));
            self.error(codes::TYPE_MISMATCH, expr.span, format!("expected {wanted}, found {}", type_name(found)));
        }
        expr.value
    }

    fn binary(&mut self, operator: B, left: &ast::Expr, right: &ast::Expr, span: Span) -> Expr {
        let keeps = matches!(operator, B::And | B::Or);
        let selector = self.in_selector;
        self.in_selector &= keeps;
        let (left, right) = (self.expression(left), self.expression(right));
        self.in_selector = selector;
        let value = self.binary_type(operator, &left, &right, span);
        Expr { kind: ExprKind::Binary(operator, Box::new(left), Box::new(right)), value, span }
    }

    fn binary_type(&mut self, operator: B, left: &Expr, right: &Expr, span: Span) -> Option<Type> {
        match operator {
            B::Multiply | B::Divide | B::Remainder | B::Subtract => {
                self.require(left, Type::Float);
                self.require(right, Type::Float);
                Some(Type::Float)
            }
            B::And | B::Or => {
                self.require(left, Type::Bool);
                self.require(right, Type::Bool);
                Some(Type::Bool)
            }
            B::Add => self.addition(left, right, span),
            B::Less | B::LessEqual | B::Greater | B::GreaterEqual => {
                self.same(left, right, span);
                for side in [left, right] {
                    if matches!(side.value, Some(Type::Bool | Type::Bools)) {
                        self.error(
                            codes::TYPE_MISMATCH,
                            side.span,
                            format!("`{}` does not order bools", operator.text()),
                        );
                    }
                }
                Some(Type::Bool)
            }
            B::Equal | B::NotEqual => {
                self.same(left, right, span);
                Some(Type::Bool)
            }
            B::ElementMultiply | B::ElementDivide | B::ElementRemainder | B::ElementSubtract => {
                self.elements(left, Type::Float);
                self.elements(right, Type::Float);
                array_if_known(left, right, Type::Floats)
            }
            B::ElementAdd => {
                let element = if [left, right].iter().any(|e| e.value.map(element_of) == Some(Type::String)) {
                    Type::Strings
                } else {
                    Type::Floats
                };
                array_if_known(left, right, element)
            }
            B::ElementAnd | B::ElementOr => {
                self.elements(left, Type::Bool);
                self.elements(right, Type::Bool);
                array_if_known(left, right, Type::Bools)
            }
            _ => {
                if let (Some(a), Some(b)) = (left.value, right.value)
                    && element_of(a) != element_of(b)
                {
                    self.different(a, b, span);
                }
                array_if_known(left, right, Type::Bools)
            }
        }
    }

    /// `+` adds numbers; with a string on one side it joins texts.
    fn addition(&mut self, left: &Expr, right: &Expr, span: Span) -> Option<Type> {
        match (left.value, right.value) {
            (Some(Type::String), _) | (_, Some(Type::String)) => Some(Type::String),
            (Some(Type::Float), Some(Type::Float)) => Some(Type::Float),
            (None, Some(Type::Float) | None) | (Some(Type::Float), None) => None,
            (a, b) => {
                let shown = a.filter(|k| *k != Type::Float).or(b).expect("one side is known");
                let message = format!("`+` adds numbers or joins strings, not {}", type_name(shown));
                self.error(codes::TYPE_MISMATCH, span, message);
                None
            }
        }
    }

    /// Both sides of a comparison have one type.
    fn same(&mut self, left: &Expr, right: &Expr, span: Span) {
        match (left.value, right.value) {
            (Some(a), Some(b)) if a != b => self.different(a, b, span),
            (Some(kind), None) => self.learn(right, kind),
            (None, Some(kind)) => self.learn(left, kind),
            _ => {}
        }
    }

    fn different(&mut self, left: Type, right: Type, span: Span) {
        let message = format!("{} is compared with {}", type_name(left), type_name(right));
        self.error(codes::TYPE_MISMATCH, span, message);
    }

    fn array(&mut self, rows: &[Vec<ast::Expr>], span: Span) -> Expr {
        let rows: Vec<Vec<Expr>> = rows.iter().map(|row| row.iter().map(|e| self.expression(e)).collect()).collect();
        let mut element: Option<Type> = None;
        let mut wrong: Vec<Diagnostic> = Vec::new();
        for item in rows.iter().flatten() {
            let Some(found) = item.value.map(element_of) else { continue };
            let wanted = *element.get_or_insert(found);
            if wanted != found {
                let message = format!("this element is {}, the first one {}", type_name(found), type_name(wanted));
                wrong.push(Diagnostic::error(codes::TYPE_MISMATCH, item.span, message));
            }
        }
        wrong.into_iter().for_each(|d| self.diagnostics.push(d));
        Expr { kind: ExprKind::Array(rows), value: element.map(array_of), span }
    }

    fn index(&mut self, array: &ast::Expr, row: &ast::Expr, column: Option<&ast::Expr>, span: Span) -> Expr {
        let array = self.plain(|b| b.expression(array));
        let row = self.plain(|b| b.expression(row));
        let column = column.map(|column| self.plain(|b| b.expression(column)));
        if let Some(found) = array.value.filter(|k| !is_array(*k)) {
            let message = format!("only arrays have elements; this is {}", type_name(found));
            self.error(codes::TYPE_MISMATCH, array.span, message);
        }
        let mut scalar = Some(true);
        for index in [Some(&row), column.as_ref()].into_iter().flatten() {
            match index.value {
                Some(Type::Float) => {}
                Some(Type::Floats | Type::Bools) => scalar = scalar.map(|_| false),
                Some(found) => {
                    let message =
                        format!("an index is a number or an array of numbers or bools, not {}", type_name(found));
                    self.error(codes::TYPE_MISMATCH, index.span, message);
                }
                None => scalar = scalar.filter(|s| !s),
            }
        }
        let value =
            array.value.zip(scalar).map(|(kind, scalar)| if scalar { element_of(kind) } else { array_of(kind) });
        let (array, row, column) = (Box::new(array), Box::new(row), column.map(Box::new));
        Expr { kind: ExprKind::Index { array, row, column }, value, span }
    }

    /// What was written at a span, for `comp.sel`.
    pub fn written(&self, span: Span) -> Arc<str> {
        let file = self.tables.files.iter().find(|f| f.ast.source == span.source);
        let text = &file.expect("spans lie in loaded files").text;
        text[span.start as usize..span.end as usize].into()
    }
}

pub fn typed(kind: ExprKind, value: Type, span: Span) -> Expr {
    Expr { kind, value: Some(value), span }
}

/// The result of an element-wise operator: an array if one side is known to be one.
fn array_if_known(left: &Expr, right: &Expr, array: Type) -> Option<Type> {
    match (left.value, right.value) {
        (Some(a), _) if is_array(a) => Some(array),
        (_, Some(b)) if is_array(b) => Some(array),
        (Some(_), Some(_)) => Some(element_of(array)),
        _ => None,
    }
}
