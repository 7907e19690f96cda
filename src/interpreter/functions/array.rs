//! Arrays (reference 6.3, 6.10).

use std::cmp::Ordering;
use std::sync::Arc;

use super::super::array::check_size;
use super::super::derivation::Derivation;
use super::super::limits::Outcome;
use super::super::value::{Array, Value};
use super::Input;
use crate::cga::builtins::Function as F;
use crate::cga::program::Type;

pub fn call(function: F, input: &Input) -> Option<Value> {
    let array = || input.any(0);
    let empty = |kind: Type| Value::default_of(kind);
    Some(match function {
        F::BoolArray => input.value(0).map_or(empty(Type::Bools), |a| Value::Bools(a.to_bools())),
        F::FloatArray => input.value(0).map_or(empty(Type::Floats), |a| Value::Floats(a.to_floats())),
        F::StringArray => input.value(0).map_or(empty(Type::Strings), |a| Value::Strings(a.to_strings())),
        F::Size => Value::Float(array().len() as f64),
        F::NRows => Value::Float(array().dimensions().0 as f64),
        F::NColumns => Value::Float(array().dimensions().1 as f64),
        F::FindFirst if !matches!(input.value(0), Some(Value::String(_))) => {
            Value::Float(find_first(input).map_or(-1.0, |i| i as f64))
        }
        F::Sum => sum(&array()),
        F::Transpose => transpose(&array()),
        F::SortIndices => sort_indices(&array()),
        F::SortRowIndices => sort_rows(&array()),
        _ => return None,
    })
}

fn find_first(input: &Input) -> Option<usize> {
    match input.value(0)? {
        Value::Floats(a) => {
            let (wanted, tolerance) = (input.float(1), input.float(2));
            a.items.iter().position(|x| (x - wanted).abs() <= tolerance)
        }
        Value::Bools(a) => {
            let wanted = input.any(1).to_bool();
            a.items.iter().position(|b| *b == wanted)
        }
        Value::Strings(a) => {
            let wanted = input.text(1);
            a.items.iter().position(|s| *s == wanted)
        }
        _ => None,
    }
}

fn sum(array: &Value) -> Value {
    match array {
        Value::Strings(a) => Value::text(a.items.iter().map(|s| &**s).collect::<String>()),
        Value::Bools(a) => Value::Float(a.items.iter().filter(|b| **b).count() as f64),
        other => Value::Float(other.to_floats().items.iter().sum()),
    }
}

fn transpose(array: &Value) -> Value {
    fn turned<T: Clone>(a: &Array<T>) -> Arc<Array<T>> {
        let cells = (0..a.columns).flat_map(|c| (0..a.rows).map(move |r| r * a.columns + c));
        Arc::new(Array { rows: a.columns, columns: a.rows, items: cells.map(|i| a.items[i].clone()).collect() })
    }
    match array {
        Value::Floats(a) => Value::Floats(turned(a)),
        Value::Bools(a) => Value::Bools(turned(a)),
        Value::Strings(a) => Value::Strings(turned(a)),
        scalar => scalar.clone(),
    }
}

fn order(array: &Value, a: usize, b: usize) -> Ordering {
    match array {
        Value::Strings(s) => s.items[a].encode_utf16().cmp(s.items[b].encode_utf16()),
        Value::Floats(x) => x.items[a].total_cmp(&x.items[b]),
        _ => Ordering::Equal,
    }
}

/// Per row: linear indices in rising order of their values.
fn sort_indices(array: &Value) -> Value {
    let (rows, columns) = array.dimensions();
    let mut items = Vec::with_capacity(array.len());
    for row in 0..rows {
        let mut indices: Vec<usize> = (row * columns..(row + 1) * columns).collect();
        indices.sort_by(|&a, &b| order(array, a, b));
        items.extend(indices.into_iter().map(|i| i as f64));
    }
    Value::Floats(Arc::new(Array { rows, columns, items }))
}

/// Row numbers in rising order of their contents.
fn sort_rows(array: &Value) -> Value {
    let (rows, columns) = array.dimensions();
    let mut indices: Vec<usize> = (0..rows).collect();
    indices.sort_by(|&a, &b| {
        let cells = (0..columns).map(|c| order(array, a * columns + c, b * columns + c));
        cells.fold(Ordering::Equal, Ordering::then)
    });
    Value::floats(indices.into_iter().map(|i| i as f64).collect())
}

/// `setElems(array, index, value)`, `setElems(array, row, column, value)`: a copy with elements replaced, grown with
/// defaults where an index lies outside.
pub fn set_elems(run: &mut Derivation, input: &Input) -> Outcome<Value> {
    let last = input.any(input.len().saturating_sub(1));
    match input.any(0) {
        Value::Floats(a) => changed(run, input, &a, &last.to_floats().items, 0.0).map(|a| Value::Floats(Arc::new(a))),
        Value::Bools(a) => changed(run, input, &a, &last.to_bools().items, false).map(|a| Value::Bools(Arc::new(a))),
        Value::Strings(a) => {
            changed(run, input, &a, &last.to_strings().items, "".into()).map(|a| Value::Strings(Arc::new(a)))
        }
        scalar => Ok(scalar),
    }
}

fn changed<T: Clone>(
    run: &mut Derivation,
    input: &Input,
    array: &Array<T>,
    values: &[T],
    default: T,
) -> Outcome<Array<T>> {
    let mut out = array.clone();
    let value = |k: usize| values.get(if values.len() == 1 { 0 } else { k }).cloned();
    let valid = |x: f64| (x >= 0.0).then_some(x as usize);
    if input.len() == 4 {
        if let (Some(r), Some(c), Some(v)) = (valid(input.float(1)), valid(input.float(2)), value(0)) {
            let (rows, columns) = (out.rows.max(r.saturating_add(1)), out.columns.max(c.saturating_add(1)));
            check_size(run, rows.saturating_mul(columns), input.span)?;
            grow(&mut out, rows, columns, &default);
            out.items[r * columns + c] = v;
        }
        return Ok(out);
    }
    for (k, &index) in input.any(1).to_floats().items.iter().enumerate() {
        let (Some(i), Some(v)) = (valid(index), value(k)) else { continue };
        if i >= out.items.len() {
            check_size(run, i.saturating_add(1), input.span)?;
            if out.rows <= 1 {
                grow(&mut out, 1, i + 1, &default);
            } else {
                let (rows, columns) = (i / out.columns + 1, out.columns);
                grow(&mut out, rows, columns, &default);
            }
        }
        out.items[i] = v;
    }
    Ok(out)
}

fn grow<T: Clone>(array: &mut Array<T>, rows: usize, columns: usize, default: &T) {
    let mut items = Vec::with_capacity(rows * columns);
    for r in 0..rows {
        for c in 0..columns {
            let old = r < array.rows && c < array.columns;
            items.push(if old { array.items[r * array.columns + c].clone() } else { default.clone() });
        }
    }
    *array = Array { rows, columns, items };
}
