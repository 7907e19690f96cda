//! The phases in order, on one screen.
//!
//! In: a recipe's path and the command line's choices. Out: scenes ([`build_scene`]), plans ([`plan_views`]) and
//! datasets ([`render_dataset`]).

mod backend;
mod budget;
mod build;
mod cost;
mod derivation;
mod error;
mod lot;
pub mod memory;
mod neighbours;
mod picking;
mod place;
mod portrait;
mod preparation;
mod progress;
mod recipe;
mod record;
mod render;
mod rules;
pub mod shipped;
mod single;
mod streets;
mod textures;
mod usage;
mod validation;
mod vegetation;
mod views;

pub use backend::BackendChoice;
pub use build::{BuiltScene, Checks, Fineness, build_scene, rebuild_scene};
pub use cost::{CostOptions, CostSummary, measure_cost};
pub use error::PipelineError;
pub use picking::{Traced, traced};
pub use portrait::portrait;
pub use preparation::Assignment;
pub use progress::{Progress, Silent};
pub use recipe::{Recipe, RecipeOptions, load_recipe, load_recipe_over};
pub use record::{acquisition_record, below_root, file_sha256, geometry_hash};
pub use render::{RenderOptions, RenderSummary, build_scenes, render_built, render_dataset, write_geometry};
pub use single::single_scene;
pub use usage::{RuleTotal, rule_totals};
pub use validation::{DefectTotal, FeatureChecks, Validation};
pub use views::{PlannedRecipe, drawn_views, plan_views};
