//! `mansard build`: the meshes of a recipe's scenes as binary glTF, and the command line's part of a recipe.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mansard::geodata::ledger::Outcome;
use mansard::output::{OutputError, aside, write_bytes};
use mansard::pipeline::{self, BuiltScene, Checks, Recipe, build_scene, load_recipe};
use mansard::scene::export::to_glb;
use mansard::source::SourceMap;

use crate::args::{RecipeOptions, WorkOptions};
use crate::progress::Reporter;
use crate::report::{self, Failure};
use crate::reports;
use crate::validate;

impl RecipeOptions {
    /// The library's form of these options.
    pub fn recipe(&self) -> Result<pipeline::RecipeOptions, Failure> {
        let argument = |text: &String| match text.split_once('=') {
            Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
            _ => Err(Failure::unable(format!("--set {text}: write NAME=VALUE"))),
        };
        let arguments = self.set.iter().map(argument).collect::<Result<_, _>>()?;
        Ok(pipeline::RecipeOptions { arguments, allow: self.allow.clone(), looked: None })
    }
}

const MOST_THREADS: usize = 1024;

/// Sets the number of threads, once per process.
pub fn use_threads(work: &WorkOptions) -> Result<(), Failure> {
    match work.jobs {
        Some(0) => Err(Failure::unable("--jobs 0: at least one thread is needed")),
        Some(jobs) if jobs > MOST_THREADS => Err(Failure::unable(format!("--jobs {jobs}: at most {MOST_THREADS}"))),
        Some(jobs) => rayon::ThreadPoolBuilder::new()
            .num_threads(jobs)
            .build_global()
            .map_err(|e| Failure::unable(format!("--jobs {jobs}: {e}"))),
        None => Ok(()),
    }
}

/// Reads a recipe and prints its warnings.
pub fn load(path: &Path, options: &RecipeOptions, sources: &mut SourceMap, quiet: bool) -> Result<Recipe, Failure> {
    let recipe = load_recipe(path, &options.recipe()?, sources).map_err(|e| report::failure(e, sources))?;
    report::print(&recipe.warnings, sources, quiet);
    Ok(recipe)
}

pub fn run(
    path: &Path,
    output: &Path,
    reports_file: Option<&PathBuf>,
    checks: Checks,
    options: &RecipeOptions,
    work: &WorkOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    reports::check(reports_file)?;
    use_threads(work)?;
    let mut sources = SourceMap::default();
    let recipe = load(path, options, &mut sources, reporter.is_quiet())?;
    // A file that cannot be written is better told before the work than after it.
    aside(output).map_err(|source| Failure::unable(OutputError::new(output, source).to_string()))?;
    let several = recipe.spec.scenes.len() > 1;
    let mut failed = false;
    let mut all_reports = Vec::new();
    for index in 0..recipe.spec.scenes.len() {
        let built = build_scene(&recipe, index, checks, reporter).map_err(|e| report::failure(e, &sources))?;
        let file = if several { scene_file(output, &built.record.name) } else { output.to_owned() };
        let bytes = to_glb(&built.scene, recipe.attribution()).map_err(|e| Failure::unable(e.to_string()))?;
        write_bytes(&file, &bytes).map_err(|e| Failure::unable(e.to_string()))?;
        failed |= !tell(&built, &sources, reporter);
        if let Some(validation) = &built.validation {
            failed |= !validate::write_and_tell(validation, &file, reporter)?;
        }
        all_reports.push(built.reports);
        reporter.say(&format!("wrote {} ({} bytes)", file.display(), bytes.len()));
    }
    reports::write(reports_file, &all_reports)?;
    if failed { Err(Failure::said()) } else { Ok(()) }
}

fn scene_file(output: &Path, scene: &str) -> PathBuf {
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    output.with_file_name(format!("{stem}-{scene}.glb"))
}

/// Features named for each reason; the manifest names all.
const NAMED: usize = 5;

/// Says what became of the scene's features. False if rules failed: the rest is written all the same.
pub fn tell(built: &BuiltScene, sources: &SourceMap, reporter: &Reporter) -> bool {
    report::print(&built.diagnostics, sources, reporter.is_quiet());
    for line in &built.prints {
        reporter.say(line);
    }
    let ledger = &built.record.ledger;
    let invalid = if ledger.invalid > 0 { format!(", {} invalid", ledger.invalid) } else { String::new() };
    reporter.say(&format!(
        "{:>10} {}: {} ok, {} repaired, {} fell back, {} skipped{invalid}",
        "ledger", built.record.name, ledger.ok, ledger.repaired, ledger.fell_back, ledger.skipped
    ));
    let mut reasons: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for entry in &ledger.entries {
        let reason = match &entry.outcome {
            Outcome::Ok => continue,
            Outcome::Repaired(what) => format!("repaired: {what}"),
            Outcome::FellBack(what) => format!("fell back: {what}"),
            Outcome::Skipped(why) => format!("skipped: {why}"),
            Outcome::Invalid(found) => format!("invalid: {found}"),
        };
        reasons.entry(reason).or_default().push(&entry.feature);
    }
    for (reason, features) in reasons {
        let more = if features.len() > NAMED { ", …" } else { "" };
        let named = features[..features.len().min(NAMED)].join(", ");
        reporter.say(&format!("{:>10} {reason} ({}): {named}{more}", "", features.len()));
    }
    for (what, count) in &ledger.assumptions {
        reporter.say(&format!("{:>10} {what} ({count})", "assumed"));
    }
    reports::tell(&built.reports.totals(), reporter);
    !built.diagnostics.has_errors()
}
