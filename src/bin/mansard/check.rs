//! `mansard check`: diagnostics of rule files and recipes.

use std::path::{Path, PathBuf};

use mansard::cga;
use mansard::diagnostics::{Diagnostics, json_line};
use mansard::pipeline::{PipelineError, load_recipe};
use mansard::source::{Access, SourceMap};

use crate::args::{Format, RecipeOptions};
use crate::report::{self, Failure};

pub fn run(files: &[PathBuf], format: Format, options: &RecipeOptions) -> Result<(), Failure> {
    let mut sources = SourceMap::default();
    let mut all = Diagnostics::default();
    for file in files {
        all.extend(check(file, options, &mut sources)?);
    }
    let all = all.sorted();
    match format {
        Format::Json => all.iter().for_each(|d| println!("{}", json_line(d, &sources))),
        Format::Text => report::print(&all, &sources),
    }
    if all.has_errors() { Err(Failure::said()) } else { Ok(()) }
}

fn check(file: &Path, options: &RecipeOptions, sources: &mut SourceMap) -> Result<Diagnostics, Failure> {
    match file.extension().and_then(|e| e.to_str()) {
        Some("cga") => {
            let access = rule_access(file, &options.allow)?;
            Ok(cga::compile(file, &access, sources, &cga::CompileOptions::default()).1)
        }
        Some("render") => match load_recipe(file, &options.recipe()?, sources) {
            Ok(recipe) => Ok(recipe.warnings),
            Err(PipelineError::Diagnostics(diagnostics)) => Ok(diagnostics),
            Err(other) => Err(report::failure(other, sources)),
        },
        _ => Err(Failure::unable(format!("{}: neither a .cga nor a .render file", file.display()))),
    }
}

/// A rule file may read from its own folder tree and from what the command line allows.
pub fn rule_access(file: &Path, allow: &[PathBuf]) -> Result<Access, Failure> {
    if !file.is_file() {
        return Err(Failure::wrong(format!("{}: no such file", file.display())));
    }
    let folder = file.parent().unwrap_or(Path::new("."));
    let mut access = Access::new(folder).map_err(|e| Failure::wrong(e.to_string()))?;
    for tree in allow {
        access.allow(tree).map_err(|e| Failure::wrong(e.to_string()))?;
    }
    Ok(access)
}
