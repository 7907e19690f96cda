//! Effects of the reference against closed forms and quadrature: haze, clouds, state of the ground, bands, optics.

use glam::{DVec2, DVec3};

use super::{estimate, render};
use crate::gpu::tests::town::{self, demand, nadir, sun, tilted, view};
use crate::plan::demand::{Ambient, Camera, Output, Projection, Shadows, State, ViewDemand};
use crate::plan::effects::{Bands, BitDepth, Clouds, GroundKind, GroundState, Haze, NirLight, Sensor};
use crate::reference::{Options, air, color};
use crate::scene::Scene;
use crate::scene::SceneClass;
use crate::scene::reflectance::near_infrared_gain;
use crate::sensor;

const HAZE: Haze = Haze { extinction: [4e-4, 6e-4, 1e-3], scale_height: 300.0, base: -20.0, airlight: [0.3, 0.4, 0.6] };
const CLOUDS: Clouds = Clouds { key: 7, cover: 0.5, height: 200.0, size: 120.0, depth: 3.0, color: [0.7, 0.75, 0.8] };
const NIR: NirLight = NirLight { sun: 0.7, zenith: 0.11, ground: 0.09, extinction: 2e-4, airlight: 0.25 };

/// A wide level plane under a constant light, seen by pixels so small that fields are the same all over one.
fn flat(off_nadir: f64, at: DVec2) -> (Scene, ViewDemand) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-900.0, -900.0), (900.0, 900.0), town::GROUND);
    let mut output = demand(&scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (Shadows::Hard, Ambient::Constant([0.5, 0.4, 0.3]));
    (scene, view(tilted(nadir(at.x, -at.y, 1e-7, 1, 1), off_nadir), sun(35.0, 140.0), vec![output]))
}

fn one_pixel(scene: &Scene, view: &ViewDemand) -> [f64; 3] {
    estimate(&render(scene, view, &Options { side: 1, passes: 2, ..Options::default() })).linear[0]
}

fn near(got: [f64; 3], expected: [f64; 3], case: &str) {
    assert!(got.iter().zip(expected).all(|(g, e)| (g - e).abs() < 1e-6), "{case}: {got:?}, not {expected:?}");
}

/// Linear albedo of the plane.
fn albedo() -> [f64; 3] {
    [0.55, 0.6, 0.5].map(color::linear)
}

/// Radiance of the plane under the constant light alone.
fn shaded() -> [f64; 3] {
    std::array::from_fn(|k| albedo()[k] * [0.5, 0.4, 0.3][k])
}

/// The haze's density integrated by Simpson's rule.
fn quadrature(from: DVec3, to: DVec3) -> f64 {
    let steps = 4000;
    let density = |i: i32| libm::exp(-(from.y + (to.y - from.y) * f64::from(i) / 4000.0 - HAZE.base) / 300.0);
    let weight = |i: i32| if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
    (0..=steps).map(|i| weight(i) * density(i)).sum::<f64>() / (3.0 * f64::from(steps)) * (to - from).length()
}

#[test]
fn the_length_through_haze_is_the_integral_of_its_density() {
    let p = DVec3::new(12.0, 3.0, -40.0);
    for way in [(0.0, 500.0, 0.0), (300.0, 20.0, 100.0), (900.0, 0.0, 0.0), (50.0, 1e-7, 0.0), (10.0, -40.0, 3.0)] {
        let eye = p + DVec3::from(way);
        let length = air::dense_length(p, eye, HAZE.base, HAZE.scale_height);
        let expected = quadrature(p, eye);
        assert!((length / expected - 1.0).abs() < 1e-9, "{way:?}: {length}, not {expected}");
        let back = air::dense_length(eye, p, HAZE.base, HAZE.scale_height);
        assert!((back / length - 1.0).abs() < 1e-12, "there and back: {length}, {back}");
    }
    // From orbit there is no more air than above the point.
    let far = air::dense_length(p, p + DVec3::Y * 7e5, HAZE.base, HAZE.scale_height);
    assert!((far / (300.0 * libm::exp(-23.0 / 300.0)) - 1.0).abs() < 1e-12, "{far}");
}

#[test]
fn haze_takes_and_adds_what_koschmieder_says() {
    for off_nadir in [0.0, 40.0, 70.0] {
        let (scene, mut view) = flat(off_nadir, DVec2::new(5.0, 9.0));
        view.sun = None;
        view.outputs[0].look.haze = Some(HAZE);
        let length = quadrature(DVec3::new(5.0, 0.0, -9.0), view.camera.position);
        let expected = std::array::from_fn(|k| {
            let kept = libm::exp(-HAZE.extinction[k] * length);
            shaded()[k] * kept + HAZE.airlight[k] * (1.0 - kept)
        });
        near(one_pixel(&scene, &view), expected, &format!("{off_nadir}° off nadir"));
    }
}

