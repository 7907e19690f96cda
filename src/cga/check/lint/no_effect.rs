//! Operations behind the last shape of a sequence: they change a copy that nothing keeps (reference 2.1). Reports, prints
//! and labels are kept, so they and blocks that hold them are not judged.

use super::super::walk;
use crate::cga::builtins::Operation;
use crate::cga::codes;
use crate::cga::program::{Item, Program, Sequence, Successor};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

pub fn check(program: &Program, diagnostics: &mut Diagnostics) {
    program.rules.iter().for_each(|rule| of_successor(&rule.successor, diagnostics));
}

fn of_successor(successor: &Successor, diagnostics: &mut Diagnostics) {
    match successor {
        Successor::Sequence(sequence) => of_sequence(sequence, diagnostics),
        Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise, .. } => {
            branches.iter().for_each(|(_, body)| of_successor(body, diagnostics));
            of_successor(otherwise, diagnostics);
        }
    }
}

fn of_sequence(sequence: &Sequence, diagnostics: &mut Diagnostics) {
    if !sequence.implicit_leaf {
        let behind = sequence.items.iter().rposition(|item| !only_changes(item)).map_or(0, |last| last + 1);
        if let Some(span) = sequence.items.get(behind).and_then(span) {
            let made = if behind == 0 { "no shape is made here" } else { "the last shape is made before it" };
            let warning = Diagnostic::warning(codes::NO_EFFECT, span, format!("has no effect: {made}"));
            diagnostics.push(warning.help("to keep the changed shape write a symbol behind it, such as `Changed.`"));
        }
    }
    let inside = sequence.items.iter().flat_map(walk::bodies);
    inside.for_each(|body| of_successor(body, diagnostics));
}

/// Whether all an item does is change the current shape.
fn only_changes(item: &Item) -> bool {
    match item {
        Item::Operation { operation, .. } => !leaves_a_trace(*operation),
        Item::Set { .. } => true,
        Item::Modify { .. } | Item::Inline { .. } | Item::Boolean { .. } => {
            // A rule that the block calls may report, so calls are not judged either.
            let mut traces = false;
            let mut look = |item: &Item| match item {
                Item::Operation { operation, .. } => traces |= leaves_a_trace(*operation),
                Item::Call { .. } | Item::Instantiate { .. } => traces = true,
                _ => {}
            };
            walk::bodies(item).into_iter().for_each(|body| walk::items(body, &mut look));
            !traces
        }
        _ => false,
    }
}

fn leaves_a_trace(operation: Operation) -> bool {
    matches!(operation, Operation::Report | Operation::Print | Operation::Label)
}

fn span(item: &Item) -> Option<Span> {
    match item {
        Item::Operation { span, .. } | Item::Set { span, .. } => Some(*span),
        Item::Modify { span, .. } | Item::Inline { span, .. } | Item::Boolean { span, .. } => Some(*span),
        _ => None,
    }
}
