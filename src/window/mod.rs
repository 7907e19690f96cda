//! The window of `mansard watch`: a recipe's scene, its views and states, and what its rules let one choose.
//!
//! In: a recipe's path, the user's hands, the files as they change. Out: the same pictures that the recipe's datasets have,
//! as soon as they can be had. Three threads: this one ([`app`]) never waits; [`builder`] owns the session; [`drawer`]
//! owns the renderer. [`viewpoint`], [`take`], [`picture`], [`attributes`] and [`desk`] know nothing of windows.

mod app;
mod attributes;
mod builder;
mod desk;
mod drawer;
mod error;
mod events;
mod mailbox;
mod painter;
mod panels;
mod picture;
mod report;
mod shown;
mod take;
mod theme;
mod viewpoint;

use std::path::PathBuf;
use std::sync::Arc;

use winit::event_loop::EventLoop;

use builder::Builder;
use drawer::Drawer;
use report::{Report, Tell};

use crate::live::{Overrides, Session};
use crate::pipeline::RecipeOptions;

pub use desk::Show;
pub use error::WindowError;

/// What the command line says.
#[derive(Clone, Debug)]
pub struct Options {
    pub recipe: PathBuf,
    pub recipe_options: RecipeOptions,
    /// Folder of screenshots.
    pub screenshots: PathBuf,
    /// Of the window, logical pixels.
    pub size: (u32, u32),
    /// To begin with, by name; the recipe's first otherwise.
    pub view: Option<String>,
    pub scene: Option<String>,
    pub show: Show,
}

/// Hears of updates and events, one line of JSON each; see `docs/watch.md`.
pub type Say = Box<dyn Fn(&str)>;

/// Opens the window and stays until it is closed.
pub fn run(options: Options, say: Say) -> Result<(), WindowError> {
    let no_display = |error: &dyn std::fmt::Display| WindowError::NoDisplay { reason: error.to_string() };
    let events = EventLoop::<Report>::with_user_event().build().map_err(|error| no_display(&error))?;
    let proxy = events.create_proxy();
    // After the window was closed nobody listens.
    let tell: Tell = Arc::new(move |report| drop(proxy.send_event(report)));
    let session = Session::open(&options.recipe, options.recipe_options.clone());
    let overrides = Overrides { scene: options.scene.clone(), ..Overrides::default() };
    let builder = Builder::start(session, overrides, tell.clone())?;
    let drawer = Drawer::start(tell)?;
    let mut app = app::App::new(options, say, builder, drawer);
    events.run_app(&mut app).map_err(|error| no_display(&error))?;
    app.failed.map_or(Ok(()), Err)
}
