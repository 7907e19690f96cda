//! Numbers (reference 6.1, 6.2). Angles in degrees.

use std::cmp::Ordering;
use std::sync::Arc;

use super::super::arithmetic::compare;
use super::super::derivation::Derivation;
use super::super::placement::sin_cos_degrees;
use super::super::value::{NULL_STRING, Value};
use super::Input;
use crate::cga::builtins::Function as F;

/// `rand([[min,] max])`: uniform; `unit` is the draw in [0, 1).
pub fn rand(run: &mut Derivation, input: &Input, unit: f64) -> Value {
    let mut bound = |i: usize| run.finite(input.float(i), input.span);
    let (low, high) = match input.len() {
        0 => (0.0, 1.0),
        1 => (0.0, bound(0)),
        _ => (bound(0), bound(1)),
    };
    Value::Float(low + (high - low) * unit)
}

pub fn call(function: F, input: &Input) -> Option<Value> {
    let x = || input.float(0);
    Some(match function {
        F::Abs => map(input, f64::abs),
        F::Ceil => map(input, f64::ceil),
        F::Floor => map(input, f64::floor),
        F::Rint => map(input, libm::rint),
        F::Acos => Value::Float(libm::acos(x()).to_degrees()),
        F::Asin => Value::Float(libm::asin(x()).to_degrees()),
        F::Atan => Value::Float(libm::atan(x()).to_degrees()),
        F::Atan2 => Value::Float(libm::atan2(x(), input.float(1)).to_degrees()),
        F::Cos => Value::Float(sin_cos_degrees(x()).1),
        F::Sin => Value::Float(sin_cos_degrees(x()).0),
        F::Tan => {
            let (sin, cos) = sin_cos_degrees(x());
            Value::Float(sin / cos)
        }
        F::Exp => Value::Float(libm::exp(x())),
        F::Ln => Value::Float(libm::log(x())),
        F::Log10 => Value::Float(libm::log10(x())),
        F::Pow => Value::Float(libm::pow(x(), input.float(1))),
        F::Sqrt => Value::Float(x().sqrt()),
        F::IsInf => test(input, f64::is_infinite),
        F::IsNan => test(input, f64::is_nan),
        F::IsNull => is_null(input),
        F::Min => pick(input, Ordering::Less),
        F::Max => pick(input, Ordering::Greater),
        F::Clamp => clamp(input),
        _ => return None,
    })
}

fn map(input: &Input, f: fn(f64) -> f64) -> Value {
    match input.value(0) {
        Some(Value::Floats(a)) => Value::Floats(Arc::new(a.map(|x| f(*x)))),
        _ => Value::Float(f(input.float(0))),
    }
}

fn test(input: &Input, f: fn(f64) -> bool) -> Value {
    match input.value(0) {
        Some(Value::Floats(a)) => Value::Bools(Arc::new(a.map(|x| f(*x)))),
        _ => Value::Bool(f(input.float(0))),
    }
}

fn is_null(input: &Input) -> Value {
    match input.value(0) {
        Some(Value::Strings(a)) => Value::Bools(Arc::new(a.map(|s| &**s == NULL_STRING))),
        Some(Value::String(s)) => Value::Bool(&**s == NULL_STRING),
        _ => test(input, f64::is_nan),
    }
}

/// The argument that is ordered as wanted against the other; the first if equal.
fn pick(input: &Input, wanted: Ordering) -> Value {
    let (a, b) = (input.any(0), input.any(1));
    if compare(&b, &a) == Some(wanted) { b } else { a }
}

fn clamp(input: &Input) -> Value {
    let (x, low, high) = (input.any(0), input.any(1), input.any(2));
    if compare(&x, &low) == Some(Ordering::Less) {
        low
    } else if compare(&x, &high) == Some(Ordering::Greater) {
        high
    } else {
        x
    }
}
