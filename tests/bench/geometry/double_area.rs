//! Areas without rounding that matters: a needle's f64 area is off by more than its faces are. In: rings. Out: areas in
//! doubled f64 (Dekker 1971, Knuth TAOCP 4.2.2), right to some 1e-30 of the squared coordinates.

use glam::DVec2;

/// A number as the sum of two, the second below half a step of the first.
#[derive(Clone, Copy, Default)]
pub struct Double(f64, f64);

impl Double {
    fn sum(a: f64, b: f64) -> Double {
        let s = a + b;
        let t = s - a;
        Double(s, (a - (s - t)) + (b - t))
    }

    fn product(a: f64, b: f64) -> Double {
        let p = a * b;
        Double(p, a.mul_add(b, -p))
    }

    pub fn plus(self, other: Double) -> Double {
        let high = Double::sum(self.0, other.0);
        let low = Double::sum(self.1, other.1);
        let first = Double::sum(high.0, high.1 + low.0);
        Double::sum(first.0, first.1 + low.1)
    }

    pub fn negated(self) -> Double {
        Double(-self.0, -self.1)
    }

    pub fn to_f64(self) -> f64 {
        self.0 + self.1
    }
}

/// Twice the signed area of a ring.
pub fn twice_signed_area(ring: &[DVec2]) -> Double {
    let corner = |k: usize| ring[k % ring.len()];
    let cross = |k| {
        let (a, b): (DVec2, DVec2) = (corner(k), corner(k + 1));
        Double::product(a.x, b.y).plus(Double::product(a.y, b.x).negated())
    };
    (0..ring.len()).map(cross).fold(Double::default(), Double::plus)
}
