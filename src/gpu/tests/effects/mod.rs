//! Effects, each against a formula: small scenes, read in linear light through a 16-bit sensor without faults.

mod air;
mod bands;
mod ground;
mod penumbra;
mod sky;
mod speed;

use glam::DVec3;

use super::town::{self, demand, nadir};
use crate::frame::{Frame, Pixels};
use crate::plan::demand::{Ambient, Camera, Output, Projection, Shadows, State, Sun, ViewDemand};
use crate::plan::effects::{Bands, BitDepth, Sensor};
use crate::scene::Scene;

/// Linear numbers from 0 to 1, nothing added, nothing lost.
fn ideal(bands: Bands) -> Sensor {
    Sensor { key: 1, psf: 0.0, exposure: 1.0, read_noise: 0.0, full_well: 0.0, depth: BitDepth::Sixteen, bands }
}

/// A colour image of all that is there before, without shadows and ambient light.
fn look(scene: &Scene, camera: Camera, sun: Option<Sun>) -> ViewDemand {
    let mut output = demand(scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (Shadows::Off, Ambient::Off);
    output.look.sensor = Some(ideal(Bands::Rgb));
    let mut view = town::view(camera, town::sun(45.0, 90.0), vec![output]);
    view.sun = sun;
    view
}

/// Linear radiance of an image of three bands.
fn linear(frame: &Frame, image: usize) -> Vec<[f64; 3]> {
    match &frame.images[image].pixels {
        Pixels::Rgb16(pixels) => {
            pixels.chunks_exact(3).map(|p| [p[0], p[1], p[2]].map(|c| f64::from(c) / 65535.0)).collect()
        }
        other => panic!("a 16-bit image, not {other:?}"),
    }
}

/// A parallel camera straight above a point of the plan, `gsd` metres per pixel.
fn above((x, z): (f64, f64), gsd: f64, (width, height): (u32, u32)) -> Camera {
    let half = |pixels: u32| f64::from(pixels) * gsd / 2.0;
    let projection = Projection::Orthographic { half_x: half(width), half_y: half(height) };
    Camera { projection, near: 1.0, ..nadir(x, z, gsd, width, height) }
}

/// World positions on the level y = 0 of all pixel centres of a [`nadir`] or an [`above`] camera.
fn ground_points(camera: &Camera) -> Vec<DVec3> {
    let (half_x, half_y) = match camera.projection {
        Projection::Perspective { tan_x, tan_y } => (tan_x * camera.position.y, tan_y * camera.position.y),
        Projection::Orthographic { half_x, half_y } => (half_x, half_y),
    };
    let at = |i: u32, count: u32, half: f64| (2.0 * (f64::from(i) + 0.5) / f64::from(count) - 1.0) * half;
    let point = |x: u32, y: u32| {
        let (x, z) = (at(x, camera.width, half_x), at(y, camera.height, half_y));
        DVec3::new(camera.position.x + x, 0.0, camera.position.z + z)
    };
    (0..camera.height).flat_map(|y| (0..camera.width).map(move |x| point(x, y))).collect()
}

/// A wide level plane.
fn plane(half: f64) -> Scene {
    let mut scene = town::empty();
    town::plane(&mut scene, (-half - 1.3, -half), (half, half + 2.1), town::GROUND);
    scene
}

/// Linear albedo of [`town::GROUND`].
fn albedo() -> [f64; 3] {
    [0.55, 0.6, 0.5].map(crate::gpu::mipmaps::linear_from_srgb)
}

/// Greatest and mean difference of all numbers.
fn difference(a: &[[f64; 3]], b: &[[f64; 3]]) -> (f64, f64) {
    assert_eq!(a.len(), b.len());
    let all = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs());
    let (worst, sum) = all.fold((0.0, 0.0), |(w, s): (f64, f64), d| (w.max(d), s + d));
    (worst, sum / (3 * a.len()) as f64)
}
