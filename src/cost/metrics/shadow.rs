//! Shadow: images of the sun's light with and without shadows → masks of shadow, and how far two masks overlap.
//!
//! A pixel lies in shadow where less than half of the sunlight that its surfaces would have without shadows is left.
//! Where they would have hardly any (they look away from the sun) there is nothing to decide.

use super::{Rgb, luminance};

/// Least luminance without shadows, of white, at which a pixel is judged.
const LIT: f32 = 0.01;

/// `Some(true)` in shadow, `Some(false)` in the sun, `None` where the sun does not count.
pub fn mask(sun: &[Rgb], unshadowed: &[Rgb]) -> Vec<Option<bool>> {
    let pixel = |(sun, all): (&Rgb, &Rgb)| {
        let (sun, all) = (luminance(*sun), luminance(*all));
        (all >= LIT).then_some(sun < all / 2.0)
    };
    sun.iter().zip(unshadowed).map(pixel).collect()
}

/// Pixels in both shadows, and in at least one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Overlap {
    both: usize,
    either: usize,
}

impl Overlap {
    /// Compares masks of one size; pixels that one of them does not judge do not count.
    pub fn add(&mut self, mask: &[Option<bool>], truth: &[Option<bool>]) {
        assert_eq!(mask.len(), truth.len(), "masks of one size");
        for (a, b) in mask.iter().zip(truth).filter_map(|(a, b)| a.zip(*b)) {
            self.both += usize::from(a && b);
            self.either += usize::from(a || b);
        }
    }

    /// Intersection over union, 0..1; 1 where neither has shadows.
    pub fn share(&self) -> f64 {
        if self.either == 0 { 1.0 } else { self.both as f64 / self.either as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn overlap(a: &[Option<bool>], b: &[Option<bool>]) -> f64 {
        let mut overlap = Overlap::default();
        overlap.add(a, b);
        overlap.share()
    }

    #[test]
    fn half_the_light_decides_and_dark_walls_do_not_count() {
        let unshadowed = [[0.8; 3], [0.8; 3], [0.8; 3], [0.001; 3]];
        let sun = [[0.39; 3], [0.41; 3], [0.0; 3], [0.0; 3]];
        assert_eq!(mask(&sun, &unshadowed), [Some(true), Some(false), Some(true), None]);
    }

    #[test]
    fn a_strip_moved_by_half_its_width_keeps_a_third() {
        let strip = |from: usize| (0..30).map(|x| Some((from..from + 10).contains(&x))).collect::<Vec<_>>();
        assert_eq!(overlap(&strip(5), &strip(10)), 5.0 / 15.0);
        assert_eq!(overlap(&strip(5), &strip(5)), 1.0);
        assert_eq!(overlap(&strip(0), &strip(15)), 0.0);
        assert_eq!(overlap(&[Some(false), None], &[Some(false), Some(true)]), 1.0);
    }

    proptest! {
        #[test]
        fn overlap_is_symmetric_and_a_share(pairs in prop::collection::vec((any::<bool>(), any::<bool>()), 0..100)) {
            let a: Vec<_> = pairs.iter().map(|p| Some(p.0)).collect();
            let b: Vec<_> = pairs.iter().map(|p| Some(p.1)).collect();
            prop_assert_eq!(overlap(&a, &b), overlap(&b, &a));
            prop_assert!((0.0..=1.0).contains(&overlap(&a, &b)));
            prop_assert_eq!(overlap(&a, &a), 1.0);
        }
    }
}
