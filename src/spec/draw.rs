//! In: a distribution written in a recipe and the seed of one property. Out: the number drawn.
//!
//! A draw is a function of its seed alone, so no draw depends on another.

use crate::interpreter::seed::Seed;

/// Deviations at which a normal distribution is cut, so that every distribution has bounds that can be checked.
pub const NORMAL_CUT: f64 = 3.0;

/// A number or how to draw one, in metres, degrees or plain units.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    Fixed(f64),
    /// Evenly over `[low, high)`; `low <= high`.
    Uniform {
        low: f64,
        high: f64,
    },
    /// Cut at [`NORMAL_CUT`] deviations on both sides.
    Normal {
        mean: f64,
        deviation: f64,
    },
    /// One of the alternatives, with its weight (positive; they need not add up to 1).
    Choice(Vec<(Distribution, f64)>),
}

impl Distribution {
    /// The number drawn under this seed.
    pub fn draw(&self, seed: Seed) -> f64 {
        match self {
            Distribution::Fixed(value) => *value,
            Distribution::Uniform { low, high } => low + (high - low) * seed.unit(),
            Distribution::Normal { mean, deviation } => mean + deviation * cut_normal(seed.unit()),
            Distribution::Choice(alternatives) => {
                let weights: Vec<f64> = alternatives.iter().map(|(_, weight)| *weight).collect();
                alternatives[pick(&weights, seed.named("choice"))].0.draw(seed.named("value"))
            }
        }
    }

    /// The value where nothing is left to chance.
    pub fn fixed(&self) -> Option<f64> {
        match self {
            Distribution::Fixed(value) => Some(*value),
            _ => None,
        }
    }

    /// The least and the greatest number that can be drawn.
    pub fn bounds(&self) -> (f64, f64) {
        match self {
            Distribution::Fixed(value) => (*value, *value),
            Distribution::Uniform { low, high } => (*low, *high),
            Distribution::Normal { mean, deviation } => (mean - NORMAL_CUT * deviation, mean + NORMAL_CUT * deviation),
            Distribution::Choice(alternatives) => alternatives
                .iter()
                .map(|(distribution, _)| distribution.bounds())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (c, d)| (a.min(c), b.max(d))),
        }
    }
}

/// The index of the weight in which a draw falls.
///
/// # Panics
/// With no weights.
pub fn pick(weights: &[f64], seed: Seed) -> usize {
    let mut left = seed.unit() * weights.iter().sum::<f64>();
    for (i, weight) in weights.iter().enumerate() {
        if left < *weight {
            return i;
        }
        left -= weight;
    }
    weights.len().checked_sub(1).expect("a choice has alternatives")
}

/// The standard normal quantile of the cut distribution, by bisection on its distribution function.
fn cut_normal(unit: f64) -> f64 {
    let below = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    let tail = below(-NORMAL_CUT);
    let wanted = tail + unit * (1.0 - 2.0 * tail);
    let (mut low, mut high) = (-NORMAL_CUT, NORMAL_CUT);
    // 60 halvings of 6 leave 5e-18.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draws(distribution: &Distribution) -> Vec<f64> {
        (0..20_000).map(|i| distribution.draw(Seed::root(0).part(i))).collect()
    }

    #[test]
    fn draws_stay_within_their_bounds_and_reach_near_them() {
        for d in [
            Distribution::Uniform { low: 5.0, high: 10.0 },
            Distribution::Normal { mean: 5.0, deviation: 2.0 },
            Distribution::Choice(vec![
                (Distribution::Fixed(1.0), 1.0),
                (Distribution::Uniform { low: 2.0, high: 3.0 }, 1.0),
            ]),
        ] {
            let (low, high) = d.bounds();
            let all = draws(&d);
            assert!(all.iter().all(|v| (low..=high).contains(v)), "{d:?}");
            let (least, most) = all.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
            assert!(least - low < 0.1 * (high - low) && high - most < 0.1 * (high - low), "{d:?} {least} {most}");
        }
    }

    #[test]
    fn a_normal_has_the_mean_and_spread_of_its_cut() {
        let all = draws(&Distribution::Normal { mean: 5.0, deviation: 2.0 });
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let variance = all.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / all.len() as f64;
        // Cut at 3 deviations the standard normal has variance 0.9733.
        assert!((mean - 5.0).abs() < 0.05 && (variance - 4.0 * 0.9733).abs() < 0.1, "{mean} {variance}");
    }

    #[test]
    fn weights_decide_how_often() {
        let d = Distribution::Choice(vec![(Distribution::Fixed(0.0), 1.0), (Distribution::Fixed(1.0), 3.0)]);
        let ones = draws(&d).iter().sum::<f64>() / 20_000.0;
        assert!((ones - 0.75).abs() < 0.02, "{ones}");
    }
}
