//! The window of `mansard watch`. In: the command line. Out: a window, and with `--json` a line for every update and event.

use std::io::Write;

use mansard::window::{Options, Show, run as open};

use crate::args::{ShownName, WatchArgs};
use crate::report::Failure;

/// Of the window when it opens, logical pixels.
const SIZE: (u32, u32) = (1440, 900);

pub fn run(args: &WatchArgs) -> Result<(), Failure> {
    let options = Options {
        recipe: args.recipe.clone(),
        recipe_options: args.options.recipe()?,
        screenshots: args.screenshots.clone(),
        size: SIZE,
        view: args.view.clone(),
        scene: args.scene.clone(),
        show: match args.state {
            ShownName::Before => Show::Before,
            ShownName::After => Show::After,
            ShownName::Mask => Show::Mask,
        },
    };
    let json = args.json;
    let say = move |line: &str| {
        // A reader that stops listening closes no window.
        let mut out = std::io::stdout().lock();
        let _unheard = if json { writeln!(out, "{line}").and_then(|()| out.flush()) } else { Ok(()) };
    };
    open(options, Box::new(say)).map_err(|error| Failure::unable(error.to_string()))
}
