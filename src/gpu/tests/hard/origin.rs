//! Origins: a scene at UTM-size and planet-size coordinates shows the same pixels; a camera that creeps does not jump.

use glam::{DVec2, DVec3};

use super::{ids, labels, pixel};
use crate::frame::Pixels;
use crate::geometry::hard_cases::footprint;
use crate::gpu::tests::town::{self, demand, nadir, rgb, sun, tilted, view};
use crate::plan::demand::{Output, State, ViewDemand};
use crate::scene::{Presence, Scene, SceneClass};

fn moved(scene: &Scene, shift: DVec3) -> Scene {
    let mut scene = scene.clone();
    scene.objects.iter_mut().flat_map(|o| &mut o.mesh.positions).for_each(|p| *p += shift);
    scene
}

fn outputs(scene: &Scene, mut camera: crate::plan::demand::Camera) -> ViewDemand {
    camera.position = (camera.position * 65536.0).round() / 65536.0;
    let outputs = [Output::Color, Output::Instance, Output::Depth, Output::Mask];
    view(camera, sun(30.0, 140.0), outputs.map(|o| demand(scene, o, State::Before)).to_vec())
}

#[test]
fn a_shift_round_the_planet_changes_no_pixel() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::town(4);
    // Positions on a grid of 2^-16 m, so that the shifts are exact.
    let positions = scene.objects.iter_mut().flat_map(|o| &mut o.mesh.positions);
    positions.for_each(|p| *p = (*p * 65536.0).round() / 65536.0);
    for camera in [nadir(0.0, 0.0, 0.5, 160, 150), tilted(nadir(0.0, 0.0, 0.5, 160, 150), 60.0)] {
        let view = outputs(&scene, camera);
        let here = town::render(&mut renderer, &scene, view.clone());
        // A UTM easting and northing; three quarters of the way round the planet; beyond it.
        for shift in [(500_000.0, 0.0, -4_649_776.0), (30_000_000.0, 300.0, 6_378_137.0), (-1e9, 8848.0, 1e9)] {
            let shift = DVec3::from(shift);
            let mut there = view.clone();
            there.camera.position += shift;
            let there = town::render(&mut renderer, &moved(&scene, shift), there);
            assert!(here == there, "moved by {shift}");
        }
    }
}

/// A gear of 24 teeth, 12 m high, on a plane.
fn gear() -> Option<Scene> {
    let outline = footprint("gear_24")?.outer;
    let mut scene = town::empty();
    town::plane(&mut scene, (-60.0, -61.0), (62.0, 63.0), town::GROUND);
    let up = |p: DVec2, y: f64| DVec3::new(p.x, y, -p.y);
    let edges = (0..outline.len()).map(|i| (outline[i], outline[(i + 1) % outline.len()]));
    let faces: Vec<(Vec<DVec3>, u32)> =
        edges.map(|(a, b)| (vec![up(a, 0.0), up(b, 0.0), up(b, 12.0), up(a, 12.0)], town::WALL)).collect();
    town::add(&mut scene, SceneClass::Building, Presence::Both, &faces);
    Some(scene)
}

#[test]
fn jitter_far_origin() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let Some(scene) = gear() else { return };
    let mut camera = tilted(nadir(0.0, 0.0, 0.25, 300, 300), 25.0);
    camera.near = 256.0;
    let view = outputs(&scene, camera);
    let here = town::render(&mut renderer, &scene, view.clone());
    assert!(ids(&here, 1).contains(&2));
    for offset in [(600_000.0, 4_200_000.0), (20_000_000.0, 20_000_000.0)] {
        let shift = DVec3::new(offset.0, 0.0, -offset.1);
        let mut there = view.clone();
        there.camera.position += shift;
        let there = town::render(&mut renderer, &moved(&scene, shift), there);
        let colors = rgb(&here, 0).chunks_exact(3).zip(rgb(&there, 0).chunks_exact(3)).filter(|(a, b)| a != b).count();
        let numbers = ids(&here, 1).iter().zip(ids(&there, 1)).filter(|(a, b)| a != b).count();
        println!("{offset:?}: {colors} colours, {numbers} labels of {} differ", 300 * 300);
        assert!(colors <= 9 && numbers <= 9, "{offset:?}: {colors} colours, {numbers} labels");
    }
}

#[test]
fn jitter_orbit() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // An edge that leans by one pixel over the image: the number of covered pixels is its place in 1/1000 pixel.
    let mut scene = town::empty();
    let gsd = 0.1;
    let edge = |z: f64| 0.3 + gsd * z / 100.0;
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let face = vec![corner(-30.0, -60.0), corner(-30.0, 60.0), corner(edge(60.0), 60.0), corner(edge(-60.0), -60.0)];
    town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
    let mut camera = nadir(0.0, 0.0, gsd, 16, 1000);
    camera.position.y = 1200.0;
    let tan = |pixels: f64| pixels * gsd / 2.0 / 1200.0;
    camera.projection = crate::plan::demand::Projection::Perspective { tan_x: tan(16.0), tan_y: tan(1000.0) };
    camera.near = 1180.0;
    let middle = DVec3::new(edge(0.0), 0.0, 0.0);
    let (mut last, mut worst) = (f64::INFINITY, 0.0f64);
    for step in 0..60 {
        camera.position.x = 1e-4 * f64::from(step);
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
        let Pixels::Id32(numbers) = &drawn.images[0].pixels else { panic!("numbers") };
        let at = numbers.iter().filter(|id| **id != 0).count() as f64 / 1000.0;
        worst = worst.max((at - pixel(&camera, middle).x).abs());
        assert!(at <= last, "step {step}: the edge goes back from {last} to {at}");
        last = at;
    }
    println!("the edge is {worst:.4} px off at worst");
    assert!(worst <= 0.01, "{worst} px");
}
