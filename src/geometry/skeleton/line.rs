//! Moving lines and where three of them meet, exactly (`../shared/numerics.md` §5.2, §5.3).
//!
//! In: edges between grid points. Out: lines a x + b y + c = w τ, moments and places at which they meet, sides.

use std::cmp::Ordering;

use super::wavefront::FloatLine;
use crate::geometry::predicates::{I256, gcd};

/// The line of an edge, moving inwards (to the left of the edge) with speed w / |(a, b)| per unit of τ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Line {
    pub a: i64,
    pub b: i64,
    pub c: i64,
    pub w: i64,
}

/// Relative bound for trusting a float sign: covers the roundings of four products and of the event point.
const DOUBT: f64 = 4e-15;

impl Line {
    /// The line through grid point `p` in direction (`dx`, `dy`) != 0; `weight` in 0..=1 scales its speed.
    pub fn new(p: [i64; 2], dx: i64, dy: i64, weight: f64) -> Line {
        let g = gcd(dx.unsigned_abs(), dy.unsigned_abs()) as i64;
        let (a, b) = (-dy / g, dx / g);
        let square = u128::from(a.unsigned_abs()).pow(2) + u128::from(b.unsigned_abs()).pow(2);
        let full = root(square << 64);
        let w = if weight == 1.0 { full } else { (full as f64 * weight).round() as i64 };
        Line { a, b, c: -(a * p[0] + b * p[1]), w }
    }

    /// [self, other]: positive if `other` turns left from this line.
    pub fn cross(&self, other: &Line) -> i64 {
        self.a * other.b - self.b * other.a
    }

    /// Whether the normals point the same way; only asked of parallel lines.
    pub fn same_direction(&self, other: &Line) -> bool {
        i128::from(self.a) * i128::from(other.a) + i128::from(self.b) * i128::from(other.b) > 0
    }
}

/// The integer square root, rounded down; `square` < 2^126. A float gives it to 53 bits, its remainder the rest.
fn root(square: u128) -> i64 {
    let close = (square as f64).sqrt() as i64;
    let rest = square as i128 - i128::from(close) * i128::from(close);
    let mut root = close + (rest as f64 / (2.0 * close as f64)) as i64;
    let below = |root: i64| i128::from(root) * i128::from(root) <= square as i128;
    while !below(root) {
        root -= 1;
    }
    while below(root + 1) {
        root += 1;
    }
    root
}

/// A value of τ as a fraction t / d with d > 0, and as a float.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub tau: f64,
    pub t: i128,
    pub d: i128,
}

impl Moment {
    pub const START: Moment = Moment { tau: 0.0, t: 0, d: 1 };

    /// With τ to three units of its last place.
    pub fn new(t: i128, d: i128) -> Moment {
        let (t, d) = if d < 0 { (-t, -d) } else { (t, d) };
        Moment { tau: close(t) / close(d), t, d }
    }

    /// With τ to one unit of its last place.
    fn rounded(self) -> Moment {
        Moment { tau: self.t as f64 / self.d as f64, ..self }
    }

