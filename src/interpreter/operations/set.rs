//! `set` of built-in attributes. In: an attribute and a value. Out: the shape changed; numbers that are not finite
//! become 0 with a warning.

use super::super::attribute;
use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::super::value::Value;
use crate::cga::builtins::{Attr, MapPart, MaterialAttr};
use crate::source::Span;

pub fn set(run: &mut Derivation, attr: Attr, value: Value, span: Span, shape: &mut Shape) {
    let value = match value {
        Value::Float(x) => Value::Float(run.finite(x, span)),
        Value::String(path) if matches!(attr, Attr::Material(MaterialAttr::Map(_, MapPart::Path))) => {
            Value::String(super::appearance::texture_path(run, &path, span))
        }
        other => other,
    };
    attribute::write(run, attr, value, shape);
}
