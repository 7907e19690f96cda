//! Labels: numbers of pixels → how many of them differ.

/// Pixels that differ, of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Disagreement {
    pub differing: usize,
    pub pixels: usize,
}

impl Disagreement {
    pub fn add(&mut self, labels: &[u32], truth: &[u32]) {
        assert_eq!(labels.len(), truth.len(), "images of one size");
        self.differing += labels.iter().zip(truth).filter(|(a, b)| a != b).count();
        self.pixels += truth.len();
    }

    /// 0..1; 0 without pixels.
    pub fn share(&self) -> f64 {
        self.differing as f64 / self.pixels.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn windows_add_up() {
        let mut found = Disagreement::default();
        found.add(&[1, 2, 3, 4], &[1, 2, 4, 4]);
        found.add(&[7], &[7]);
        assert_eq!((found.differing, found.share()), (1, 0.2));
        assert_eq!(Disagreement::default().share(), 0.0);
    }

    proptest! {
        #[test]
        fn every_change_counts(labels in prop::collection::vec(0u32..5, 1..50), at in any::<prop::sample::Index>()) {
            let mut other = labels.clone();
            other[at.index(labels.len())] += 10;
            let mut found = Disagreement::default();
            found.add(&labels, &other);
            prop_assert_eq!(found.differing, 1);
        }
    }
}
