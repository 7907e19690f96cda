//! Light and shadow against closed forms: formula colours, lengths, penumbrae, the share of the sky beside a wall.

use std::f64::consts::PI;

use glam::DVec3;

use super::{estimate, render};
use crate::gpu::tests::town::{self, demand, nadir, sun, view};
use crate::plan::demand::{Ambient, Camera, Output, Projection, Shadows, State, Sun, ViewDemand};
use crate::reference::{Options, color};
use crate::scene::{Presence, Scene, SceneClass};

const AMBIENT: f64 = 0.2;

/// Green light of the level ground with a share of the sun.
fn ground(sun: &Sun, share: f64) -> f64 {
    color::linear(0.6) * (AMBIENT + share * sun.irradiance[1] * sun.direction.y)
}

/// Share of the sun in a green value of the ground.
fn share(sun: &Sun, green: f64) -> f64 {
    (green - ground(sun, 0.0)) / (ground(sun, 1.0) - ground(sun, 0.0))
}

fn lit(scene: &Scene, camera: Camera, sun: Sun, shadows: Shadows) -> ViewDemand {
    let mut output = demand(scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (shadows, Ambient::Constant([AMBIENT; 3]));
    view(camera, sun, vec![output])
}

/// A strip of ground along x, `width` pixels of `size` metres, one pixel high, from `left` on.
fn strip(left: f64, width: u32, size: f64) -> Camera {
    let half_x = f64::from(width) * size / 2.0;
    let camera = nadir(left + half_x, 0.0, size, width, 1);
    Camera { projection: Projection::Orthographic { half_x, half_y: size / 2.0 }, near: 1.0, ..camera }
}

/// A wall along z of a height, its shaded side at x = 0, long enough to have no ends.
fn walled(height: f64) -> Scene {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -5000.0), (1000.0, 5000.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-8.0, 0.0, -4000.0), DVec3::new(0.0, height, 4000.0));
    scene
}

#[test]
fn a_lit_plane_has_the_colour_of_the_formula_everywhere() {
    let mut scene = town::empty();
    town::plane(&mut scene, (-130.0, -120.0), (140.0, 128.0), town::GROUND);
    for elevation in [90.0, 89.9, 60.0, 20.0, 5.0, 0.5] {
        for shadows in [Shadows::Off, Shadows::Hard, Shadows::Soft] {
            let sun = sun(elevation, 33.0);
            let demand = lit(&scene, nadir(0.0, 0.0, 5.0, 24, 24), sun, shadows);
            let rendered = render(&scene, &demand, &Options { side: 2, passes: 2, ..Options::default() });
            let worst = estimate(&rendered).linear.iter().map(|c| (c[1] - ground(&sun, 1.0)).abs()).fold(0.0, f64::max);
            // A sample of the disc lights by its own height: at most a quarter of a degree off, at random.
            let allowed = if shadows == Shadows::Soft { 0.0047 } else { 1e-12 };
            assert!(worst < allowed, "{shadows:?} at {elevation}°: {worst} off");
        }
    }
}

#[test]
fn a_shadow_is_as_long_as_the_sun_is_high() {
    for (height, elevation) in [(10.0, 70.0), (10.0, 45.0), (10.0, 20.0), (10.0, 5.0), (3.0, 1.0), (3.0, 0.5)] {
        let scene = walled(height);
        let sun = sun(elevation, 270.0);
        let length = height / libm::tan(f64::to_radians(elevation));
        let size = length / 100.0;
        let demand = lit(&scene, strip(0.0, 110, size), sun, Shadows::Hard);
        let rendered = render(&scene, &demand, &Options { side: 8, passes: 2, ..Options::default() });
        let dark: f64 = estimate(&rendered).linear.iter().map(|c| 1.0 - share(&sun, c[1])).sum();
        // Only the pixel of the shadow's end is sampled; all others are exact.
        assert!((dark * size - length).abs() < 0.1 * size, "{elevation}°: {} m, not {length} m", dark * size);
        // Nothing detaches: the ground is dark from the wall's foot on.
        assert!(share(&sun, estimate(&rendered).linear[0][1]).abs() < 1e-12);
    }
}

