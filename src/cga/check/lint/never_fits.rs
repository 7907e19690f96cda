//! Parts of a split that are never made: those of a size of nothing or less, those behind parts that fill the whole
//! length, and those that find no room in a length known from the text (`s` with fixed sizes, an outer split).
//! Decided from literals and constants; a length from an outer split is an upper bound, which is enough.

use super::constant::number;
use crate::cga::builtins::{Attr, Operation};
use crate::cga::codes;
use crate::cga::program::{
    Arg, Axis, Expr, Item, Prefix, Program, Sequence, SetTarget, SplitBlock, SplitItem, SplitKind, Successor,
};
use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::Span;

const EPSILON: f64 = 1e-9;

/// The scope is no larger than this along x, y and z, where anything is known.
type Bounds = [Option<f64>; 3];

const UNKNOWN: Bounds = [None; 3];

struct Search<'s> {
    program: &'s Program,
    diagnostics: &'s mut Diagnostics,
}

pub fn check(program: &Program, diagnostics: &mut Diagnostics) {
    let mut search = Search { program, diagnostics };
    program.rules.iter().for_each(|rule| search.of_successor(&rule.successor, UNKNOWN));
}

fn number_of(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    }
}

impl Search<'_> {
    fn warn(&mut self, span: Span, message: &str) {
        self.diagnostics.push(Diagnostic::warning(codes::NEVER_FITS, span, message));
    }

    fn of_successor(&mut self, successor: &Successor, bounds: Bounds) {
        match successor {
            Successor::Sequence(sequence) => self.of_sequence(sequence, bounds),
            Successor::Case { branches, otherwise } | Successor::Stochastic { branches, otherwise, .. } => {
                branches.iter().for_each(|(_, body)| self.of_successor(body, bounds));
                self.of_successor(otherwise, bounds);
            }
        }
    }

    fn of_sequence(&mut self, sequence: &Sequence, mut bounds: Bounds) {
        for item in &sequence.items {
            match item {
                Item::Operation { operation, args, .. } => self.after_operation(*operation, args, &mut bounds),
                Item::Set { target: SetTarget::Builtin(Attr::ScopeSize(axis)), value, .. } => {
                    bounds[number_of(*axis)] = number(value, self.program).map(f64::abs);
                }
                Item::Set { .. } | Item::Call { .. } | Item::Instantiate { .. } | Item::Leaf { .. } => {}
                Item::Discard => {}
                Item::Group(body) => self.of_successor(body, bounds),
                Item::Split { kind: SplitKind::Scope { axis, .. }, block, .. } => {
                    self.of_block(block, number_of(*axis), bounds);
                }
                Item::Split { block, .. } => self.of_block_of_other_kind(block),
                Item::Comp { .. } | Item::Regions { .. } | Item::Scatter { .. } | Item::PerimeterSplit { .. } => {
                    super::super::walk::bodies(item).into_iter().for_each(|body| self.of_successor(body, UNKNOWN));
                }
                Item::Modify { .. } | Item::Inline { .. } | Item::Boolean { .. } => {
                    super::super::walk::bodies(item).into_iter().for_each(|body| self.of_successor(body, UNKNOWN));
                    bounds = UNKNOWN;
                }
            }
        }
    }

    /// What is known of the scope's size after an operation.
    fn after_operation(&self, operation: Operation, args: &[Arg], bounds: &mut Bounds) {
        use Operation as O;
        match operation {
            O::S => {
                for (bound, arg) in bounds.iter_mut().zip(args) {
                    *bound = match arg {
                        Arg::Value(Prefix::Absolute, e) => number(e, self.program).map(f64::abs),
                        Arg::Value(_, e) => bound.zip(number(e, self.program)).map(|(size, share)| size * share.abs()),
                        _ => None,
                    };
                }
            }
            O::T | O::Center | O::Color | O::Texture | O::SetupProjection | O::ProjectUv | O::Report | O::Print => {}
            O::TileUv | O::ScaleUv | O::TranslateUv | O::RotateUv | O::NormalizeUv => {}
            _ => *bounds = UNKNOWN,
        }
    }

    fn of_block_of_other_kind(&mut self, block: &SplitBlock) {
        for item in &block.items {
            match item {
                SplitItem::Piece { size, body, .. } => {
                    self.of_size(size);
                    self.of_successor(body, UNKNOWN);
                }
                SplitItem::Group(block) => self.of_block_of_other_kind(block),
            }
        }
    }

    /// Whether the size can be more than nothing.
    fn of_size(&mut self, size: &Expr) -> bool {
        let nothing = number(size, self.program).is_some_and(|x| x <= 0.0);
        if nothing {
            self.warn(size.span, "a part of this size is never made");
        }
        !nothing
    }

    fn of_block(&mut self, block: &SplitBlock, axis: usize, bounds: Bounds) {
        let length = bounds[axis];
        let fixed = self.fixed(block, block.items.len());
        for (place, item) in block.items.iter().enumerate() {
            let SplitItem::Piece { prefix, size, body } = item else {
                let SplitItem::Group(inner) = item else { continue };
                self.of_block(inner, axis, bounds);
                continue;
            };
            let before = self.fixed(block, place);
            if self.of_size(size) && !block.repeat {
                if !before.leaves_room(length) {
                    self.warn(size.span, "the parts before it take the whole length: this one is never made");
                } else if *prefix == Prefix::Floating && !fixed.leaves_room(length) {
                    self.warn(size.span, "the fixed parts take the whole length: nothing is left to share");
                }
            }
            let own = match (prefix, number(size, self.program)) {
                (Prefix::Absolute, Some(x)) => Some(length.map_or(x, |length| length.min(x))),
                (Prefix::Relative, Some(x)) => length.map(|length| length * x.min(1.0)),
                _ => length,
            };
            let mut inside = bounds;
            inside[axis] = own;
            self.of_successor(body, inside);
        }
    }

    /// What the fixed parts among the first ones take at least.
    fn fixed(&self, block: &SplitBlock, first: usize) -> Fixed {
        let mut out = Fixed { metres: 0.0, share: 0.0 };
        for item in &block.items[..first] {
            let SplitItem::Piece { prefix, size, .. } = item else { continue };
            let size = number(size, self.program).unwrap_or(0.0).max(0.0);
            match prefix {
                Prefix::Absolute => out.metres += size,
                Prefix::Relative => out.share += size,
                Prefix::Floating => {}
            }
        }
        out
    }
}

/// A length in metres and as a share of the whole.
struct Fixed {
    metres: f64,
    share: f64,
}

impl Fixed {
    /// `length` is an upper bound; a shorter whole has less room.
    fn leaves_room(&self, length: Option<f64>) -> bool {
        let full = self.share >= 1.0 - EPSILON;
        let taken =
            length.is_some_and(|length| self.metres + self.share * length >= length - EPSILON && self.metres > 0.0);
        !(full || taken)
    }
}
