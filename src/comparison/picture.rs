//! Pictures of differences. In: two decoded images. Out: a strip A, B, difference, with captions and a scale. Large images
//! are made smaller, but every pixel that differs stays in sight: the difference of a block is its greatest.

use super::glyphs;
use super::pixels::{Decoded, Kind};
use crate::cost::report::picture::Picture;
use crate::frame::Pixels;

type Rgb = [u8; 3];

/// Greatest and least side of an image in a strip, pixels.
const MOST: u32 = 640;
const LEAST: u32 = 288;
const GAP: u32 = 12;
/// Height of a line of captions; letters are drawn twice as large.
const LINE: u32 = 24;
const SCALE: u32 = 2;
const BACK: Rgb = [251, 251, 250];
const INK: Rgb = [28, 35, 48];
/// Differences of labels.
const CHANGED: Rgb = [255, 170, 20];
/// Colours of small numbers, by the number.
const LABELS: [Rgb; 9] = [
    [20, 20, 24],
    [176, 168, 140],
    [214, 84, 60],
    [120, 120, 128],
    [196, 206, 120],
    [86, 150, 82],
    [150, 200, 140],
    [70, 130, 200],
    [30, 100, 60],
];

/// A picture that is being put together.
pub struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

impl Canvas {
    fn new(width: u32, height: u32) -> Canvas {
        Canvas { width, height, pixels: vec![BACK; (width * height) as usize] }
    }

    fn set(&mut self, x: u32, y: u32, color: Rgb) {
        if x < self.width && y < self.height {
            self.pixels[(y * self.width + x) as usize] = color;
        }
    }

    fn text(&mut self, left: u32, top: u32, text: &str) {
        for (x, y) in glyphs::ink(text) {
            for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                self.set(left + SCALE * x + i, top + SCALE * y + j, INK);
            }
        }
    }

    fn paste(&mut self, left: u32, top: u32, cell: &Cell) {
        for y in 0..cell.height {
            for x in 0..cell.width {
                self.set(left + x, top + y, cell.pixels[(y * cell.width + x) as usize]);
            }
        }
    }

    /// One picture below the other.
    pub fn stacked(strips: &[Canvas]) -> Picture {
        let width = strips.iter().map(|s| s.width).max().unwrap_or(1);
        let height = strips.iter().map(|s| s.height).sum::<u32>().max(1);
        let mut all = Canvas::new(width, height);
        let mut top = 0;
        for strip in strips {
            let cell = Cell { width: strip.width, height: strip.height, pixels: strip.pixels.clone() };
            all.paste(0, top, &cell);
            top += strip.height;
        }
        Picture { width, height, bytes: all.pixels.into_iter().flatten().collect() }
    }
}

struct Cell {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

/// How pixels of an image become pixels of a strip: `by` of them one, or one `times` of them.
#[derive(Clone, Copy)]
struct Zoom {
    width: u32,
    height: u32,
    by: u32,
    times: u32,
}

impl Zoom {
    fn of(image: &Decoded) -> Zoom {
        let side = image.width.max(image.height).max(1);
        let (by, times) = (side.div_ceil(MOST), if side < LEAST { LEAST.div_ceil(side) } else { 1 });
        Zoom { width: image.width, height: image.height, by, times }
    }

