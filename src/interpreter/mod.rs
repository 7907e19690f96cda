//! Derivation: `Program` + start shape + seed → `ShapeTree`.
//!
//! In: a checked [`Program`], a [`StartShape`] in world coordinates (x east, y up, z south, metres), assets, limits.
//! Out: a [`ShapeTree`] of leaves, reports, prints and diagnostics. The result depends on nothing else: not on
//! threads, time or neighbours.

mod appearance;
mod arithmetic;
mod array;
pub mod assets;
mod attribute;
mod choice;
pub mod context;
mod derivation;
mod dynamic_import;
mod environment;
mod expression;
mod files;
mod form;
mod functions;
pub mod host;
pub mod json;
mod labels;
mod leaves;
pub mod limits;
pub mod material;
mod measure;
mod merging;
pub mod obj;
mod operations;
mod orientation;
mod outline;
mod palette;
mod placement;
mod projection;
mod provenance;
mod recompose;
mod recomposition;
pub mod reports;
pub mod seed;
mod shape;
mod solids;
mod start;
pub mod steps;
mod streets;
mod subderivation;
mod successor;
pub mod text;
mod topology;
pub mod tree;
mod trim_planes;
pub mod used;
mod value;
pub mod watch;

use std::sync::Arc;

pub use assets::{Assets, FileAssets, NoAssets};
use context::{Surroundings, Survey};
use derivation::Derivation;
pub use host::HostData;
pub use limits::Limits;
use seed::Seed;
use tree::{Scalar, ShapeTree};
use watch::Watch;

use crate::cga::program::Program;
use crate::geometry::Mesh;

/// What a host gives to derive.
#[derive(Clone, Debug)]
pub struct StartShape {
    /// In world coordinates. The first edge of the first face is the front (reference 3.3).
    pub mesh: Mesh,
    /// Without parameters; the program's own start rule if `None`.
    pub start_rule: Option<String>,
    /// Values of the program's attributes by name; names it does not have are ignored.
    pub attributes: Vec<(Arc<str>, Scalar)>,
    pub seed: Seed,
    /// `initialShape.name`.
    pub name: Arc<str>,
    /// Data per edge and the place on Earth.
    pub host: HostData,
}

impl StartShape {
    /// A start shape for the program's own start rule, without attributes.
    pub fn new(mesh: Mesh, seed: Seed, name: &str) -> Self {
        StartShape {
            mesh,
            start_rule: None,
            attributes: Vec::new(),
            seed,
            name: name.into(),
            host: HostData::default(),
        }
    }
}

/// Derives one start shape. Never panics and never fails: what went wrong is in the tree's diagnostics, and the leaves
/// made before are kept. Queries see this start shape only; [`Batch`](context::Batch) derives several that see each other.
pub fn derive(program: &Program, start: &StartShape, assets: &dyn Assets, limits: &Limits) -> ShapeTree {
    if !program.needs().asks() {
        return Derivation::new(program, start, assets, limits).run();
    }
    let own = survey(program, start, assets, limits);
    let surroundings = Surroundings { own: Some(&own), ..Surroundings::default() };
    derive_among(program, start, assets, limits, &surroundings)
}

/// The first derivation: queries have their defaults, and only what others may ask about is kept (reference 6.8).
pub fn survey(program: &Program, start: &StartShape, assets: &dyn Assets, limits: &Limits) -> Survey {
    Derivation::new(program, start, assets, limits).noting().survey()
}

/// The second derivation, its queries answered from first ones.
pub fn derive_among(
    program: &Program,
    start: &StartShape,
    assets: &dyn Assets,
    limits: &Limits,
    surroundings: &Surroundings,
) -> ShapeTree {
    Derivation::new(program, start, assets, limits).among(surroundings).run()
}

/// Derives one start shape as [`derive`] does, slower, and notes where its leaves come from. Queries see this start shape
/// only, unless `surroundings` are given.
pub fn derive_watched(
    program: &Program,
    start: &StartShape,
    assets: &dyn Assets,
    limits: &Limits,
    surroundings: Option<&Surroundings>,
) -> (ShapeTree, Watch) {
    let watched = |surroundings: Option<&Surroundings>| {
        let derivation = Derivation::new(program, start, assets, limits).watched();
        match surroundings {
            Some(surroundings) => derivation.among(surroundings).run_watched(),
            None => derivation.run_watched(),
        }
    };
    if surroundings.is_some() || !program.needs().asks() {
        return watched(surroundings);
    }
    let own = survey(program, start, assets, limits);
    watched(Some(&Surroundings { own: Some(&own), ..Surroundings::default() }))
}

#[cfg(test)]
mod tests;
