//! The live loop: files change, and what depends on them is done again.
//!
//! In: a recipe's path, what the user changed beside the files ([`Overrides`]), and the files as they are now. Out: an
//! [`Update`] that says what was done again, and the last good scene. The scene is built by the same code as everywhere
//! ([`crate::pipeline`]), with a memory that keeps what is still valid; no window and no output here.

mod canvas;
mod number;
mod overrides;
mod picking;
mod session;
mod update;
mod usage;
mod watcher;

pub use canvas::{Canvas, Drawing, Shown, demand_of};
pub use number::thousands;
pub use overrides::{AttributeOverride, Overrides, SunAngles};
pub use picking::{LeafInfo, LotInfo, Ray};
pub use session::{RuleFile, Session};
pub use update::{Message, Phase, Redone, Update};
pub use usage::{RuleUsage, usage};
pub use watcher::{WatchError, Watcher};

#[cfg(test)]
mod tests;
