//! The sensor against its definition: sums, statistics, exact numbers.

use super::{develop, noise, psf};
use crate::frame::Pixels;
use crate::interpreter::seed::Seed;
use crate::plan::effects::{Bands, BitDepth, NirLight, Sensor};

const PLAIN: Sensor = Sensor { key: 7, depth: BitDepth::Sixteen, ..super::PLAIN };

const NIR: NirLight = NirLight { sun: 1.0, zenith: 0.1, ground: 0.1, extinction: 0.0, airlight: 0.0 };

fn words(pixels: Pixels) -> Vec<u16> {
    match pixels {
        Pixels::Rgb16(words) | Pixels::Gray16(words) => words,
        other => panic!("words, not {other:?}"),
    }
}

/// Mean and standard deviation of the shares of full scale that a grey image gives.
fn statistics(grey: f32, sensor: &Sensor) -> (f64, f64) {
    let numbers = words(develop(&vec![[grey; 3]; 200 * 200], (200, 200), sensor));
    let values: Vec<f64> = numbers.iter().map(|n| f64::from(*n) / 65535.0).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, (squares / values.len() as f64).sqrt())
}

#[test]
fn the_point_spread_function_has_integral_one_and_its_deviation() {
    for deviation in [0.05, 0.2, 0.35, 0.5, 0.8, 1.3, 2.0, 5.0] {
        let kernel = psf::kernel(deviation);
        let both = |i: usize| if i == 0 { 1.0 } else { 2.0 };
        let sum: f64 = kernel.iter().enumerate().map(|(i, w)| both(i) * w).sum();
        let variance: f64 = kernel.iter().enumerate().map(|(i, w)| both(i) * w * (i * i) as f64).sum();
        assert!((sum - 1.0).abs() < 1e-12 && kernel.iter().all(|w| *w >= 0.0), "{deviation}: {sum}");
        assert!((variance.sqrt() / deviation - 1.0).abs() < 1e-3, "{deviation}: {}", variance.sqrt());
    }
}

#[test]
fn spreading_conserves_light_at_borders_too() {
    for (size, at) in [((31, 17), 8 * 31 + 15), ((31, 17), 0), ((3, 2), 4), ((1, 1), 0)] {
        let mut image = vec![[0.0; 3]; size.0 as usize * size.1 as usize];
        image[at] = [1.0, 0.5, 0.25];
        for deviation in [0.4, 1.1, 3.0] {
            let spread = psf::spread(&image, size, deviation);
            for k in 0..3 {
                let sum: f64 = spread.iter().map(|p| f64::from(p[k])).sum();
                assert!((sum - f64::from(image[at][k])).abs() < 1e-6, "{size:?} {deviation}: {sum}");
            }
        }
        let flat = psf::spread(&vec![[0.3; 3]; image.len()], size, 1.1);
        assert!(flat.iter().flatten().all(|v| (v - 0.3).abs() < 1e-6), "a plain image stays");
    }
    // A point in the middle: the product of two kernels, the same along rows and columns.
    let mut image = vec![[0.0; 3]; 21 * 21];
    image[10 * 21 + 10] = [1.0; 3];
    let (spread, kernel) = (psf::spread(&image, (21, 21), 0.9), psf::kernel(0.9));
    for (y, x) in (0..21usize).flat_map(|y| (0..21usize).map(move |x| (y, x))) {
        let at = |i: usize| kernel.get(i.abs_diff(10)).copied().unwrap_or(0.0);
        assert!((f64::from(spread[y * 21 + x][0]) - at(x) * at(y)).abs() < 1e-7);
    }
}

#[test]
fn read_noise_has_its_deviation_and_no_mean() {
    for (grey, read_noise) in [(0.5, 0.02), (0.3, 0.004)] {
        let (mean, deviation) = statistics(grey, &Sensor { read_noise, ..PLAIN });
        // 120 000 numbers: the mean is sure within 0.3 %, the deviation within 0.2 %.
        assert!((mean - f64::from(grey)).abs() < 0.015 * read_noise, "{mean}");
        assert!((deviation / read_noise - 1.0).abs() < 0.01, "{deviation} instead of {read_noise}");
    }
}

