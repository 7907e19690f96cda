//! `mansard check`: diagnostics of rule files and recipes.

use std::path::{Path, PathBuf};

use mansard::diagnostics::{Diagnostics, json_line, short_line};
use mansard::pipeline::{PipelineError, load_recipe};
use mansard::source::{Access, Project, SourceMap};
use mansard::{cga, spec};

use crate::args::{Format, RecipeOptions};
use crate::report::{self, Failure};

/// Checks every file, whatever is wrong with the others.
pub fn run(files: &[PathBuf], format: Format, options: &RecipeOptions, quiet: bool) -> Result<(), Failure> {
    let mut sources = SourceMap::default();
    let mut all = Diagnostics::default();
    let mut unread: Option<u8> = None;
    for file in files {
        match check(file, options, &mut sources) {
            Ok(found) => all.extend(found),
            Err(failure) => {
                unread = unread.max(Some(failure.code));
                failure.tell();
            }
        }
    }
    let all = all.sorted();
    match format {
        Format::Json => report::out(&all.iter().map(|d| json_line(d, &sources) + "\n").collect::<String>())?,
        Format::Short => report::out(&all.iter().map(|d| short_line(d, &sources) + "\n").collect::<String>())?,
        Format::Text => report::print(&all, &sources, quiet),
    }
    match unread {
        Some(code) => Err(Failure { code, message: None }),
        None if all.has_errors() => Err(Failure::said()),
        None => Ok(()),
    }
}

fn check(file: &Path, options: &RecipeOptions, sources: &mut SourceMap) -> Result<Diagnostics, Failure> {
    match file.extension().and_then(|e| e.to_str()) {
        Some("cga") => {
            let access = rule_access(file, &options.allow)?;
            Ok(cga::check(file, &access, sources))
        }
        Some("render") => check_recipe(file, options, sources),
        _ => Err(Failure::unable(format!("{}: neither a .cga nor a .render file", file.display()))),
    }
}

/// A recipe whose inputs are not given, or a file of shared blocks, is checked as far as it goes by itself.
fn check_recipe(file: &Path, options: &RecipeOptions, sources: &mut SourceMap) -> Result<Diagnostics, Failure> {
    let options = options.recipe()?;
    let incomplete = |d: &Diagnostics| {
        d.iter().all(|d| matches!(d.code, "spec::missing-input" | "spec::missing-block")) && d.has_errors()
    };
    match load_recipe(file, &options, sources) {
        Ok(recipe) => Ok(recipe.warnings),
        Err(PipelineError::Diagnostics(diagnostics)) if incomplete(&diagnostics) => {
            let access = rule_access(file, &options.allow)?;
            Ok(spec::check(&file.display().to_string(), &access, sources, &options.arguments))
        }
        Err(PipelineError::Diagnostics(diagnostics)) => Ok(diagnostics),
        Err(other) => Err(report::failure(other, sources)),
    }
}

/// A rule file may read from its project and from what the command line allows.
pub fn rule_access(file: &Path, allow: &[PathBuf]) -> Result<Access, Failure> {
    if !file.is_file() {
        return Err(Failure::wrong(format!("{}: no such file", file.display())));
    }
    let folder = file.parent().unwrap_or(Path::new("."));
    let mut access = Access::new(Project::of(folder).tree()).map_err(|e| Failure::wrong(e.to_string()))?;
    for tree in allow {
        access.allow(tree).map_err(|e| Failure::wrong(e.to_string()))?;
    }
    Ok(access)
}
