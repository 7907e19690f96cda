//! `mansard render`: the dataset of a recipe.

use std::path::Path;

use mansard::pipeline::{RenderOptions, render_dataset};
use mansard::source::SourceMap;

use crate::args::{RecipeOptions, WorkOptions};
use crate::build::{load, tell, use_threads};
use crate::progress::Reporter;
use crate::report::{self, Failure};

pub fn run(
    path: &Path,
    output: &Path,
    views: &[String],
    options: &RecipeOptions,
    work: &WorkOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    use_threads(work)?;
    let mut sources = SourceMap::default();
    let recipe = load(path, options, &mut sources, reporter.is_quiet())?;
    let options = RenderOptions { output: output.to_owned(), views: views.to_vec() };
    let failed = std::cell::Cell::new(false);
    let told = |built: &mansard::pipeline::BuiltScene| failed.set(failed.get() | !tell(built, &sources, reporter));
    let summary =
        render_dataset(&recipe, &options, &sources, reporter, &told).map_err(|e| report::failure(e, &sources))?;
    reporter.say(&format!(
        "wrote {} images of {} views and {} to {}",
        summary.images,
        summary.views,
        summary.other_files.join(", "),
        output.display()
    ));
    if failed.get() { Err(Failure::said()) } else { Ok(()) }
}