#[test]
fn clouds_dim_the_sun_and_cover_the_view() {
    let (mut dimmed, mut hidden) = (0, 0);
    for i in 0..40 {
        let at = DVec2::new(f64::from(i) * 17.0 - 340.0, f64::from(i * 7 % 40) * 15.0 - 300.0);
        let (scene, mut view) = flat(25.0, at);
        view.outputs[0].look.clouds = Some(CLOUDS);
        let direction = view.sun.expect("there is a sun").direction;
        let above = at + DVec2::new(direction.x, -direction.z) * (CLOUDS.height / direction.y);
        let sunny = libm::exp(-CLOUDS.optical_depth(above) / direction.y);
        let lit: [f64; 3] =
            std::array::from_fn(|k| shaded()[k] + albedo()[k] * [0.9, 0.87, 0.8][k] * direction.y * sunny);
        // The camera leans to the south, so its way up goes there.
        let back = -view.camera.forward;
        let crossed = at + DVec2::new(back.x, -back.z) * (CLOUDS.height / back.y);
        let clear = libm::exp(-CLOUDS.optical_depth(crossed) / back.y);
        let expected = std::array::from_fn(|k| lit[k] * clear + CLOUDS.color[k] * (1.0 - clear));
        near(one_pixel(&scene, &view), expected, &format!("at {at}"));
        // A layer above the camera hides nothing of the ground.
        let high = Clouds { height: 2000.0, ..CLOUDS };
        view.outputs[0].look.clouds = Some(high);
        let above = at + DVec2::new(direction.x, -direction.z) * (high.height / direction.y);
        let sunny = libm::exp(-high.optical_depth(above) / direction.y);
        let lit = std::array::from_fn(|k| shaded()[k] + albedo()[k] * [0.9, 0.87, 0.8][k] * direction.y * sunny);
        near(one_pixel(&scene, &view), lit, &format!("under a high layer at {at}"));
        (dimmed, hidden) = (dimmed + i32::from(sunny < 0.5), hidden + i32::from(clear < 0.5));
    }
    assert!((3..38).contains(&dimmed) && (3..38).contains(&hidden), "{dimmed} dimmed, {hidden} hidden of 40");
}

#[test]
fn ash_and_puddles_cover_the_share_that_the_field_says() {
    for (kind, off_nadir) in [(GroundKind::Ash, 0.0), (GroundKind::Puddles, 0.0), (GroundKind::Puddles, 65.0)] {
        let ground = GroundState { key: 3, kind, strength: 0.6, reach: 12.0, around: [(DVec2::ZERO, 15.0)].into() };
        let mut covered = 0;
        for i in 0..40 {
            let at = DVec2::new(f64::from(i) * 1.3 - 26.0, f64::from(i * 11 % 40) * 0.9 - 18.0);
            let (scene, mut view) = flat(off_nadir, at);
            view.sun = None;
            view.outputs[0].look.ambient = Ambient::Sky { zenith: [0.5, 0.4, 0.3], ground: [0.0; 3], occluded: false };
            view.outputs[0].look.ground = Some(ground.clone());
            let share = ground.coverage(at);
            let cosine = libm::cos(f64::to_radians(off_nadir));
            let mirrored = if kind == GroundKind::Ash { 0.0 } else { 0.02 + 0.98 * libm::pow(1.0 - cosine, 5.0) };
            let full = |bare: f64| if kind == GroundKind::Ash { 0.1 } else { 0.35 * bare };
            let expected = std::array::from_fn(|k| {
                let bare = albedo()[k];
                [0.5, 0.4, 0.3][k] * (bare * (1.0 - share) + full(bare) * share + mirrored * share)
            });
            near(one_pixel(&scene, &view), expected, &format!("{kind:?} at {at}"));
            covered += i32::from(share > 0.5);
        }
        assert!((5..36).contains(&covered), "{covered} of 40 covered by {kind:?}");
    }
}

