//! Footprints by class (`../shared/numerics.md` §4, §5, §11, and more). In: random numbers. Out: rings in metres.

use std::f64::consts::TAU;

use glam::DVec2;
use mansard::geometry::Ring;

use crate::plans::{courtyards, histogram, letter, polyomino};
use crate::random::Random;

/// A generator of footprints of one kind.
pub struct Class {
    pub name: &'static str,
    /// Share of the generated polygons.
    pub share: usize,
    pub make: fn(&mut Random) -> Vec<Ring>,
}

const fn class(name: &'static str, share: usize, make: fn(&mut Random) -> Vec<Ring>) -> Class {
    Class { name, share, make }
}

pub const CLASSES: &[Class] = &[
    class("rectangles", 6, |r| {
        let plan = rectangle(r);
        placed(r, vec![plan])
    }),
    class("L, T, U, H, plus", 8, |r| {
        let plan = letter(r);
        placed(r, vec![plan])
    }),
    class("skylines and combs", 6, |r| {
        let plan = histogram(r);
        placed(r, vec![plan])
    }),
    class("polyominoes, their corners touching", 8, |r| {
        let plan = polyomino(r);
        placed(r, plan)
    }),
    class("regular polygons", 4, regular),
    class("nearly regular polygons", 4, nearly_regular),
    class("random stars", 8, |r| {
        let n = r.count(3, 40);
        vec![star(r, n, 0.05, 30.0)]
    }),
    class("random stars of 100 to 400 vertices", 1, |r| {
        let n = r.count(100, 400);
        vec![star(r, n, 0.2, 80.0)]
    }),
    class("stars around stars", 6, |r| {
        let (n, m) = (r.count(3, 20), r.count(3, 20));
        vec![star(r, n, 0.7, 30.0), star(r, m, 0.2, 12.0)]
    }),
    class("courtyards on a grid", 5, |r| {
        let plan = courtyards(r);
        placed(r, plan)
    }),
    class("needles and slots", 6, needle),
    class("walls nearly on one line", 6, nearly_straight),
    class("thick zigzags", 5, zigzag),
    class("stars on 7 bits", 6, |r| on_bits(r, 7)),
    class("stars on 10 bits", 6, |r| on_bits(r, 10)),
    class("stars on 14 bits", 4, |r| on_bits(r, 14)),
    class("touching rings", 5, touching),
    class("self-crossing rings", 6, crossing),
    class("doubled points, spikes, necks", 6, dirty),
    class("from 1 cm to 100 km", 4, scaled),
    class("at UTM and planet offsets", 4, far),
];

