//! Render spec: `SourceFile → SpecAst → RenderSpec`.
//!
//! In: the path of a `.render` recipe and values for its inputs. Out: a [`RenderSpec`] with every name resolved and
//! every default filled in, or spanned diagnostics. The language is described in `docs/render.md`.

pub mod ast;
mod check;
pub mod draw;
pub mod effects;
mod expression;
pub mod filter;
mod inherit;
mod inputs;
pub mod parse;
mod properties;
mod read;
pub mod render_spec;
pub mod schema;
mod units;

pub use check::PRESETS;

use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::source::{Access, SourceFile, SourceMap, Span};
use inputs::Unbound;
use render_spec::RenderSpec;

/// Reads and checks the recipe at `path` with the files that it uses; `arguments` are the command line's
/// `--set name=value`. `None` exactly if there are errors.
pub fn load(
    path: &str,
    access: &Access,
    sources: &mut SourceMap,
    arguments: &[(String, String)],
) -> (Option<RenderSpec>, Diagnostics) {
    let (spec, mut diagnostics) = analyse(path, access, sources, arguments, Unbound::Error);
    let Some(spec) = spec.filter(|_| !diagnostics.has_errors()) else {
        return (None, diagnostics.sorted());
    };
    if spec.scenes.is_empty() {
        let recipe = sources.files().iter().find(|file| &*file.name == path).expect("the recipe was read");
        let message = "the recipe has no `scene`";
        diagnostics.push(Diagnostic::error("spec::missing-block", Span::new(recipe.id, 0, 0), message));
        return (None, diagnostics.sorted());
    }
    (Some(spec), diagnostics.sorted())
}

/// Checks a recipe, or a file of shared blocks, whose inputs need not be given.
pub fn check(path: &str, access: &Access, sources: &mut SourceMap, arguments: &[(String, String)]) -> Diagnostics {
    analyse(path, access, sources, arguments, Unbound::Allowed).1.sorted()
}

/// The recipe's tree as canonical recipe text, and its syntax mistakes.
pub fn dump_ast(file: &SourceFile) -> (String, Diagnostics) {
    let (ast, diagnostics) = parse::parse(file);
    (ast.to_string(), diagnostics.sorted())
}

/// All phases of the recipe.
fn analyse(
    path: &str,
    access: &Access,
    sources: &mut SourceMap,
    arguments: &[(String, String)],
    unbound: Unbound,
) -> (Option<RenderSpec>, Diagnostics) {
    let mut diagnostics = Diagnostics::default();
    let mut recipe = read::read(path, access, sources, &mut diagnostics);
    inputs::bind(&mut recipe, arguments, unbound, sources, &mut diagnostics);
    let blocks = inherit::resolve(recipe.blocks, &mut diagnostics);
    let (spec, found) = check::check(&blocks, &recipe.folders);
    diagnostics.extend(found);
    (spec, diagnostics)
}

#[cfg(test)]
mod tests;
