//! Textures the program makes itself, so that every dataset can be shared. In: a `builtin:` name. Out: a square
//! tile of [`SIZE`] pixels that repeats without a seam, the same bytes on every machine.
//!
//! Rules name them like files: `texture("builtin:roof_tiles")`. They are near white (mean luminance about 0.8) unless
//! they stand for a material of one colour, so that CGA's `color` tints them.

use image::{Rgba, RgbaImage};

/// Pixels per side of a built-in tile.
pub const SIZE: u32 = 128;

/// How a tile is painted: a colour in 0..1 at a pixel.
type Paint = fn(u32, u32) -> [f64; 3];

/// Every built-in texture; the length of side a tile is meant for, in metres, stands beside it.
const TILES: &[(&str, f64, Paint)] = &[
    ("builtin:white", 1.0, |_, _| [1.0; 3]),
    ("builtin:roof_tiles", 3.0, roof_tiles),
    ("builtin:shingles", 3.0, shingles),
    ("builtin:sheet_metal", 6.0, sheet_metal),
    ("builtin:gravel", 4.0, |x, y| grey(0.80 + 0.30 * (noise(x, y, 2, 11) - 0.5) + 0.16 * (noise(x, y, 16, 12) - 0.5))),
    ("builtin:plaster", 4.0, |x, y| grey(0.90 + 0.10 * (fractal(x, y, 21) - 0.5))),
    ("builtin:brick", 2.0, brick),
    ("builtin:concrete", 6.0, |x, y| grey(0.82 + 0.20 * (fractal(x, y, 31) - 0.5) - seam(x, y, 64))),
    ("builtin:facade", 3.0, facade),
    ("builtin:asphalt", 8.0, |x, y| grey(0.34 + 0.10 * (noise(x, y, 2, 41) - 0.5) + 0.10 * (fractal(x, y, 42) - 0.5))),
    ("builtin:paving", 4.0, |x, y| grey(0.72 + 0.14 * (cell(x, y, 16, 51) - 0.5) - seam(x, y, 16))),
    ("builtin:grass", 32.0, |x, y| blend(x, y, 61, [0.24, 0.36, 0.14], [0.42, 0.52, 0.24])),
    ("builtin:meadow", 48.0, |x, y| blend(x, y, 71, [0.40, 0.47, 0.22], [0.58, 0.60, 0.34])),
    ("builtin:farmland", 24.0, farmland),
    ("builtin:forest", 24.0, forest),
    ("builtin:soil", 32.0, |x, y| blend(x, y, 91, [0.42, 0.36, 0.26], [0.60, 0.52, 0.40])),
    ("builtin:ground", 64.0, |x, y| blend(x, y, 101, [0.44, 0.44, 0.30], [0.62, 0.59, 0.43])),
    ("builtin:sand", 32.0, |x, y| blend(x, y, 111, [0.76, 0.69, 0.52], [0.88, 0.82, 0.66])),
    ("builtin:rock", 48.0, |x, y| blend(x, y, 121, [0.42, 0.40, 0.38], [0.66, 0.63, 0.59])),
    ("builtin:water", 48.0, |x, y| blend(x, y, 131, [0.10, 0.19, 0.24], [0.14, 0.25, 0.31])),
    ("builtin:ash", 8.0, ash),
    ("builtin:rubble", 4.0, rubble),
    // Names that CityEngine has too (cga-reference 4.0.6).
    ("builtin:default", 1.0, |x, y| grey(f64::from((x / 8 + y / 8) % 2))),
    ("builtin:uvtest.png", 1.0, uv_test),
    ("builtin:unknowntexture.png", 1.0, |x, y| if (x / 32 + y / 32) % 2 == 0 { [0.9, 0.1, 0.8] } else { grey(0.1) }),
];

/// Names of all built-in textures, in the order of the manual.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    TILES.iter().map(|(name, ..)| *name)
}

/// Length in metres that the side of a built-in tile is meant to cover.
pub fn builtin_size(name: &str) -> Option<f64> {
    TILES.iter().find(|(n, ..)| *n == name).map(|(_, size, _)| *size)
}

/// Paints a built-in texture; `None` for a name that does not exist.
pub fn builtin(name: &str) -> Option<RgbaImage> {
    let (.., paint) = TILES.iter().find(|(n, ..)| *n == name)?;
    Some(RgbaImage::from_fn(SIZE, SIZE, |x, y| {
        let [r, g, b] = paint(x, y).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
        Rgba([r, g, b, 255])
    }))
}

