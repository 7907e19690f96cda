//! Arrays. In: the elements and indices of an expression. Out: arrays built and indexed as reference 1.7 and 6.10 say.

use std::sync::Arc;

use super::derivation::Derivation;
use super::environment::Env;
use super::limits::{Outcome, Stop};
use super::value::{Array, Value};
use crate::cga::program::{Expr, Type};
use crate::source::Span;

/// `[a, b; c, d]`: elements may be arrays, which are joined, not nested.
pub fn construct<'p>(run: &mut Derivation<'p>, rows: &'p [Vec<Expr>], span: Span, env: &Env) -> Outcome<Value> {
    let mut values = Vec::with_capacity(rows.len());
    for row in rows {
        let elements = row.iter().map(|e| run.eval(e, env)).collect::<Outcome<Vec<_>>>()?;
        values.push(elements);
    }
    let total: usize = values.iter().flatten().map(Value::len).sum();
    check_size(run, total, span)?;
    let kind = values.iter().flatten().map(Value::kind).next().unwrap_or(Type::Floats);
    let joined = match kind {
        Type::Float | Type::Floats => stack(&values, Value::to_floats).map(|a| Value::Floats(Arc::new(a))),
        Type::Bool | Type::Bools => stack(&values, Value::to_bools).map(|a| Value::Bools(Arc::new(a))),
        Type::String | Type::Strings => stack(&values, Value::to_strings).map(|a| Value::Strings(Arc::new(a))),
    };
    joined.ok_or_else(|| {
        run.error("cga::array-dimensions", span, "the parts of this array do not fit together".into());
        Stop
    })
}

/// Joins parts side by side (equal rows) and the rows one below the other (equal columns). Empty parts vanish.
fn stack<T: Clone>(rows: &[Vec<Value>], read: fn(&Value) -> Arc<Array<T>>) -> Option<Array<T>> {
    let mut out: Option<Array<T>> = None;
    for row in rows {
        let parts: Vec<Arc<Array<T>>> = row.iter().map(read).filter(|a| !a.items.is_empty()).collect();
        let Some(height) = parts.first().map(|a| a.rows) else { continue };
        if parts.iter().any(|a| a.rows != height) {
            return None;
        }
        let mut items = Vec::new();
        for r in 0..height {
            for part in &parts {
                items.extend_from_slice(&part.items[r * part.columns..(r + 1) * part.columns]);
            }
        }
        let columns = parts.iter().map(|a| a.columns).sum();
        match &mut out {
            None => out = Some(Array { rows: height, columns, items }),
            Some(above) if above.columns == columns => {
                above.rows += height;
                above.items.extend(items);
            }
            Some(_) => return None,
        }
    }
    Some(out.unwrap_or(Array::row(Vec::new())))
}

/// `from : step : to`: element i is `from + i step`; empty if the step is 0 or points away.
pub fn range<'p>(
    run: &mut Derivation<'p>,
    from: &'p Expr,
    step: Option<&'p Expr>,
    to: &'p Expr,
    env: &Env,
) -> Outcome<Value> {
    let first = run.eval_finite(from, env)?;
    let step = step.map_or(Ok(1.0), |s| run.eval_finite(s, env))?;
    let last = run.eval_finite(to, env)?;
    let count = (last - first) / step;
    if step == 0.0 || !count.is_finite() || count < 0.0 {
        return Ok(Value::floats(Vec::new()));
    }
    let count = (count + 1e-9).floor();
    check_size(run, count as usize, from.span)?;
    Ok(Value::floats((0..=count as u64).map(|i| first + i as f64 * step).collect()))
}

/// Refuses arrays beyond the limit.
pub fn check_size(run: &mut Derivation, size: usize, span: Span) -> Outcome<()> {
    if size <= run.limits.max_array {
        return Ok(());
    }
    let limit = run.limits.max_array;
    run.error("cga::limit-array", span, format!("an array of {size} elements passes the limit of {limit}"));
    Err(Stop)
}

/// Indices along one dimension.
enum Picks {
    One(f64),
    Many { rows: usize, columns: usize, at: Vec<f64> },
}

impl Picks {
    fn of(value: &Value) -> Picks {
        match value {
            Value::Floats(a) => Picks::Many { rows: a.rows, columns: a.columns, at: a.items.clone() },
            Value::Bools(a) => {
                let chosen = a.items.iter().enumerate().filter(|(_, chosen)| **chosen);
                let at: Vec<f64> = chosen.map(|(i, _)| i as f64).collect();
                Picks::Many { rows: usize::from(!at.is_empty()), columns: at.len(), at }
            }
            other => Picks::One(other.to_float()),
        }
    }

    fn list(&self) -> Vec<f64> {
        match self {
            Picks::One(i) => vec![*i],
            Picks::Many { at, .. } => at.clone(),
        }
    }
}

/// `array[row]` (linear, row by row) or `array[row, column]`; out of range gives the default value.
pub fn index<'p>(
    run: &mut Derivation<'p>,
    array: &'p Expr,
    row: &'p Expr,
    column: Option<&'p Expr>,
    env: &Env,
) -> Outcome<Value> {
    let value = run.eval(array, env)?;
    let row = Picks::of(&run.eval(row, env)?);
    let column = column.map(|c| run.eval(c, env)).transpose()?.map(|v| Picks::of(&v));
    let size = row.list().len() * column.as_ref().map_or(1, |c| c.list().len());
    check_size(run, size, array.span)?;
    Ok(match &value {
        Value::Floats(a) => pick(a, &row, column.as_ref(), 0.0, Value::Float, Value::Floats),
        Value::Bools(a) => pick(a, &row, column.as_ref(), false, Value::Bool, Value::Bools),
        Value::Strings(a) => pick(a, &row, column.as_ref(), "".into(), Value::String, Value::Strings),
        scalar => scalar.clone(),
    })
}

fn pick<T: Clone>(
    array: &Array<T>,
    row: &Picks,
    column: Option<&Picks>,
    missing: T,
    scalar: fn(T) -> Value,
    many: fn(Arc<Array<T>>) -> Value,
) -> Value {
    let item = |i: f64| place(i, array.items.len()).map_or(missing.clone(), |i| array.items[i].clone());
    let Some(column) = column else {
        return match row {
            Picks::One(i) => scalar(item(*i)),
            Picks::Many { rows, columns, at } => {
                let items = at.iter().map(|&i| item(i)).collect();
                many(Arc::new(Array { rows: *rows, columns: *columns, items }))
            }
        };
    };
    let cell = |r: f64, c: f64| match (place(r, array.rows), place(c, array.columns)) {
        (Some(r), Some(c)) => array.items[r * array.columns + c].clone(),
        _ => missing.clone(),
    };
    if let (Picks::One(r), Picks::One(c)) = (row, column) {
        return scalar(cell(*r, *c));
    }
    let (rows, columns) = (row.list(), column.list());
    let items = rows.iter().flat_map(|&r| columns.iter().map(move |&c| (r, c))).map(|(r, c)| cell(r, c)).collect();
    many(Arc::new(Array { rows: rows.len(), columns: columns.len(), items }))
}

/// The element a float index names.
fn place(index: f64, length: usize) -> Option<usize> {
    let rounded = libm::rint(index);
    (rounded >= 0.0 && rounded < length as f64).then_some(rounded as usize)
}
