//! `label` (reference 6.8). In: a name. Out: nothing to see; a first derivation notes a copy of the shape.

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use crate::cga::builtins::Operation;

pub fn apply(run: &mut Derivation, args: &Args, shape: &Shape) {
    let name = args.value(0).map_or_else(|| "".into(), |v| v.to_text());
    if name.is_empty() {
        run.warn("cga::empty-label", args.span, || format!("`{}` needs a name", Operation::Label.name()));
        return;
    }
    run.note_label(shape, name);
}
