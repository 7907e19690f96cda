//! Bands and sensors: the near infrared from gain and luminance, channels in their order, bits and faults.

use super::{albedo, ideal, linear, look, plane};
use crate::frame::Pixels;
use crate::gpu::tests::town::{self, nadir, sun};
use crate::plan::demand::Ambient;
use crate::plan::effects::{Bands, BitDepth, LUMINANCE, NirLight, Sensor};
use crate::scene::SceneClass;
use crate::scene::reflectance::near_infrared_gain;

const LIGHT: NirLight = NirLight { sun: 0.7, zenith: 0.15, ground: 0.1, extinction: 1e-4, airlight: 0.05 };

#[test]
fn bands_have_the_light_of_their_albedo() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for material in [town::GROUND, town::WALL] {
        let mut scene = town::empty();
        town::plane(&mut scene, (-60.0, -60.0), (61.3, 62.0), material);
        let sun = sun(50.0, 100.0);
        let color = scene.materials[material as usize].color.map(crate::gpu::mipmaps::linear_from_srgb);
        let gain = near_infrared_gain(SceneClass::Terrain, &scene.materials[material as usize]);
        let luminance: f64 = (0..3).map(|c| LUMINANCE[c] * color[c]).sum();
        let infrared = (gain * luminance).min(0.95) * (LIGHT.zenith + LIGHT.sun * sun.direction.y);
        let [r, g, b] = [0, 1, 2].map(|c| color[c] * (0.2 + sun.irradiance[c] * sun.direction.y));
        for bands in [Bands::Rgb, Bands::FalseColor(LIGHT), Bands::Nir(LIGHT), Bands::Panchromatic(LIGHT)] {
            let mut view = look(&scene, nadir(0.0, 0.0, 1.0, 16, 8), Some(sun));
            view.outputs[0].look.ambient = Ambient::Constant([0.2; 3]);
            view.outputs[0].look.sensor = Some(ideal(bands));
            let frame = town::render(&mut renderer, &scene, view);
            let expected = bands.of([r, g, b, infrared]);
            let found = match &frame.images[0].pixels {
                Pixels::Gray16(pixels) => vec![[f64::from(pixels[40]) / 65535.0; 3]],
                _ => linear(&frame, 0),
            };
            for pixel in found {
                let worst = (0..3).map(|c| (pixel[c] - expected[c].min(1.0)).abs()).fold(0.0, f64::max);
                assert!(worst < 6e-4, "{bands:?}: {pixel:.4?}, not {expected:.4?}");
            }
        }
    }
}

#[test]
fn textures_weigh_the_near_infrared_by_their_luminance() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-60.0, -60.0), (61.3, 62.0), town::TEXTURED);
    let mut view = look(&scene, nadir(0.0, 0.0, 0.1, 64, 64), Some(sun(90.0, 0.0)));
    view.outputs[0].look.sensor = Some(ideal(Bands::FalseColor(LIGHT)));
    let gain = near_infrared_gain(SceneClass::Terrain, &scene.materials[town::TEXTURED as usize]);
    let seen = linear(&town::render(&mut renderer, &scene, view), 0);
    let mut checked = 0;
    for expected in [[230, 220, 200], [120, 110, 100]] {
        let color = expected.map(|c| crate::gpu::mipmaps::linear_from_srgb(f64::from(c) / 255.0));
        let infrared = (gain * (0..3).map(|c| LUMINANCE[c] * color[c]).sum::<f64>()).min(0.95) * LIGHT.sun;
        let near = |a: f64, b: f64| (a - b).abs() < 2e-3;
        let flat = seen.iter().filter(|p| near(p[1], color[0] * 0.9) && near(p[2], color[1] * 0.87));
        let flat: Vec<_> = flat.collect();
        checked += flat.len();
        assert!(flat.iter().all(|p| near(p[0], infrared)), "{:?}, not {infrared}", flat.first());
    }
    assert!(checked > 1000, "{checked} texels recognised");
}

#[test]
fn eight_bits_are_the_bytes_of_the_plain_image() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(3);
    let mut view = look(&scene, nadir(0.0, 0.0, 0.5, 120, 100), Some(sun(40.0, 100.0)));
    let mut plain = view.outputs[0].clone();
    plain.look.sensor = None;
    view.outputs[0].look.sensor = Some(Sensor { depth: BitDepth::Eight, ..ideal(Bands::Rgb) });
    view.outputs.push(plain);
    let frame = town::render(&mut renderer, &scene, view);
    let worst = town::rgb(&frame, 0).iter().zip(town::rgb(&frame, 1)).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{worst:?}");
}

#[test]
fn a_sensor_in_tiles_is_the_sensor_in_one_piece() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plane(60.0);
    let mut view = look(&scene, nadir(0.0, 0.0, 1.0, 100, 80), Some(sun(40.0, 100.0)));
    view.outputs[0].look.sensor = Some(Sensor { psf: 1.2, read_noise: 0.01, full_well: 10_000.0, ..ideal(Bands::Rgb) });
    let whole = town::render(&mut renderer, &scene, view.clone());
    renderer.set_tile(64);
    assert!(town::render(&mut renderer, &scene, view) == whole);
    let green: Vec<f64> = linear(&whole, 0).iter().map(|p| p[1]).collect();
    let mean = green.iter().sum::<f64>() / green.len() as f64;
    let spread = (green.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / green.len() as f64).sqrt();
    let lit = albedo()[1] * 0.87 * sun(40.0, 100.0).direction.y;
    let expected = (lit / 10_000.0 + 0.01f64.powi(2)).sqrt();
    assert!((mean - lit).abs() < 5.0 * expected / 89.0 && (spread / expected - 1.0).abs() < 0.1, "{mean} ± {spread}");
}
