//! In: one `expr` of the grammar. Out: an [`Expr`].

use pest::iterators::Pair;

use super::ast::{CallArgument, Expr, ExprKind, Name, Test};
use super::parse::{Reader, Rule};
use crate::geodata::feature::ObjectKind;

/// The word itself, or the inside of a quoted text.
pub(super) fn unquoted<'a>(pair: &Pair<'a, Rule>) -> &'a str {
    let text = pair.as_str();
    match pair.as_rule() {
        Rule::text => &text[1..text.len() - 1],
        _ => text,
    }
}

/// Reads `expr` and every rule below it.
pub(super) fn expression(reader: &mut Reader, pair: Pair<Rule>) -> Expr {
    let span = reader.span(&pair);
    let kind = match pair.as_rule() {
        Rule::expr => return fold(reader, pair, ExprKind::Or),
        Rule::both => return fold(reader, pair, ExprKind::And),
        Rule::negated => {
            let mut inner = pair.into_inner();
            let first = inner.next().expect("a negation has an operand");
            if first.as_rule() != Rule::bang {
                return expression(reader, first);
            }
            ExprKind::Not(Box::new(expression(reader, inner.next().expect("`!` has an operand"))))
        }
        Rule::product => return product(reader, pair),
        Rule::quantity => quantity(reader, &pair),
        Rule::text => ExprKind::Text(unquoted(&pair).to_owned()),
        Rule::date => ExprKind::Date(pair.as_str().to_owned()),
        Rule::clock => ExprKind::Clock(pair.as_str().to_owned()),
        Rule::argument => ExprKind::Argument(pair.as_str()[1..].to_owned()),
        Rule::object => object(reader, &pair),
        Rule::call => call(reader, pair),
        Rule::filter => {
            let mut inner = pair.into_inner();
            let class = head(reader, inner.next().expect("a filter has a class"));
            ExprKind::Filter { class, test: test(reader, inner.next().expect("a filter has a test")) }
        }
        Rule::list => ExprKind::List(pair.into_inner().map(|value| expression(reader, value)).collect()),
        Rule::group => {
            let mut values: Vec<Expr> = pair.into_inner().map(|value| expression(reader, value)).collect();
            match values.pop() {
                Some(only) if values.is_empty() => return Expr { span, ..only },
                last => {
                    values.extend(last);
                    ExprKind::Group(values)
                }
            }
        }
        Rule::word => ExprKind::Word(pair.as_str().to_owned()),
        other => unreachable!("{other:?} is not part of an expression"),
    };
    Expr { kind, span }
}

/// A chain of one operator; a chain of one operand is the operand.
fn fold(reader: &mut Reader, pair: Pair<Rule>, join: fn(Vec<Expr>) -> ExprKind) -> Expr {
    let span = reader.span(&pair);
    let mut operands: Vec<Expr> = pair.into_inner().map(|part| expression(reader, part)).collect();
    if operands.len() == 1 { operands.remove(0) } else { Expr { kind: join(operands), span } }
}

fn product(reader: &mut Reader, pair: Pair<Rule>) -> Expr {
    let span = reader.span(&pair);
    let mut inner = pair.into_inner();
    let left = expression(reader, inner.next().expect("a product has a first factor"));
    let (Some(infix), Some(right)) = (inner.next(), inner.next()) else { return left };
    let join = if infix.as_str() == "*" { ExprKind::Times } else { ExprKind::By };
    Expr { kind: join(Box::new(left), Box::new(expression(reader, right))), span }
}

fn quantity(reader: &mut Reader, pair: &Pair<Rule>) -> ExprKind {
    let mut inner = pair.clone().into_inner();
    let number = inner.next().expect("a quantity has a number");
    let value: f64 = number.as_str().parse().unwrap_or(f64::NAN);
    if !value.is_finite() {
        reader.error("spec::number-too-large", reader.span(pair), format!("`{}` is too large", number.as_str()));
    }
    let value = if value.is_finite() { value } else { 0.0 };
    ExprKind::Quantity { value, unit: inner.next().map(|unit| unit.as_str().to_owned()) }
}

fn object(reader: &mut Reader, pair: &Pair<Rule>) -> ExprKind {
    let (word, number) = pair.as_str().split_once('/').expect("the grammar asks for a slash");
    let kind = match word {
        "node" => ObjectKind::Node,
        "way" => ObjectKind::Way,
        "relation" => ObjectKind::Relation,
        _ => ObjectKind::Feature,
    };
    let id = number.parse().unwrap_or_else(|_| {
        reader.error("spec::number-too-large", reader.span(pair), format!("`{number}` is too large for an id"));
        0
    });
    ExprKind::Object { kind, id }
}

/// The word of `word(` or `word[`.
fn head(reader: &Reader, pair: Pair<Rule>) -> Name {
    reader.name(&pair.into_inner().next().expect("the head of a call is a word"))
}

fn call(reader: &mut Reader, pair: Pair<Rule>) -> ExprKind {
    let mut inner = pair.into_inner();
    let name = head(reader, inner.next().expect("a call has a name"));
    let mut arguments = Vec::new();
    for argument in inner {
        let (mut name, mut weight, mut value) = (None, None, None);
        for part in argument.into_inner() {
            match part.as_rule() {
                Rule::word => name = Some(reader.name(&part)),
                Rule::quantity => weight = Some(expression(reader, part)),
                _ => value = Some(expression(reader, part)),
            }
        }
        arguments.push(CallArgument { name, weight, value: value.expect("an argument has a value") });
    }
    ExprKind::Call { name, arguments }
}

fn test(reader: &mut Reader, pair: Pair<Rule>) -> Test {
    match pair.as_rule() {
        Rule::test => chain(reader, pair, Test::Any),
        Rule::test_all => chain(reader, pair, Test::All),
        Rule::test_one => {
            let mut inner = pair.into_inner();
            let first = inner.next().expect("a test is not empty");
            if first.as_rule() != Rule::bang {
                return test(reader, first);
            }
            Test::Not(Box::new(test(reader, inner.next().expect("`!` has an operand"))))
        }
        Rule::comparison => {
            let mut inner = pair.into_inner();
            let tag = reader.name(&inner.next().expect("a comparison has a tag"));
            let operator = inner.next().expect("a comparison has an operator").as_str().to_owned();
            let value = inner.next().expect("a comparison has a value");
            let value = match value.as_rule() {
                Rule::anything => None,
                Rule::quantity => Some(Box::new(expression(reader, value))),
                _ => {
                    let kind = ExprKind::Text(unquoted(&value).to_owned());
                    Some(Box::new(Expr { kind, span: reader.span(&value) }))
                }
            };
            Test::Compare { tag, operator, value }
        }
        _ => Test::Kind(reader.name(&pair)),
    }
}

fn chain(reader: &mut Reader, pair: Pair<Rule>, join: fn(Vec<Test>) -> Test) -> Test {
    let mut tests: Vec<Test> = pair.into_inner().map(|part| test(reader, part)).collect();
    if tests.len() == 1 { tests.remove(0) } else { join(tests) }
}