#[test]
fn shot_noise_is_the_root_of_the_count() {
    for (grey, full_well) in [(0.5f32, 10_000.0), (0.5, 400.0), (0.2, 100.0), (0.02, 100.0), (0.1, 645.0)] {
        let (mean, deviation) = statistics(grey, &Sensor { full_well, ..PLAIN });
        let expected = (f64::from(grey) / full_well).sqrt();
        assert!((mean - f64::from(grey)).abs() < 0.015 * expected, "{grey} of {full_well}: mean {mean}");
        assert!((deviation / expected - 1.0).abs() < 0.01, "{grey} of {full_well}: {deviation}, not {expected}");
    }
    // Both together add in squares.
    let (_, deviation) = statistics(0.5, &Sensor { full_well: 5000.0, read_noise: 0.01, ..PLAIN });
    assert!((deviation / (0.5f64 / 5000.0 + 1e-4).sqrt() - 1.0).abs() < 0.01, "{deviation}");
    // Nothing has no shot noise.
    assert_eq!(statistics(0.0, &Sensor { full_well: 100.0, ..PLAIN }), (0.0, 0.0));
}

#[test]
fn counts_follow_the_poisson_distribution() {
    for mean in [3.0, 40.0, 70.0] {
        let sensor = Sensor { full_well: 100.0, ..PLAIN };
        let noise = noise::Noise::new(&sensor);
        let mut seen = [0u32; 200];
        let draws = 200_000;
        for i in 0..draws {
            let counted = noise.over(mean / 100.0, Seed::root(3).part(i)) * 100.0;
            assert!((counted - counted.round()).abs() < 1e-9 && counted >= 0.0, "{counted} electrons");
            seen[counted.round() as usize] += 1;
        }
        let (mut term, mut expected, mut got) = (libm::exp(-mean), 0.0, 0.0);
        for (count, seen) in seen.into_iter().enumerate() {
            term *= if count == 0 { 1.0 } else { mean / count as f64 };
            expected += term;
            got += f64::from(seen) / draws as f64;
            // Kolmogorov's bound at 1 in 10⁴ for this many draws is 0.005.
            assert!((got - expected).abs() < 0.005, "mean {mean}: {got} up to {count}, not {expected}");
        }
    }
}

#[test]
fn exposure_clipping_and_bands_are_exact() {
    let image = [[0.25, 0.5, 2.0], [-1.0, f32::NAN, 1.0 / 65535.0]];
    let sixteen = words(develop(&image, (2, 1), &Sensor { exposure: 2.0, ..PLAIN }));
    assert_eq!(sixteen, [32768, 65535, 65535, 0, 0, 2]);
    let eight = Sensor { depth: BitDepth::Eight, ..PLAIN };
    // sRGB: 0.25 is 137, 0.5 is 188.
    assert_eq!(develop(&image, (2, 1), &eight), Pixels::Rgb8(vec![137, 188, 255, 0, 0, 0]));
    for bands in [Bands::Nir(NIR), Bands::Panchromatic(NIR)] {
        assert_eq!(develop(&image, (1, 2), &Sensor { bands, ..eight }), Pixels::Gray8(vec![137, 0]));
        assert_eq!(develop(&image, (1, 2), &Sensor { bands, ..PLAIN }), Pixels::Gray16(vec![16384, 0]));
    }
    let color = Sensor { bands: Bands::FalseColor(NIR), ..eight };
    assert_eq!(develop(&image, (2, 1), &color), develop(&image, (2, 1), &eight));
    assert_eq!(develop(&[], (0, 0), &Sensor { psf: 1.0, ..eight }), Pixels::Rgb8(Vec::new()));
}

#[test]
fn noise_is_keyed_by_sensor_pixel_and_band_and_not_by_threads() {
    let image = vec![[0.4; 3]; 64 * 48];
    let noisy = Sensor { psf: 0.7, read_noise: 0.01, full_well: 2000.0, ..PLAIN };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be made");
        pool.install(|| words(develop(&image, (64, 48), &noisy)))
    };
    let once = with(1);
    assert_eq!(once, with(3));
    assert_ne!(once, words(develop(&image, (64, 48), &Sensor { key: 8, ..noisy })));
    assert!(once.chunks(3).filter(|p| p[0] == p[1]).count() < 64, "bands have noise of their own");
    // A pixel's noise does not depend on the image's size.
    let cut = words(develop(&image[..64 * 16], (64, 16), &noisy));
    assert_eq!(once[..64 * 16 * 3], cut);
}
