//! In: the built-ins a program calls. Out: what it asks of other start shapes and of its host, known before it runs.

use super::Arg;
use crate::cga::builtins::{Function, Operation, Word};

/// A program that needs nothing is derived once and alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Queries about shapes of its own start shape (target `intra` or `all`).
    pub own: bool,
    /// Occlusion queries about other start shapes within reach.
    pub near: bool,
    /// Queries about labelled shapes of any start shape.
    pub far: bool,
    /// It labels shapes for others to meet.
    pub labels: bool,
    /// Trim planes of face shapes: it inserts geometry or trims.
    pub trims: bool,
    /// Data of the initial shape's edges: streets and edge attributes.
    pub edges: bool,
}

impl Needs {
    /// Whether it asks about shapes at all.
    pub fn asks(self) -> bool {
        self.own || self.near || self.far
    }

    /// Adds what a call needs.
    pub fn with_call(mut self, function: Function, args: &[Arg]) -> Needs {
        use Function as F;
        let occlusion = matches!(function, F::Inside | F::Overlaps | F::Touches);
        let context = matches!(function, F::MinimumDistance | F::ContextCount | F::ContextCompare);
        if occlusion || context {
            let target = match args.first() {
                Some(Arg::Word(word, _)) => *word,
                // Left out, or known only when running.
                _ => Word::All,
            };
            self.own |= target != Word::Inter;
            self.near |= occlusion && target != Word::Intra;
            self.far |= context && target != Word::Intra;
        }
        self.edges |= matches!(function, F::EdgeAttrGetFloat | F::EdgeAttrGetString | F::EdgeAttrGetBool);
        args.iter().fold(self, |needs, arg| match arg {
            Arg::Word(word, _) => needs.with_word(*word),
            Arg::Value(..) | Arg::ComputedWord(_) => needs,
        })
    }

    /// Adds what an operation needs or gives.
    pub fn with_operation(mut self, operation: Operation) -> Needs {
        self.labels |= operation == Operation::Label;
        self.trims |= operation.inserts() || operation == Operation::Trim;
        self.edges |= operation == Operation::SetTagsFromEdgeAttrs;
        self
    }

    /// Adds what a selector word needs.
    pub fn with_word(mut self, word: Word) -> Needs {
        use Word as W;
        self.edges |= matches!(
            word,
            W::StreetFront
                | W::StreetBack
                | W::StreetLeft
                | W::StreetRight
                | W::StreetSide
                | W::LegacyStreetSide
                | W::LegacyNoStreetSide
        );
        self
    }
}
