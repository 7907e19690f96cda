//! What both languages share about pest: decoding, spans, depth, error wording.
//!
//! In: bytes of a file, pest pairs and errors. Out: text, [`Span`]s, and syntax diagnostics that say what was
//! expected and what was found.

mod decode;
mod error;

use pest::RuleType;
use pest::iterators::Pair;

use crate::source::{SourceId, Span};

pub use decode::{Decoded, decode};
pub use error::{Expected, Wording, expected, syntax_error};

/// Where pairs of one parse lie: pest counts from the start of the slice it was given.
#[derive(Clone, Copy, Debug)]
pub struct Origin {
    pub source: SourceId,
    /// Byte offset of the slice in the file.
    pub offset: usize,
}

impl Origin {
    /// The span of a pair without trailing white space.
    pub fn span<R: RuleType>(self, pair: &Pair<'_, R>) -> Span {
        let start = self.offset + pair.as_span().start();
        Span::new(self.source, start, start + pair.as_str().trim_end().len())
    }
}
