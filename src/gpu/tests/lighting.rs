//! Light and shadow: lengths from the sun's height, no acne, colours from the formula.

use glam::DVec3;

use super::town::{self, demand, nadir, rgb, sun, tilted, view};
use crate::gpu::mipmaps::{linear_from_srgb, srgb_from_linear};
use crate::plan::demand::{Ambient, Output, Projection, Shadows, State, Sun, ViewDemand};
use crate::scene::{Presence, Scene};

fn byte(linear: f64) -> f64 {
    srgb_from_linear(linear.clamp(0.0, 1.0)) * 255.0
}

/// Radiance of the level ground, lit by the sun or not.
fn ground(sun: &Sun, ambient: f64, lit: bool) -> [f64; 3] {
    std::array::from_fn(|c| {
        let albedo = linear_from_srgb([0.55, 0.6, 0.5][c]);
        albedo * (ambient + if lit { sun.irradiance[c] * sun.direction.y } else { 0.0 })
    })
}

fn hard(scene: &Scene, camera: crate::plan::demand::Camera, sun: Sun) -> ViewDemand {
    let mut output = demand(scene, Output::Color, State::Before);
    (output.look.shadows, output.look.ambient) = (Shadows::Hard, Ambient::Constant([0.2; 3]));
    view(camera, sun, vec![output])
}

#[test]
fn a_lit_plane_has_the_colour_of_the_formula_everywhere() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    // Not square: no diagonal through the corners of the image, where clipping leaves slivers.
    town::plane(&mut scene, (-130.0, -120.0), (140.0, 128.0), town::GROUND);
    for (elevation, azimuth) in [(90.0, 0.0), (60.0, 33.0), (20.0, 190.0), (5.0, 100.0), (1.5, 271.0)] {
        for shadows in [Shadows::Off, Shadows::Hard, Shadows::Soft] {
            let mut demand = hard(&scene, nadir(0.0, 0.0, 1.0, 96, 96), sun(elevation, azimuth));
            demand.outputs[0].look.shadows = shadows;
            let frame = town::render(&mut renderer, &scene, demand.clone());
            let expected = ground(&demand.sun.expect("set"), 0.2, true).map(byte);
            let wrong = |p: &[u8]| (0..3).any(|c| (f64::from(p[c]) - expected[c]).abs() > 1.0);
            let pixels = rgb(&frame, 0).chunks_exact(3).enumerate();
            let wrong: Vec<_> = pixels.filter(|(_, p)| wrong(p)).map(|(i, p)| (i % 96, i / 96, p)).collect();
            assert!(wrong.is_empty(), "{shadows:?} at {elevation}°: not {expected:?} but {wrong:?}");
        }
    }
}

