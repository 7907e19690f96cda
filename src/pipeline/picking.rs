//! One state of a feature derived once more, watched. In: what the memory keeps of it. Out: its tree, where each leaf
//! comes from, and the parts of each leaf.

use std::sync::Arc;

use rayon::prelude::*;

use super::memory::Memory;
use super::memory::states::{KeptState, StateKey};
use super::neighbours::worlds;
use super::recipe::Recipe;
use crate::geodata::terrain::Terrain;
use crate::interpreter::assets::Assets;
use crate::interpreter::context::{Batch, Member, Survey};
use crate::interpreter::tree::ShapeTree;
use crate::interpreter::watch::Watch;
use crate::interpreter::{Limits, derive_watched};
use crate::scene::parts::Parts;

/// A state of a feature with everything that can be told of it.
pub struct Traced {
    pub tree: ShapeTree,
    /// Origins are in the order of the leaves.
    pub watch: Watch,
    /// In the order of the leaves, without a foundation.
    pub parts: Vec<Parts>,
    /// Key of its program.
    pub program: Arc<str>,
    /// Seconds of the derivation that the scene is made of.
    pub seconds: f64,
}

/// Derives a state of the last build again; `None` if the build had no such state.
pub fn traced(recipe: &Recipe, memory: &Memory, key: &StateKey, terrain: &Terrain) -> Option<Traced> {
    let (states, assets) = (memory.states(), memory.kept_assets()?);
    let state = states.get(key)?;
    let limits = states.limits()?;
    let program = recipe.programs.find(&state.program)?;
    let (tree, watch) = if program.needs().asks() {
        among_others(recipe, memory, key, assets.as_ref(), limits)?
    } else {
        derive_watched(program, &state.start, assets.as_ref(), limits, None)
    };
    let parts = state.lot.parts_by_leaf(&tree.leaves, terrain);
    Some(Traced { tree, watch, parts, program: state.program.clone(), seconds: state.seconds })
}

/// The same for a program that asks about other shapes.
fn among_others(
    recipe: &Recipe,
    memory: &Memory,
    key: &StateKey,
    assets: &dyn Assets,
    limits: &Limits,
) -> Option<(ShapeTree, Watch)> {
    let all: Vec<(&StateKey, &KeptState)> = memory.states().all().collect();
    let member = |(_, state): &(&StateKey, &KeptState)| {
        let (is_in, sees) = worlds(state.state.presence);
        Some(Member { program: recipe.programs.find(&state.program)?, start: state.start.clone(), is_in, sees })
    };
    let members: Vec<Member> = all.iter().map(member).collect::<Option<_>>()?;
    let number = all.iter().position(|(other, _)| *other == key)?;
    let batch = Batch::new(&members, assets, limits);
    let surveys: Vec<Option<Survey>> = (0..members.len()).into_par_iter().map(|i| batch.survey(i)).collect();
    let surroundings = batch.surroundings(number, &surveys);
    let Member { program, start, .. } = &members[number];
    Some(derive_watched(program, start, assets, limits, surroundings.as_ref()))
}
