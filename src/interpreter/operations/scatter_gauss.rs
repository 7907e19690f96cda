//! Normal distributions cut off at the scope's box. In: mean and standard deviation per axis. Out: points of the box.

use glam::DVec3;

use super::super::shape::Scope;
use super::scatter::Dice;

/// Around `mean` (metres in the scope's axes) with `deviation` metres along each, never outside the box.
pub struct Bell {
    pub scope: Scope,
    pub mean: DVec3,
    pub deviation: DVec3,
}

impl Bell {
    pub fn draw(&self, dice: &mut Dice) -> DVec3 {
        let axis = |i: usize, u: f64| truncated(self.mean[i], self.deviation[i], self.scope.size[i], u);
        let u = dice.roll3();
        self.scope.frame.world_from_local(DVec3::new(axis(0, u.x), axis(1, u.y), axis(2, u.z)))
    }
}

/// The normal distribution cut off at 0 and `size` (which may be negative), by inversion.
fn truncated(mean: f64, deviation: f64, size: f64, u: f64) -> f64 {
    if size == 0.0 || deviation == 0.0 {
        return mean;
    }
    let (low, high) = (size.min(0.0), size.max(0.0));
    let (from, to) = (below((low - mean) / deviation), below((high - mean) / deviation));
    (mean + deviation * quantile(from + (to - from) * u)).clamp(low, high)
}

/// Share of the standard normal distribution below z.
fn below(z: f64) -> f64 {
    libm::erfc(-z / std::f64::consts::SQRT_2) / 2.0
}

/// The z below which the share p lies: halving between +-40 deviations (beyond which all shares are 0 or 1).
fn quantile(p: f64) -> f64 {
    let (mut low, mut high) = (-40.0f64, 40.0f64);
    for _ in 0..64 {
        let middle = (low + high) / 2.0;
        if below(middle) < p { low = middle } else { high = middle }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_turn_shares_around() {
        for z in [-3.0, -1.0, 0.0, 0.3, 2.5] {
            assert!((quantile(below(z)) - z).abs() < 1e-9, "{z}");
        }
        assert!((below(1.0) - 0.841_344_746_068_543).abs() < 1e-12);
    }

    #[test]
    fn cut_off_at_the_box() {
        assert_eq!(truncated(0.0, 1e9, 4.0, 0.0), 0.0);
        assert!((truncated(0.0, 1e9, 4.0, 0.5) - 2.0).abs() < 1e-6);
        assert_eq!(truncated(2.0, 0.0, 4.0, 0.9), 2.0);
        assert!((truncated(-2.0, 0.5, -4.0, 0.5) + 2.0).abs() < 1e-9);
    }
}
