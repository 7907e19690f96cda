//! Sampling: numbers keyed by view, pixel, pass and sample → stratified points in pixels, in the point-spread
//! function, on the sun's disc and in the hemisphere. No number depends on another or on when it is drawn.

use glam::DVec3;
use smallvec::SmallVec;

use crate::interpreter::seed::Seed;

/// What a number is for.
#[derive(Clone, Copy)]
pub enum Dimension {
    Pixel,
    Sun,
    Sky,
    Spread,
}

/// `side × side` strata of one pass over one pixel. Each dimension visits all of them once, in an order of its own.
pub struct Strata {
    seed: Seed,
    side: u32,
    orders: [SmallVec<[u16; 64]>; 4],
}

impl Strata {
    /// `side` is at most 256; only the dimensions of `used` may be asked for.
    pub fn new(seed: Seed, side: u32, used: [bool; 4]) -> Strata {
        let order =
            |at: usize| if used[at] { shuffled(seed.part(1 << 32 | at as u64), side * side) } else { SmallVec::new() };
        let orders = [0, 1, 2, 3].map(order);
        Strata { seed, side, orders }
    }

    /// A point in the unit square for a sample.
    pub fn point(&self, sample: u32, dimension: Dimension) -> [f64; 2] {
        let cell = u32::from(self.orders[dimension as usize][sample as usize]);
        let key = self.seed.part(u64::from(sample) * 8 + dimension as u64);
        let jitter = [key.part(0).unit(), key.part(1).unit()];
        let side = f64::from(self.side);
        [(f64::from(cell % self.side) + jitter[0]) / side, (f64::from(cell / self.side) + jitter[1]) / side]
    }
}

/// Numbers below `count` in random order (Fisher and Yates).
fn shuffled(seed: Seed, count: u32) -> SmallVec<[u16; 64]> {
    let mut order: SmallVec<[u16; 64]> = (0..count).map(|i| i as u16).collect();
    for i in (1..order.len()).rev() {
        let j = (seed.part(i as u64).unit() * (i + 1) as f64) as usize;
        order.swap(i, j);
    }
    order
}

/// The unit square onto the unit disc: equal areas stay equal and near points near (Shirley and Chiu 1997).
pub fn disc([x, y]: [f64; 2]) -> [f64; 2] {
    let (a, b) = (2.0 * x - 1.0, 2.0 * y - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0, 0.0];
    }
    let (radius, angle) = if a.abs() > b.abs() {
        (a, std::f64::consts::FRAC_PI_4 * (b / a))
    } else {
        (b, std::f64::consts::FRAC_PI_2 - std::f64::consts::FRAC_PI_4 * (a / b))
    };
    let (sin, cos) = libm::sincos(angle);
    [radius * cos, radius * sin]
}

/// The unit square onto the plane, normally distributed with deviation 1 (Box and Muller 1958).
pub fn normal([x, y]: [f64; 2]) -> [f64; 2] {
    let radius = (-2.0 * libm::log(1.0 - x)).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * y);
    [radius * cos, radius * sin]
}

/// Two unit vectors across a unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
fn across(n: DVec3) -> (DVec3, DVec3) {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// A direction uniform in a cone about `axis` whose whole angle is `diameter_deg`. The cone is that of a disc in the
/// tangent plane; for the sun's, its solid angle is uniform within 10⁻⁴.
pub fn in_cone(axis: DVec3, diameter_deg: f64, square: [f64; 2]) -> DVec3 {
    let radius = libm::tan((diameter_deg / 2.0).to_radians());
    let [x, y] = disc(square);
    let (u, v) = across(axis);
    (axis + u * (x * radius) + v * (y * radius)).normalize()
}

/// A direction about `normal` with a density that goes with the cosine (Malley's method).
pub fn in_hemisphere(normal: DVec3, square: [f64; 2]) -> DVec3 {
    let [x, y] = disc(square);
    let (u, v) = across(normal);
    u * x + v * y + normal * (1.0 - x * x - y * y).max(0.0).sqrt()
}