/// Red grows with u, green with v, in 8 x 8 fields; an F stands upright in the lower left quarter.
fn uv_test(x: u32, y: u32) -> [f64; 3] {
    const F: [&str; 7] = ["#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "];
    let (column, row) = ((x as usize).wrapping_sub(12) / 8, (y as usize).wrapping_sub(68) / 8);
    if F.get(row).and_then(|line| line.as_bytes().get(column)) == Some(&b'#') {
        return grey(1.0);
    }
    let (u, v) = (f64::from(x / 16) / 7.0, 1.0 - f64::from(y / 16) / 7.0);
    let shade = if (x / 16 + y / 16).is_multiple_of(2) { 1.0 } else { 0.8 };
    [(0.15 + 0.8 * u) * shade, (0.15 + 0.8 * v) * shade, 0.3 * shade]
}

fn grey(v: f64) -> [f64; 3] {
    [v; 3]
}

/// A number in [0, 1) for a lattice point.
fn hash(x: u32, y: u32, salt: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77) ^ salt.wrapping_mul(0xc2b2_ae3d);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    f64::from(h ^ (h >> 15)) / 4_294_967_296.0
}

/// One random number per square of `step` pixels.
fn cell(x: u32, y: u32, step: u32, salt: u32) -> f64 {
    hash(x / step, y / step, salt)
}

/// Smooth noise with features of `step` pixels, periodic over the tile.
fn noise(x: u32, y: u32, step: u32, salt: u32) -> f64 {
    let cells = SIZE / step;
    let (i, j) = (x / step, y / step);
    let fade = |v: u32| {
        let t = (f64::from(v % step) + 0.5) / f64::from(step);
        t * t * (3.0 - 2.0 * t)
    };
    let (u, v) = (fade(x), fade(y));
    let at = |a: u32, b: u32| hash((i + a) % cells, (j + b) % cells, salt);
    let (low, high) = (at(0, 0) + (at(1, 0) - at(0, 0)) * u, at(0, 1) + (at(1, 1) - at(0, 1)) * u);
    low + (high - low) * v
}

/// Noise of several sizes, mean 0.5.
fn fractal(x: u32, y: u32, salt: u32) -> f64 {
    [(64, 0.4), (16, 0.3), (4, 0.2), (1, 0.1)].iter().map(|&(step, w)| w * noise(x, y, step, salt + step)).sum()
}

/// Mottled ground: no single feature is large enough to show how often the tile repeats.
fn blend(x: u32, y: u32, salt: u32, dark: [f64; 3], light: [f64; 3]) -> [f64; 3] {
    let sizes = [(16, 0.2), (8, 0.2), (4, 0.2), (2, 0.2), (1, 0.2)];
    let mean: f64 = sizes.iter().map(|&(step, w)| w * noise(x, y, step, salt + step)).sum();
    let t = ((mean - 0.5) * 1.8 + 0.5).clamp(0.0, 1.0);
    std::array::from_fn(|c| dark[c] + (light[c] - dark[c]) * t)
}

/// Darkening along the joints of squares of `step` pixels.
fn seam(x: u32, y: u32, step: u32) -> f64 {
    if x.is_multiple_of(step) || y.is_multiple_of(step) { 0.07 } else { 0.0 }
}

fn roof_tiles(x: u32, y: u32) -> [f64; 3] {
    let (row, across) = (y / 16, x % 16);
    let curve = 1.0 - (f64::from(across) - 7.5).abs() / 7.5;
    let shade = 0.70 + 0.22 * curve - if y % 16 < 2 { 0.25 } else { 0.0 };
    grey(shade + 0.14 * (hash(x / 16, row, 201) - 0.5))
}

fn shingles(x: u32, y: u32) -> [f64; 3] {
    let row = y / 8;
    let shifted = (x + if row.is_multiple_of(2) { 0 } else { 8 }) % SIZE;
    let joint = if y.is_multiple_of(8) || shifted.is_multiple_of(16) { 0.16 } else { 0.0 };
    grey(0.82 - joint + 0.20 * (hash(shifted / 16, row, 211) - 0.5))
}

fn sheet_metal(x: u32, y: u32) -> [f64; 3] {
    let rib = match x % 32 {
        0 | 1 => 0.12,
        2 | 3 => -0.14,
        _ => 0.0,
    };
    grey(0.82 + rib + 0.10 * (fractal(x, y, 221) - 0.5))
}

