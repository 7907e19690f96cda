//! What a derivation used of its program. In: the rules and functions that ran. Out: sets of their ids.

use smallvec::SmallVec;

use crate::cga::program::{FunctionId, RuleId};

/// A set of small numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bits(SmallVec<[u64; 2]>);

impl Bits {
    #[inline]
    pub fn insert(&mut self, number: u32) {
        let word = (number / 64) as usize;
        if word >= self.0.len() {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (number % 64);
    }

    pub fn contains(&self, number: u32) -> bool {
        self.0.get((number / 64) as usize).is_some_and(|word| word & (1 << (number % 64)) != 0)
    }

    pub fn meets(&self, other: &Bits) -> bool {
        self.0.iter().zip(&other.0).any(|(a, b)| a & b != 0)
    }

    /// Adds the numbers of another set.
    pub fn join(&mut self, other: &Bits) {
        self.0.resize(self.0.len().max(other.0.len()), 0);
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own |= other);
    }

    /// In ascending order.
    pub fn iter(&self) -> impl Iterator<Item = u32> {
        let words = (0..).zip(&self.0);
        words.flat_map(|(at, &word): (u32, _)| {
            (0..64).filter(move |bit| word & (1 << bit) != 0).map(move |bit| 64 * at + bit)
        })
    }
}

impl FromIterator<u32> for Bits {
    fn from_iter<T: IntoIterator<Item = u32>>(numbers: T) -> Bits {
        let mut bits = Bits::default();
        numbers.into_iter().for_each(|number| bits.insert(number));
        bits
    }
}

/// Rules and functions that ran; attributes count as used where the host gives no value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Used {
    pub rules: Bits,
    pub functions: Bits,
}

impl Used {
    #[inline]
    pub fn rule(&mut self, id: RuleId) {
        self.rules.insert(id.0);
    }

    #[inline]
    pub fn function(&mut self, id: FunctionId) {
        self.functions.insert(id.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_hold_what_was_put_in() {
        let bits: Bits = [3, 64, 200, 3].into_iter().collect();
        assert_eq!(bits.iter().collect::<Vec<_>>(), [3, 64, 200]);
        assert!(bits.contains(64) && !bits.contains(65) && !bits.contains(9999));
        assert!(bits.meets(&[65, 200].into_iter().collect()) && !bits.meets(&[65].into_iter().collect()));
        let mut joined: Bits = [65, 200].into_iter().collect();
        joined.join(&[1, 500].into_iter().collect());
        assert_eq!(joined.iter().collect::<Vec<_>>(), [1, 65, 200, 500]);
    }
}
