//! Render spec: `SourceFile → SpecAst → RenderSpec`.
//!
//! In: the path of a `.render` recipe and values for its inputs. Out: a [`render_spec::RenderSpec`] with every name
//! resolved and every default filled in, or spanned diagnostics. The language is described in `docs/render.md`.

pub mod draw;
pub mod filter;
pub mod render_spec;
