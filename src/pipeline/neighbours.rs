//! Start shapes that see each other. In: every state of every feature as a start shape. Out: their trees, derived in
//! parallel: first those that a query may ask about, then all (reference 6.8).
//!
//! A state before a change meets others before it, a state after one others after it. A feature that stays as it is has
//! one derivation for both: it looks at the state before.

use rayon::prelude::*;

use crate::interpreter::assets::Assets;
use crate::interpreter::context::{Batch, Member, Survey, Worlds};
use crate::interpreter::limits::Limits;
use crate::interpreter::tree::ShapeTree;
use crate::scene::Presence;

const BEFORE: Worlds = 1;
const AFTER: Worlds = 2;

/// The worlds a state is in, and those it sees.
pub fn worlds(presence: Presence) -> (Worlds, Worlds) {
    match presence {
        Presence::Both => (BEFORE | AFTER, BEFORE),
        Presence::BeforeOnly => (BEFORE, BEFORE),
        Presence::AfterOnly => (AFTER, AFTER),
    }
}

/// Derives every member and hands its tree on; results in the order of the members.
pub fn derive_all<T: Send>(
    members: &[Member],
    assets: &dyn Assets,
    limits: &Limits,
    each: impl Fn(usize, ShapeTree) -> T + Sync,
) -> Vec<T> {
    let batch = Batch::new(members, assets, limits);
    let surveys: Vec<Option<Survey>> = (0..members.len()).into_par_iter().map(|i| batch.survey(i)).collect();
    (0..members.len()).into_par_iter().map(|i| each(i, batch.derive(i, &surveys))).collect()
}
