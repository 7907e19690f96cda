//! `edgeAttr.getFloat`, `getString`, `getBool` (reference 6.9): what the host says about the edge of the initial shape
//! that the current geometry lies along.

use super::super::derivation::Derivation;
use super::super::host::EdgeValues;
use super::super::shape::Shape;
use super::super::value::Value;
use super::Input;
use crate::cga::builtins::Function as F;

/// The value at the edge covered most; 0, "" or false where the attribute is missing or of another type.
pub fn call(run: &Derivation, function: F, input: &Input, shape: &Shape) -> Option<Value> {
    let default = match function {
        F::EdgeAttrGetFloat => Value::Float(0.0),
        F::EdgeAttrGetString => Value::text(""),
        F::EdgeAttrGetBool => Value::Bool(false),
        _ => return None,
    };
    let name = input.text(0);
    let name = name.strip_prefix("/edgeattr/").unwrap_or(&name);
    let attribute = run.start.host.edge_attributes.iter().find(|a| &*a.name == name);
    let value = attribute.and_then(|a| at(&a.values, run.outline.as_ref()?.covered_most(&shape.world_form())?));
    Some(value.filter(|v| v.kind() == default.kind()).unwrap_or(default))
}

/// The element of an edge.
pub fn at(values: &EdgeValues, edge: usize) -> Option<Value> {
    match values {
        EdgeValues::Floats(list) => list.get(edge).map(|x| Value::Float(*x)),
        EdgeValues::Bools(list) => list.get(edge).map(|b| Value::Bool(*b)),
        EdgeValues::Strings(list) => list.get(edge).map(|s| Value::String(s.clone())),
    }
}
