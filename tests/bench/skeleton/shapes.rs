//! Simple polygons with a given number of vertices. In: random numbers. Out: counter-clockwise rings in metres.

use std::f64::consts::TAU;

use glam::DVec2;
use mansard::geometry::Ring;

use crate::random::Random;

/// A ring of exactly so many vertices.
pub type Shape = fn(&mut Random, usize) -> Ring;

fn polar(angle: f64, radius: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin) * radius
}

/// Turned by any angle and moved.
fn turned(r: &mut Random, ring: Ring) -> Ring {
    let (turn, shift) = (DVec2::from_angle(r.between(0.0, TAU)), r.point(2000.0));
    ring.into_iter().map(|p| turn.rotate(p) + shift).collect()
}

/// A rectangle of a building's size at any turn.
pub fn rectangle(r: &mut Random, _: usize) -> Ring {
    let (w, h) = (r.between(4.0, 40.0), r.between(4.0, 20.0));
    turned(r, [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(DVec2::from).to_vec())
}

/// A rectilinear plan with walls of whole half metres: stairs, T, U, H and the like, wings to the north and to the south
/// of one body. Half of them are turned. `n` is even.
pub fn plan(r: &mut Random, n: usize) -> Ring {
    let steps = n / 2 - 2;
    let north = r.count(0, steps as u64);
    let width = 6 * (steps as u64 + 1);
    let mut ring = skyline(r, steps - north, width);
    let body = DVec2::new(width as f64, 12.0) / 2.0;
    // Half a turn about the body's centre makes a northern side of a southern one.
    let opposite = skyline(r, north, width);
    ring.extend(opposite.into_iter().map(|p| body - p));
    if r.chance(0.5) { turned(r, ring) } else { ring }
}

/// The southern side of a plan from west to east, with `steps` steps at different places, each to another depth.
fn skyline(r: &mut Random, steps: usize, width: u64) -> Vec<DVec2> {
    let mut places: Vec<usize> = Vec::new();
    while places.len() < steps {
        let missing = steps - places.len();
        places.extend((0..missing).map(|_| r.count(1, width - 1)));
        places.sort_unstable();
        places.dedup();
    }
    let mut depth = r.count(0, 16);
    let mut side = vec![(0, depth)];
    for x in places {
        side.push((x, depth));
        depth = (depth + r.count(1, 16)) % 17;
        side.push((x, depth));
    }
    side.push((width as usize, depth));
    side.into_iter().map(|(x, depth)| DVec2::new(x as f64, -(depth as f64)) / 2.0).collect()
}

/// Random distances at nearly even angles: about half of the corners are reflex.
pub fn star(r: &mut Random, n: usize) -> Ring {
    (0..n).map(|k| polar(TAU * (k as f64 + r.unit()) / n as f64, r.between(6.0, 30.0))).collect()
}

/// A regular polygon: all of it ends in one point.
pub fn circle(r: &mut Random, n: usize) -> Ring {
    let radius = r.between(6.0, 30.0);
    (0..n).map(|k| polar(TAU * k as f64 / n as f64, radius)).collect()
}

/// Equal teeth on a bar. `n` is a multiple of four.
pub fn comb(r: &mut Random, n: usize) -> Ring {
    let (width, depth, teeth) = (r.between(0.5, 3.0), r.between(5.0, 20.0), n / 4);
    let mut ring: Ring = vec![DVec2::ZERO, DVec2::new((2 * teeth - 1) as f64 * width, 0.0)];
    for tooth in (0..teeth).rev() {
        let (x0, x1) = ((2 * tooth) as f64 * width, (2 * tooth + 1) as f64 * width);
        ring.extend([DVec2::new(x1, depth), DVec2::new(x0, depth)]);
        if tooth > 0 {
            ring.extend([DVec2::new(x0, width), DVec2::new(x0 - width, width)]);
        }
    }
    ring
}
