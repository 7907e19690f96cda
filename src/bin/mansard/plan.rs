//! `mansard plan`: what a recipe will derive and draw, what not, and why.

use std::path::Path;

use mansard::pipeline::plan_views;
use mansard::source::SourceMap;

use crate::args::{PlanFormat, RecipeOptions, WorkOptions};
use crate::build::{load, use_threads};
use crate::progress::Reporter;
use crate::report::{self, Failure};

pub fn run(
    path: &Path,
    format: PlanFormat,
    options: &RecipeOptions,
    work: &WorkOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    use_threads(work)?;
    let mut sources = SourceMap::default();
    let recipe = load(path, options, &mut sources, reporter.is_quiet())?;
    let planned = plan_views(&recipe, reporter).map_err(|e| report::failure(e, &sources))?;
    match format {
        PlanFormat::Text => report::out(&planned.text())?,
        PlanFormat::Json => report::out(&format!("{:#}\n", planned.json()))?,
        PlanFormat::Dot => report::out(&planned.dot())?,
    }
    Ok(())
}
