//! The wgpu renderer against the reference, effect by effect, in linear light through a sensor without faults. Without
//! an adapter this says so and passes.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{estimate, numbers, render};
use crate::frame::Pixels;
use crate::gpu::tests::town::{self, demand, nadir, sun, tilted, view};
use crate::interpreter::material::{Material, OpacityMode};
use crate::plan::demand::{Ambient, Look, Output, Projection, Shadows, State, ViewDemand};
use crate::plan::effects::{Bands, BitDepth, Clouds, GroundKind, GroundState, Haze, NirLight, Sensor};
use crate::reference::Options;
use crate::scene::{Presence, Scene, SceneClass, TriMesh};
use crate::sensor;

const IDEAL: Sensor = Sensor { depth: BitDepth::Sixteen, ..sensor::PLAIN };
const SKY: Ambient = Ambient::Sky { zenith: [0.3, 0.36, 0.45], ground: [0.1, 0.1, 0.08], occluded: false };
const OCCLUDED: Ambient = Ambient::Sky { zenith: [0.3, 0.36, 0.45], ground: [0.1, 0.1, 0.08], occluded: true };
const HAZE: Haze = Haze { extinction: [4e-4, 6e-4, 1e-3], scale_height: 300.0, base: -20.0, airlight: [0.3, 0.4, 0.6] };
const CLOUDS: Clouds = Clouds { key: 7, cover: 0.5, height: 2000.0, size: 60.0, depth: 3.0, color: [0.7, 0.75, 0.8] };
const NIR: NirLight = NirLight { sun: 0.7, zenith: 0.11, ground: 0.09, extinction: 2e-4, airlight: 0.25 };

fn ground(kind: GroundKind) -> Option<GroundState> {
    Some(GroundState { key: 3, kind, strength: 0.6, reach: 12.0, around: [(DVec2::new(3.0, 5.0), 18.0)].into() })
}

fn sensed(bands: Bands, psf: f64) -> Option<Sensor> {
    Some(Sensor { bands, psf, ..IDEAL })
}

