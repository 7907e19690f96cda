//! In: bytes. Out: the rings of a footprint: corners on a lattice, generated plans with changes, or any floats.

use arbitrary::{Result, Unstructured};
use glam::DVec2;

use crate::classes::CLASSES;
use crate::geometry::Ring;
use crate::random::Random;

/// Rings with at most some sixty corners drawn from the bytes, or a generated plan of at most a few hundred.
pub fn rings(bytes: &mut Unstructured<'_>) -> Result<Vec<Ring>> {
    let mut rings = match bytes.int_in_range(0..=7u8)? {
        0..=3 => lattice(bytes)?,
        4..=6 => {
            let class = bytes.choose(CLASSES)?;
            (class.make)(&mut Random::new(u64::from(bytes.arbitrary::<u32>()?)))
        }
        _ => floats(bytes)?,
    };
    for _ in 0..bytes.int_in_range(0..=4u8)? {
        change(&mut rings, bytes)?;
    }
    if bytes.ratio(1u8, 4u8)? {
        let (scale, shift) = (libm::exp10(f64::from(bytes.int_in_range(-8..=8i8)?)), bytes.arbitrary::<[i32; 2]>()?);
        let shift = DVec2::new(f64::from(shift[0]), f64::from(shift[1]));
        rings.iter_mut().flatten().for_each(|p| *p = *p * scale + shift);
    }
    Ok(rings)
}

/// Corners on a small lattice, where nearly every event is a tie.
fn lattice(bytes: &mut Unstructured<'_>) -> Result<Vec<Ring>> {
    let unit = *bytes.choose(&[1.0, 0.5, 0.1, 0.37])?;
    let mut rings = Vec::new();
    for _ in 0..bytes.int_in_range(1..=4u8)? {
        let mut ring = Ring::new();
        for _ in 0..bytes.int_in_range(3..=15u8)? {
            let [x, y] = bytes.arbitrary::<[i8; 2]>()?;
            ring.push(DVec2::new(f64::from(x), f64::from(y)) * unit);
        }
        rings.push(ring);
    }
    Ok(rings)
}

/// Any numbers at all.
fn floats(bytes: &mut Unstructured<'_>) -> Result<Vec<Ring>> {
    let mut rings = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3u8)? {
        let mut ring = Ring::new();
        for _ in 0..bytes.int_in_range(0..=12u8)? {
            ring.push(DVec2::from_array(bytes.arbitrary()?));
        }
        rings.push(ring);
    }
    Ok(rings)
}

/// One corner moved, doubled, taken away or put beside another.
fn change(rings: &mut [Ring], bytes: &mut Unstructured<'_>) -> Result<()> {
    let count = rings.len();
    let ring = &mut rings[bytes.int_in_range(0..=count - 1)?];
    if ring.is_empty() {
        return Ok(());
    }
    let (at, other) = (bytes.int_in_range(0..=ring.len() - 1)?, bytes.int_in_range(0..=ring.len() - 1)?);
    let [x, y] = bytes.arbitrary::<[i8; 2]>()?;
    let step = DVec2::new(f64::from(x), f64::from(y)) * libm::exp10(f64::from(bytes.int_in_range(-9..=0i8)?));
    match bytes.int_in_range(0..=3u8)? {
        0 => ring[at] += step,
        1 => ring.insert(at, ring[at] + step),
        2 => drop(ring.remove(at)),
        _ => ring[at] = ring[other] + step,
    }
    Ok(())
}