fn rectangle(r: &mut Random) -> Ring {
    let (w, h) = (r.between(2.0, 60.0), r.between(2.0, 30.0));
    [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(DVec2::from).to_vec()
}

/// Turned half of the time, moved always.
fn placed(r: &mut Random, mut rings: Vec<Ring>) -> Vec<Ring> {
    let turn = DVec2::from_angle(if r.chance(0.5) { r.between(0.0, TAU) } else { 0.0 });
    let shift = (r.point(2000.0) * 4.0).round() / 4.0;
    rings.iter_mut().flatten().for_each(|p| *p = turn.rotate(*p) + shift);
    rings
}

fn polar(angle: f64, radius: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(angle);
    DVec2::new(cos, sin) * radius
}

fn regular(r: &mut Random) -> Vec<Ring> {
    let n = r.count(3, 64);
    let radius = r.between(2.0, 40.0);
    vec![(0..n).map(|k| polar(TAU * k as f64 / n as f64, radius)).collect()]
}

fn nearly_regular(r: &mut Random) -> Vec<Ring> {
    let noise = r.power(-9.0, -2.0);
    let mut rings = regular(r);
    rings[0].iter_mut().for_each(|p| *p += r.point(noise));
    rings
}

/// Random distances (between `least` and 1 times `radius`) at random angles about the origin.
fn star(r: &mut Random, corners: usize, least: f64, radius: f64) -> Ring {
    let mut angles: Vec<f64> = (0..corners).map(|_| r.between(0.0, TAU)).collect();
    angles.sort_by(f64::total_cmp);
    angles.into_iter().map(|a| polar(a, radius * r.between(least, 1.0))).collect()
}

/// Sharp wedges, slots far narrower than long, chamfers far shorter than their walls.
fn needle(r: &mut Random) -> Vec<Ring> {
    let (w, h, thin) = (r.between(5.0, 100.0), r.between(5.0, 40.0), r.power(-6.0, 0.0));
    let x = r.between(0.1, 0.9) * w;
    let depth = r.between(0.1, 0.95) * h;
    let corners: Vec<(f64, f64)> = match r.count(0, 3) {
        0 => vec![(0.0, 0.0), (w, 0.0), (w, thin)],
        1 => vec![(0.0, 0.0), (w, 0.0), (w, h), (x + thin, h), (x, h - depth), (x, h), (0.0, h)],
        2 => vec![(0.0, 0.0), (w, 0.0), (w, h), (x + thin, h), (x + thin, depth), (x, depth), (x, h), (0.0, h)],
        _ => vec![(thin, 0.0), (w, 0.0), (w, h), (0.0, h), (0.0, thin)],
    };
    placed(r, vec![corners.into_iter().map(DVec2::from).collect()])
}

/// A rectangle or a star whose edges have many vertices a little off the line.
fn nearly_straight(r: &mut Random) -> Vec<Ring> {
    let n = r.count(3, 9);
    let base = if r.chance(0.5) { rectangle(r) } else { star(r, n, 0.4, 30.0) };
    let noise = if r.chance(0.2) { 0.0 } else { r.power(-10.0, -2.0) };
    let mut ring = Ring::new();
    for i in 0..base.len() {
        let (a, b) = (base[i], base[(i + 1) % base.len()]);
        let pieces = r.count(1, 6);
        ring.extend((0..pieces).map(|k| a.lerp(b, k as f64 / pieces as f64) + r.point(noise)));
    }
    placed(r, vec![ring])
}

/// A polyline with a width: parallel walls in plenty; narrow turns cross themselves.
fn zigzag(r: &mut Random) -> Vec<Ring> {
    let (n, half) = (r.count(2, 12), r.between(0.5, 4.0));
    let mut line = vec![DVec2::ZERO];
    let mut heading = 0.0;
    for _ in 0..n {
        heading += if r.chance(0.5) { (r.count(0, 2) as f64 - 1.0) * TAU / 8.0 } else { r.between(-1.2, 1.2) };
        line.push(line[line.len() - 1] + polar(heading, r.between(6.0, 20.0)));
    }
    let side = |k: usize| {
        let before = (line[k] - line[k.saturating_sub(1)]).normalize_or_zero();
        let after = (line[(k + 1).min(n)] - line[k]).normalize_or_zero();
        (before + after).perp().normalize() * half
    };
    let right = (0..=n).map(|k| line[k] - side(k));
    vec![right.chain((0..=n).rev().map(|k| line[k] + side(k))).collect()]
}

/// Rounded to a grid of 2^bits steps, where almost every event is a tie.
fn on_bits(r: &mut Random, bits: i32) -> Vec<Ring> {
    let unit = libm::ldexp(100.0, -bits);
    let n = r.count(4, 40);
    let mut rings = vec![star(r, n, 0.2, 50.0)];
    if r.chance(0.3) {
        let n = r.count(3, 8);
        rings.push(star(r, n, 0.3, 9.0));
    }
    rings.iter_mut().flatten().for_each(|p| *p = (*p / unit).round() * unit);
    rings
}

/// Holes that touch the outline or each other in corners.
fn touching(r: &mut Random) -> Vec<Ring> {
    let outline: Ring = [(0.0, 0.0), (24.0, 0.0), (24.0, 16.0), (0.0, 16.0)].map(DVec2::from).to_vec();
    let diamond = |x: f64, y: f64, s: f64| -> Ring {
        [(x, y), (x - s, y + s), (x, y + 2.0 * s), (x + s, y + s)].map(DVec2::from).to_vec()
    };
    let (s, x) = (r.count(1, 3) as f64, r.count(4, 8) as f64);
    let mut rings = vec![outline];
    // On the southern wall; then one on top of it, one to its right, one in the corner of the first two.
    rings.push(diamond(x, 0.0, s));
    if r.chance(0.7) {
        rings.push(diamond(x, 2.0 * s, s));
    }
    if r.chance(0.7) {
        rings.push(diamond(x + 2.0 * s, 0.0, s));
    }
    if r.chance(0.5) {
        rings.push(diamond(20.0, 4.0, 4.0));
    }
    placed(r, rings)
}

fn crossing(r: &mut Random) -> Vec<Ring> {
    let lattice = r.chance(0.3);
    let ring = |r: &mut Random, corners, width| -> Ring {
        (0..corners).map(|_| r.point(width)).map(|p: DVec2| if lattice { p.round() } else { p }).collect()
    };
    let n = r.count(4, 14);
    let mut rings = vec![ring(r, n, 20.0)];
    for _ in 0..r.count(0, 2) {
        let n = r.count(3, 6);
        rings.push(ring(r, n, 8.0));
    }
    rings
}

/// A sound plan made dirty: closing points, doubles, spikes, necks, either direction.
fn dirty(r: &mut Random) -> Vec<Ring> {
    let n = r.count(4, 12);
    let mut ring = if r.chance(0.5) { letter(r) } else { star(r, n, 0.3, 20.0) };
    for _ in 0..r.count(1, 4) {
        let at = r.count(0, ring.len() as u64 - 1);
        let p = ring[at];
        match r.count(0, 3) {
            0 => ring.insert(at, p + r.point(1e-4)),
            1 => {
                let tip = p + r.point(10.0);
                ring.splice(at..at, [p, tip]);
            }
            2 => {
                let q = p + r.point(6.0);
                let room = [q, q + DVec2::X, q + DVec2::ONE, q];
                ring.splice(at..at, [p].into_iter().chain(room));
            }
            _ => ring.push(ring[0]),
        }
    }
    if r.chance(0.5) {
        ring.reverse();
    }
    placed(r, vec![ring])
}

fn scaled(r: &mut Random) -> Vec<Ring> {
    let (n, size) = (r.count(3, 20), r.power(-2.0, 5.0));
    let mut ring = star(r, n, 0.2, 1.0);
    ring.iter_mut().for_each(|p| *p *= size);
    vec![ring]
}

fn far(r: &mut Random) -> Vec<Ring> {
    let shift = if r.chance(0.5) { DVec2::new(6e5, 4.2e6) } else { DVec2::new(2e7, -2e7) };
    let n = r.count(4, 20);
    let ring = if r.chance(0.5) { letter(r) } else { star(r, n, 0.3, 20.0) };
    vec![ring.into_iter().map(|p| p + shift).collect()]
}
