//! `setMaterial` (reference 4.17). In: names and values of material attributes, in a row or in two columns. Out: the
//! shape's material, as by `set` for each. Names and values that are none warn and change nothing.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::super::value::Value;
use super::args::Args;
use super::set;
use crate::cga::builtins::Attr;
use crate::cga::program::Type;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let Some(Value::Strings(array)) = args.value(0) else { return };
    if array.columns != 2 && array.rows > 1 || array.items.len() % 2 == 1 {
        let (rows, columns) = (array.rows, array.columns);
        run.warn("cga::material-pairs", args.span, || {
            format!("names and values were expected in pairs, not an array of {rows} x {columns}")
        });
        return;
    }
    for pair in array.items.chunks_exact(2) {
        let name = pair[0].strip_prefix("material.").unwrap_or(&pair[0]);
        let Some(row) = Attr::from_name(&format!("material.{name}")) else {
            run.warn("cga::material-pairs", args.span, || format!("`{name:.80}` is no material attribute"));
            continue;
        };
        let value = Value::String(pair[1].clone()).converted(row.kind);
        if row.kind == Type::Float && !value.to_float().is_finite() {
            run.warn("cga::material-pairs", args.span, || format!("`{:.80}` is no value of `{name}`", pair[1]));
            continue;
        }
        set(run, row.attr, value, args.span, shape);
    }
}
