//! Operators. In: values. Out: their sum, product, comparison... with the array forms of reference 1.7 and 1.8.

use std::cmp::Ordering;
use std::sync::Arc;

use super::derivation::Derivation;
use super::limits::Outcome;
use super::value::{Array, Value};
use crate::cga::program::{BinaryOperator as B, UnaryOperator as U};
use crate::source::Span;

pub fn unary(run: &mut Derivation, operator: U, value: Value, span: Span) -> Value {
    match (operator, value) {
        (U::Minus, Value::Float(x)) => Value::Float(-x),
        (U::Plus, Value::Float(x)) => Value::Float(x),
        (U::Not, Value::Bool(b)) => Value::Bool(!b),
        (U::Minus | U::ElementMinus, Value::Floats(a)) => Value::Floats(Arc::new(a.map(|x| -x))),
        (U::Plus | U::ElementPlus, Value::Floats(a)) => Value::Floats(a),
        (U::Not | U::ElementNot, Value::Bools(a)) => Value::Bools(Arc::new(a.map(|b| !b))),
        (operator, value) => {
            run.warn("cga::wrong-type", span, || format!("this operator does not take `{}`", value.to_text()));
            match operator {
                U::Not | U::ElementNot => Value::Bool(!value.to_bool()),
                U::Minus | U::ElementMinus => Value::Float(-value.to_float()),
                U::Plus | U::ElementPlus => Value::Float(value.to_float()),
            }
        }
    }
}

/// All but `&&` and `||` between scalars, which the evaluator cuts short.
pub fn binary(run: &mut Derivation, operator: B, a: Value, b: Value, span: Span) -> Outcome<Value> {
    if let (Value::Float(x), Value::Float(y)) = (&a, &b)
        && let Some(value) = floats(operator, *x, *y)
    {
        return Ok(value);
    }
    match operator {
        B::Equal => Ok(Value::Bool(equal(&a, &b))),
        B::NotEqual => Ok(Value::Bool(!equal(&a, &b))),
        B::Less | B::LessEqual | B::Greater | B::GreaterEqual => {
            let order = compare(&a, &b);
            Ok(Value::Bool(order.is_some_and(|o| holds(operator, o))))
        }
        B::Add if matches!(a, Value::String(_)) || matches!(b, Value::String(_)) => concatenated(run, &a, &b, span),
        B::Multiply | B::Divide | B::Remainder | B::Add | B::Subtract => {
            run.warn("cga::wrong-type", span, || {
                format!("numbers were needed, got `{}` and `{}`", a.to_text(), b.to_text())
            });
            Ok(floats(operator, a.to_float(), b.to_float()).unwrap_or(Value::Float(0.0)))
        }
        B::And => Ok(Value::Bool(a.to_bool() && b.to_bool())),
        B::Or => Ok(Value::Bool(a.to_bool() || b.to_bool())),
        element => elementwise(run, element, &a, &b, span),
    }
}

fn floats(operator: B, x: f64, y: f64) -> Option<Value> {
    Some(match operator {
        B::Multiply => Value::Float(x * y),
        B::Divide => Value::Float(x / y),
        B::Remainder => Value::Float(libm::fmod(x, y)),
        B::Add => Value::Float(x + y),
        B::Subtract => Value::Float(x - y),
        B::Less => Value::Bool(x < y),
        B::LessEqual => Value::Bool(x <= y),
        B::Greater => Value::Bool(x > y),
        B::GreaterEqual => Value::Bool(x >= y),
        B::Equal => Value::Bool(x == y),
        B::NotEqual => Value::Bool(x != y),
        _ => return None,
    })
}

fn holds(operator: B, order: Ordering) -> bool {
    match operator {
        B::Less | B::ElementLess => order == Ordering::Less,
        B::LessEqual | B::ElementLessEqual => order != Ordering::Greater,
        B::Greater | B::ElementGreater => order == Ordering::Greater,
        _ => order != Ordering::Less,
    }
}

fn concatenated(run: &mut Derivation, a: &Value, b: &Value, span: Span) -> Outcome<Value> {
    let (a, b) = (a.to_text(), b.to_text());
    run.check_text(a.len() + b.len(), span)?;
    let mut out = String::with_capacity(a.len() + b.len());
    out.push_str(&a);
    out.push_str(&b);
    Ok(Value::text(out))
}

/// `==`: equal dimensions and elements; different types are different.
fn equal(a: &Value, b: &Value) -> bool {
    a == b
}

/// The order of `<`: strings by code unit, arrays element by element, then by columns or rows (reference 1.8).
/// `None` where NaN or different types meet.
pub fn compare(a: &Value, b: &Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Float(x), Value::Float(y)) => x.partial_cmp(y),
        (Value::Bool(x), Value::Bool(y)) => Some(x.cmp(y)),
        (Value::String(x), Value::String(y)) => Some(by_code_unit(x, y)),
        (Value::Floats(x), Value::Floats(y)) => compare_arrays(x, y, |p, q| p.partial_cmp(q)),
        (Value::Strings(x), Value::Strings(y)) => compare_arrays(x, y, |p, q| Some(by_code_unit(p, q))),
        _ => None,
    }
}