#[test]
fn slopes_have_no_acne() {
    let Some(mut renderer) = super::renderer() else { return };
    for tilt in [0.3f64, 0.8, 1.5] {
        let mut scene = town::empty();
        let p = |x: f64, z: f64| DVec3::new(x, 100.0 + x * tilt, z);
        let face = vec![p(-64.0, -64.0), p(-64.0, 64.0), p(64.0, 64.0), p(64.0, -64.0)];
        town::add(&mut scene, crate::scene::SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
        for (elevation, azimuth) in [(70.0, 10.0), (40.0, 350.0), (15.0, 280.0)] {
            let mut demand = hard(&scene, nadir(0.0, 0.0, 1.0, 64, 64), sun(elevation, azimuth));
            demand.outputs[0].look.shadows = Shadows::Soft;
            let frame = town::render(&mut renderer, &scene, demand);
            let colors: std::collections::BTreeSet<_> = rgb(&frame, 0).chunks_exact(3).map(|p| p[0]).collect();
            let spread = colors.last().zip(colors.first()).map(|(a, b)| a - b);
            assert!(spread <= Some(1), "slope {tilt} under {elevation}°: {colors:?}");
        }
    }
}

/// Rolling ground of 8 m cells with smooth normals, slopes up to 0.13.
fn rolling(scene: &mut Scene) {
    let height = |x: f64, z: f64| 2.0 * libm::sin(x / 20.0) + 1.5 * libm::cos(z / 25.0);
    let mut mesh = crate::scene::TriMesh::default();
    for (j, i) in (0..41).flat_map(|j| (0..41).map(move |i| (j, i))) {
        let (x, z) = (f64::from(i) * 8.0 - 160.0, f64::from(j) * 8.0 - 160.0);
        mesh.positions.push(DVec3::new(x, height(x, z), z));
        let slope = |dx: f64, dz: f64| height(x - dx, z - dz) - height(x + dx, z + dz);
        mesh.normals.push(DVec3::new(slope(0.01, 0.0), 0.02, slope(0.0, 0.01)).normalize().as_vec3());
        mesh.uvs.push(glam::Vec2::ZERO);
        if i < 40 && j < 40 {
            let (a, b) = (j as u32 * 41 + i as u32, (j as u32 + 1) * 41 + i as u32);
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let count = mesh.triangles.len() as u32;
    mesh.groups.push(crate::scene::Group { material: town::GROUND, first: 0, count });
    town::plane(scene, (0.0, 0.0), (1.0, 1.0), town::GROUND);
    scene.objects[0].mesh = mesh.into();
}

#[test]
fn smooth_ground_of_flat_triangles_has_no_acne() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    rolling(&mut scene);
    for (elevation, azimuth) in [(60.0, 77.0), (30.0, 200.0), (15.0, 310.0)] {
        let mut shadowed = demand(&scene, Output::Color, State::Before);
        shadowed.look.shadows = Shadows::Soft;
        let mut open = shadowed.clone();
        open.look.shadows = Shadows::Off;
        let view = view(nadir(0.0, 0.0, 0.5, 500, 500), sun(elevation, azimuth), vec![shadowed, open]);
        let frame = town::render(&mut renderer, &scene, view);
        town::keep(&frame, 0, &format!("rolling_{elevation}.png"));
        let worst = rgb(&frame, 0).iter().zip(rgb(&frame, 1)).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(4), "{elevation}°: {worst:?}");
    }
}

/// Length in metres of the shadow of a wall of `height`, measured along a row of pixels of 0.25 m away from the sun.
fn shadow_length(renderer: &mut crate::gpu::Renderer, height: f64, elevation: f64) -> (f64, f64) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (448.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-8.0, 0.0, -40.0), DVec3::new(0.0, height, 40.0));
    let length = height / libm::tan(elevation.to_radians());
    let mut camera = nadir(length / 2.0, 0.0, 0.25, ((length + 16.0) * 4.0) as u32 / 2 * 2, 8);
    let half_x = f64::from(camera.width) * 0.125;
    camera.projection = Projection::Orthographic { half_x, half_y: 1.0 };
    let demand = hard(&scene, camera, sun(elevation, 270.0));
    let plan = town::plan(&scene, demand.clone());
    let texel = plan.views[0].passes().find_map(|p| match &p.kind {
        crate::plan::pass::PassKind::ShadowMap { light, .. } => Some(light.texel / light.direction.y.min(1.0)),
        _ => None,
    });
    let frame = town::render(renderer, &scene, demand.clone());
    let sun = demand.sun.expect("set");
    let middle = (byte(ground(&sun, 0.2, true)[1]) + byte(ground(&sun, 0.2, false)[1])) / 2.0;
    let row = &rgb(&frame, 0)[..camera.width as usize * 3];
    let left = length / 2.0 - half_x;
    let dark = row.chunks_exact(3).enumerate().filter(|(i, pixel)| {
        let x = left + (*i as f64 + 0.5) * 0.25;
        x > 0.0 && f64::from(pixel[1]) < middle
    });
    let texel = texel.expect("there is a shadow map").max_element();
    (dark.count() as f64 * 0.25 - length, texel)
}

#[test]
fn a_shadow_is_as_long_as_the_sun_is_high() {
    let Some(mut renderer) = super::renderer() else { return };
    for (height, elevation) in [(10.0, 70.0), (10.0, 45.0), (10.0, 20.0), (10.0, 5.0), (3.0, 1.0)] {
        let (error, texel) = shadow_length(&mut renderer, height, elevation);
        assert!(error.abs() <= texel + 0.25, "{elevation}°: {error} m off, a texel is {texel} m");
    }
}

#[test]
fn the_sun_in_the_zenith_throws_no_shadow_on_the_ground() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-4.0, 0.0, -4.0), DVec3::new(4.0, 12.0, 4.0));
    let mut camera = nadir(0.0, 0.0, 0.5, 64, 64);
    camera.projection = Projection::Orthographic { half_x: 16.0, half_y: 16.0 };
    let sun = Sun { direction: DVec3::Y, ..sun(90.0, 0.0) };
    let frame = town::render(&mut renderer, &scene, hard(&scene, camera, sun));
    let lit = byte(ground(&sun, 0.2, true)[1]);
    for (i, pixel) in rgb(&frame, 0).chunks_exact(3).enumerate() {
        let (x, y) = (i % 64, i / 64);
        let beside_roof = !(23..=40).contains(&x) || !(23..=40).contains(&y);
        assert!(!beside_roof || (f64::from(pixel[1]) - lit).abs() <= 1.0, "({x}, {y}) is {pixel:?}");
    }
}

