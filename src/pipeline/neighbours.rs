//! Start shapes that see each other. In: every state of every feature as a start shape. Out: the trees of those that are
//! wanted, derived in parallel: first those that a query may ask about, then the wanted ones (reference 6.8).
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

/// Hands on how to derive each of the wanted members (in ascending order), from whatever files; results in their order.
pub fn derive_some<T: Send>(
    members: &[Member],
    wanted: &[usize],
    assets: &dyn Assets,
    limits: &Limits,
    each: impl Fn(usize, &dyn Fn(&dyn Assets) -> ShapeTree) -> T + Sync,
) -> Vec<T> {
    let batch = Batch::new(members, assets, limits);
    let asks = wanted.iter().any(|&number| members[number].program.needs().asks());
    let surveys: Vec<Option<Survey>> =
        (0..members.len()).into_par_iter().map(|number| asks.then(|| batch.survey(number))?).collect();
    let one = |&number: &usize| each(number, &|files| batch.derive(number, &surveys, files));
    wanted.par_iter().map(one).collect()
}
