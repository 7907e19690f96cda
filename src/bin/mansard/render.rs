//! `mansard render`: the dataset of a recipe.

use mansard::pipeline::{BackendChoice, RenderOptions, render_dataset};
use mansard::source::SourceMap;

use crate::args::{BackendName, RenderArgs};
use crate::build::{load, tell, use_threads};
use crate::progress::Reporter;
use crate::report::{self, Failure};
use crate::reports;

pub fn run(args: &RenderArgs, reporter: &Reporter) -> Result<(), Failure> {
    reports::check(args.reports.as_ref())?;
    use_threads(&args.work)?;
    let mut sources = SourceMap::default();
    let recipe = load(&args.recipe, &args.options, &mut sources, reporter.is_quiet())?;
    let backend = match args.backend {
        None => BackendChoice::Any,
        Some(BackendName::Wgpu) => BackendChoice::Gpu,
        Some(BackendName::Reference) => BackendChoice::Reference,
    };
    let (output, views) = (args.output.clone(), args.views.clone());
    let options = RenderOptions { output, views, backend, samples: args.samples, ..RenderOptions::default() };
    let failed = std::cell::Cell::new(false);
    let all_reports = std::cell::RefCell::new(Vec::new());
    let told = |built: &mansard::pipeline::BuiltScene| {
        failed.set(failed.get() | !tell(built, &sources, reporter));
        all_reports.borrow_mut().push(built.reports.clone());
    };
    let summary =
        render_dataset(&recipe, &options, &sources, reporter, &told).map_err(|e| report::failure(e, &sources))?;
    reports::write(args.reports.as_ref(), &all_reports.borrow())?;
    reporter.say(&format!(
        "wrote {} images of {} views and {} to {}",
        summary.images,
        summary.views,
        summary.other_files.join(", "),
        options.output.display()
    ));
    if failed.get() { Err(Failure::said()) } else { Ok(()) }
}
