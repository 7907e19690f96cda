//! Old forms of operations that still have a name (reference 9). In: an operation with its resolved arguments. Out:
//! a warning with the modern form.

use super::lower::Body;
use crate::cga::builtins::{Operation, Word};
use crate::cga::codes;
use crate::cga::program::{Arg, ExprKind};
use crate::diagnostics::Diagnostic;
use crate::source::Span;

/// Operations that are gone, and what does their work.
pub static REMOVED: &[(&str, &str)] = &[("roof", "roofGable, roofHip, roofPyramid or roofShed")];

impl Body<'_, '_> {
    pub fn deprecated_form(&mut self, operation: Operation, args: &[Arg], span: Span) {
        use Operation as O;
        let word = |i: usize| match args.get(i) {
            Some(Arg::Word(word, _)) => Some(*word),
            _ => None,
        };
        let text = |i: usize| match args.get(i) {
            Some(Arg::Value(_, e)) => match &e.kind {
                ExprKind::String(text) => Some(&**text),
                _ => None,
            },
            _ => None,
        };
        match operation {
            O::InnerRect => self.old_form(span, "`innerRect` is an old name", "innerRectangle(scope) { shape : … }"),
            O::Insert if text(0).is_some_and(|t| t.starts_with("builtin:cube")) => {
                self.old_form(span, "the built-in cube is an old form", "primitiveCube()");
            }
            O::Extrude => {
                use Word as W;
                if let Some(axis) = word(0)
                    && matches!(axis, W::X | W::Y | W::Z | W::WorldX | W::WorldY | W::WorldZ)
                {
                    let message = format!("extruding along `{}` is an old form", axis.text());
                    self.old_form(span, &message, "extrude(world.up, …) or extrude(face.normal, …)");
                }
            }
            O::AlignScopeToGeometry if args.len() == 2 => {
                let modern = match word(1) {
                    Some(Word::Auto) => "alignScopeToGeometry(yUp, any, world.lowest)",
                    _ => "alignScopeToGeometry(yUp, face, 0)",
                };
                self.old_form(span, "`alignScopeToGeometry` with two arguments is an old form", modern);
            }
            O::Envelope if word(0).is_none() && !args.is_empty() => {
                self.old_form(span, "`envelope` without a direction is an old form", "envelope(normal, …)");
            }
            O::SetPivot => match word(0) {
                Some(Word::YUp) => self.old_form(span, "`setPivot(yUp, …)` is an old form", "setPivot(xyz, …)"),
                Some(Word::ZUp) => self.old_form(span, "`setPivot(zUp, …)` is an old form", "setPivot(yzx, …)"),
                _ => {}
            },
            _ => {}
        }
    }

    pub fn old_form(&mut self, span: Span, message: &str, modern: &str) {
        let help = format!("write `{modern}`");
        self.diagnostics.push(Diagnostic::warning(codes::DEPRECATED, span, message).help(help));
    }
}
