//! What is known of a value before a run. In: an expression. Out: its value, if it is made of literals and, for
//! numbers, of constants of the file.

use crate::cga::program::{BinaryOperator as B, Expr, ExprKind, Program, UnaryOperator as U};

/// Constants within constants.
const DEEPEST: usize = 16;

/// A number made of literals and constants.
pub fn number(expr: &Expr, program: &Program) -> Option<f64> {
    fold(expr, program, DEEPEST).filter(|x| x.is_finite())
}

fn fold(expr: &Expr, program: &Program, depth: usize) -> Option<f64> {
    let depth = depth.checked_sub(1)?;
    let inner = |e: &Expr| fold(e, program, depth);
    match &expr.kind {
        ExprKind::Number(x) => Some(*x),
        ExprKind::Unary(U::Minus, e) => Some(-inner(e)?),
        ExprKind::Unary(U::Plus, e) => inner(e),
        ExprKind::Binary(operator, left, right) => {
            let (a, b) = (inner(left)?, inner(right)?);
            match operator {
                B::Add => Some(a + b),
                B::Subtract => Some(a - b),
                B::Multiply => Some(a * b),
                B::Divide => Some(a / b),
                _ => None,
            }
        }
        ExprKind::Attribute(id) => {
            let attribute = program.attribute(*id);
            if attribute.is_const { inner(&attribute.default) } else { None }
        }
        _ => None,
    }
}

/// A condition made of literals alone: constants of the file are switches, set for another day.
pub fn condition(expr: &Expr) -> Option<bool> {
    match &expr.kind {
        ExprKind::Bool(value) => Some(*value),
        ExprKind::Unary(U::Not, e) => condition(e).map(|value| !value),
        ExprKind::Binary(B::And, a, b) => match (condition(a), condition(b)) {
            (Some(false), _) | (_, Some(false)) => Some(false),
            (Some(true), Some(true)) => Some(true),
            _ => None,
        },
        ExprKind::Binary(B::Or, a, b) => match (condition(a), condition(b)) {
            (Some(true), _) | (_, Some(true)) => Some(true),
            (Some(false), Some(false)) => Some(false),
            _ => None,
        },
        ExprKind::Binary(operator, a, b) => {
            let (ExprKind::Number(a), ExprKind::Number(b)) = (&a.kind, &b.kind) else { return None };
            match operator {
                B::Less => Some(a < b),
                B::LessEqual => Some(a <= b),
                B::Greater => Some(a > b),
                B::GreaterEqual => Some(a >= b),
                B::Equal => Some(a == b),
                B::NotEqual => Some(a != b),
                _ => None,
            }
        }
        _ => None,
    }
}
