//! Float tests of a moving corner against moving lines. In: the two lines of a corner, other lines. Out: whether the corner
//! certainly misses, certainly hits, or the integers have to tell.

use super::cells::Spot;
use super::line::Line;
use super::wavefront::FloatLine;

/// Relative bound for trusting a float: the terms below carry less than a quarter of it.
const DOUBT: f64 = 4e-15;

/// Grid steps by which places may be off that are not on any path.
const SLACK: f64 = 8.0;

/// Where a corner is at time τ: (x, y) + τ (dx, dy), in grid steps. Each number is exact but for three roundings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    x: f64,
    y: f64,
    dx: f64,
    dy: f64,
}

/// The distance of a line from a path at τ = 0 and the speed at which it shrinks, with what the floats leave open.
struct Approach {
    gap: f64,
    gap_doubt: f64,
    speed: f64,
    speed_doubt: f64,
}

/// When a path meets a line, and by how much that may be wrong.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meet {
    tau: f64,
    doubt: f64,
}

impl Path {
    /// Of the corner between two lines that are not parallel.
    pub fn of(l: &Line, r: &Line) -> Path {
        let cross = l.cross(r) as f64;
        let over = |p: i64, q: i64, s: i64, t: i64| {
            (i128::from(p) * i128::from(q) - i128::from(s) * i128::from(t)) as f64 / cross
        };
        Path {
            x: over(r.c, l.b, l.c, r.b),
            y: over(l.c, r.a, r.c, l.a),
            dx: over(l.w, r.b, r.w, l.b),
            dy: over(r.w, l.a, l.w, r.a),
        }
    }

    /// Where the corner is at time τ.
    pub fn spot(&self, tau: f64) -> Spot {
        let (mx, my) = (tau * self.dx, tau * self.dy);
        let size = self.x.abs() + self.y.abs() + mx.abs() + my.abs();
        Spot { at: [self.x + mx, self.y + my], pad: SLACK + DOUBT * size }
    }

    /// Grid steps per unit of τ.
    pub fn speed(&self) -> f64 {
        (self.dx * self.dx + self.dy * self.dy).sqrt()
    }

    #[inline]
    fn approach(&self, f: &FloatLine) -> Approach {
        let (ax, by, au, bv) = (f.a * self.x, f.b * self.y, f.a * self.dx, f.b * self.dy);
        Approach {
            gap: ax + by + f.c,
            gap_doubt: DOUBT * (ax.abs() + by.abs() + f.c.abs()),
            speed: f.w - au - bv,
            speed_doubt: DOUBT * (au.abs() + bv.abs() + f.w),
        }
    }

    /// False if the path certainly does not meet the line from its inner side between `now` and `latest`.
    #[inline]
    pub fn may_meet(&self, f: &FloatLine, now: f64, latest: f64) -> bool {
        let Approach { gap, gap_doubt, speed, speed_doubt } = self.approach(f);
        let leaves = speed < -speed_doubt;
        let past = gap - now * speed < -(gap_doubt + now * speed_doubt);
        // With no bound both sides are infinite, or not numbers: not too late.
        let late = gap - latest * speed > gap_doubt + latest * speed_doubt;
        !(leaves | past | late)
    }

    /// When the path meets the line, if the floats can tell.
    pub fn meet(&self, f: &FloatLine) -> Option<Meet> {
        let Approach { gap, gap_doubt, speed, speed_doubt } = self.approach(f);
        let tau = gap / speed;
        let doubt = 2.0 * (gap_doubt + tau.abs() * speed_doubt) / speed;
        (speed > 4.0 * speed_doubt && doubt.is_finite()).then_some(Meet { tau, doubt })
    }

    /// The side of a line on which the path is then: 1 inside, -1 outside, 0 in doubt.
    pub fn side(&self, f: &FloatLine, meet: Meet) -> i32 {
        let Approach { gap, gap_doubt, speed, speed_doubt } = self.approach(f);
        let side = gap - meet.tau * speed;
        let doubt = gap_doubt + meet.tau.abs() * speed_doubt + (speed.abs() + speed_doubt) * meet.doubt;
        if side > doubt {
            1
        } else if side < -doubt {
            -1
        } else {
            0
        }
    }
}
