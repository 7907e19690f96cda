//! Values of the rule language. In: literals and results. Out: conversions and the text forms of reference 6.3.

use std::sync::Arc;

use super::tree::Scalar;
use crate::cga::program::Type;

/// A value: three scalars and their two-dimensional arrays (reference 1.6).
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    Float(f64),
    Bool(bool),
    String(Arc<str>),
    Floats(Arc<Array<f64>>),
    Bools(Arc<Array<bool>>),
    Strings(Arc<Array<Arc<str>>>),
}

/// Rows times columns, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Array<T> {
    pub rows: usize,
    pub columns: usize,
    pub items: Vec<T>,
}

impl<T> Array<T> {
    /// A 1 x n array.
    pub fn row(items: Vec<T>) -> Self {
        Array { rows: usize::from(!items.is_empty()), columns: items.len(), items }
    }

    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Array<U> {
        Array { rows: self.rows, columns: self.columns, items: self.items.iter().map(f).collect() }
    }
}

/// The marker of a missing string (reference 1.5).
pub const NULL_STRING: &str = "\u{e000}";

impl Value {
    pub fn text(s: impl Into<Arc<str>>) -> Value {
        Value::String(s.into())
    }

    pub fn floats(items: Vec<f64>) -> Value {
        Value::Floats(Arc::new(Array::row(items)))
    }

    pub fn bools(items: Vec<bool>) -> Value {
        Value::Bools(Arc::new(Array::row(items)))
    }

    pub fn strings(items: Vec<Arc<str>>) -> Value {
        Value::Strings(Arc::new(Array::row(items)))
    }

    pub fn kind(&self) -> Type {
        match self {
            Value::Float(_) => Type::Float,
            Value::Bool(_) => Type::Bool,
            Value::String(_) => Type::String,
            Value::Floats(_) => Type::Floats,
            Value::Bools(_) => Type::Bools,
            Value::Strings(_) => Type::Strings,
        }
    }

    /// What an absent value of a type reads as (reference 6.10, out of range).
    pub fn default_of(kind: Type) -> Value {
        match kind {
            Type::Float => Value::Float(0.0),
            Type::Bool => Value::Bool(false),
            Type::String => Value::text(""),
            Type::Floats => Value::floats(Vec::new()),
            Type::Bools => Value::bools(Vec::new()),
            Type::Strings => Value::strings(Vec::new()),
        }
    }

    /// `float(x)` of reference 6.3; an array gives its first element.
    pub fn to_float(&self) -> f64 {
        match self {
            Value::Float(x) => *x,
            Value::Bool(b) => f64::from(u8::from(*b)),
            Value::String(s) => number_prefix(s),
            Value::Floats(a) => a.items.first().copied().unwrap_or(0.0),
            Value::Bools(a) => a.items.first().map_or(0.0, |&b| f64::from(u8::from(b))),
            Value::Strings(a) => a.items.first().map_or(0.0, |s| number_prefix(s)),
        }
    }

    /// `bool(x)` of reference 6.3; an array gives its first element.
    pub fn to_bool(&self) -> bool {
        match self {
            Value::Float(x) => *x != 0.0,
            Value::Bool(b) => *b,
            Value::String(s) => text_is_true(s),
            Value::Floats(a) => a.items.first().is_some_and(|x| *x != 0.0),
            Value::Bools(a) => a.items.first().copied().unwrap_or(false),
            Value::Strings(a) => a.items.first().is_some_and(|s| text_is_true(s)),
        }
    }

    /// `str(x)` of reference 6.3.
    pub fn to_text(&self) -> Arc<str> {
        match self {
            Value::Float(x) => format_float(*x).into(),
            Value::Bool(b) => bool_text(*b).into(),
            Value::String(s) => s.clone(),
            Value::Floats(a) => array_text(&a.map(|x| format_float(*x))).into(),
            Value::Bools(a) => array_text(&a.map(|b| bool_text(*b).to_owned())).into(),
            Value::Strings(a) => array_text(&a.map(|s| s.to_string())).into(),
        }
    }

    /// Number of elements; 1 for a scalar.
    pub fn len(&self) -> usize {
        match self {
            Value::Floats(a) => a.items.len(),
            Value::Bools(a) => a.items.len(),
            Value::Strings(a) => a.items.len(),
            _ => 1,
        }
    }

    /// Rows and columns; 1 x 1 for a scalar.
    pub fn dimensions(&self) -> (usize, usize) {
        match self {
            Value::Floats(a) => (a.rows, a.columns),
            Value::Bools(a) => (a.rows, a.columns),
            Value::Strings(a) => (a.rows, a.columns),
            _ => (1, 1),
        }
    }

    /// This value as one of a type: exact matches pass, others go by `float`, `bool`, `str` (reference 8, A49).
    pub fn converted(&self, kind: Type) -> Value {
        if self.kind() == kind {
            return self.clone();
        }
        match kind {
            Type::Float => Value::Float(self.to_float()),
            Type::Bool => Value::Bool(self.to_bool()),
            Type::String => Value::String(self.to_text()),
            Type::Floats => Value::Floats(self.to_floats()),
            Type::Bools => Value::Bools(self.to_bools()),
            Type::Strings => Value::Strings(self.to_strings()),
        }
    }

    pub fn to_floats(&self) -> Arc<Array<f64>> {
        match self {
            Value::Floats(a) => a.clone(),
            Value::Bools(a) => Arc::new(a.map(|&b| f64::from(u8::from(b)))),
            Value::Strings(a) => Arc::new(a.map(|s| number_prefix(s))),
            scalar => Arc::new(Array::row(vec![scalar.to_float()])),
        }
    }

