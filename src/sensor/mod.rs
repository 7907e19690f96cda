//! Sensor: linear radiance and what takes the image → the numbers of an image file. Both renderers end here.
//!
//! Point-spread function, exposure, noise, clamp, encoding, in this order. Noise is keyed by sensor, pixel and band:
//! threads change no value.

mod encode;
mod noise;
mod psf;

use rayon::prelude::*;

use crate::frame::Pixels;
use crate::interpreter::seed::Seed;
use crate::plan::effects::{Bands, BitDepth, Sensor};

/// 8 bits of sRGB, nothing added and nothing lost.
pub const PLAIN: Sensor = Sensor {
    key: 0,
    psf: 0.0,
    exposure: 1.0,
    read_noise: 0.0,
    full_well: 0.0,
    depth: BitDepth::Eight,
    bands: Bands::Rgb,
};

/// Makes the image of `size` (columns, rows) from its linear pixels, rows from the top. Images of one band take the
/// first of the three numbers. What is not a number becomes 0.
pub fn develop(linear: &[[f32; 3]], size: (u32, u32), sensor: &Sensor) -> Pixels {
    assert_eq!(linear.len(), size.0 as usize * size.1 as usize, "one pixel per place");
    let blurred = (sensor.psf > 0.0).then(|| psf::spread(linear, size, sensor.psf));
    let linear = blurred.as_deref().unwrap_or(linear);
    let bands = bands(sensor.bands);
    match sensor.depth {
        BitDepth::Eight => {
            let table = encode::Table::new();
            let bytes = numbers(linear, size.0, sensor, |value| table.byte(value));
            if bands == 3 { Pixels::Rgb8(bytes) } else { Pixels::Gray8(bytes) }
        }
        BitDepth::Sixteen => {
            let words = numbers(linear, size.0, sensor, encode::word);
            if bands == 3 { Pixels::Rgb16(words) } else { Pixels::Gray16(words) }
        }
    }
}

/// Bands of an image file.
pub fn bands(bands: Bands) -> usize {
    match bands {
        Bands::Rgb | Bands::FalseColor(_) => 3,
        Bands::Nir(_) | Bands::Panchromatic(_) => 1,
    }
}

fn numbers<T: Copy + Default + Send>(
    linear: &[[f32; 3]],
    width: u32,
    sensor: &Sensor,
    encoded: impl Fn(f64) -> T + Sync,
) -> Vec<T> {
    let bands = bands(sensor.bands);
    let noise = noise::Noise::new(sensor);
    let key = Seed::root(sensor.key);
    let width = (width as usize).max(1);
    let mut numbers = vec![T::default(); linear.len() * bands];
    let rows = numbers.par_chunks_mut(width * bands).zip(linear.par_chunks(width));
    rows.enumerate().for_each(|(y, (row, pixels))| {
        for (x, (pixel, linear)) in row.chunks_mut(bands).zip(pixels).enumerate() {
            let key = key.part((y as u64) << 32 | x as u64);
            for (band, (number, &radiance)) in pixel.iter_mut().zip(linear).enumerate() {
                let value = f64::from(radiance) * sensor.exposure;
                *number = encoded(noise.over(value, key.part(band as u64)));
            }
        }
    });
    numbers
}

#[cfg(test)]
mod tests;
