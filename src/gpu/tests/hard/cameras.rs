//! Cameras: exact nadir, almost nadir, far from nadir, inside a building.

use glam::{DVec2, DVec3};

use super::{above, ids, labels, metres, pixel, trace};
use crate::gpu::tests::town::{self, demand, rgb, sun, view};
use crate::plan::demand::{Camera, Output, Projection, Shadows, State};
use crate::plan::view::frame;
use crate::scene::Presence;

/// A camera 1,000 m from the origin of the plan that sees 60 m of it.
fn looking(off_nadir: f64, azimuth: f64, heading: f64) -> Camera {
    let (right, up, forward) = frame(off_nadir, azimuth, heading);
    let tan = 0.03;
    Camera {
        position: -forward * 1000.0,
        right,
        up,
        forward,
        projection: Projection::Perspective { tan_x: tan, tan_y: tan },
        width: 120,
        height: 120,
        near: 500.0,
    }
}

#[test]
fn camera_nadir() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // A mark of one pixel in the east, one in the north, both on pixel borders.
    let mut scene = town::empty();
    town::plane(&mut scene, (-40.0, -41.0), (42.0, 43.0), town::GROUND);
    let (low, high) = (DVec3::new(20.0, 0.0, 0.0), DVec3::new(20.5, 1e-3, 0.5));
    let east = town::block(&mut scene, Presence::Both, low, high);
    let north = town::block(&mut scene, Presence::Both, low + DVec3::new(-20.0, 0.0, -20.0), high - DVec3::X * 20.0);
    for azimuth in [0.0, 90.0, 123.0, 359.0] {
        let camera = looking(0.0, azimuth, 0.0);
        assert!((camera.right - DVec3::X).length() < 1e-12 && (camera.up + DVec3::Z).length() < 1e-12);
        for (p, expected) in [((0.0, 0.0), (60.0, 60.0)), ((20.0, 0.0), (100.0, 60.0)), ((-3.0, -20.0), (54.0, 20.0))] {
            let at = pixel(&camera, DVec3::new(p.0, 0.0, p.1));
            assert!((at - DVec2::from(expected)).length() < 1e-3, "{at}");
        }
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
        let at = |x: usize, y: usize| ids(&drawn, 0)[y * 120 + x];
        assert_eq!((at(100, 60), at(101, 60), at(99, 60)), (east as u32 + 1, 1, 1));
        assert_eq!((at(60, 20), at(60, 19), at(61, 20)), (north as u32 + 1, 1, 1));
    }
}

#[test]
fn camera_near_nadir() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(2);
    let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)];
    let exact = looking(0.0, 70.0, 10.0);
    for tilt in [1e-3f64, 1e-6, 1e-9, 1e-12, 0.0] {
        let camera = looking(tilt.to_degrees(), 70.0, 10.0);
        let worst = corners
            .map(|(x, z)| DVec3::new(x, 0.0, z))
            .map(|p| (pixel(&camera, p) - pixel(&exact, p)).length())
            .into_iter()
            .fold(0.0, f64::max);
        // The near and the far side of the image are this much nearer and farther: 57 px · 28 m / 1,000 m.
        assert!(worst <= 1.6 * tilt + 1e-9, "{tilt}: {worst} px");
        assert!(worst <= 0.01, "{tilt}: {worst} px");
        let outputs = [Output::Instance, Output::Color].map(|o| demand(&scene, o, State::Before)).to_vec();
        let drawn = town::render(&mut renderer, &scene, view(camera, sun(40.0, 100.0), outputs.clone()));
        let nadir = town::render(&mut renderer, &scene, view(exact, sun(40.0, 100.0), outputs));
        let other = ids(&drawn, 0).iter().zip(ids(&nadir, 0)).filter(|(a, b)| a != b).count();
        assert!(other <= if tilt > 1e-8 { 30 } else { 0 }, "{tilt}: {other} pixels");
        assert!(tilt > 1e-8 || drawn == nadir);
    }
}

