//! `report` and `print` (reference 4.17). In: a key and a value. Out: statistics and printed lines of the run.

use super::super::derivation::Derivation;
use super::super::limits::Outcome;
use super::super::value::Value;
use super::args::Args;

/// Adds a value to a report (see [`super::super::reports`]).
pub fn report(run: &mut Derivation, args: &Args) {
    let (Some(key), Some(value)) = (args.value(0), args.value(1)) else { return };
    let x = match value {
        Value::Float(x) => run.finite(*x, args.span),
        Value::Bool(_) => value.to_float(),
        _ => Some(value.to_float()).filter(|x| x.is_finite()).unwrap_or(0.0),
    };
    run.reports.add(key.to_text(), value, x);
}

pub fn print(run: &mut Derivation, args: &Args) -> Outcome<()> {
    let text = args.value(0).map_or_else(|| "".into(), Value::to_text);
    run.print(&text, args.span)
}
