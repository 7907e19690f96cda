//! `mansard render`: the dataset of a recipe.

use std::path::{Path, PathBuf};

use mansard::pipeline::{BackendChoice, RenderOptions, render_dataset};
use mansard::source::SourceMap;

use crate::args::{BackendName, BackendOptions, RecipeOptions, WorkOptions};
use crate::build::{load, tell, use_threads};
use crate::progress::Reporter;
use crate::report::{self, Failure};
use crate::reports;

pub fn run(
    path: &Path,
    output: &Path,
    views: &[String],
    reports_file: Option<&PathBuf>,
    backend: &BackendOptions,
    options: &RecipeOptions,
    work: &WorkOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    reports::check(reports_file)?;
    use_threads(work)?;
    let mut sources = SourceMap::default();
    let recipe = load(path, options, &mut sources, reporter.is_quiet())?;
    let choice = match backend.backend {
        None => BackendChoice::Any,
        Some(BackendName::Wgpu) => BackendChoice::Gpu,
        Some(BackendName::Reference) => BackendChoice::Reference,
    };
    let (output, views) = (output.to_owned(), views.to_vec());
    let options = RenderOptions { output, views, backend: choice, samples: backend.samples };
    let failed = std::cell::Cell::new(false);
    let all_reports = std::cell::RefCell::new(Vec::new());
    let told = |built: &mansard::pipeline::BuiltScene| {
        failed.set(failed.get() | !tell(built, &sources, reporter));
        all_reports.borrow_mut().push(built.reports.clone());
    };
    let summary =
        render_dataset(&recipe, &options, &sources, reporter, &told).map_err(|e| report::failure(e, &sources))?;
    reports::write(reports_file, &all_reports.borrow())?;
    reporter.say(&format!(
        "wrote {} images of {} views and {} to {}",
        summary.images,
        summary.views,
        summary.other_files.join(", "),
        options.output.display()
    ));
    if failed.get() { Err(Failure::said()) } else { Ok(()) }
}
