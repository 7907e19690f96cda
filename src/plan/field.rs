//! Field: a place in the plan → density of clouds, share of ash. Both are functions of the place alone, so that any
//! resolution of a map of them can be compared with the truth.

use glam::DVec2;

use super::effects::{Clouds, GroundKind, GroundState};
use crate::interpreter::seed::Seed;

/// Octaves of noise; each is twice as fine and half as strong as the one before.
const OCTAVES: u32 = 5;
/// Standard deviation of [`noise`] over the plan.
const NOISE_SPREAD: f64 = 0.122;

impl Clouds {
    /// Vertical optical depth at a place of the layer, 0 between the clouds.
    pub fn optical_depth(&self, plan: DVec2) -> f64 {
        let over = noise(self.key, plan / self.size) - threshold(self.cover);
        self.depth * smooth(over / (1.5 * NOISE_SPREAD))
    }
}

impl GroundState {
    /// Share of the ground that is covered at a place, 0..1.
    pub fn coverage(&self, plan: DVec2) -> f64 {
        let near = |&(center, radius): &(DVec2, f64)| 1.0 - ((plan - center).length() - radius).max(0.0) / self.reach;
        let near = self.around.iter().map(near).fold(0.0, f64::max);
        if near == 0.0 {
            return 0.0;
        }
        let (patch, softness) = match self.kind {
            GroundKind::Ash => (6.0, 3.0 * NOISE_SPREAD),
            GroundKind::Puddles => (4.0, 0.25 * NOISE_SPREAD),
        };
        smooth((noise(self.key, plan / patch) - threshold(self.strength * near)) / softness + 0.5)
    }
}

/// The height that the share `cover` of the noise is above.
fn threshold(cover: f64) -> f64 {
    0.5 - NOISE_SPREAD * probit(cover.clamp(1e-6, 1.0 - 1e-6))
}

/// The normal distribution's quantile, to 5e-4 (Abramowitz and Stegun 1964, 26.2.23).
fn probit(share: f64) -> f64 {
    let tail = share.min(1.0 - share);
    let t = (-2.0 * libm::log(tail)).sqrt();
    let x = t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    if share < 0.5 { -x } else { x }
}

/// From 0 to 1 while `x` does, without a kink.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Value noise in octaves, 0..1, mean ½; features of the first octave are about one unit across.
fn noise(key: u64, p: DVec2) -> f64 {
    let octave = |k: u32| {
        let share = libm::ldexp(1.0, -(k as i32));
        (share * lattice(Seed::root(key).part(u64::from(k)), p / share), share)
    };
    let (sum, weight) = (0..OCTAVES).map(octave).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
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