/// Name, sun's height, degrees off nadir, root of the mean square and mean of the error that are allowed, what is
/// asked for.
type Case = (&'static str, f64, f64, (f64, f64), Look);

fn cases() -> Vec<Case> {
    let plain = |shadows, ambient| Look::plain(shadows, ambient);
    let lit = Look::plain(Shadows::Hard, SKY);
    vec![
        ("light", 50.0, 0.0, (0.01, 0.001), plain(Shadows::Off, SKY)),
        ("hard shadows", 50.0, 20.0, (0.01, 0.001), plain(Shadows::Hard, Ambient::Off)),
        ("hard shadows of a low sun", 8.0, 0.0, (0.01, 0.001), plain(Shadows::Hard, Ambient::Off)),
        ("hard shadows of the zenith", 90.0, 30.0, (0.01, 0.001), plain(Shadows::Hard, Ambient::Off)),
        ("soft shadows", 35.0, 0.0, (0.01, 0.001), plain(Shadows::Soft, Ambient::Off)),
        ("soft shadows of a low sun", 8.0, 20.0, (0.012, 0.002), plain(Shadows::Soft, Ambient::Off)),
        ("occluded sky", 50.0, 20.0, (0.015, 0.003), plain(Shadows::Off, OCCLUDED)),
        ("haze", 50.0, 40.0, (0.01, 0.001), Look { haze: Some(HAZE), ..lit.clone() }),
        ("shadows of clouds", 40.0, 0.0, (0.012, 0.002), Look { clouds: Some(CLOUDS), ..lit.clone() }),
        (
            "clouds in view",
            40.0,
            20.0,
            (0.012, 0.002),
            Look { clouds: Some(Clouds { height: 300.0, size: 12.0, ..CLOUDS }), ..lit.clone() },
        ),
        ("ash", 50.0, 0.0, (0.01, 0.001), Look { ground: ground(GroundKind::Ash), ..lit.clone() }),
        ("puddles", 50.0, 50.0, (0.012, 0.002), Look { ground: ground(GroundKind::Puddles), ..lit.clone() }),
        (
            "near infrared",
            50.0,
            0.0,
            (0.01, 0.001),
            Look { sensor: sensed(Bands::Nir(NIR), 0.0), haze: Some(HAZE), ..lit.clone() },
        ),
        (
            "panchromatic",
            50.0,
            0.0,
            (0.01, 0.001),
            Look { sensor: sensed(Bands::Panchromatic(NIR), 0.0), ..lit.clone() },
        ),
        (
            "false colours",
            50.0,
            20.0,
            (0.01, 0.001),
            Look { sensor: sensed(Bands::FalseColor(NIR), 0.0), ..lit.clone() },
        ),
        ("optics", 50.0, 0.0, (0.01, 0.001), Look { sensor: sensed(Bands::Rgb, 0.8), ..lit }),
    ]
}

/// Linear numbers of an image of 16 bits, three to a pixel.
fn linear(pixels: &Pixels) -> Vec<f64> {
    match pixels {
        Pixels::Rgb16(words) => words.iter().map(|w| f64::from(*w) / 65535.0).collect(),
        Pixels::Gray16(words) => words.iter().flat_map(|w| [f64::from(*w) / 65535.0; 3]).collect(),
        other => panic!("an image of 16 bits, not {other:?}"),
    }
}

#[test]
fn every_effect_is_the_reference_within_its_bound() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(4);
    let mut breaches = Vec::new();
    for (name, elevation, off_nadir, bounds, look) in cases() {
        let mut output = demand(&scene, Output::Color, State::After);
        output.look = Look { sensor: look.sensor.or(Some(IDEAL)), ..look };
        let camera = tilted(nadir(0.3, -0.2, 0.8, 72, 56), off_nadir);
        let mut demand = view(camera, sun(elevation, 120.0), vec![output]);
        let quality = &mut demand.quality;
        (quality.supersample, quality.shadow_map) = (4, 2048);
        (quality.sky_samples, quality.field_map, quality.shadow_samples) = (128, 1024, 32);
        let drawn = linear(&town::render(&mut renderer, &scene, demand.clone()).images[0].pixels);
        // The optics of the reference are sampled too.
        let side = if name == "optics" { 8 } else { 4 };
        let traced = render(&scene, &demand, &Options { side, passes: 2, ..Options::default() });
        let truth = estimate(&traced);
        let errors = drawn.iter().zip(truth.linear.iter().flatten()).enumerate();
        // The optics of the reference see beyond the image; those of the other renderer mirror it.
        let inside = |i: usize| {
            let (x, y) = (i / 3 % 72, i / 3 / 72);
            (4..68).contains(&x) && (4..52).contains(&y)
        };
        let errors: Vec<f64> = errors.filter(|(i, _)| inside(*i)).map(|(_, (a, b))| a - b.clamp(0.0, 1.0)).collect();
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        let bias = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{name}: rms {rms:.5}, bias {bias:.6}, noise {:.5}", truth.mean_standard_error);
        if rms > bounds.0 || bias.abs() > bounds.1 {
            breaches.push(format!("{name}: rms {rms:.5}, bias {bias:.6}"));
        }
        let spread = truth.linear.iter().map(|c| c[0]);
        assert!(spread.clone().fold(0.0, f64::max) - spread.fold(1.0, f64::min) > 0.1, "{name}: the picture is empty");
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

#[test]
fn edges_through_pixel_centres_differ_there_alone() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // The top's edges run through the centres of columns 8 and 24 and of rows 4 and 12.
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-8.0, 0.0, -4.0), DVec3::new(8.0, 8.0, 4.0));
    let mut camera = nadir(0.5, 0.5, 1.0, 32, 16);
    camera.projection = Projection::Orthographic { half_x: 16.0, half_y: 8.0 };
    (camera.position.x, camera.position.z) = (0.5, 0.5);
    let outputs = vec![demand(&scene, Output::Instance, State::Before)];
    let demand = view(camera, sun(45.0, 90.0), outputs);
    let frame = town::render(&mut renderer, &scene, demand.clone());
    let Pixels::Id32(drawn) = &frame.images[0].pixels else { panic!("numbers") };
    let traced = render(&scene, &demand, &Options::default());
    let mut ties = 0;
    for (i, (drawn, traced)) in drawn.iter().zip(numbers(&traced, 0)).enumerate() {
        let (x, y) = (i % 32, i / 32);
        // World x of column c is c - 15, so -8 is column 7 and 8 is column 23; rows likewise.
        let (within, inside) =
            ((7..=23).contains(&x) && (3..=11).contains(&y), (8..23).contains(&x) && (4..11).contains(&y));
        assert_eq!(*traced, if within { 2 } else { 1 }, "the reference counts borders in, at ({x}, {y})");
        assert!(drawn == traced || (within && !inside), "({x}, {y}) is {drawn}, not {traced}");
        ties += usize::from(drawn != traced);
    }
    // Rasterisers give an edge to the upper left: two of the four sides.
    assert!(ties <= 17 + 9, "{ties} pixels of ties differ");
}