fn by_code_unit(a: &str, b: &str) -> Ordering {
    a.encode_utf16().cmp(b.encode_utf16())
}

fn compare_arrays<T>(a: &Array<T>, b: &Array<T>, element: impl Fn(&T, &T) -> Option<Ordering>) -> Option<Ordering> {
    for row in 0..a.rows.min(b.rows) {
        for column in 0..a.columns.min(b.columns) {
            let order = element(&a.items[row * a.columns + column], &b.items[row * b.columns + column])?;
            if order != Ordering::Equal {
                return Some(order);
            }
        }
        if a.columns != b.columns {
            return Some(a.columns.cmp(&b.columns));
        }
    }
    Some(a.rows.cmp(&b.rows))
}

/// The dotted operators: equal dimensions, or a scalar spread over the other side.
fn elementwise(run: &mut Derivation, operator: B, a: &Value, b: &Value, span: Span) -> Outcome<Value> {
    use Value as V;
    let strings = matches!(a, V::String(_) | V::Strings(_)) || matches!(b, V::String(_) | V::Strings(_));
    let bools = matches!(a, V::Bool(_) | V::Bools(_)) && matches!(b, V::Bool(_) | V::Bools(_));
    Ok(match operator {
        B::ElementAnd | B::ElementOr => {
            let and = operator == B::ElementAnd;
            let joined = zip(run, a, b, span, Value::to_bools, |x, y| if and { *x && *y } else { *x || *y })?;
            V::Bools(Arc::new(joined))
        }
        B::ElementAdd if strings => {
            V::Strings(Arc::new(zip(run, a, b, span, Value::to_strings, |x, y| format!("{x}{y}").into())?))
        }
        B::ElementEqual | B::ElementNotEqual if bools => {
            let wanted = operator == B::ElementEqual;
            V::Bools(Arc::new(zip(run, a, b, span, Value::to_bools, |x, y| (x == y) == wanted)?))
        }
        B::ElementEqual | B::ElementNotEqual if strings => {
            let wanted = operator == B::ElementEqual;
            V::Bools(Arc::new(zip(run, a, b, span, Value::to_strings, |x, y| (x == y) == wanted)?))
        }
        B::ElementLess | B::ElementLessEqual | B::ElementGreater | B::ElementGreaterEqual if strings => {
            V::Bools(Arc::new(zip(run, a, b, span, Value::to_strings, |x, y| holds(operator, by_code_unit(x, y)))?))
        }
        B::ElementMultiply | B::ElementDivide | B::ElementRemainder | B::ElementAdd | B::ElementSubtract => {
            let plain = match operator {
                B::ElementMultiply => |x: f64, y: f64| x * y,
                B::ElementDivide => |x: f64, y: f64| x / y,
                B::ElementRemainder => libm::fmod,
                B::ElementAdd => |x: f64, y: f64| x + y,
                _ => |x: f64, y: f64| x - y,
            };
            V::Floats(Arc::new(zip(run, a, b, span, Value::to_floats, |x, y| plain(*x, *y))?))
        }
        B::ElementEqual => V::Bools(Arc::new(zip(run, a, b, span, Value::to_floats, |x, y| x == y)?)),
        B::ElementNotEqual => V::Bools(Arc::new(zip(run, a, b, span, Value::to_floats, |x, y| x != y)?)),
        compared => V::Bools(Arc::new(zip(run, a, b, span, Value::to_floats, |x, y| {
            x.partial_cmp(y).is_some_and(|o| holds(compared, o))
        })?)),
    })
}

/// Joins element by element; different dimensions are a runtime error, after which the common part is used.
fn zip<T: Clone, U>(
    run: &mut Derivation,
    a: &Value,
    b: &Value,
    span: Span,
    read: fn(&Value) -> Arc<Array<T>>,
    join: impl Fn(&T, &T) -> U,
) -> Outcome<Array<U>> {
    let is_array = |v: &Value| matches!(v, Value::Floats(_) | Value::Bools(_) | Value::Strings(_));
    let (x, y) = (read(a), read(b));
    Ok(match (is_array(a), is_array(b)) {
        (true, false) => x.map(|item| join(item, &y.items[0])),
        (false, true) => y.map(|item| join(&x.items[0], item)),
        _ => {
            if (x.rows, x.columns) != (y.rows, y.columns) {
                run.error(
                    "cga::array-dimensions",
                    span,
                    "the arrays of an element-wise operator differ in size".into(),
                );
                return Err(super::limits::Stop);
            }
            let items = x.items.iter().zip(&y.items).map(|(p, q)| join(p, q)).collect();
            Array { rows: x.rows, columns: x.columns, items }
        }
    })
}
