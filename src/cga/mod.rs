//! Rules: `SourceFile → Ast → Program`.
//!
//! In: a rule file and what it imports. Out: a checked [`program::Program`], or diagnostics.

pub mod ast;
mod ast_walk;
pub mod builtins;
mod check;
pub mod codes;
pub mod compatibility;
mod dump;
mod format;
pub mod parse;
pub mod program;

pub use check::{CompileOptions, check, compile, compile_text, styles};
pub use check::{Index, IndexedFile, Meaning, Name, annotation_names, index, selector_words};
pub use dump::{dump_ast, dump_program};
pub use format::format;
