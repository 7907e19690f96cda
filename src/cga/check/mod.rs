//! In: the main rule file. Out: a [`Program`] for one style, or the mistakes that keep it from being one.
//!
//! 1. [`load`] reads and parses the file and its imports.
//! 2. [`instance`] gives every declaration of every import an id and builds the tables of names.
//! 3. [`lower`] resolves bodies against the tables, three times: twice to infer the types of parameters and results,
//!    once to report mistakes and keep what was made.
//! 4. [`order`] sorts the attributes by what they read.

mod annotation_rules;
mod annotations;
mod builtin_call;
mod callable;
mod dynamic;
mod expression;
mod graph;
mod instance;
mod item;
mod load;
mod lower;
mod order;
mod overloads;
mod overrides;
mod selector;
mod style;
mod successor;
#[cfg(test)]
mod tests;
mod types;
mod walk;

use std::path::Path;

use super::program::Program;
use crate::diagnostics::Diagnostics;
use crate::source::{Access, SourceFile, SourceMap};

/// What a program is compiled for.
#[derive(Clone, Debug, Default)]
pub struct CompileOptions {
    /// The style to use; the default style where absent.
    pub style: Option<String>,
}

/// Stack of the compiling thread: room for the deepest tree the parser allows, in any build.
const STACK: usize = 64 << 20;

/// Compiles a rule file with everything it imports. There is a program only if there are no errors.
pub fn compile(
    path: &Path,
    access: &Access,
    sources: &mut SourceMap,
    options: &CompileOptions,
) -> (Option<Program>, Diagnostics) {
    on_big_stack(|| {
        let mut loader = load::Loader::new(Some(access), sources);
        loader.main_file(path, access);
        finish(loader, options)
    })
}

/// Compiles a text that is part of the program; `name` is what messages call it. It cannot import.
pub fn compile_text(
    name: &str,
    text: &str,
    sources: &mut SourceMap,
    options: &CompileOptions,
) -> (Option<Program>, Diagnostics) {
    on_big_stack(|| {
        let mut loader = load::Loader::new(None, sources);
        loader.main_text(name, text);
        finish(loader, options)
    })
}

/// The styles a file declares, in source order, without those of its imports.
pub fn styles(file: &SourceFile) -> Vec<std::sync::Arc<str>> {
    let (ast, _) = on_big_stack(|| super::parse::parse(file));
    let style = |d: super::ast::Declaration| match d.kind {
        super::ast::DeclarationKind::Style(style) => Some(style.name.text),
        _ => None,
    };
    ast.declarations.into_iter().filter_map(style).collect()
}

fn finish(loader: load::Loader<'_>, options: &CompileOptions) -> (Option<Program>, Diagnostics) {
    let load::Loaded { files, mut diagnostics } = loader.finish();
    let broken = diagnostics.has_errors();
    let mut tables = instance::Tables::new(&files);
    tables.instantiate_main(options.style.as_deref());
    let program = lower::lower(tables, &mut diagnostics, broken);
    let diagnostics = diagnostics.sorted();
    (program.filter(|_| !diagnostics.has_errors()), diagnostics)
}

fn on_big_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().name("rules".to_owned()).stack_size(STACK);
        let thread = builder.spawn_scoped(scope, work).expect("the system grants one thread");
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