    /// Exact comparison; floats decide where they can.
    pub fn compare(&self, other: &Moment) -> Ordering {
        let gap = self.tau - other.tau;
        if gap.abs() > DOUBT * (self.tau.abs() + other.tau.abs()) {
            return if gap > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        I256::product(self.t, other.d).minus(I256::product(other.t, self.d)).signum().cmp(&0)
    }
}

/// A float within two units of its last place, in fewer steps than one that is rounded to the nearest.
fn close(v: i128) -> f64 {
    const HALF: f64 = 18_446_744_073_709_551_616.0; // 2^64
    let magnitude = v.unsigned_abs();
    let (high, low) = ((magnitude >> 64) as u64, magnitude as u64);
    // What is shifted out is below a unit of the last place, unless there is no upper half.
    let float = if high == 0 { low as f64 } else { high as i64 as f64 * HALF + (low >> 11) as i64 as f64 * 2048.0 };
    if v < 0 { -float } else { float }
}

/// D of three lines: 0 if they never meet in one point (or always).
pub(super) fn determinant(p: &Line, e: &Line, q: &Line) -> i128 {
    i128::from(p.w) * i128::from(e.cross(q)) - i128::from(e.w) * i128::from(p.cross(q))
        + i128::from(q.w) * i128::from(p.cross(e))
}

/// T of three lines: they meet at τ = T / D.
pub(super) fn time_numerator(p: &Line, e: &Line, q: &Line) -> i128 {
    i128::from(p.c) * i128::from(e.cross(q)) - i128::from(e.c) * i128::from(p.cross(q))
        + i128::from(q.c) * i128::from(p.cross(e))
}

/// A point of the plane at a moment, with exact numerators over the moment's denominator, in grid steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub moment: Moment,
    pub x: f64,
    pub y: f64,
    numerator_x: I256,
    numerator_y: I256,
}

impl Place {
    /// Where three lines meet; `None` if D = 0.
    pub fn of(p: &Line, e: &Line, q: &Line) -> Option<Place> {
        let d = determinant(p, e, q);
        if d == 0 {
            return None;
        }
        let moment = Moment::new(time_numerator(p, e, q), d).rounded();
        let minor = |u: i64, v: i64, s: i64, t: i64| i128::from(u) * i128::from(v) - i128::from(s) * i128::from(t);
        let term = |c: &Line, minor: i128| I256::product(c.c.into(), minor);
        let x = term(p, minor(e.b, q.w, q.b, e.w)).minus(term(e, minor(p.b, q.w, q.b, p.w)));
        let x = x.plus(term(q, minor(p.b, e.w, e.b, p.w)));
        let y = term(e, minor(p.a, q.w, q.a, p.w)).minus(term(p, minor(e.a, q.w, q.a, e.w)));
        let y = y.minus(term(q, minor(p.a, e.w, e.a, p.w)));
        Some(if d > 0 { Place::from(moment, x.negated(), y.negated()) } else { Place::from(moment, x, y) })
    }

    /// Where two lines cross at a moment; `None` if they are parallel.
    pub fn at(moment: Moment, l: &Line, r: &Line) -> Option<Place> {
        let cross = l.cross(r);
        if cross == 0 {
            return None;
        }
        // With the constants k = w t - c d of both lines: x = (k_l b_r - k_r b_l) / (d [l,r]).
        let constant = |e: &Line| I256::product(moment.t, e.w.into()).minus(I256::product(moment.d, e.c.into()));
        let (kl, kr) = (constant(l), constant(r));
        let x = kl.times(r.b).minus(kr.times(l.b)).to_f64();
        let y = kr.times(l.a).minus(kl.times(r.a)).to_f64();
        let scale = moment.d as f64 * cross as f64;
        Some(Place { moment, x: x / scale, y: y / scale, numerator_x: I256::ZERO, numerator_y: I256::ZERO })
    }

    fn from(moment: Moment, numerator_x: I256, numerator_y: I256) -> Place {
        let d = moment.d as f64;
        Place { moment, x: numerator_x.to_f64() / d, y: numerator_y.to_f64() / d, numerator_x, numerator_y }
    }

    /// Exact side of the place as seen from `line` at the moment: 1 inside, 0 on it, -1 outside. Only for places made by
    /// [`Place::of`].
    pub fn side(&self, line: &Line) -> i32 {
        let (side, doubt) = self.float_side(line.a as f64, line.b as f64, line.c as f64, line.w as f64);
        if side.abs() <= doubt {
            self.exact_side(line)
        } else if side > 0.0 {
            1
        } else {
            -1
        }
    }

