//! Exact signs on the integer grid. In: grid coordinates and products of them. Out: orientations, and a 256-bit signed
//! integer wide enough for every decision of the skeleton (`../shared/numerics.md` §5.3).

use std::cmp::Ordering;

/// Twice the signed area of the triangle `a`, `b`, `c` in grid steps: positive if it turns left. Exact for coordinates
/// up to 2^29 + 1.
pub fn orientation(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Greatest common divisor of two magnitudes (binary algorithm); the other one if one is 0.
pub fn gcd(a: u64, b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let shift = (a | b).trailing_zeros();
    let (mut a, mut b) = (a >> a.trailing_zeros(), b >> b.trailing_zeros());
    while a != b {
        let apart = a.abs_diff(b);
        b = a.min(b);
        a = apart >> apart.trailing_zeros();
    }
    a << shift
}

/// Two's complement integer of 256 bits: `hi * 2^128 + lo`. The callers' bit budgets exclude overflow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct I256 {
    hi: i128,
    lo: u128,
}

impl I256 {
    pub const ZERO: I256 = I256 { hi: 0, lo: 0 };

    /// The product of two 128-bit integers, exact.
    pub fn product(a: i128, b: i128) -> I256 {
        let (x, y) = (a.unsigned_abs(), b.unsigned_abs());
        let (x1, x0, y1, y0) = (x >> 64, x & LOW, y >> 64, y & LOW);
        let (low, high) = (x0 * y0, x1 * y1);
        let (cross, carry) = (x1 * y0).overflowing_add(x0 * y1);
        let (lo, carry_lo) = low.overflowing_add(cross << 64);
        let hi = high + (cross >> 64) + (u128::from(carry) << 64) + u128::from(carry_lo);
        let magnitude = I256 { hi: hi as i128, lo };
        if (a < 0) != (b < 0) { magnitude.negated() } else { magnitude }
    }

    /// `self * k`, exact while the result fits.
    pub fn times(self, k: i64) -> I256 {
        let negative = (self.hi < 0) != (k < 0);
        let m = if self.hi < 0 { self.negated() } else { self };
        let k = u128::from(k.unsigned_abs());
        let (low, high) = ((m.lo & LOW) * k, (m.lo >> 64) * k);
        let (lo, carry) = low.overflowing_add(high << 64);
        let hi = (m.hi as u128).wrapping_mul(k) + (high >> 64) + u128::from(carry);
        let magnitude = I256 { hi: hi as i128, lo };
        if negative { magnitude.negated() } else { magnitude }
    }

    pub fn plus(self, other: I256) -> I256 {
        let (lo, carry) = self.lo.overflowing_add(other.lo);
        I256 { hi: self.hi.wrapping_add(other.hi).wrapping_add(i128::from(carry)), lo }
    }

    pub fn minus(self, other: I256) -> I256 {
        self.plus(other.negated())
    }

    pub fn negated(self) -> I256 {
        let (lo, carry) = (!self.lo).overflowing_add(1);
        I256 { hi: (!self.hi).wrapping_add(i128::from(carry)), lo }
    }

    /// -1, 0 or 1.
    pub fn signum(self) -> i32 {
        match self.hi.cmp(&0) {
            Ordering::Less => -1,
            Ordering::Equal if self.lo == 0 => 0,
            _ => 1,
        }
    }

    /// The value to within one unit of the last place.
    pub fn to_f64(self) -> f64 {
        if self.hi < 0 {
            return -self.negated().to_f64();
        }
        self.hi as f64 * TWO_128 + self.lo as f64
    }
}

const LOW: u128 = u64::MAX as u128;
const TWO_128: f64 = 340_282_366_920_938_463_463_374_607_431_768_211_456.0;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn orientation_is_exact_at_the_limit() {
        let far = (1 << 29) + 1;
        assert_eq!(orientation([-far, -far], [far, far], [far, far]), 0);
        assert!(orientation([-far, -far], [far, far], [far - 1, far]) > 0);
    }

    fn small(v: i128) -> I256 {
        I256::product(v, 1)
    }

    proptest! {
        #[test]
        fn agrees_with_i128_where_that_fits(a in any::<i64>(), b in any::<i64>(), c in -1000i64..1000) {
            let exact = i128::from(a) * i128::from(b);
            prop_assert_eq!(I256::product(a.into(), b.into()), small(exact));
            prop_assert_eq!(small(exact / 4000).times(c), small(exact / 4000 * i128::from(c)));
            prop_assert_eq!(small(exact / 2).plus(small(a.into())), small(exact / 2 + i128::from(a)));
            prop_assert_eq!(i128::from(small(exact).signum()), exact.signum());
        }

        /// (x + y)(x - y) = x^2 - y^2 with all 256 bits in use.
        #[test]
        fn binomial_identity(x in any::<i128>(), y in any::<i128>()) {
            let (x, y) = (x / 4, y / 4);
            let left = I256::product(x + y, x - y);
            let right = I256::product(x, x).minus(I256::product(y, y));
            prop_assert_eq!(left, right);
            prop_assert_eq!(left.minus(right).signum(), 0);
            let f = (x as f64 + y as f64) * (x as f64 - y as f64);
            prop_assert!((left.to_f64() - f).abs() <= 1e-12 * (x as f64).powi(2).max((y as f64).powi(2)));
        }

        #[test]
        fn times_distributes(x in any::<i128>(), k in any::<i64>()) {
            let once = I256::product(x / 8, 3);
            prop_assert_eq!(once.times(k), I256::product(x / 8, i128::from(k)).times(3));
        }

        #[test]
        fn gcd_divides(a in 0u64..1 << 31, b in 1u64..1 << 31, k in 1u64..1 << 10) {
            let g = gcd(a * k, b * k);
            prop_assert!((a * k).is_multiple_of(g) && (b * k).is_multiple_of(g) && g.is_multiple_of(k));
        }
    }
}
