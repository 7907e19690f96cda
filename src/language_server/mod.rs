//! The language server: an editor's requests about rule files and recipes → its answers (Language Server Protocol 3.17).
//!
//! In: messages of a client. Out: answers, diagnostics, code lenses. Open documents stand for their files
//! ([`crate::source::Overlay`]), so imports of unsaved libraries are seen. One thread answers; derivations for code
//! lenses run on another one.
//!
//! Semantic tokens have these types: `rule` is told as `class`, `attribute` as `property`, constants as `variable` with
//! `readonly`, functions as `function`, operations as `method`, parameters and locals as `parameter`, keywords that
//! arguments and selectors take as `enumMember`, imports as `namespace`, annotations as `decorator`, then `keyword`,
//! `string`, `number`, `comment`, `operator`. Modifiers: `declaration`, `readonly`, `defaultLibrary` (of the language),
//! `deprecated`.

mod capabilities;
mod context;
mod derivation;
mod describe;
mod documents;
mod manual;
mod position;
mod publish;
mod recipe_context;
mod recipe_file;
mod requests;
mod rule_file;
mod server;
mod symbols;
mod uri;
mod workspace;

pub use server::{Ending, serve};
