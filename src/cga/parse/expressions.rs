//! In: `value`, `expression` and their parts. Out: expressions with the precedence of reference 1.8.

use pest::iterators::Pair;

use super::Rule;
use super::build::Builder;
use crate::cga::ast::{Argument, Expr, ExprKind, Selector};
use crate::cga::program::{BinaryOperator, Prefix, SelectorOperator, UnaryOperator};
use crate::source::Span;

impl Builder {
    /// An expression, a case chain or a percentage chain. `else : case` is one longer chain.
    pub fn value(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        self.nested(span, |b| b.value_here(pair, span)).unwrap_or_else(|| placeholder(span))
    }

    fn value_here(&mut self, pair: Pair<'_, Rule>, span: Span) -> Expr {
        let mut branches = Vec::new();
        let mut next = pair;
        loop {
            let mut parts = next.into_inner();
            let first = parts.next().expect("a value is not empty");
            if first.as_rule() != Rule::value_case {
                let otherwise = self.plain_value(first, parts.next(), span);
                if branches.is_empty() {
                    return otherwise;
                }
                return Expr { kind: ExprKind::Case { branches, otherwise: Box::new(otherwise) }, span };
            }
            let mut condition = None;
            let mut last = None;
            for part in first.into_inner() {
                match (part.as_rule(), condition.take()) {
                    (Rule::expression, _) => condition = Some(self.expression(part)),
                    (Rule::value, Some(condition)) => branches.push((condition, self.value(part))),
                    (Rule::value, None) => last = Some(part),
                    (_, pending) => condition = pending,
                }
            }
            next = last.expect("a case chain ends with its else");
        }
    }

    /// An expression or a percentage chain.
    fn plain_value(&mut self, first: Pair<'_, Rule>, weights: Option<Pair<'_, Rule>>, span: Span) -> Expr {
        let first = self.expression(first);
        let Some(weights) = weights else { return first };
        let mut weight = Some(first);
        let (mut branches, mut otherwise) = (Vec::new(), None);
        for part in weights.into_inner() {
            match (part.as_rule(), weight.take()) {
                (Rule::expression, _) => weight = Some(self.expression(part)),
                (Rule::value, Some(weight)) => branches.push((weight, self.value(part))),
                (Rule::value, None) => otherwise = Some(Box::new(self.value(part))),
                (_, pending) => weight = pending,
            }
        }
        let otherwise = otherwise.expect("a percentage chain ends with its else");
        Expr { kind: ExprKind::Stochastic { branches, otherwise }, span }
    }

    /// Operands and operators by precedence climbing without recursion; all operators are left-associative.
    pub fn expression(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let around = |kind| matches!(kind, Rule::binary_operator | Rule::unary_operator | Rule::index);
        let levels = pair.clone().into_inner().filter(|part| around(part.as_rule())).count();
        self.deeper(levels, span, |b| b.expression_here(pair)).unwrap_or_else(|| placeholder(span))
    }

