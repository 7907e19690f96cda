//! Text and where it came from; the only door for reading files.
//!
//! In: paths named by the user or by another file. Out: [`SourceFile`]s with stable ids, bytes, and the
//! [`Access`] rule that keeps every path inside the allowed folders.

mod access;
mod looked;
mod map;
mod project;

pub use access::{Access, AccessError, MOST_TEXT_BYTES, Overlay, read_regular};
pub use looked::Looked;
pub use map::{Place, SourceFile, SourceId, SourceMap, Span};
pub use project::Project;
