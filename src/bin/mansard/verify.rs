//! `mansard verify`: a dataset made again from its manifest.

use mansard::comparison::{Colours, VerifyOptions, verification_text, verify};
use mansard::source::SourceMap;

use crate::args::{ColoursName, ReportFormat, VerifyArgs};
use crate::build::use_threads;
use crate::diff::failure;
use crate::progress::Reporter;
use crate::report::{self, Failure};

pub fn run(args: &VerifyArgs, reporter: &Reporter) -> Result<(), Failure> {
    use_threads(&args.work)?;
    let options = VerifyOptions {
        recipe: args.recipe.clone(),
        inputs: args.inputs.clone(),
        images: !args.no_images,
        colours: match args.colours {
            ColoursName::Exact => Colours::Exact,
            ColoursName::Close => Colours::Close,
        },
    };
    let mut sources = SourceMap::default();
    let found = verify(&args.dir, &options, &mut sources, reporter).map_err(|error| failure(error, &sources))?;
    match args.format {
        ReportFormat::Text => report::out(&verification_text(&found))?,
        ReportFormat::Json => {
            let json = serde_json::to_string_pretty(&found).expect("names and numbers serialise");
            report::out(&format!("{json}\n"))?;
        }
    }
    if found.verified { Ok(()) } else { Err(Failure::said()) }
}
