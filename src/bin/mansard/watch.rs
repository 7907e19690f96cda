//! `mansard watch`: a recipe and everything it names are followed.

mod headless;
mod window;

use crate::args::WatchArgs;
use crate::build::use_threads;
use crate::report::Failure;

pub fn run(args: &WatchArgs) -> Result<(), Failure> {
    use_threads(&args.work)?;
    if args.headless {
        return headless::run(args);
    }
    window::run(args)
}