fn brick(x: u32, y: u32) -> [f64; 3] {
    let row = y / 8;
    let shifted = (x + if row.is_multiple_of(2) { 0 } else { 12 }) % SIZE;
    if y.is_multiple_of(8) || shifted.is_multiple_of(32) {
        return grey(0.88);
    }
    let shade = 0.78 + 0.24 * (hash(shifted / 32, row, 231) - 0.5);
    [shade, shade * 0.92, shade * 0.88]
}

/// One window bay: wall, frame and glass.
fn facade(x: u32, y: u32) -> [f64; 3] {
    let (inside_x, inside_y) = ((40..88).contains(&x), (34..100).contains(&y));
    if !(inside_x && inside_y) {
        return grey(0.90 + 0.06 * (fractal(x, y, 241) - 0.5));
    }
    let frame = !(44..84).contains(&x) || !(38..96).contains(&y) || (62..66).contains(&x);
    if frame { grey(0.97) } else { [0.24, 0.30, 0.36] }
}

fn farmland(x: u32, y: u32) -> [f64; 3] {
    let furrow = if x % 8 < 3 { -0.06 } else { 0.03 };
    blend(x, y, 81, [0.50, 0.44, 0.26], [0.68, 0.62, 0.38]).map(|c| c + furrow)
}

/// Tree crowns seen from above.
fn forest(x: u32, y: u32) -> [f64; 3] {
    let (i, j) = (x / 16, y / 16);
    let mut light = 0.0f64;
    for dj in [7, 0, 1] {
        for di in [7, 0, 1] {
            let (a, b) = ((i + di) % 8, (j + dj) % 8);
            let centre = [hash(a, b, 251) * 10.0 + 3.0, hash(a, b, 252) * 10.0 + 3.0];
            let wrap = |d: f64| (d + 64.0).rem_euclid(128.0) - 64.0;
            let dx = wrap(f64::from(x) - f64::from(a) * 16.0 - centre[0]);
            let dy = wrap(f64::from(y) - f64::from(b) * 16.0 - centre[1]);
            let radius = 7.0 + 4.0 * hash(a, b, 253);
            light = light.max(1.0 - (dx * dx + dy * dy).sqrt() / radius);
        }
    }
    let t = light.clamp(0.0, 1.0) * 0.8 + 0.2 * noise(x, y, 2, 254);
    [0.10 + 0.16 * t, 0.17 + 0.23 * t, 0.07 + 0.10 * t]
}

fn ash(x: u32, y: u32) -> [f64; 3] {
    let t = fractal(x, y, 261);
    let v = 0.14 + 0.34 * t + if noise(x, y, 4, 262) > 0.82 { 0.07 } else { 0.0 };
    [v * 1.02, v, v * 0.97]
}

fn rubble(x: u32, y: u32) -> [f64; 3] {
    let stone = cell(x, y, 8, 271) * 0.6 + cell((x + 4) % SIZE, (y + 4) % SIZE, 8, 272) * 0.4;
    let v = 0.22 + 0.50 * stone + 0.10 * (noise(x, y, 2, 273) - 0.5);
    [v, v * 0.95, v * 0.90]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_know_the_built_in_textures() {
        use crate::interpreter::assets::{BUILTIN_IMAGES, builtin_image};
        assert!(builtin_names().eq(BUILTIN_IMAGES.iter().copied()));
        assert_eq!(builtin_image("builtin:brick").map(|info| info.width), Some(SIZE));
    }

    #[test]
    fn every_tile_repeats_without_a_seam() {
        for name in builtin_names() {
            let tile = builtin(name).expect("listed names can be painted");
            // Steps across the tile's border are no larger than steps within it.
            let step = |a: &Rgba<u8>, b: &Rgba<u8>| (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))).sum::<f64>();
            let pixel = |x: u32, y: u32| tile.get_pixel(x % SIZE, y);
            let column = |x: u32| (0..SIZE).map(|y| step(pixel(x, y), pixel(x + 1, y))).sum::<f64>();
            let inner = (0..SIZE - 1).map(column).fold(0.0, f64::max);
            assert!(column(SIZE - 1) <= inner + 1.0, "{name} has a seam");
        }
        assert!(builtin("builtin:nothing").is_none());
    }
}