    /// The side by floats, and the doubt about it.
    #[inline]
    fn float_side(&self, a: f64, b: f64, c: f64, w: f64) -> (f64, f64) {
        let (ax, by, wt) = (a * self.x, b * self.y, w * self.moment.tau);
        (ax + by + c - wt, DOUBT * (ax.abs() + by.abs() + c.abs() + wt.abs()))
    }

    /// False if floats tell that the place is not on the line.
    #[inline]
    pub fn may_be_on(&self, line: &FloatLine) -> bool {
        let (side, doubt) = self.float_side(line.a, line.b, line.c, line.w);
        side.abs() <= doubt
    }

    /// The side by integers.
    pub fn exact_side(&self, line: &Line) -> i32 {
        let Place { moment: m, numerator_x: x, numerator_y: y, .. } = self;
        let offset = I256::product(m.d, line.c.into()).minus(I256::product(m.t, line.w.into()));
        x.times(line.a).plus(y.times(line.b)).plus(offset).signum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(p: [i64; 2], q: [i64; 2]) -> Line {
        Line::new(p, q[0] - p[0], q[1] - p[1], 1.0)
    }

    #[test]
    fn three_sides_of_a_triangle_meet_in_its_incentre() {
        let (a, b, c) = ([0, 0], [4 << 20, 0], [0, 3 << 20]);
        let lines = [edge(a, b), edge(b, c), edge(c, a)];
        let place = Place::of(&lines[0], &lines[1], &lines[2]).expect("an incentre");
        let one = f64::from(1 << 20);
        assert!((place.x - one).abs() < 1e-6 && (place.y - one).abs() < 1e-6);
        assert!((place.moment.tau * 4294967296.0 - one).abs() < 1e-6);
        assert!(lines.iter().all(|l| place.side(l) == 0 && place.exact_side(l) == 0));
        let beyond = edge([0, 2 << 20], [4 << 20, 2 << 20]);
        assert_eq!((place.side(&beyond), place.exact_side(&beyond)), (-1, -1));
    }

    #[test]
    fn place_of_two_lines_agrees_with_that_of_three() {
        let lines =
            [edge([0, 0], [700_001, 13]), edge([700_001, 13], [650_000, 400_000]), edge([650_000, 400_000], [0, 0])];
        let place = Place::of(&lines[0], &lines[1], &lines[2]).expect("an incentre");
        let again = Place::at(place.moment, &lines[2], &lines[0]).expect("a corner");
        assert!((place.x - again.x).abs() < 1e-6 && (place.y - again.y).abs() < 1e-6);
    }

    #[test]
    fn roots_are_rounded_down() {
        for (a, b) in
            [(1u64, 0u64), (1, 1), (3, 4), (1 << 30, 1 << 30), ((1 << 30) - 1, (1 << 30) - 35), (715_827_883, 2)]
        {
            let square = u128::from(a * a + b * b) << 64;
            assert_eq!(u128::from(root(square) as u64), square.isqrt(), "{a} {b}");
        }
    }

    #[test]
    fn lines_on_one_line_are_equal() {
        assert_eq!(edge([3, 5], [9, 8]), edge([11, 9], [15, 11]));
        assert_ne!(edge([3, 5], [9, 8]), edge([9, 8], [3, 5]));
    }

    #[test]
    fn moments_compare_exactly() {
        let third = Moment::new(1 << 100, 3 << 100);
        let close = Moment::new((1 << 100) + 1, 3 << 100);
        assert_eq!(third.compare(&Moment::new(-5, -15)), Ordering::Equal);
        assert_eq!(third.compare(&close), Ordering::Less);
        assert_eq!(third.tau, close.tau);
        for (t, d) in [(-1, 3), (1 << 70, (1 << 64) - 1), (-(1 << 120) - 12_345, (1 << 119) + 987), (0, 1 << 90)] {
            let tau = t as f64 / d as f64;
            assert!((Moment::new(t, d).tau - tau).abs() <= 7e-16 * tau.abs());
        }
    }
}
