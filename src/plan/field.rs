//! Field: a place in the plan → density of clouds, share of ash. Both are functions of the place alone, so that any
//! resolution of a map of them can be compared with the truth.

use glam::DVec2;

use super::effects::{Clouds, GroundKind, GroundState};
use crate::interpreter::seed::Seed;

/// Octaves of noise; each is twice as fine and half as strong as the one before.
const OCTAVES: u32 = 5;
/// Standard deviation of [`noise`] over the plan.
const NOISE_SPREAD: f64 = 0.1347;
/// Shares of the plan above the noise's middle, and how many deviations above it they begin (measured on 3.6 million
/// places under 40 keys; the noise is flatter than a normal distribution). The lower half mirrors them.
const QUANTILES: [(f64, f64); 13] = [
    (0.5, 0.0),
    (0.4, 0.278),
    (0.3, 0.570),
    (0.25, 0.730),
    (0.2, 0.898),
    (0.15, 1.090),
    (0.1, 1.322),
    (0.05, 1.640),
    (0.02, 1.966),
    (0.01, 2.161),
    (0.005, 2.327),
    (0.001, 2.627),
    (0.0, 3.71),
];

impl Clouds {
    /// Vertical optical depth at a place of the layer, 0 between the clouds.
    pub fn optical_depth(&self, plan: DVec2) -> f64 {
        let over = noise(self.key, plan / self.size) - threshold(self.cover, 0.0);
        self.depth * smooth(over / (1.5 * NOISE_SPREAD))
    }
}

impl GroundState {
    /// Share of the ground that is covered at a place, 0..1. Far from the border of what is reached its mean over the
    /// plan is the strength; towards the border the strength falls evenly to nothing.
    pub fn coverage(&self, plan: DVec2) -> f64 {
        let mut near = 0.0f64;
        for &(center, radius) in self.around.iter() {
            let (offset, outer) = (plan - center, radius + self.reach);
            // Most discs are far away, and there may be thousands.
            if offset.length_squared() < outer * outer {
                near = near.max(1.0 - (offset.length() - radius).max(0.0) / self.reach);
            }
        }
        if near == 0.0 {
            return 0.0;
        }
        let (patch, softness) = match self.kind {
            GroundKind::Ash => (6.0, 3.0),
            GroundKind::Puddles => (4.0, 0.25),
        };
        let over = noise(self.key, plan / patch) - threshold(self.strength * near, softness);
        smooth(over / (softness * NOISE_SPREAD) + 0.5)
    }
}

/// The height of noise that the share `cover` of the plan is above, where the border is drawn out over `softness`
/// deviations: a smooth step as wide as 1 spreads like a distribution of variance 1/20.
fn threshold(cover: f64, softness: f64) -> f64 {
    let tail = cover.min(1.0 - cover).clamp(0.0, 0.5);
    let i = QUANTILES.partition_point(|(share, _)| *share >= tail).clamp(1, QUANTILES.len() - 1);
    let ((share, at), (next_share, next_at)) = (QUANTILES[i - 1], QUANTILES[i]);
    let above = at + (next_at - at) * (share - tail) / (share - next_share);
    let deviations = above * (1.0 + softness * softness / 20.0).sqrt();
    0.5 + NOISE_SPREAD * if cover < 0.5 { deviations } else { -deviations }
}

/// From 0 to 1 while `x` does, without a kink.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Value noise in octaves, 0..1, mean ½; features of the first octave are about one unit across. Each octave is turned
/// against the one before (by the angle of the triangle 3, 4, 5), so that no direction of the lattice shows.
fn noise(key: u64, p: DVec2) -> f64 {
    let (mut p, mut sum, mut weight) = (p, 0.0, 0.0);
    for k in 0..OCTAVES {
        p = DVec2::new(0.8 * p.x - 0.6 * p.y, 0.6 * p.x + 0.8 * p.y);
        let share = libm::ldexp(1.0, -(k as i32));
        sum += share * lattice(Seed::root(key).part(u64::from(k)), p / share);
        weight += share;
    }
    sum / weight
}

/// One octave: a random number at each whole place, blended by quintic weights (Perlin 2002) between them.
fn lattice(seed: Seed, p: DVec2) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let at = |dx: f64, dy: f64| seed.part((cell.x + dx) as i64 as u64).part((cell.y + dy) as i64 as u64).unit();
    let row = |dy: f64| at(0.0, dy) * (1.0 - w.x) + at(1.0, dy) * w.x;
    row(0.0) * (1.0 - w.y) + row(1.0) * w.y
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    /// Mean of a field over 1600 largest features, away from the origin on both sides of it.
    fn mean(size: f64, field: &dyn Fn(DVec2) -> f64) -> f64 {
        let places =
            (0..200).flat_map(|i| (0..200).map(move |j| DVec2::new(f64::from(i) - 75.0, f64::from(j) - 130.0)));
        places.map(|p| field(p * (0.2074 * size))).sum::<f64>() / 40_000.0
    }

    #[test]
    fn clouds_cover_the_share_of_the_sky_that_is_asked_for() {
        for (key, cover) in [(1, 0.02), (2, 0.1), (3, 0.3), (4, 0.5), (5, 0.75), (6, 0.95)] {
            let clouds = Clouds { key, cover, height: 1000.0, size: 400.0, depth: 8.0, color: [1.0; 3] };
            let found = mean(400.0, &|p| f64::from(clouds.optical_depth(p) > 0.0));
            assert!((found - cover).abs() < 0.02, "{cover} {found}");
            let deepest = mean(400.0, &|p| f64::from(clouds.optical_depth(p) > 8.0));
            assert_eq!(deepest, 0.0);
        }
        let sky = |cover: f64| Clouds { key: 7, cover, height: 1000.0, size: 400.0, depth: 8.0, color: [1.0; 3] };
        assert_eq!(mean(400.0, &|p| sky(0.0).optical_depth(p)), 0.0);
        assert_eq!(mean(400.0, &|p| f64::from(sky(1.0).optical_depth(p) > 0.0)), 1.0);
    }

    #[test]
    fn the_ground_is_covered_by_the_share_that_is_asked_for() {
        for kind in [GroundKind::Ash, GroundKind::Puddles] {
            for (key, strength) in [(1, 0.05), (2, 0.2), (3, 0.4), (4, 0.7), (5, 0.9)] {
                let around = Arc::from([(DVec2::ZERO, 1e6)]);
                let ground = GroundState { key, kind, strength, reach: 25.0, around };
                let found = mean(6.0, &|p| ground.coverage(p));
                assert!((found - strength).abs() < 0.02, "{kind:?} {strength} {found}");
            }
        }
    }

    #[test]
    fn ash_thins_out_to_nothing_at_its_reach() {
        let around = Arc::from([(DVec2::new(10.0, -20.0), 8.0), (DVec2::new(400.0, 0.0), 8.0)]);
        let ground = GroundState { key: 3, kind: GroundKind::Ash, strength: 0.8, reach: 30.0, around };
        let ring = |radius: f64| {
            let at = |i: u32| {
                let (sin, cos) = libm::sincos(f64::from(i) * 0.0037);
                ground.coverage(DVec2::new(10.0, -20.0) + radius * DVec2::new(cos, sin))
            };
            (0..1700).map(at).sum::<f64>() / 1700.0
        };
        let (inside, middle, border) = (ring(7.0), ring(23.0), ring(37.0));
        assert!(inside > middle && middle > border && border > 0.0, "{inside} {middle} {border}");
        assert_eq!(ring(38.01), 0.0);
    }
}