#[test]
fn a_tower_outside_the_image_throws_its_shadow_into_it() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-130.0, -120.0), (140.0, 128.0), town::GROUND);
    // 40 m high, 60 m east of the image's centre; the sun in the east at 30° makes the shadow 69 m long.
    town::block(&mut scene, Presence::Both, DVec3::new(60.0, 0.0, -8.0), DVec3::new(70.0, 40.0, 8.0));
    let frame = town::render(&mut renderer, &scene, hard(&scene, nadir(0.0, 0.0, 1.0, 64, 64), sun(30.0, 90.0)));
    let sun = sun(30.0, 90.0);
    let green = |x: usize, y: usize| f64::from(rgb(&frame, 0)[(y * 64 + x) * 3 + 1]);
    let (lit, dark) = (byte(ground(&sun, 0.2, true)[1]), byte(ground(&sun, 0.2, false)[1]));
    assert!((green(40, 32) - dark).abs() <= 1.0, "{} in the shadow", green(40, 32));
    assert!((green(10, 32) - lit).abs() <= 1.0, "{} beyond its end", green(10, 32));
    assert!((green(40, 10) - lit).abs() <= 1.0, "{} beside it", green(40, 10));
}

#[test]
fn samples_are_averaged_in_linear_light() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    // The edge at x = 0.5 m halves pixel 4 of 8.
    town::plane(&mut scene, (-20.0, -20.0), (0.5, 20.0), town::GROUND);
    for (supersample, share) in [(1, None), (2, Some(0.5)), (4, Some(0.5)), (6, Some(0.5)), (3, Some(1.0 / 3.0))] {
        let mut demand = hard(&scene, nadir(0.0, 0.0, 1.0, 8, 4), sun(90.0, 0.0));
        demand.outputs[0].look.shadows = Shadows::Off;
        demand.quality.supersample = supersample;
        let frame = town::render(&mut renderer, &scene, demand.clone());
        let row: Vec<f64> = (0..8).map(|x| f64::from(rgb(&frame, 0)[x * 3 + 1])).collect();
        let lit = ground(&demand.sun.expect("set"), 0.2, true)[1];
        let empty = crate::plan::demand::BACKGROUND[1];
        assert!((row[3] - byte(lit)).abs() <= 1.0 && (row[5] - byte(empty)).abs() <= 1.0, "{row:?}");
        if let Some(share) = share {
            let mixed = byte(lit * share + empty * (1.0 - share));
            // A sample on the edge itself may fall to either side: 3 samples have one there.
            let other = byte(lit * (1.0 - share) + empty * share);
            let error = (row[4] - mixed).abs().min((row[4] - other).abs());
            assert!(error <= 1.0, "{supersample} samples: {} is not {mixed}", row[4]);
        }
    }
}

#[test]
fn sky_light_goes_with_the_normal() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    let p = |x: f64, z: f64| DVec3::new(x, 100.0 + x, z);
    let face = vec![p(-64.0, -64.0), p(-64.0, 64.0), p(64.0, 64.0), p(64.0, -64.0)];
    town::add(&mut scene, crate::scene::SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
    let mut demand = hard(&scene, nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 0.0));
    demand.sun = None;
    demand.outputs[0].look.ambient = Ambient::Sky { zenith: [0.8; 3], ground: [0.2; 3], occluded: false };
    let frame = town::render(&mut renderer, &scene, demand);
    // A slope of 45°: the cosine of its normal to the zenith is √½.
    let irradiance = 0.2 + 0.6 * (0.5 + 0.5 * 0.5f64.sqrt());
    let expected = [0.55, 0.6, 0.5].map(|c| byte(linear_from_srgb(c) * irradiance));
    for pixel in rgb(&frame, 0).chunks_exact(3) {
        assert!((0..3).all(|c| (f64::from(pixel[c]) - expected[c]).abs() <= 1.0), "{pixel:?}, not {expected:?}");
    }
}

#[test]
fn unchanged_surroundings_are_the_same_pixels_before_and_after() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::town(3);
    for object in &mut scene.objects {
        object.presence = Presence::Both;
    }
    scene.objects[9].presence = Presence::BeforeOnly;
    let outputs = [State::Before, State::After].map(|s| demand(&scene, Output::Color, s)).to_vec();
    let frame = town::render(&mut renderer, &scene, view(nadir(0.0, 0.0, 0.25, 240, 240), sun(50.0, 135.0), outputs));
    let differs = |i: usize| rgb(&frame, 0)[i * 3..][..3] != rgb(&frame, 1)[i * 3..][..3];
    // The house and its shadow to the north-west lie in the lower right of the image.
    let changed: Vec<usize> = (0..240 * 240).filter(|&i| differs(i)).collect();
    assert!(changed.len() > 1000);
    assert!(changed.iter().all(|i| i % 240 > 120 && i / 240 > 120), "{:?}", changed.first());
}

#[test]
fn a_street_of_houses_to_look_at() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(6);
    let outputs = vec![demand(&scene, Output::Color, State::Before)];
    let demand = view(tilted(nadir(0.0, 0.0, 0.12, 800, 600), 35.0), sun(35.0, 120.0), outputs);
    let frame = town::render(&mut renderer, &scene, demand);
    town::keep(&frame, 0, "street.png");
    let dark = rgb(&frame, 0).chunks_exact(3).filter(|p| p.iter().all(|c| *c < 110)).count();
    assert!((20_000..200_000).contains(&dark), "{dark} dark pixels: shadows are missing or everywhere");
}
