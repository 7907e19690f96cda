//! `mansard dump`: looks into a phase.

use std::path::Path;

use mansard::source::SourceMap;
use mansard::{cga, spec};

use crate::args::Phase;
use crate::check::rule_access;
use crate::derive;
use crate::report::{self, Failure};

pub fn run(phase: Phase, file: &Path, quiet: bool) -> Result<(), Failure> {
    let is_recipe = file.extension().is_some_and(|e| e == "render");
    let access = rule_access(file, &[])?;
    let mut sources = SourceMap::default();
    let (text, diagnostics) = match (phase, is_recipe) {
        (Phase::Ast, true) => {
            let text = std::fs::read_to_string(file).map_err(|e| Failure::wrong(format!("{}: {e}", file.display())))?;
            let (text, diagnostics) = spec::dump_ast(&sources.add(file.display().to_string(), text));
            (Some(text), diagnostics)
        }
        (Phase::Program, true) => {
            let (spec, diagnostics) = spec::load(&file.display().to_string(), &access, &mut sources, &[]);
            (spec.map(|spec| format!("{spec:#?}\n")), diagnostics)
        }
        (Phase::Ast, false) => cga::dump_ast(file, &access, &mut sources),
        (Phase::Program, false) => cga::dump_program(file, &access, &mut sources),
        (Phase::Tree, true) => return Err(Failure::unable("a recipe has no single tree; name a .cga file")),
        (Phase::Tree, false) => return derive::dump(file, quiet),
    };
    report::print(&diagnostics, &sources, quiet);
    if let Some(text) = &text {
        report::out(text)?;
    }
    if text.is_none() || diagnostics.has_errors() { Err(Failure::said()) } else { Ok(()) }
}
