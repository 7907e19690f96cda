//! The tables of the language: every operation, function, attribute, keyword and deprecated name.
//!
//! In: a name as written. Out: its id, its overloads.
//! Signatures are written as in the reference's appendix B: one string per overload, parameters separated by
//! spaces. `F B S` float, bool, string; `F[] B[] S[]` arrays; `A` any array; `X` any value; `F'` takes `'`; `F~`
//! takes `'` or `~`; `{a b}` one of the words; a trailing `?` marks an optional parameter.

mod attribute;
mod function;
mod operation;
mod signature;
pub mod usage;
mod word;

pub use attribute::{Attr, AttrInfo, MapLayer, MapPart, MaterialAttr};
pub use function::Function;
pub use operation::Operation;
pub use signature::{ParameterKind, Signature};
pub use word::Word;
