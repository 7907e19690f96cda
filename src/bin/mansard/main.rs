//! The program: words in, exit code out. The only code that prints or exits.

mod args;
mod build;
mod check;
mod compatibility;
mod cost;
mod derive;
mod diff;
mod dump;
mod explain;
mod fmt;
mod footprint;
mod lsp;
mod plan;
mod progress;
mod render;
mod report;
mod reports;
mod start_shapes;
mod town;
mod validate;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::Parser;
use mansard::pipeline::Checks;

use args::{Args, Command};
use progress::Reporter;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// The input is wrong.
const WRONG: u8 = 1;
/// The command line is wrong, or the machine cannot do it.
const UNABLE: u8 = 2;

fn main() -> ExitCode {
    quieten_device_selection();
    let args = Args::parse();
    let reporter = Reporter::new(args.quiet);
    let result = match args.command {
        Command::Check { files, cityengine: true, format, recipe } => compatibility::run(&files, format, &recipe),
        Command::Check { files, cityengine: false, format, recipe } => check::run(&files, format, &recipe, args.quiet),
        Command::Fmt { files, check, stdin } => fmt::run(&files, check, stdin, args.quiet),
        Command::Explain { code } => explain::run(&code),
        Command::Derive(derive) => derive::run(&derive, args.quiet),
        Command::Build { recipe, output, reports, validate, options, work } => {
            let checks = if validate { Checks::All } else { Checks::Off };
            build::run(&recipe, &output, reports.as_ref(), checks, &options, &work, &reporter)
        }
        Command::Render(render) => render::run(&render, &reporter),
        Command::Watch(watch) => watch::run(&watch),
        Command::Plan { recipe, format, options, work } => plan::run(&recipe, format, &options, &work, &reporter),
        Command::Cost { recipe, output, measure, options, work } => {
            cost::run(&recipe, &output, &measure, &options, &work, &reporter)
        }
        Command::Diff(diff) => diff::run(&diff, &reporter),
        Command::Verify(verify) => verify::run(&verify, &reporter),
        Command::Lsp { stdio: _ } => lsp::run(),
        Command::Dump { phase, file } => dump::run(phase, &file, args.quiet),
        Command::Town { seed, buildings, output, name } => town::run(seed, buildings, &output, &name, &reporter),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Mesa's device selection layer complains on standard error where there is no desktop; it would only reorder adapters,
/// and the renderer chooses by what they can do.
fn quieten_device_selection() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: the program has one thread here, before anything could read the environment.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
