//! Acne: pixels of lit planes that a shadow map darkens. None may be, whatever the slope and the height of the sun.

use glam::DVec3;

use super::{above, even_sun, shares, sunlit};
use crate::gpu::Renderer;
use crate::gpu::tests::town::{self, tilted};
use crate::plan::demand::{Camera, Shadows};
use crate::scene::{Presence, Scene, SceneClass};

/// A level plane of 200 m × 200 m under a map of 0.25 m texels: no pixel is darker than the formula says.
fn no_acne(elevation: f64) {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-100.0, -99.0), (101.0, 102.0), town::GROUND);
    for azimuth in [0.0, 37.0, 90.0] {
        for shadows in [Shadows::Hard, Shadows::Soft] {
            let mut view = sunlit(&scene, above((0.0, 0.0), 1.0, (198, 198)), even_sun(elevation, azimuth), shadows);
            view.quality.shadow_map = 816;
            let frame = town::render(&mut renderer, &scene, view);
            // Two steps of 8 bits: normals of 16 bits and the formula differ by one under low suns.
            let dark = shares(&frame, 0).iter().filter(|share| (**share - 1.0).abs() > 0.03).count();
            assert_eq!(dark, 0, "{shadows:?}, {azimuth}°");
        }
    }
}

#[test]
fn shadow_acne_0_5() {
    no_acne(0.5);
}

#[test]
fn shadow_acne_1() {
    no_acne(1.0);
}

#[test]
fn shadow_acne_2() {
    no_acne(2.0);
}

#[test]
fn shadow_acne_5() {
    no_acne(5.0);
}

#[test]
fn shadow_acne_20() {
    no_acne(20.0);
}

#[test]
fn shadow_acne_45() {
    no_acne(45.0);
}

#[test]
fn shadow_acne_89_99() {
    no_acne(89.99);
}

/// A square face of 40 m that rises by `slope` towards `azimuth`, its middle 60 m up, and a small floor far below.
fn slope(slope: f64, azimuth: f64) -> Scene {
    let mut scene = town::empty();
    let (sin, cos) = (libm::sin(azimuth.to_radians()), libm::cos(azimuth.to_radians()));
    let tilt = libm::atan(slope);
    let along = DVec3::new(libm::cos(tilt) * sin, libm::sin(tilt), -libm::cos(tilt) * cos);
    let across = DVec3::new(cos, 0.0, sin);
    let corner = |a: f64, b: f64| DVec3::Y * 60.0 + along * (20.0 * a) + across * (20.0 * b);
    let face = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
    scene
}

/// Pixels that are lit without shadows, and how many of them lose more than a tenth of their light with them.
fn darkened(renderer: &mut Renderer, scene: &Scene, camera: Camera, sun: (f64, f64)) -> (usize, usize) {
    let mut view = sunlit(scene, camera, town::sun(sun.0, sun.1), Shadows::Off);
    let mut shadowed = view.outputs[0].clone();
    shadowed.look.shadows = Shadows::Hard;
    view.outputs.push(shadowed);
    view.sun.as_mut().expect("set").irradiance = [2.0; 3];
    let frame = town::render(renderer, scene, view);
    let (open, shadowed) = (shares(&frame, 0), shares(&frame, 1));
    let background = shares_of_background();
    let lit = open.iter().zip(&shadowed).filter(|(o, _)| **o > 0.02 && (**o - background).abs() > 1e-3);
    lit.fold((0, 0), |(all, dark), (o, s)| (all + 1, dark + usize::from(*s < 0.9 * o)))
}

fn shares_of_background() -> f64 {
    crate::plan::demand::BACKGROUND[1] / (crate::gpu::mipmaps::linear_from_srgb(0.6) * 0.9)
}

#[test]
fn no_slope_darkens_itself_under_any_sun() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let (mut lit, mut dark, mut worst) = (0, 0, (0.0, String::new()));
    for steepness in [0.0, 0.05, 0.3, 1.0, 3.0, 20.0] {
        for facing in [0.0, 70.0, 200.0] {
            let scene = slope(steepness, facing);
            for sun in [(0.5, 12.0), (5.0, 100.0), (30.0, 250.0), (60.0, 10.0), (89.9, 45.0), (90.0, 0.0)] {
                // Walls are seen from aside.
                let camera = tilted(town::nadir(0.0, 0.0, 0.7, 72, 72), if steepness > 2.0 { 50.0 } else { 0.0 });
                let (pixels, darkened) = darkened(&mut renderer, &scene, camera, sun);
                (lit, dark) = (lit + pixels, dark + darkened);
                let share = darkened as f64 / pixels.max(1) as f64;
                if share > worst.0 {
                    worst = (share, format!("slope {steepness} towards {facing}° under {sun:?}"));
                }
            }
        }
    }
    println!("{dark} of {lit} lit pixels are wrongly dark; worst {worst:?}");
    assert!(lit > 50_000, "{lit}");
    assert_eq!(dark, 0, "{worst:?}");
}