    fn expression_here(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let mut operands: Vec<Expr> = Vec::new();
        let mut waiting: Vec<BinaryOperator> = Vec::new();
        let mut signs: Vec<(UnaryOperator, Span)> = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::unary_operator => signs.push((unary_operator(self.written(&part)), self.span(&part))),
                Rule::index => {
                    let array = operands.pop().expect("an index follows an operand");
                    let indexed = self.index(array, part);
                    operands.push(indexed);
                }
                Rule::binary_operator => {
                    apply_signs(&mut signs, &mut operands);
                    let operator = binary_operator(self.written(&part));
                    while waiting.last().is_some_and(|&before| precedence(before) >= precedence(operator)) {
                        reduce(&mut operands, &mut waiting);
                    }
                    waiting.push(operator);
                }
                _ => {
                    let operand = self.primary(part);
                    operands.push(operand);
                }
            }
        }
        apply_signs(&mut signs, &mut operands);
        while !waiting.is_empty() {
            reduce(&mut operands, &mut waiting);
        }
        operands.pop().expect("an expression has an operand")
    }

    fn primary(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::number => ExprKind::Number(self.written(&pair).parse().expect("the grammar's numbers are Rust's")),
            Rule::string => ExprKind::String(self.string(&pair).text),
            Rule::boolean => ExprKind::Bool(self.written(&pair) == "true"),
            Rule::parenthesised => {
                let inner = pair.into_inner().find(|p| p.as_rule() == Rule::value).expect("parentheses hold a value");
                return Expr { span, ..self.value(inner) };
            }
            Rule::array => {
                let rows = pair.into_inner().filter(|p| p.as_rule() == Rule::array_row);
                ExprKind::Array(rows.map(|row| self.elements(row)).collect())
            }
            Rule::comp_function => self.comp_function(pair),
            Rule::call => {
                let mut parts = pair.into_inner();
                let name = self.text(&parts.next().expect("a call has a name"));
                ExprKind::Call { name, args: parts.next().map(|args| self.arguments(args)) }
            }
            other => unreachable!("{other:?} is no primary expression of the grammar"),
        };
        Expr { kind, span }
    }

    pub fn arguments(&mut self, pair: Pair<'_, Rule>) -> Vec<Argument> {
        pair.into_inner().filter(|p| p.as_rule() == Rule::argument).map(|p| self.argument(p)).collect()
    }

    fn argument(&mut self, pair: Pair<'_, Rule>) -> Argument {
        let span = self.span(&pair);
        let mut prefix = Prefix::Absolute;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::prefix => prefix = read_prefix(&part),
                _ => return Argument { prefix, value: self.value(part), span },
            }
        }
        unreachable!("an argument has a value")
    }

    fn elements(&mut self, pair: Pair<'_, Rule>) -> Vec<Expr> {
        pair.into_inner().filter(|p| p.as_rule() == Rule::element_value).map(|p| self.element(p)).collect()
    }

    /// `value`, `from : to` or `from : step : to`.
    fn element(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let values: Vec<Expr> =
            pair.into_inner().filter(|p| p.as_rule() == Rule::value).map(|p| self.value(p)).collect();
        let mut values = values.into_iter().map(Box::new);
        let first = values.next().expect("an element has a value");
        let (step, to) = match (values.next(), values.next()) {
            (None, _) => return *first,
            (Some(to), None) => (None, to),
            (Some(step), Some(to)) => (Some(step), to),
        };
        Expr { kind: ExprKind::Range { from: first, step, to }, span }
    }

    fn index(&mut self, array: Expr, pair: Pair<'_, Rule>) -> Expr {
        let span = array.span.to(self.span(&pair));
        let mut parts = self.elements(pair).into_iter().map(Box::new);
        let row = parts.next().expect("an index has an element");
        Expr { kind: ExprKind::Index { array: Box::new(array), row, column: parts.next() }, span }
    }

    fn comp_function(&mut self, pair: Pair<'_, Rule>) -> ExprKind {
        let (mut args, mut selectors) = (Vec::new(), Vec::new());
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::arguments => args = self.arguments(part),
                Rule::value_selector => {
                    let mut parts = part.into_inner();
                    let test = self.expression(parts.next().expect("a selector has a test"));
                    let operator = selector_operator(&parts.next().expect("a selector has an operator"));
                    let body = self.value(parts.next().expect("a selector has a value"));
                    selectors.push(Selector { test, operator, body });
                }
                _ => {}
            }
        }
        ExprKind::Comp { args, selectors }
    }
}

/// Stands where a text was too deep; the error keeps the tree from being used.
fn placeholder(span: Span) -> Expr {
    Expr { kind: ExprKind::Bool(false), span }
}

/// Puts the waiting unary operators around the last operand, the innermost last.
fn apply_signs(signs: &mut Vec<(UnaryOperator, Span)>, operands: &mut Vec<Expr>) {
    while let Some((operator, at)) = signs.pop() {
        let inner = operands.pop().expect("a unary operator has an operand");
        let span = at.to(inner.span);
        operands.push(Expr { kind: ExprKind::Unary(operator, Box::new(inner)), span });
    }
}

pub fn read_prefix(pair: &Pair<'_, Rule>) -> Prefix {
    match pair.as_str() {
        "~" => Prefix::Floating,
        _ => Prefix::Relative,
    }
}

pub fn selector_operator(pair: &Pair<'_, Rule>) -> SelectorOperator {
    match pair.as_str() {
        ":" => SelectorOperator::Each,
        "=" => SelectorOperator::All,
        _ => SelectorOperator::Connected,
    }
}

/// Joins the last two operands with the last waiting operator.
fn reduce(operands: &mut Vec<Expr>, waiting: &mut Vec<BinaryOperator>) {
    let operator = waiting.pop().expect("the caller saw an operator");
    let right = operands.pop().expect("an operator has a right operand");
    let left = operands.pop().expect("an operator has a left operand");
    let span = left.span.to(right.span);
    operands.push(Expr { kind: ExprKind::Binary(operator, Box::new(left), Box::new(right)), span });
}

fn precedence(operator: BinaryOperator) -> u8 {
    use BinaryOperator as B;
    match operator {
        B::Multiply | B::Divide | B::Remainder | B::ElementMultiply | B::ElementDivide | B::ElementRemainder => 6,
        B::Add | B::Subtract | B::ElementAdd | B::ElementSubtract => 5,
        B::Less | B::LessEqual | B::Greater | B::GreaterEqual => 4,
        B::ElementLess | B::ElementLessEqual | B::ElementGreater | B::ElementGreaterEqual => 4,
        B::Equal | B::NotEqual | B::ElementEqual | B::ElementNotEqual => 3,
        B::And | B::ElementAnd => 2,
        B::Or | B::ElementOr => 1,
    }
}

fn binary_operator(text: &str) -> BinaryOperator {
    BinaryOperator::ALL.iter().copied().find(|o| o.text() == text).expect("the grammar's operators are the program's")
}

fn unary_operator(text: &str) -> UnaryOperator {
    UnaryOperator::ALL.iter().copied().find(|o| o.text() == text).expect("the grammar's operators are the program's")
}
