//! `mansard cost`: what accuracy costs in time in a recipe's own scene.

use std::path::Path;

use mansard::pipeline::{self, BuiltScene, measure_cost};
use mansard::source::SourceMap;

use crate::args::{CostOptions, RecipeOptions, WorkOptions};
use crate::build::{load, tell, use_threads};
use crate::progress::Reporter;
use crate::report::{self, Failure};

pub fn run(
    path: &Path,
    output: &Path,
    measure: &CostOptions,
    options: &RecipeOptions,
    work: &WorkOptions,
    reporter: &Reporter,
) -> Result<(), Failure> {
    if !(measure.noise > 0.0 && measure.noise <= 100.0) {
        return Err(Failure::unable(format!("--noise {}: a percentage above 0 is due", measure.noise)));
    }
    use_threads(work)?;
    let mut sources = SourceMap::default();
    let recipe = load(path, options, &mut sources, reporter.is_quiet())?;
    let options = pipeline::CostOptions {
        output: output.to_owned(),
        view: measure.view.clone(),
        repeats: measure.repeats as usize,
        windows: measure.windows as usize,
        side: measure.side,
        noise: measure.noise / 100.0,
    };
    let failed = std::cell::Cell::new(false);
    let told = |built: &BuiltScene| failed.set(!tell(built, &sources, reporter));
    let summary = measure_cost(&recipe, &options, reporter, &told).map_err(|e| report::failure(e, &sources))?;
    summary.lines.iter().for_each(|line| reporter.say(line));
    reporter.say(&format!(
        "measured {} settings, wrote {} to {}",
        summary.settings,
        summary.files.join(", "),
        output.display()
    ));
    if failed.get() { Err(Failure::said()) } else { Ok(()) }
}