#[test]
fn masked_materials_have_the_holes_of_their_own_cut_off() {
    let mut renderer = crate::gpu::tests::renderer();
    // Quarters of alpha 51, 102, 153 and 255 side by side, each 4 m wide.
    let alphas = [51, 102, 153, 255];
    let picture = image::RgbaImage::from_fn(16, 16, |x, _| image::Rgba([200, 200, 200, alphas[x as usize / 4]]));
    let material = |opacity_mode, opacity, opacity_cutoff| {
        let colormap = Some(Arc::from("fence"));
        Arc::new(Material { colormap, opacity, opacity_mode, opacity_cutoff, ..Material::default() })
    };
    for (mode, opacity, cutoff, there) in [
        (OpacityMode::Mask, 1.0, 0.3, [false, true, true, true]),
        (OpacityMode::Mask, 1.0, 0.8, [false, false, false, true]),
        (OpacityMode::Mask, 0.6, 0.3, [false, false, true, true]),
        (OpacityMode::Blend, 1.0, 0.3, [false, false, true, true]),
        (OpacityMode::Blend, 0.7, 0.3, [false, false, false, true]),
        (OpacityMode::Opaque, 1.0, 0.9, [true; 4]),
    ] {
        let mut scene: Scene = town::empty();
        scene.textures[1].1 = Arc::new(picture.clone());
        scene.materials[town::FENCE as usize] = material(mode, opacity, cutoff);
        let face = [(-8.0, -8.0), (-8.0, 8.0), (8.0, 8.0), (8.0, -8.0)].map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
        let building = town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::FENCE)]);
        let mesh: &mut TriMesh = &mut scene.objects[building].mesh;
        for (p, uv) in mesh.positions.iter().zip(&mut mesh.uvs) {
            *uv = glam::Vec2::new(((p.x + 8.0) / 16.0) as f32, ((p.z + 8.0) / 16.0) as f32);
        }
        // One pixel in the middle of each quarter.
        let demand: ViewDemand =
            view(nadir(0.0, 0.0, 4.0, 4, 1), sun(60.0, 0.0), vec![demand(&scene, Output::Class, State::Before)]);
        let expected = there.map(|there| if there { 2 } else { 0 });
        let traced = render(&scene, &demand, &Options::default());
        assert_eq!(town::gray(&traced.frame, 0), expected, "{mode:?} {opacity} {cutoff}, traced");
        if let Some(renderer) = &mut renderer {
            let drawn = town::render(renderer, &scene, demand);
            assert_eq!(town::gray(&drawn, 0), expected, "{mode:?} {opacity} {cutoff}, drawn");
        }
    }
}
