//! Exact orientation of three plan points. In: f64 coordinates as they are. Out: a sign that is never wrong.
//!
//! Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997): a filtered
//! float determinant first, and where that is in doubt the exact sum of the six products.

use std::cmp::Ordering;

use glam::DVec2;

/// Error bound of the float determinant, (3 + 16 e) e with e = 2^-53 (Shewchuk, section 4.3).
const FILTER: f64 = 3.330_669_073_875_471_6e-16;

/// `Greater`: a, b, c turn left (counter-clockwise); `Less`: right; `Equal`: on one line.
/// Exact for coordinates of magnitude 0 or 1e-140 to 1e150.
pub fn orientation(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let (left, right) = ((a.x - c.x) * (b.y - c.y), (a.y - c.y) * (b.x - c.x));
    let det = left - right;
    if det.abs() > FILTER * (left.abs() + right.abs()) {
        return det.total_cmp(&0.0);
    }
    exact_sign(a, b, c)
}

fn exact_sign(a: DVec2, b: DVec2, c: DVec2) -> Ordering {
    let products = [(a.x, b.y), (-a.y, b.x), (b.x, c.y), (-b.y, c.x), (c.x, a.y), (-c.y, a.x)];
    let mut sum = [0.0; 12];
    let mut length = 0;
    for (p, q) in products {
        let high = p * q;
        let low = p.mul_add(q, -high);
        for term in [low, high] {
            length = grow(&mut sum, length, term);
        }
    }
    // The last non-zero part of a non-overlapping expansion has the sign of the whole.
    let leading = sum[..length].iter().rev().find(|&&x| x != 0.0).copied().unwrap_or(0.0);
    if leading > 0.0 {
        Ordering::Greater
    } else if leading < 0.0 {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}

/// Adds one float to an expansion without loss (Shewchuk's GROW-EXPANSION); returns the new length.
fn grow(expansion: &mut [f64; 12], length: usize, term: f64) -> usize {
    let mut carry = term;
    for part in &mut expansion[..length] {
        let total = carry + *part;
        let virtual_part = total - carry;
        *part = (carry - (total - virtual_part)) + (*part - virtual_part);
        carry = total;
    }
    expansion[length] = carry;
    length + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_last_bit_decides() {
        let (a, b) = (DVec2::new(0.5, 0.5), DVec2::new(12.0, 12.0));
        for i in 0..64 {
            for j in 0..64 {
                let ulp = f64::EPSILON / 2.0;
                let c = DVec2::new(24.0, 24.0);
                let p = DVec2::new(0.5 + i as f64 * ulp, 0.5 + j as f64 * ulp);
                let expected = j.cmp(&i);
                assert_eq!(orientation(p, b, c), expected, "{i} {j}");
                assert_eq!(orientation(b, c, p), expected, "{i} {j}");
            }
        }
        assert_eq!(orientation(a, b, DVec2::new(24.0, 24.0)), Ordering::Equal);
    }

    proptest! {
        #[test]
        fn agrees_with_integers(c in prop::array::uniform6(-1_000_000_000i64..1_000_000_000)) {
            let det = i128::from(c[0] - c[4]) * i128::from(c[3] - c[5]) - i128::from(c[1] - c[5]) * i128::from(c[2] - c[4]);
            let p = |i: usize| DVec2::new(c[i] as f64 * 0.125, c[i + 1] as f64 * 0.125);
            prop_assert_eq!(orientation(p(0), p(2), p(4)), det.cmp(&0));
        }

        #[test]
        fn points_of_one_line_are_collinear(d in prop::array::uniform2(-1000i32..1000), s in 1i32..1000, t in 1i32..1000) {
            let at = |k: i32| DVec2::new(f64::from(d[0]) * f64::from(k) + 0.25, f64::from(d[1]) * f64::from(k) - 0.5);
            prop_assert_eq!(orientation(at(0), at(s), at(t)), Ordering::Equal);
        }
    }
}