#[test]
fn bands_are_made_of_four_kinds_of_light() {
    let (scene, mut view) = flat(0.0, DVec2::ZERO);
    let sun = view.sun.expect("there is a sun");
    let [r, g, b] = albedo();
    let gain = near_infrared_gain(SceneClass::Terrain, &scene.materials[town::GROUND as usize]);
    let infrared = (gain * (0.2126 * r + 0.7152 * g + 0.0722 * b)).min(0.95);
    let lit = |k: usize| albedo()[k] * ([0.5, 0.4, 0.3][k] + sun.irradiance[k] * sun.direction.y);
    // A constant ambient is seen by level ground as its zenith.
    let n = infrared * (NIR.zenith + NIR.sun * sun.direction.y);
    let all = [lit(0), lit(1), lit(2), n];
    for (bands, expected) in [
        (Bands::Rgb, [all[0], all[1], all[2]]),
        (Bands::Nir(NIR), [n; 3]),
        (Bands::Panchromatic(NIR), [all.iter().sum::<f64>() / 4.0; 3]),
        (Bands::FalseColor(NIR), [n, all[0], all[1]]),
    ] {
        view.outputs[0].look.sensor = Some(Sensor { bands, ..sensor::PLAIN });
        near(one_pixel(&scene, &view), expected, &format!("{bands:?}"));
    }
    // Each band has its own haze.
    view.outputs[0].look.haze = Some(HAZE);
    view.outputs[0].look.sensor = Some(Sensor { bands: Bands::Nir(NIR), ..sensor::PLAIN });
    let kept = libm::exp(-NIR.extinction * quadrature(DVec3::ZERO, view.camera.position));
    near(one_pixel(&scene, &view), [n * kept + NIR.airlight * (1.0 - kept); 3], "near infrared through haze");
}

/// The integral of the normal distribution.
fn normal_integral(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

/// A dark half plane that ends at `edge` pixels from the left of a strip of 24, and the strip's camera.
fn half_plane(edge: f64) -> (Scene, Camera) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-200.0, -200.0), (edge - 12.0, 200.0), town::GROUND);
    let camera = nadir(0.0, 0.0, 1.0, 24, 24);
    (scene, Camera { projection: Projection::Orthographic { half_x: 12.0, half_y: 12.0 }, near: 1.0, ..camera })
}

#[test]
fn an_edge_is_spread_by_the_integral_of_the_point_spread_function() {
    for (edge, psf) in [(12.0, 0.5), (12.3, 0.8), (11.62, 2.0)] {
        let (scene, camera) = half_plane(edge);
        let mut output = demand(&scene, Output::Color, State::Before);
        (output.look.shadows, output.look.ambient) = (Shadows::Off, Ambient::Constant([1.0; 3]));
        output.look.sensor = Some(Sensor { psf, ..sensor::PLAIN });
        let mut view = view(camera, sun(45.0, 0.0), vec![output]);
        view.sun = None;
        let rendered = render(&scene, &view, &Options { side: 8, passes: 4, ..Options::default() });
        let (light, dark) = (albedo()[1], crate::plan::demand::BACKGROUND[1]);
        let mut missed = 0;
        for x in 0..24 {
            // The mean over the pixel of the share of the function's light that falls on the ground.
            let open = |k: i32| normal_integral((edge - (f64::from(x) + (f64::from(k) + 0.5) / 64.0)) / psf);
            let share = (0..64).map(open).sum::<f64>() / 64.0;
            let column = (0..24).map(|y| y * 24 + x as usize);
            let mean = column.clone().map(|i| estimate(&rendered).linear[i][1]).sum::<f64>() / 24.0;
            let error = column.map(|i| estimate(&rendered).standard_error[i][1].powi(2)).sum::<f64>().sqrt() / 24.0;
            let off = ((mean - dark) / (light - dark) - share).abs();
            let error = error / (light - dark);
            assert!(off < 4.5 * error + 2e-3, "σ {psf}, column {x}: {off} off, error {error}");
            missed += i32::from(off > 2.0 * error + 1e-3);
        }
        assert!(missed <= 4, "σ {psf}: {missed} of 24 columns are two standard errors off");
    }
}

#[test]
fn the_sensor_is_that_of_the_demand() {
    let (scene, mut view) = flat(0.0, DVec2::ZERO);
    view.sun = None;
    let plain = render(&scene, &view, &Options::default());
    let sixteen = Sensor { exposure: 2.0, depth: BitDepth::Sixteen, ..sensor::PLAIN };
    view.outputs[0].look.sensor = Some(sixteen);
    let rendered = render(&scene, &view, &Options::default());
    assert_eq!(estimate(&rendered), estimate(&plain), "exposure comes after the light");
    let words = shaded().map(|light| (2.0 * light * 65535.0).round() as u16).to_vec();
    assert_eq!(rendered.frame.images[0].pixels, crate::frame::Pixels::Rgb16(words));
    view.outputs[0].look.sensor = Some(Sensor { bands: Bands::Nir(NIR), ..sixteen });
    let rendered = render(&scene, &view, &Options::default());
    assert!(matches!(&rendered.frame.images[0].pixels, crate::frame::Pixels::Gray16(words) if words.len() == 1));
}