    pub fn to_bools(&self) -> Arc<Array<bool>> {
        match self {
            Value::Bools(a) => a.clone(),
            Value::Floats(a) => Arc::new(a.map(|&x| x != 0.0)),
            Value::Strings(a) => Arc::new(a.map(|s| text_is_true(s))),
            scalar => Arc::new(Array::row(vec![scalar.to_bool()])),
        }
    }

    pub fn to_strings(&self) -> Arc<Array<Arc<str>>> {
        match self {
            Value::Strings(a) => a.clone(),
            Value::Floats(a) => Arc::new(a.map(|&x| format_float(x).into())),
            Value::Bools(a) => Arc::new(a.map(|&b| bool_text(b).into())),
            scalar => Arc::new(Array::row(vec![scalar.to_text()])),
        }
    }

    /// How the value leaves the interpreter; arrays leave as their text.
    pub fn to_scalar(&self) -> Scalar {
        match self {
            Value::Float(x) => Scalar::Float(*x),
            Value::Bool(b) => Scalar::Bool(*b),
            other => Scalar::String(other.to_text()),
        }
    }
}

impl From<&Scalar> for Value {
    fn from(scalar: &Scalar) -> Value {
        match scalar {
            Scalar::Float(x) => Value::Float(*x),
            Scalar::Bool(b) => Value::Bool(*b),
            Scalar::String(s) => Value::String(s.clone()),
        }
    }
}

fn bool_text(b: bool) -> &'static str {
    if b { "true" } else { "false" }
}

fn text_is_true(s: &str) -> bool {
    let lower = s.trim().to_ascii_lowercase();
    let zero = lower.parse::<f64>().is_ok_and(|x| x == 0.0);
    !(lower.is_empty() || lower == "f" || lower == "false" || zero)
}

/// The longest prefix that is a number (after white space), else NaN.
fn number_prefix(s: &str) -> f64 {
    let s = s.trim_start();
    let end = s.find(|c: char| !(c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E'))).unwrap_or(s.len());
    (1..=end).rev().find_map(|n| s.get(..n)?.parse::<f64>().ok()).unwrap_or(f64::NAN)
}

/// At most 15 significant digits, no trailing zeros, integers without a point (reference 6.3; C's `%.15g`).
pub fn format_float(x: f64) -> String {
    if x.is_nan() {
        return "nan".into();
    }
    if x.is_infinite() {
        return if x > 0.0 { "inf".into() } else { "-inf".into() };
    }
    if x == 0.0 {
        return "0".into();
    }
    let scientific = format!("{x:.14e}");
    let (mantissa, exponent) = scientific.split_once('e').expect("{:e} writes an exponent");
    let exponent: i32 = exponent.parse().expect("{:e} writes an integer exponent");
    if !(-5..15).contains(&exponent) {
        let sign = if exponent < 0 { '-' } else { '+' };
        return format!("{}e{sign}{:02}", trim_zeros(mantissa), exponent.abs());
    }
    trim_zeros(&format!("{x:.*}", (14 - exponent).max(0) as usize)).to_owned()
}

fn trim_zeros(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// `(3)[a,b,c]`, `(0)[]`, or `(RxC)` with a line per row, columns right-aligned, three spaces apart.
fn array_text(cells: &Array<String>) -> String {
    if cells.rows <= 1 {
        return format!("({})[{}]", cells.items.len(), cells.items.join(","));
    }
    let width = |c: usize| (0..cells.rows).map(|r| cells.items[r * cells.columns + c].chars().count()).max();
    let widths: Vec<usize> = (0..cells.columns).map(|c| width(c).unwrap_or(0)).collect();
    let mut out = format!("({}x{})", cells.rows, cells.columns);
    for row in cells.items.chunks(cells.columns.max(1)) {
        let line: Vec<String> = row.iter().zip(&widths).map(|(cell, &w)| format!("{cell:>w$}")).collect();
        out.push('\n');
        out.push_str(&line.join("   "));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_the_reference_shows() {
        let cases = [
            (1.0 / 3.0, "0.333333333333333"),
            (1.5, "1.5"),
            (-7.0, "-7"),
            (1e21, "1e+21"),
            (1e-7, "1e-07"),
            (0.1 + 0.2, "0.3"),
            (123456789.25, "123456789.25"),
            (-0.0, "0"),
            (1e15, "1e+15"),
            (1e14, "100000000000000"),
        ];
        for (x, text) in cases {
            assert_eq!(format_float(x), text);
        }
    }

    #[test]
    fn texts_become_numbers_and_truths() {
        for (text, x) in [("12px", 12.0), ("4-1", 4.0), ("007.25", 7.25), ("-2e1x", -20.0), ("1e", 1.0)] {
            assert_eq!(Value::text(text).to_float(), x, "{text}");
        }
        assert!(Value::text("px").to_float().is_nan());
        for (text, truth) in [("f", false), ("no", true), ("FALSE", false), ("0.0", false), ("", false), ("2", true)] {
            assert_eq!(Value::text(text).to_bool(), truth, "{text}");
        }
    }

    #[test]
    fn arrays_are_written_in_rows() {
        assert_eq!(&*Value::floats(vec![1.0, 2.5]).to_text(), "(2)[1,2.5]");
        assert_eq!(&*Value::floats(vec![]).to_text(), "(0)[]");
        let table = Array { rows: 2, columns: 2, items: vec![1.0, 10.0, 200.0, 3.0] };
        assert_eq!(&*Value::Floats(Arc::new(table)).to_text(), "(2x2)\n  1   10\n200    3");
    }
}
