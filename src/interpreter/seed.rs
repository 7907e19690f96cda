//! Randomness keyed by identity: every draw is a hash of what it is, never of when it happens.
//!
//! In: a dataset seed and the path of a thing (feature id, rule path, property, draw number). Out: numbers.
//! The mixer is SplitMix64's finaliser (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").

/// A point in the tree of all draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Seed(u64);

fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Seed {
    /// The root of a dataset; seed 0 is as good as any.
    pub fn root(seed: u64) -> Self {
        Seed(mix64(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)))
    }

    /// The seed of the part with this number.
    pub fn part(self, number: u64) -> Self {
        Seed(mix64(self.0 ^ mix64(number.wrapping_add(0x9e37_79b9_7f4a_7c15)).rotate_left(17)))
    }

    /// The seed of the part with this name.
    pub fn named(self, name: &str) -> Self {
        let mut hash = self.0 ^ 0xcbf2_9ce4_8422_2325;
        for chunk in name.as_bytes().chunks(8) {
            let mut word = [0u8; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            hash = mix64(hash ^ u64::from_le_bytes(word)).wrapping_add(chunk.len() as u64);
        }
        Seed(mix64(hash))
    }

    /// A number in [0, 1) with 53 random bits.
    pub fn unit(self) -> f64 {
        (mix64(self.0 ^ 0x5851_f42d_4c95_7f2d) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn bits(self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::Seed;

    #[test]
    fn draws_are_spread_and_independent_of_order() {
        let root = Seed::root(0);
        let mean = (0..10_000).map(|i| root.part(i).unit()).sum::<f64>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        assert_eq!(root.part(3).named("roof").unit(), Seed::root(0).part(3).named("roof").unit());
        assert_ne!(root.named("ab").unit(), root.named("ba").unit());
    }
}