    fn cell(self, color: impl Fn(&mut dyn Iterator<Item = usize>) -> Rgb) -> Cell {
        let (width, height) = (self.width.div_ceil(self.by) * self.times, self.height.div_ceil(self.by) * self.times);
        let mut pixels = Vec::with_capacity((width * height) as usize);
        for y in 0..height {
            for x in 0..width {
                let range = |at: u32, end: u32| {
                    let first = at / self.times * self.by;
                    first..(first + self.by).min(end)
                };
                let (columns, rows) = (range(x, self.width), range(y, self.height));
                let mut block = rows
                    .flat_map(|j| columns.clone().map(move |i| (j * self.width + i) as usize))
                    .collect::<Vec<_>>()
                    .into_iter();
                pixels.push(color(&mut block));
            }
        }
        Cell { width, height, pixels }
    }
}

/// A strip of two images of the same size and kind. `name` is the image's, `result` how it differs.
pub fn strip(a: &Decoded, b: &Decoded, kind: Kind, name: &str, result: &str) -> Canvas {
    let zoom = Zoom::of(a);
    let scale = DepthScale::of(a, b);
    let shown = |image: &Decoded| zoom.cell(|block| average(image, kind, &scale, block));
    let (left, right) = (shown(a), shown(b));
    let differences = differences(a, b, kind, &scale);
    let heat = zoom.cell(|block| {
        let block: Vec<usize> = block.collect();
        let greatest = block.iter().map(|&i| differences[i]).fold(0.0f32, f32::max);
        match (greatest > 0.0, kind) {
            (false, _) => {
                let [r, g, b] = average(a, kind, &scale, &mut block.into_iter());
                let grey = (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
                [(grey / 4) as u8; 3]
            }
            (true, Kind::Labels) => CHANGED,
            (true, Kind::Colour | Kind::Depth) => heat_color(greatest),
        }
    });
    let step = left.width + GAP;
    // Three cells, a line of captions above, a scale and a line of numbers below.
    let mut out = Canvas::new(3 * step + GAP, LINE + left.height + 2 * LINE + GAP);
    for (number, (cell, caption)) in
        [(&left, format!("A {name}")), (&right, format!("B {name}")), (&heat, "difference".to_owned())]
            .into_iter()
            .enumerate()
    {
        let x = GAP + number as u32 * step;
        out.text(x, 6, &fitting(&caption, cell.width));
        out.paste(x, LINE, cell);
    }
    let below = LINE + left.height + 8;
    out.text(GAP, below + 2, &fitting(result, 2 * left.width));
    legend(&mut out, GAP + 2 * step, below, left.width, kind, &scale);
    out
}

/// As much of a caption as a width holds.
fn fitting(text: &str, width: u32) -> String {
    text.chars().take((width / (SCALE * glyphs::ADVANCE)) as usize).collect()
}

/// The scale of a difference: colours at the root of the share, so that small differences are seen.
fn legend(out: &mut Canvas, left: u32, top: u32, width: u32, kind: Kind, scale: &DepthScale) {
    if kind == Kind::Labels {
        for (x, y) in (0..16).flat_map(|x| (0..14).map(move |y| (x, y))) {
            out.set(left + x, top + y, CHANGED);
        }
        out.text(left + 24, top, &fitting("another label", width.saturating_sub(24)));
        return;
    }
    for x in 0..width {
        let value = (x as f32 / width.max(2) as f32).powi(2);
        for y in 0..12 {
            out.set(left + x, top + y, heat_color(value.max(1e-6)));
        }
    }
    let ticks: Vec<(f32, String)> = match kind {
        Kind::Depth => [0.0625, 0.25, 1.0].map(|share| (share, metres(share * scale.difference))).to_vec(),
        Kind::Colour | Kind::Labels => [1.0, 16.0, 64.0, 255.0].map(|n: f32| (n / 255.0, n.to_string())).to_vec(),
    };
    for (share, text) in ticks {
        let (at, wide) = ((share.sqrt() * width as f32) as u32, text.len() as u32 * SCALE * glyphs::ADVANCE);
        out.text(left + at.saturating_sub(wide / 2).min(width.saturating_sub(wide)), top + 16, &text);
    }
}

fn metres(m: f32) -> String {
    if m >= 0.01 { format!("{m:.2}M") } else { format!("{m:.0e}M") }
}

/// Metres between which depths are shown, and the greatest difference that is not infinite.
struct DepthScale {
    low: f32,
    high: f32,
    difference: f32,
}

impl DepthScale {
    fn of(a: &Decoded, b: &Decoded) -> DepthScale {
        let mut scale = DepthScale { low: f32::INFINITY, high: f32::NEG_INFINITY, difference: 0.0 };
        let (Pixels::Float32(a), Pixels::Float32(b)) = (&a.pixels, &b.pixels) else { return scale };
        for depth in a.iter().chain(b).filter(|depth| depth.is_finite()) {
            (scale.low, scale.high) = (scale.low.min(*depth), scale.high.max(*depth));
        }
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).filter(|apart| apart.is_finite());
        scale.difference = apart.fold(0.0, f32::max);
        scale
    }
}

/// The colour of a block: the mean of colours, the middle one of labels.
fn average(image: &Decoded, kind: Kind, scale: &DepthScale, block: &mut dyn Iterator<Item = usize>) -> Rgb {
    let block: Vec<usize> = block.collect();
    if kind != Kind::Colour {
        return color(image, kind, scale, block[block.len() / 2]);
    }
    let sum = block.iter().map(|&i| color(image, kind, scale, i).map(u32::from));
    let sum = sum.fold([0u32; 3], |a, b| std::array::from_fn(|k| a[k] + b[k]));
    sum.map(|s| (s / block.len() as u32) as u8)
}

fn color(image: &Decoded, kind: Kind, scale: &DepthScale, i: usize) -> Rgb {
    // Linear light of 16 bits looks right with a root.
    let encoded = |x: u16| (f64::from(x) / 65535.0).sqrt().mul_add(255.0, 0.5) as u8;
    match &image.pixels {
        Pixels::Rgb8(data) => [data[3 * i], data[3 * i + 1], data[3 * i + 2]],
        Pixels::Rgb16(data) => [data[3 * i], data[3 * i + 1], data[3 * i + 2]].map(encoded),
        Pixels::Gray16(data) => [encoded(data[i]); 3],
        Pixels::Gray8(data) if kind == Kind::Colour || data[i] == 255 => [data[i]; 3],
        Pixels::Gray8(data) => {
            LABELS.get(usize::from(data[i])).copied().unwrap_or_else(|| scattered(u32::from(data[i])))
        }
        Pixels::Id32(data) => {
            if data[i] == 0 {
                LABELS[0]
            } else {
                scattered(data[i])
            }
        }
        Pixels::Float32(data) if data[i].is_finite() => {
            let share = (data[i] - scale.low) / (scale.high - scale.low).max(1e-6);
            [(235.0 - 200.0 * share) as u8; 3]
        }
        Pixels::Float32(_) => LABELS[0],
    }
}

/// A colour of its own for every number.
fn scattered(number: u32) -> Rgb {
    let mixed = number.wrapping_mul(0x9e37_79b1).rotate_left(13).wrapping_mul(0x85eb_ca6b);
    [mixed >> 24, mixed >> 16 & 0xff, mixed >> 8 & 0xff].map(|c| (55 + c * 180 / 255) as u8)
}

/// How much each pixel differs, 0..1: colours of white, depths of the greatest.
fn differences(a: &Decoded, b: &Decoded, kind: Kind, scale: &DepthScale) -> Vec<f32> {
    fn channels<T: Copy + Into<f32>>(a: &[T], b: &[T], count: usize, white: f32) -> Vec<f32> {
        let pixel = |(a, b): (&[T], &[T])| {
            a.iter().zip(b).map(|(a, b)| ((*a).into() - (*b).into()).abs() / white).fold(0.0, f32::max)
        };
        a.chunks_exact(count).zip(b.chunks_exact(count)).map(pixel).collect()
    }
    match (&a.pixels, &b.pixels) {
        (Pixels::Rgb8(a), Pixels::Rgb8(b)) => channels(a, b, 3, 255.0),
        (Pixels::Rgb16(a), Pixels::Rgb16(b)) => channels(a, b, 3, 65535.0),
        (Pixels::Gray16(a), Pixels::Gray16(b)) => channels(a, b, 1, 65535.0),
        (Pixels::Gray8(a), Pixels::Gray8(b)) if kind == Kind::Colour => channels(a, b, 1, 255.0),
        (Pixels::Gray8(a), Pixels::Gray8(b)) => a.iter().zip(b).map(|(a, b)| f32::from(a != b)).collect(),
        (Pixels::Id32(a), Pixels::Id32(b)) => a.iter().zip(b).map(|(a, b)| f32::from(a != b)).collect(),
        (Pixels::Float32(a), Pixels::Float32(b)) => {
            let one = |(a, b): (&f32, &f32)| match (a - b).abs() {
                _ if a == b => 0.0,
                apart if apart.is_finite() => (apart / scale.difference.max(1e-12)).clamp(1e-6, 1.0),
                _ => 1.0,
            };
            a.iter().zip(b).map(one).collect()
        }
        _ => vec![0.0; (a.width * a.height) as usize],
    }
}

/// Violet, red, orange, pale yellow.
fn heat_color(value: f32) -> Rgb {
    const STOPS: [[f32; 3]; 5] =
        [[70.0, 15.0, 110.0], [160.0, 30.0, 105.0], [225.0, 80.0, 50.0], [252.0, 165.0, 20.0], [255.0, 252.0, 190.0]];
    let at = value.clamp(0.0, 1.0).sqrt() * 4.0;
    let (first, share) = ((at as usize).min(3), at - at.floor().min(3.0));
    std::array::from_fn(|k| (STOPS[first][k] + (STOPS[first + 1][k] - STOPS[first][k]) * share) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pixel_of_a_large_image_stays_in_sight() {
        let (width, height) = (2000, 1000);
        let a = Decoded { width, height, pixels: Pixels::Rgb8(vec![100; 3 * 2_000_000]) };
        let mut b = a.clone();
        let Pixels::Rgb8(data) = &mut b.pixels else { panic!("it is a colour image") };
        data[3 * (500 * 2000 + 1001)] = 103;
        let drawn = Canvas::stacked(&[strip(&a, &b, Kind::Colour, "x", "y")]);
        let hot = |rgb: &[u8]| rgb == heat_color(3.0 / 255.0);
        let cell = 500;
        let left = (GAP + 2 * (cell + GAP)) as usize;
        let top = LINE as usize;
        let rows = drawn.bytes.chunks_exact(3 * drawn.width as usize).skip(top).take(250);
        let found: usize =
            rows.map(|row| row[3 * left..3 * (left + cell as usize)].chunks_exact(3).filter(|p| hot(p)).count()).sum();
        assert_eq!(found, 1);
    }

    #[test]
    fn small_images_are_made_larger_and_labels_keep_their_colours() {
        let image = |labels: [u8; 2]| Decoded { width: 2, height: 1, pixels: Pixels::Gray8(labels.to_vec()) };
        let drawn = Canvas::stacked(&[strip(&image([0, 2]), &image([0, 7]), Kind::Labels, "x", "y")]);
        assert_eq!(drawn.width, 3 * (288 + GAP) + GAP);
        let count = |color: Rgb| drawn.bytes.chunks_exact(3).filter(|p| *p == color).count();
        assert_eq!((count(LABELS[2]), count(LABELS[7])), (144 * 144, 144 * 144));
        assert_eq!(count(CHANGED), 144 * 144 + 16 * 14);
    }
}
