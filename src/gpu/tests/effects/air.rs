//! Haze against the integral along each way of sight; clouds against the field's own values.

use glam::{DVec2, DVec3};

use super::{above, albedo, difference, ground_points, linear, look, plane};
use crate::gpu::tests::town::{self, nadir, sun};
use crate::plan::demand::{Ambient, Camera};
use crate::plan::effects::{Clouds, Haze};

const HAZE: Haze = Haze { extinction: [4e-4, 6e-4, 1e-3], scale_height: 300.0, base: -20.0, airlight: [0.3, 0.4, 0.6] };

/// Transmittance of a straight path by the midpoint rule.
fn kept(from: DVec3, to: DVec3, channel: usize) -> f64 {
    let steps = 4000;
    let density = |i: i32| {
        let y = from.y + (to.y - from.y) * (f64::from(i) + 0.5) / f64::from(steps);
        libm::exp(-(y - HAZE.base) / HAZE.scale_height)
    };
    let mean = (0..steps).map(density).sum::<f64>() / f64::from(steps);
    libm::exp(-HAZE.extinction[channel] * mean * (to - from).length())
}

#[test]
fn haze_is_the_integral_along_the_way_of_sight() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plane(900.0);
    // Wide, nearly level with the ground, and far away.
    let wide = nadir(3.0, -5.0, 16.0, 64, 48);
    let mut low = wide;
    low.position.y = 2.0;
    low.near = 0.5;
    let mut far = above((0.0, 0.0), 16.0, (64, 48));
    far.position.y = 700_000.0;
    far.near = 699_000.0;
    for camera in [wide, low, far] {
        let mut view = look(&scene, camera, None);
        view.outputs[0].look.ambient = Ambient::Constant([0.5; 3]);
        view.outputs[0].look.haze = Some(HAZE);
        view.quality.supersample = 1;
        let drawn = linear(&town::render(&mut renderer, &scene, view), 0);
        let expected: Vec<[f64; 3]> = ground_points(&camera).iter().map(|&p| haze(&camera, p)).collect();
        let (worst, mean) = difference(&drawn, &expected);
        println!("camera at {} m: worst {worst:.6}, mean {mean:.6}", camera.position.y);
        assert!(worst < 6e-4, "camera at {} m: {worst}", camera.position.y);
    }
}

fn haze(camera: &Camera, p: DVec3) -> [f64; 3] {
    let eye = match camera.projection {
        crate::plan::demand::Projection::Perspective { .. } => camera.position,
        _ => DVec3::new(p.x, camera.position.y, p.z),
    };
    // Above fifty scale heights there is nothing to integrate.
    let top = eye.y.min(50.0 * HAZE.scale_height);
    let start = p + (eye - p) * (top / eye.y);
    std::array::from_fn(|c| {
        let kept = kept(start, p, c);
        albedo()[c] * 0.5 * kept + HAZE.airlight[c] * (1.0 - kept)
    })
}

fn layer(height: f64) -> Clouds {
    Clouds { key: 7, cover: 0.5, height, size: 120.0, depth: 3.0, color: [0.7, 0.75, 0.8] }
}

#[test]
fn clouds_dim_the_sun_where_its_rays_cross_them() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plane(300.0);
    let camera = nadir(10.0, -20.0, 4.0, 96, 80);
    let clouds = layer(2000.0);
    for (elevation, azimuth) in [(80.0, 10.0), (35.0, 140.0), (12.0, 250.0)] {
        let sun = sun(elevation, azimuth);
        let mut view = look(&scene, camera, Some(sun));
        view.outputs[0].look.clouds = Some(clouds);
        (view.quality.supersample, view.quality.field_map) = (1, 512);
        let plan = town::plan(&scene, view.clone());
        assert!(plan.views[0].skipped.iter().any(|s| s.what == "clouds in view"), "{:?}", plan.views[0].skipped);
        let drawn = linear(&town::render(&mut renderer, &scene, view), 0);
        let light = |p: &DVec3| {
            let q = *p + sun.direction * (clouds.height / sun.direction.y);
            let kept = libm::exp(-clouds.optical_depth(DVec2::new(q.x, -q.z)) / sun.direction.y);
            std::array::from_fn(|c| albedo()[c] * sun.irradiance[c] * sun.direction.y * kept)
        };
        let expected: Vec<[f64; 3]> = ground_points(&camera).iter().map(light).collect();
        let (worst, mean) = difference(&drawn, &expected);
        println!("sun at {elevation}°: worst {worst:.5}, mean {mean:.6}");
        assert!(worst < 0.01 && mean < 1e-3, "sun at {elevation}°: worst {worst}, mean {mean}");
        let dark = expected.iter().filter(|e| e[1] < 0.5 * albedo()[1] * sun.irradiance[1] * sun.direction.y).count();
        assert!(dark > 100 && dark < expected.len() - 100, "{dark} in the shadow of clouds");
    }
}

#[test]
fn clouds_cover_what_a_camera_above_them_sees() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plane(300.0);
    let clouds = layer(200.0);
    for camera in [nadir(10.0, -20.0, 4.0, 96, 80), above((10.0, -20.0), 4.0, (96, 80))] {
        let mut view = look(&scene, camera, None);
        view.outputs[0].look.ambient = Ambient::Constant([0.4; 3]);
        view.outputs[0].look.clouds = Some(clouds);
        (view.quality.supersample, view.quality.field_map) = (1, 512);
        let drawn = linear(&town::render(&mut renderer, &scene, view), 0);
        let light = |p: &DVec3| {
            let eye = match camera.projection {
                crate::plan::demand::Projection::Perspective { .. } => camera.position,
                _ => DVec3::new(p.x, camera.position.y, p.z),
            };
            let way = eye - *p;
            let q = *p + way * (clouds.height / way.y);
            let kept = libm::exp(-clouds.optical_depth(DVec2::new(q.x, -q.z)) * way.length() / way.y);
            std::array::from_fn(|c| albedo()[c] * 0.4 * kept + clouds.color[c] * (1.0 - kept))
        };
        let expected: Vec<[f64; 3]> = ground_points(&camera).iter().map(light).collect();
        let (worst, mean) = difference(&drawn, &expected);
        println!("worst {worst:.5}, mean {mean:.6}");
        assert!(worst < 0.02 && mean < 1e-3, "worst {worst}, mean {mean}");
    }
}
