//! `mansard diff`: what differs between two recipes, revisions or output folders.

use std::path::Path;

use mansard::comparison::{
    Collected, ComparisonError, Difference, Operand, Pixels, collect, compare, difference_text, write_pages,
};
use mansard::pipeline;
use mansard::source::SourceMap;

use crate::args::{DiffArgs, ReportFormat};
use crate::build::use_threads;
use crate::progress::Reporter;
use crate::report::{self, Failure};

pub fn run(args: &DiffArgs, reporter: &Reporter) -> Result<(), Failure> {
    use_threads(&args.work)?;
    let options = args.options.recipe().map_err(trouble)?;
    let operand = |word: &str| Operand::new(word, args.recipe.as_deref());
    let [a, b] = [operand(&args.a), operand(&args.b)];
    let (a, b) = (a.map_err(said)?, b.map_err(said)?);
    let as_stored = matches!(a, Operand::Folder(_)) || matches!(b, Operand::Folder(_));
    let side = |operand: &Operand| side(operand, as_stored, args, &options, reporter);
    let (a, b) = (side(&a)?, side(&b)?);
    let difference = compare(&a.snapshot, &b.snapshot).map_err(said)?;
    tell(&difference, args.format)?;
    if let Some(folder) = &args.output {
        write(&difference, &a, &b, folder, reporter)?;
    }
    if difference.same { Ok(()) } else { Err(Failure::said()) }
}

fn side(
    operand: &Operand,
    as_stored: bool,
    args: &DiffArgs,
    options: &pipeline::RecipeOptions,
    reporter: &Reporter,
) -> Result<Collected, Failure> {
    let mut sources = SourceMap::default();
    let pixels = if args.pixels || args.output.is_some() { Pixels::Compared } else { Pixels::Left };
    collect(operand, as_stored, pixels, options, &mut sources, reporter).map_err(|error| failure(error, &sources))
}

fn tell(difference: &Difference, format: ReportFormat) -> Result<(), Failure> {
    match format {
        ReportFormat::Text => report::out(&difference_text(difference)),
        ReportFormat::Json => report::out(&format!(
            "{}\n",
            serde_json::to_string_pretty(difference).expect("names and numbers serialise")
        )),
    }
}

fn write(
    difference: &Difference,
    a: &Collected,
    b: &Collected,
    folder: &Path,
    reporter: &Reporter,
) -> Result<(), Failure> {
    let names = write_pages(difference, &a.snapshot, &b.snapshot, folder).map_err(said)?;
    reporter.say(&format!("wrote {} to {}", names.join(", "), folder.display()));
    Ok(())
}

/// Whatever keeps two things from being compared is trouble: exit code 2, as 1 says that they differ.
fn trouble(failure: Failure) -> Failure {
    Failure { code: crate::UNABLE, ..failure }
}

fn said(error: ComparisonError) -> Failure {
    Failure::unable(error.to_string())
}

/// An error of comparing, with the mistakes of recipes printed.
pub fn failure(error: ComparisonError, sources: &SourceMap) -> Failure {
    match error {
        ComparisonError::Pipeline(error) => trouble(report::failure(*error, sources)),
        other => said(other),
    }
}
