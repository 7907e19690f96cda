//! Detail of 0.1 m from an aeroplane at 1,200 m and from a satellite at 700 km: labels, shadows, depth.

use glam::{DVec2, DVec3};

use super::{centres, even_sun, ids, labels, metres, on_level, shares, sunlit};
use crate::gpu::Renderer;
use crate::gpu::tests::town;
use crate::plan::demand::{Camera, Output, Projection, Shadows};
use crate::plan::view::frame;
use crate::scene::{Presence, Scene, SceneClass};

const SIDE: usize = 48;
const PLATE: f64 = 0.1;

/// Plates of 0.1 m in a square, each its own object, numbered row by row from 1.
fn plates() -> Scene {
    let mut scene = town::empty();
    for (j, i) in (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| (j, i))) {
        let edge = |k: usize| (k as f64 - SIDE as f64 / 2.0) * PLATE;
        let corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
        let face = corners.map(|(i, j)| DVec3::new(edge(i), 0.0, edge(j))).to_vec();
        town::add(&mut scene, SceneClass::Terrain, Presence::Both, &[(face, town::GROUND)]);
    }
    scene
}

/// A camera that sees a square of 6.4 m of the ground, 0.05 m per pixel, a little aside of the plates' edges.
fn from(distance: f64, tilt: f64) -> Camera {
    let (right, up, forward) = frame(tilt, 140.0, 20.0);
    let tan = 3.2 / distance;
    let projection = Projection::Perspective { tan_x: tan, tan_y: tan };
    let target = DVec3::new(0.013, 0.0, 0.021);
    // As the planner sets it: a little nearer than the nearest corner.
    let near = 0.99 * (distance - 10.0);
    Camera { position: target - forward * distance, right, up, forward, projection, width: 128, height: 128, near }
}

/// Every pixel whose middle is at least a hundredth of a pixel from a plate's edge shows that plate.
fn every_plate_is_where_it_is(distance: f64) {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plates();
    for tilt in [0.0, 30.0, 60.0] {
        let camera = from(distance, tilt);
        let drawn = town::render(&mut renderer, &scene, labels(&scene, camera, Output::Instance));
        let (mut decided, mut wrong) = (0, 0);
        for (at, &id) in centres(&camera).zip(ids(&drawn, 0)) {
            let p = on_level(&camera, at, 0.0);
            let cell = DVec2::new(p.x, p.z) / PLATE + SIDE as f64 / 2.0;
            let inside = cell - cell.floor();
            if inside.min_element().min(1.0 - inside.max_element()) < 0.02 {
                continue;
            }
            let range = 0.0..SIDE as f64;
            let expected = if range.contains(&cell.x) && range.contains(&cell.y) {
                cell.y as u32 * SIDE as u32 + cell.x as u32 + 1
            } else {
                0
            };
            (decided, wrong) = (decided + 1, wrong + usize::from(expected != id));
        }
        println!("{distance} m, {tilt}°: {wrong} of {decided} pixels wrong");
        assert_eq!(wrong, 0, "{distance} m, {tilt}°");
        assert!(decided > 13_000, "{decided}");
    }
}

#[test]
fn a_tenth_of_a_metre_from_1200_metres() {
    every_plate_is_where_it_is(1_200.0);
}

#[test]
fn a_tenth_of_a_metre_from_700_kilometres() {
    every_plate_is_where_it_is(700_000.0);
}

/// Metres that the depth image of level ground is off at worst.
fn depth_error(renderer: &mut Renderer, camera: Camera) -> f64 {
    let mut scene = town::empty();
    town::plane(&mut scene, (-20.0, -21.0), (22.0, 23.0), town::GROUND);
    let drawn = town::render(renderer, &scene, labels(&scene, camera, Output::Depth));
    let expected = |at| (on_level(&camera, at, 0.0) - camera.position).dot(camera.forward);
    let errors = centres(&camera).zip(metres(&drawn, 0)).map(|(at, &depth)| (f64::from(depth) - expected(at)).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn depth_from_space_has_the_digits_of_its_format() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for (distance, tilt) in [(1_200.0, 0.0), (1_200.0, 60.0), (700_000.0, 0.0), (700_000.0, 60.0)] {
        let error = depth_error(&mut renderer, from(distance, tilt));
        // Half a step of a 32-bit float, and 1/256 pixel of 0.05 m along the ground.
        let step = distance * 2f64.powi(-23);
        println!("{distance} m, {tilt}°: {error:.6} m off, a step of the format is {step:.6} m");
        assert!(error <= step + 0.002, "{distance} m, {tilt}°: {error} m");
    }
}

#[test]
fn shadows_from_space_are_those_from_an_aeroplane() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-20.0, -21.0), (22.0, 23.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-1.0, 0.0, -0.7), DVec3::new(-0.2, 0.6, 0.9));
    for elevation in [5.0, 35.0] {
        let mut pictures = Vec::new();
        for distance in [1_200.0, 700_000.0] {
            let view = sunlit(&scene, from(distance, 0.0), even_sun(elevation, 250.0), Shadows::Hard);
            let picture = shares(&town::render(&mut renderer, &scene, view), 0);
            let speckles = picture.iter().filter(|share| **share > 0.02 && **share < 0.98).count();
            // The ground is lit or in the shadow, but for the outline.
            assert!(speckles < 700, "{distance} m, {elevation}°: {speckles} pixels are half lit");
            pictures.push(picture);
        }
        let differ = pictures[0].iter().zip(&pictures[1]).filter(|(a, b)| (**a - **b).abs() > 0.1).count();
        println!("{elevation}°: {differ} pixels differ");
        assert!(differ < 200, "{elevation}°: {differ}");
    }
}
