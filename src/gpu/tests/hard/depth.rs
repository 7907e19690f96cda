//! Depth: layers 0.1 m apart from 1,200 m whatever the near plane, a ladder of layers under every tilt, and the depth image
//! from 1 m to 20 km.

use glam::{DVec2, DVec3};

use super::{centres, ids, labels, metres, on_level, sight};
use crate::gpu::tests::town::{self, nadir};
use crate::plan::demand::{Camera, Output, Projection};
use crate::plan::view::frame;
use crate::scene::{Presence, SceneClass};

/// A level square of half a side about the vertical axis.
fn level(scene: &mut crate::scene::Scene, half: f64, height: f64) -> usize {
    let corner = |x: f64, z: f64| DVec3::new(x * half, height, z * half);
    let face = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    town::add(scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)])
}

/// Two planes 0.1 m apart from 1,200 m, with something 5 km away: the upper one wins everywhere.
fn upper_wins(near: f64) {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for tilt in [0.0, 35.0, 60.0] {
        let mut scene = town::empty();
        let upper = level(&mut scene, 900.0, 0.05);
        // Drawn after the upper one: at equal depth the first stays.
        level(&mut scene, 900.0, -0.05);
        town::plane(&mut scene, (-5.0, -5.0), (5.0, 5.0), town::GROUND);
        scene.objects[2].mesh.positions.iter_mut().for_each(|p| p.y = -3800.0);
        let (right, up, forward) = frame(tilt, 0.0, 0.0);
        let projection = Projection::Perspective { tan_x: 0.1, tan_y: 0.1 };
        let position = -forward * 1200.0;
        let camera = Camera { position, right, up, forward, projection, width: 256, height: 256, near };
        for swapped in [false, true] {
            if swapped {
                scene.objects.swap(0, 1);
            }
            let upper = scene.objects[usize::from(swapped)].instance.max(upper as u32);
            let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
            let wrong = ids(&drawn, 0).iter().filter(|id| **id != upper).count();
            assert_eq!(wrong, 0, "{tilt}°, near {near} m");
        }
    }
}

#[test]
fn depth_near_0_1() {
    upper_wins(0.1);
}

#[test]
fn depth_near_1() {
    upper_wins(1.0);
}

#[test]
fn depth_near_10() {
    upper_wins(10.0);
}

#[test]
fn depth_ladder() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    let height = |step: usize| 5.0 - 0.05 * step as f64;
    let half = |step: usize| 4.0 + 0.3 * step as f64;
    for step in 0..100 {
        level(&mut scene, half(step), height(step));
    }
    for tilt in [0.0, 20.0, 40.0, 60.0, 75.0, 80.0] {
        let (right, up, forward) = frame(tilt, 25.0, 0.0);
        let projection = Projection::Perspective { tan_x: 0.03, tan_y: 0.03 };
        let position = -forward * 1200.0;
        let camera = Camera { position, right, up, forward, projection, width: 240, height: 240, near: 1.0 };
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
        let mut decided = 0;
        for (at, &id) in centres(&camera).zip(ids(&drawn, 0)) {
            // How far the pixel's middle is inside each square: the first that it is in is seen.
            let inside = (0..100).map(|step| {
                let p = on_level(&camera, at, height(step));
                half(step) - p.x.abs().max(p.z.abs())
            });
            let margin = 0.01 * 0.3 / libm::cos(f64::to_radians(tilt));
            let Some((step, inside)) = inside.enumerate().find(|(_, inside)| *inside > -margin) else {
                assert_eq!(id, 0, "{at} under {tilt}°");
                continue;
            };
            if inside > margin {
                assert_eq!(id as usize, step + 1, "{at} under {tilt}°");
                decided += 1;
            }
        }
        assert!(decided > 9_000, "{decided}");
    }
}

#[test]
fn depth_is_right_from_one_metre_to_the_horizon() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-20_000.0, -20_000.0), (20_001.0, 20_002.0), town::GROUND);
    let projection = Projection::Perspective { tan_x: 1.0, tan_y: 1.0 };
    for (height, near) in [(1.5, 0.1), (120.0, 10.0)] {
        let (right, up, forward) = frame(89.0, 180.0, 0.0);
        let position = DVec3::new(0.3, height, 0.2);
        let camera = Camera { position, right, up, forward, projection, width: 64, height: 512, near };
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Depth));
        let (mut worst, mut seen, mut nearest, mut farthest) = (0.0f64, 0, f64::INFINITY, 0.0f64);
        for (at, &depth) in centres(&camera).zip(metres(&drawn, 0)) {
            let along = |row: f64| {
                let (from, towards) = sight(&camera, at + DVec2::new(0.0, row));
                -from.y / towards.y
            };
            let expected = along(0.0);
            // Corners are rounded to 1/256 pixel; beyond the plane's end there is nothing.
            let rounding = (along(-1.0 / 128.0) - along(1.0 / 128.0)).abs();
            if expected < 0.0 || along(-0.1) < 0.0 || along(-0.1) > 19_000.0 {
                continue;
            }
            let error = (f64::from(depth) - expected).abs();
            assert!(error <= rounding + 4e-7 * expected, "{depth} m instead of {expected} m at {at}");
            worst = worst.max(error / expected);
            (seen, nearest, farthest) = (seen + 1, nearest.min(expected), farthest.max(expected));
        }
        println!("from {nearest:.1} m to {farthest:.0} m: {worst:.2e} of the distance off at worst");
        assert!(seen > 10_000 && nearest < 1.5 * height && farthest > 50.0 * height, "{seen}, {nearest}, {farthest}");
    }
}

#[test]
fn layers_two_centimetres_apart_keep_their_order_from_space() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for (distance, tilt) in [(3_000.0, 0.0), (700_000.0, 0.0), (700_000.0, 45.0)] {
        let mut scene = town::empty();
        for step in 0..10 {
            level(&mut scene, 60.0, 0.02 * f64::from(step));
        }
        scene.objects.reverse();
        let (right, up, forward) = frame(tilt, 300.0, 0.0);
        let tan = 20.0 / distance;
        let projection = Projection::Perspective { tan_x: tan, tan_y: tan };
        let (position, near) = (-forward * distance, 0.99 * (distance - 100.0));
        let camera = Camera { position, right, up, forward, projection, width: 128, height: 128, near };
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
        assert!(ids(&drawn, 0).iter().all(|id| *id == 10), "from {distance} m under {tilt}°");
        let straight = nadir(0.0, 0.0, 0.1, 4, 4);
        assert_eq!(straight.near, 256.0);
    }
}
