//! Point-spread function: pixels → pixels that share their light with their neighbours.

use rayon::prelude::*;

/// Standard deviations after which the function is cut off.
const REACH: f64 = 4.5;

/// The Gaussian over whole pixels (0, 1, 2, … to either side) whose sum is 1 and whose standard deviation is `deviation`
/// exactly: samples of a Gaussian alone are too narrow below one pixel.
pub fn kernel(deviation: f64) -> Vec<f64> {
    let radius = (REACH * deviation).ceil().max(1.0) as usize;
    let sampled = |width: f64| -> (Vec<f64>, f64) {
        let weights: Vec<f64> = (0..=radius).map(|i| libm::exp(-0.5 * (i as f64 / width).powi(2))).collect();
        let sum = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
        let variance = 2.0 * weights.iter().enumerate().map(|(i, w)| w * (i * i) as f64).sum::<f64>() / sum;
        (weights.into_iter().map(|w| w / sum).collect(), variance)
    };
    let (mut low, mut high) = (0.5 * deviation, 2.0 * deviation + 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if sampled(middle).1 < deviation * deviation { low = middle } else { high = middle }
    }
    sampled(0.5 * (low + high)).0
}

/// Spreads light along rows, then along columns. The image is mirrored at its borders, so its sum stays.
pub fn spread(linear: &[[f32; 3]], (width, height): (u32, u32), deviation: f64) -> Vec<[f32; 3]> {
    let (width, height) = (width as usize, height as usize);
    let kernel = kernel(deviation);
    let mut along = vec![[0f32; 3]; linear.len()];
    along.par_chunks_mut(width.max(1)).zip(linear.par_chunks(width.max(1))).for_each(|(out, row)| {
        for (x, out) in out.iter_mut().enumerate() {
            *out = weighted(&kernel, |offset| row[mirrored(x as i64 + offset, width)]);
        }
    });
    let mut spread = vec![[0f32; 3]; linear.len()];
    spread.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, out)| {
        for (x, out) in out.iter_mut().enumerate() {
            *out = weighted(&kernel, |offset| along[mirrored(y as i64 + offset, height) * width + x]);
        }
    });
    spread
}

fn weighted(kernel: &[f64], at: impl Fn(i64) -> [f32; 3]) -> [f32; 3] {
    let mut sum = at(0).map(|c| kernel[0] * f64::from(c));
    for (offset, weight) in (1..).zip(&kernel[1..]) {
        let (before, after) = (at(-offset), at(offset));
        (0..3).for_each(|k| sum[k] += weight * (f64::from(before[k]) + f64::from(after[k])));
    }
    sum.map(|s| s as f32)
}

/// … 1 0 | 0 1 … n-1 | n-1 n-2 …
fn mirrored(at: i64, count: usize) -> usize {
    let period = 2 * count as i64;
    let at = at.rem_euclid(period);
    at.min(period - 1 - at) as usize
}
