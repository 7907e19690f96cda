//! Arguments of an operation. In: evaluated values and words. Out: finite numbers, texts, words by position.

use super::super::derivation::Derivation;
use super::super::expression::Evaluated;
use super::super::value::Value;
use crate::cga::builtins::Word;
use crate::cga::program::Prefix;
use crate::source::Span;

pub struct Args<'a> {
    list: &'a [Evaluated],
    /// The whole operation.
    pub span: Span,
}

impl<'a> Args<'a> {
    pub fn new(list: &'a [Evaluated], span: Span) -> Self {
        Args { list, span }
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn word(&self, i: usize) -> Option<Word> {
        match self.list.get(i)? {
            Evaluated::Word(word) => Some(*word),
            Evaluated::Value(..) => None,
        }
    }

    pub fn value(&self, i: usize) -> Option<&'a Value> {
        match self.list.get(i)? {
            Evaluated::Value(_, value) => Some(value),
            Evaluated::Word(_) => None,
        }
    }

    pub fn prefix(&self, i: usize) -> Prefix {
        match self.list.get(i) {
            Some(Evaluated::Value(prefix, _)) => *prefix,
            _ => Prefix::Absolute,
        }
    }

    /// The number at `i`; NaN and infinity become 0 with a warning; absent is `None`.
    pub fn float(&self, run: &mut Derivation, i: usize) -> Option<f64> {
        Some(run.finite(self.value(i)?.to_float(), self.span))
    }

    pub fn float_or(&self, run: &mut Derivation, i: usize, default: f64) -> f64 {
        self.float(run, i).unwrap_or(default)
    }

    /// A length that may be relative to `extent` (prefix `'`).
    pub fn length(&self, run: &mut Derivation, i: usize, extent: f64) -> f64 {
        let x = self.float_or(run, i, 0.0);
        if self.prefix(i) == Prefix::Relative { x * extent } else { x }
    }

    pub fn bool(&self, i: usize) -> bool {
        self.value(i).is_some_and(Value::to_bool)
    }

    /// The texture set number 0..9; others warn.
    pub fn uv_set(&self, run: &mut Derivation, i: usize) -> Option<u8> {
        let x = self.float_or(run, i, 0.0);
        if x.fract() == 0.0 && (0.0..10.0).contains(&x) {
            return Some(x as u8);
        }
        run.warn("cga::uv-set", self.span, || "texture coordinate sets are numbered 0 to 9".into());
        None
    }
}
