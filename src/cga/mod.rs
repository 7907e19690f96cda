//! Rules: `SourceFile → Ast → Program`.