#[test]
fn shadows_begin_at_the_foot_of_the_wall() {
    let scene = walled(3.0);
    for (elevation, size) in [(60.0, 1e-6), (5.0, 1e-6), (60.0, 1e-7)] {
        let sun = sun(elevation, 270.0);
        let demand = lit(&scene, strip(0.0, 16, size), sun, Shadows::Hard);
        let rendered = render(&scene, &demand, &Options { side: 2, passes: 2, ..Options::default() });
        let brightest = estimate(&rendered).linear.iter().map(|c| share(&sun, c[1])).fold(0.0, f64::max);
        assert!(brightest < 1e-12, "light of {brightest} within {size} m of the wall at {elevation}°");
    }
}

#[test]
fn level_and_steep_faces_do_not_shadow_themselves() {
    for tilt in [0.0, 0.3, 0.8, 1.5, 40.0] {
        let mut scene = town::empty();
        let p = |x: f64, z: f64| DVec3::new(4_000_000.0 + x, 100.0 + x * tilt, 517_000.0 + z);
        let face = vec![p(-64.0, -64.0), p(-64.0, 64.0), p(64.0, 64.0), p(64.0, -64.0)];
        town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
        for (elevation, azimuth) in [(70.0, 10.0), (40.0, 350.0), (15.0, 280.0), (1.0, 280.0)] {
            let mut camera = nadir(4_000_000.0, 517_000.0, 1.0, 48, 48);
            camera.position.y = 4000.0;
            let mut demand = lit(&scene, camera, sun(elevation, azimuth), Shadows::Hard);
            let options = Options { side: 2, passes: 2, ..Options::default() };
            let shadowed = render(&scene, &demand, &options);
            demand.outputs[0].look.shadows = Shadows::Off;
            assert_eq!(shadowed.frame, render(&scene, &demand, &options).frame, "slope {tilt} under {elevation}°");
        }
    }
}

/// Share of the disc above a straight edge whose height angle is `edge`, for a sun at `height`, radians: the area of a
/// segment of the disc in the tangent plane.
fn segment(height: f64, edge: f64, diameter_deg: f64) -> f64 {
    let d = libm::tan(edge - height) / libm::tan((diameter_deg / 2.0).to_radians());
    if d >= 1.0 {
        0.0
    } else if d <= -1.0 {
        1.0
    } else {
        (libm::acos(d) - d * (1.0 - d * d).sqrt()) / PI
    }
}

#[test]
fn the_penumbra_of_a_wall_is_the_segment_of_the_disc() {
    let scene = walled(10.0);
    for (elevation, width) in [(45.0, 0.186), (10.0, 3.1), (5.0, 12.3)] {
        let sun = sun(elevation, 270.0);
        let height = f64::to_radians(elevation);
        let reach = |degrees: f64| 10.0 / libm::tan((elevation + degrees).to_radians());
        let (near, far) = (reach(sun.disc_deg / 2.0), reach(-sun.disc_deg / 2.0));
        assert!(((far - near) / width - 1.0).abs() < 0.02, "{elevation}°: {} m wide", far - near);
        // 40 pixels over the penumbra, 5 on either side.
        let size = (far - near) / 40.0;
        let left = near - 5.0 * size;
        let demand = lit(&scene, strip(left, 50, size), sun, Shadows::Soft);
        let rendered = render(&scene, &demand, &Options { side: 8, passes: 8, ..Options::default() });
        let estimate = estimate(&rendered);
        let scale = ground(&sun, 1.0) - ground(&sun, 0.0);
        let mut outside = 0;
        for (i, (light, error)) in estimate.linear.iter().zip(&estimate.standard_error).enumerate() {
            let mean = |k: i32| {
                segment(height, libm::atan2(10.0, left + (i as f64 + (f64::from(k) + 0.5) / 16.0) * size), sun.disc_deg)
            };
            let expected = (0..16).map(mean).sum::<f64>() / 16.0;
            let (got, error) = (share(&sun, light[1]), error[1] / scale);
            // The visible part of the disc is the upper one, which lights a little more than the mean.
            let tilt = 0.5 * libm::tan((sun.disc_deg / 2.0).to_radians()) / libm::tan(height);
            assert!(
                (got - expected).abs() < 0.01 + tilt + 4.0 * error,
                "{elevation}°, pixel {i}: {got}, not {expected}"
            );
            outside += usize::from((got - expected).abs() > tilt + 2.0 * error + 1e-3);
        }
        assert!(outside <= 8, "{elevation}°: {outside} of 50 pixels are two standard errors off");
        assert!(share(&sun, estimate.linear[2][1]) < 1e-9, "the core of the shadow is dark");
        assert!((share(&sun, estimate.linear[47][1]) - 1.0).abs() < 0.02, "beyond it the sun is whole");
    }
}

