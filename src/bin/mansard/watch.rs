//! `mansard watch`: a recipe and everything it names are followed.

mod headless;

use crate::args::WatchArgs;
use crate::build::use_threads;
use crate::report::Failure;

pub fn run(args: &WatchArgs) -> Result<(), Failure> {
    use_threads(&args.work)?;
    if args.headless {
        return headless::run(args);
    }
    Err(Failure::unable("there is no window yet: say --headless"))
}
