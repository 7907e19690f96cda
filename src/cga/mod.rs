//! Rules: `SourceFile → Ast → Program`.

pub mod builtins;
pub mod program;
