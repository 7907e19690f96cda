//! Stochastic branches. In: weights in percent and a draw site. Out: the branch that was drawn (reference 2.2).

use super::derivation::Derivation;
use super::environment::Env;
use super::limits::Outcome;
use crate::cga::program::{DrawSite, Expr};

/// The first branch k with u < p1 + .. + pk for one draw u in [0, 100); `None` for `else`.
/// A percentage of 0 or less is never chosen.
pub fn choose<'p, T>(
    run: &mut Derivation<'p>,
    branches: &'p [(Expr, T)],
    site: DrawSite,
    env: &Env,
) -> Outcome<Option<&'p T>> {
    let drawn = env.draw(Some(site)) * 100.0;
    let mut sum = 0.0;
    for (weight, branch) in branches {
        sum += run.eval_finite(weight, env)?.max(0.0);
        if drawn < sum {
            return Ok(Some(branch));
        }
    }
    Ok(None)
}