#[test]
fn the_sun_in_the_zenith_throws_no_shadow_on_the_ground() {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-4.0, 0.0, -4.0), DVec3::new(4.0, 12.0, 4.0));
    let mut camera = nadir(0.0, 0.0, 0.5, 64, 64);
    camera.projection = Projection::Orthographic { half_x: 16.0, half_y: 16.0 };
    let sun = Sun { direction: DVec3::Y, ..sun(90.0, 0.0) };
    let rendered = render(&scene, &lit(&scene, camera, sun, Shadows::Hard), &Options { side: 2, ..Options::default() });
    for (i, light) in estimate(&rendered).linear.iter().enumerate() {
        let roof = (24..40).contains(&(i % 64)) && (24..40).contains(&(i / 64));
        assert!(roof || (share(&sun, light[1]) - 1.0).abs() < 1e-12, "pixel {i}");
    }
}

#[test]
fn cut_outs_throw_the_shadow_of_what_is_there() {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    // A fence over the ground: 2 m solid, 2 m open.
    let face =
        [(-16.0, -16.0), (-16.0, 16.0), (16.0, 16.0), (16.0, -16.0)].map(|(x, z)| DVec3::new(x, 5.0, z)).to_vec();
    town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::FENCE)]);
    let sun = Sun { direction: DVec3::Y, ..sun(90.0, 0.0) };
    let mut demand = lit(&scene, strip(-16.0, 32, 1.0), sun, Shadows::Hard);
    demand.camera.near = 509.0;
    let rendered = render(&scene, &demand, &Options::default());
    for (i, light) in estimate(&rendered).linear.iter().enumerate() {
        let open = i % 4 >= 2;
        assert!((share(&sun, light[1]) - f64::from(open)).abs() < 1e-12, "pixel {i}");
    }
}

#[test]
fn a_wall_hides_its_form_factor_of_the_sky() {
    let scene = walled(10.0);
    let mut demand = lit(&scene, strip(0.0, 40, 1.0), sun(45.0, 270.0), Shadows::Off);
    demand.sun = None;
    demand.outputs[0].look.ambient = Ambient::Sky { zenith: [1.0; 3], ground: [0.0; 3], occluded: true };
    let rendered = render(&scene, &demand, &Options { side: 8, passes: 16, ..Options::default() });
    let estimate = estimate(&rendered);
    for (i, (light, error)) in estimate.linear.iter().zip(&estimate.standard_error).enumerate() {
        // An endless strip up to the angle α hides (1 - cos α) / 2 of the sky's light; the mean over the pixel.
        let open = |k: i32| 0.5 + 0.5 * libm::cos(libm::atan2(10.0, i as f64 + (f64::from(k) + 0.5) / 32.0));
        let expected = color::linear(0.6) * (0..32).map(open).sum::<f64>() / 32.0;
        assert!((light[1] - expected).abs() < 4.5 * error[1] + 1e-4, "pixel {i}: {} not {expected}", light[1]);
    }
    assert!(estimate.mean_standard_error < 0.005, "{}", estimate.mean_standard_error);
}

#[test]
fn an_open_sky_is_the_mean_that_goes_with_the_normal() {
    let mut scene = town::empty();
    let p = |x: f64, z: f64| DVec3::new(x, 100.0 + x, z);
    let face = vec![p(-64.0, -64.0), p(-64.0, 64.0), p(64.0, 64.0), p(64.0, -64.0)];
    town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
    let mut demand = lit(&scene, nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 0.0), Shadows::Hard);
    demand.sun = None;
    let expected = color::linear(0.6) * (0.2 + 0.6 * (0.5 + 0.5 * 0.5f64.sqrt()));
    for (occluded, allowed) in [(false, 1e-7), (true, 0.002)] {
        demand.outputs[0].look.ambient = Ambient::Sky { zenith: [0.8; 3], ground: [0.2; 3], occluded };
        let rendered = render(&scene, &demand, &Options { side: 8, passes: 4, ..Options::default() });
        let light = estimate(&rendered).linear.iter().map(|c| c[1]).sum::<f64>() / 64.0;
        assert!((light - expected).abs() < allowed, "{light}, not {expected}");
    }
}
