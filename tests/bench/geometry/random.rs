//! A small generator of pseudo-random numbers. In: a seed. Out: the same numbers on every machine.

use glam::DVec2;

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of `low..=high`.
    pub fn count(&mut self, low: u64, high: u64) -> usize {
        (low + self.bits() % (high - low + 1)) as usize
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// 10 to a power between `low` and `high`.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(self.between(low, high))
    }

    pub fn point(&mut self, half_width: f64) -> DVec2 {
        DVec2::new(self.between(-half_width, half_width), self.between(-half_width, half_width))
    }
}
