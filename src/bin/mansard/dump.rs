//! `mansard dump`: looks into a phase.

use std::path::Path;

use mansard::source::SourceMap;
use mansard::{cga, spec};

use crate::args::Phase;
use crate::check::rule_access;
use crate::derive;
use crate::report::{self, Failure};

pub fn run(phase: Phase, file: &Path) -> Result<(), Failure> {
    let is_recipe = file.extension().is_some_and(|e| e == "render");
    let access = rule_access(file, &[])?;
    let mut sources = SourceMap::default();
    let (text, diagnostics) = match (phase, is_recipe) {
        (Phase::Ast, true) => spec::dump_ast(file, &access, &mut sources),
        (Phase::Ast, false) => cga::dump_ast(file, &access, &mut sources),
        (Phase::Program, true) => spec::dump_spec(file, &access, &mut sources),
        (Phase::Program, false) => cga::dump_program(file, &access, &mut sources),
        (Phase::Tree, true) => return Err(Failure::unable("a recipe has no single tree; name a .cga file")),
        (Phase::Tree, false) => return derive::dump(file),
    };
    report::print(&diagnostics, &sources);
    match text {
        Some(text) => {
            print!("{text}");
            Ok(())
        }
        None => Err(Failure::said()),
    }
}
