//! Plan: what the recipe demands → which passes run, in which order, over which resources. No GPU here.

pub mod change;
pub mod demand;
pub mod dump;
pub mod effects;
pub mod light;
pub mod pass;
pub mod resource;
pub mod schedule;
pub mod summary;
pub mod sun;
pub mod view;

pub use pass::{Counts, RenderPlan, ViewPlan};
pub use schedule::schedule;
pub use summary::{ObjectSummary, summarize};
