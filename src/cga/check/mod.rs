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
mod deprecated;
mod dynamic;
mod expression;
mod graph;
mod instance;
mod item;
mod lint;
mod load;
mod lower;
mod names;
mod order;
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
pub use annotation_rules::names as annotation_names;
pub use callable::selector_words;
pub use lint::release;
pub use names::{Index, IndexedFile, Meaning, Name, index};

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
    style::names(&ast)
}

/// Every diagnostic of a rule file with everything it imports, in all its styles, each once.
pub fn check(path: &Path, access: &Access, sources: &mut SourceMap) -> Diagnostics {
    on_big_stack(|| {
        let mut loader = load::Loader::new(Some(access), sources);
        loader.main_file(path, access);
        every_style_noting(&loader.finish(), None).1
    })
}

fn finish(loader: load::Loader<'_>, options: &CompileOptions) -> (Option<Program>, Diagnostics) {
    let loaded = loader.finish();
    let (program, diagnostics) = in_style(&loaded, options.style.as_deref(), None);
    let diagnostics = diagnostics.sorted();
    (program.filter(|_| !diagnostics.has_errors()), diagnostics)
}

fn in_style(
    loaded: &load::Loaded,
    style: Option<&str>,
    names: Option<&names::Recorder>,
) -> (Option<Program>, Diagnostics) {
    let mut diagnostics = loaded.diagnostics.clone();
    let broken = diagnostics.has_errors();
    lint::old_versions(&loaded.files, &mut diagnostics);
    let mut tables = instance::Tables::new(&loaded.files);
    tables.names = names.cloned();
    tables.instantiate_main(style);
    let program = lower::lower(tables, &mut diagnostics, broken);
    (program, diagnostics)
}

/// The default style and those of the main file. A rule is unused only if no style that has it uses it. Gives the
/// default style's program, if nothing in it is wrong.
fn every_style_noting(loaded: &load::Loaded, names: Option<&names::Recorder>) -> (Option<Program>, Diagnostics) {
    let styles = loaded.files.first().map_or_else(Vec::new, |file| style::names(&file.ast));
    let (default, of_default) = in_style(loaded, None, names);
    let mut all = of_default.clone();
    let mut found: Vec<(Program, Diagnostics)> = Vec::new();
    for name in styles {
        let (program, diagnostics) = in_style(loaded, Some(&name), names);
        if let (Some(default), Some(program)) = (&default, &program) {
            style::kept_types(default, program, &mut all);
        }
        all.extend(diagnostics.clone());
        found.extend(program.map(|program| (program, diagnostics)));
    }
    found.extend(default.clone().map(|program| (program, of_default)));
    all.retain(|d| {
        let used = |(program, own): &(Program, Diagnostics)| {
            program.rules.iter().any(|rule| rule.span == d.span) && !own.iter().any(|o| o == d)
        };
        d.code != super::codes::UNUSED_RULE || !found.iter().any(used)
    });
    (default, all.sorted())
}

fn on_big_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    std::thread::scope(|scope| {
        let builder = std::thread::Builder::new().name("rules".to_owned()).stack_size(STACK);
        let thread = builder.spawn_scoped(scope, work).expect("the system grants one thread");
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