#[test]
fn camera_inside() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(3);
    // In the middle of the house at (2.3, 1.9), then through its walls.
    for (eye, azimuth) in [((6.0, 2.0, 5.0), 20.0), ((6.0, 3.5, 8.9), 200.0), ((2.4, 1.0, 2.0), 310.0)] {
        let (right, up, forward) = frame(80.0, azimuth, azimuth + 180.0);
        let projection = Projection::Perspective { tan_x: 0.8, tan_y: 0.6 };
        let position = DVec3::from(eye);
        let camera = Camera { position, right, up, forward, projection, width: 160, height: 120, near: 0.1 };
        let outputs = [Output::Color, Output::Instance, Output::Depth].map(|o| demand(&scene, o, State::Before));
        let mut demand = view(camera, sun(40.0, 100.0), outputs.to_vec());
        demand.quality.supersample = 1;
        demand.outputs[0].look.shadows = Shadows::Hard;
        let drawn = town::render(&mut renderer, &scene, demand.clone());
        let [r, g, b] = crate::plan::demand::BACKGROUND.map(|c| crate::gpu::mipmaps::srgb_from_linear(c) * 255.0);
        let background = [r.round() as u8, g.round() as u8, b.round() as u8];
        for ((color, id), depth) in rgb(&drawn, 0).chunks_exact(3).zip(ids(&drawn, 1)).zip(metres(&drawn, 2)) {
            assert_eq!(color == background, *id == 0);
            assert_eq!(depth.is_infinite(), *id == 0);
        }
        let traced = trace(&scene, &demand, 1);
        let other = ids(&drawn, 1).iter().zip(ids(&traced.frame, 1)).filter(|(a, b)| a != b).count();
        assert!(other <= 40, "{other} labels differ from those of rays");
    }
}

#[test]
fn sixty_degrees_off_nadir_is_what_rays_see() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(5);
    for (azimuth, heading) in [(30.0, 0.0), (215.0, 35.0)] {
        let camera = Camera { width: 240, height: 240, ..looking(60.0, azimuth, heading) };
        let outputs = [Output::Color, Output::Instance].map(|o| demand(&scene, o, State::Before)).to_vec();
        let mut demand = view(camera, sun(50.0, 120.0), outputs);
        (demand.quality.supersample, demand.quality.shadow_map) = (4, 4096);
        demand.outputs[0].look.shadows = Shadows::Hard;
        let drawn = town::render(&mut renderer, &scene, demand.clone());
        let traced = trace(&scene, &demand, 4);
        let other = ids(&drawn, 1).iter().zip(ids(&traced.frame, 1)).filter(|(a, b)| a != b).count();
        let light = traced.estimates[0].as_ref().expect("a colour image").linear.iter().flatten();
        let square = |(byte, light): (&u8, &f64)| {
            (crate::gpu::mipmaps::linear_from_srgb(f64::from(*byte) / 255.0) - light.min(1.0)).powi(2)
        };
        let rms = (rgb(&drawn, 0).iter().zip(light).map(square).sum::<f64>() / rgb(&drawn, 0).len() as f64).sqrt();
        println!("azimuth {azimuth}°: {other} labels of {} differ, rms {rms:.5}", 240 * 240);
        assert!(other * 1000 <= 240 * 240 && rms < 0.01, "{other} labels, rms {rms}");
    }
}

#[test]
fn a_parallel_and_a_distant_camera_agree() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(3);
    let parallel = above((0.3, 0.2), 0.31, (200, 200));
    let distance = 5.0e6;
    let tan = 100.0 * 0.31 / distance;
    let distant = Camera {
        position: DVec3::new(0.3, distance, 0.2),
        projection: Projection::Perspective { tan_x: tan, tan_y: tan },
        near: distance - 30.0,
        ..parallel
    };
    let draw = |camera| labels(&scene, camera, Output::Instance);
    let (a, b) =
        (town::render(&mut renderer, &scene, draw(parallel)), town::render(&mut renderer, &scene, draw(distant)));
    let other = ids(&a, 0).iter().zip(ids(&b, 0)).filter(|(a, b)| a != b).count();
    assert!(other <= 8, "{other}");
}
