//! What a correct program does in vain. In: a program without errors. Out: warnings; only recursion of functions, which
//! never ends, is an error.
//!
//! Each check is named after the defect it finds and says what it can decide; it is silent about the rest.

mod constant;
mod endless_recursion;
mod never_fits;
mod no_effect;
mod old_versions;
#[cfg(test)]
mod tests;
mod unreachable;
mod unused_rule;

pub use old_versions::release;

use super::instance::Tables;
use super::load::LoadedFile;
use crate::cga::program::Program;
use crate::diagnostics::Diagnostics;

/// All checks, of all files of the program.
pub fn lint(program: &Program, tables: &Tables<'_>, diagnostics: &mut Diagnostics) {
    unused_rule::check(program, tables, diagnostics);
    endless_recursion::check(program, diagnostics);
    unreachable::check(program, tables.files, diagnostics);
    never_fits::check(program, diagnostics);
    no_effect::check(program, diagnostics);
}

/// Changes of meaning that the version of each file is older than; needs no program.
pub fn old_versions(files: &[LoadedFile], diagnostics: &mut Diagnostics) {
    files.iter().for_each(|file| old_versions::check(&file.ast, diagnostics));
}

/// A rule's name as its own file writes it.
fn own_name(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}
