//! Rules: `SourceFile → Ast → Program`.

pub mod ast;
pub mod builtins;
pub mod codes;
pub mod parse;
pub mod program;
