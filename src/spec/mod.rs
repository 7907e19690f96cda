//! Render spec: `SourceFile → SpecAst → RenderSpec`.
