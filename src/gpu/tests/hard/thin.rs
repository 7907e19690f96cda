//! Thin things: poles narrower than a pixel, casters narrower than a texel, walls of one sheet.

use glam::DVec3;

use super::{above, even_sun, light, shares, sunlit, texel_on_ground};
use crate::gpu::tests::town;
use crate::plan::demand::{Shadows, State};
use crate::scene::{Presence, SceneClass};

#[test]
fn thin_features() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let gsd = 0.3;
    for width in [0.05, 0.1, 0.2, 0.3, 0.5] {
        // Lying poles over the whole height of the image, each with its own place within a pixel.
        let (count, spacing) = (61, 4.0 * gsd + gsd / 61.0);
        let mut scene = town::empty();
        for i in 0..count {
            let x = (f64::from(i) - 30.0) * spacing + 0.07;
            let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
            let face = vec![corner(x, -9.0), corner(x, 9.0), corner(x + width, 9.0), corner(x + width, -9.0)];
            town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
        }
        for supersample in [2, 4] {
            let camera = above((0.0, 0.0), gsd, (256, 8));
            let mut view = sunlit(&scene, camera, even_sun(90.0, 0.0), Shadows::Off);
            view.quality.supersample = supersample;
            let drawn = town::render(&mut renderer, &scene, view);
            // The first pixel shows the background.
            let drawn = shares(&drawn, 0);
            let background = drawn[0];
            let covered: f64 = drawn.iter().map(|s| (s - background) / (1.0 - background)).sum();
            let covered = covered / 8.0 * gsd / f64::from(count);
            println!("{width} m, {supersample} × {supersample} samples: {covered:.4} m");
            assert!((covered / width - 1.0).abs() <= 0.05, "{width} m, {supersample}: {covered} m");
        }
    }
}

/// Square metres of shadow that 40 poles of 0.1 m throw on the ground, and the longest side of a texel there.
fn shadow_of_poles(renderer: &mut crate::gpu::Renderer, map: u32, shadows: Shadows) -> (f64, f64) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-20.0, -60.0), (40.0, 61.0), town::GROUND);
    for i in 0..40 {
        let z = (f64::from(i) - 20.0) * 2.37 + 0.031;
        town::block(&mut scene, Presence::Both, DVec3::new(-0.1, 0.0, z), DVec3::new(0.0, 10.0, z + 0.1));
    }
    // From the poles' feet to beyond the ends of their shadows, 10 m long.
    let camera = above((6.0, 0.0), 0.1, (120, 960));
    let mut view = sunlit(&scene, camera, even_sun(45.0, 270.0), shadows);
    view.quality.shadow_map = map;
    let texel = texel_on_ground(&light(&scene, &view));
    let drawn = town::render(renderer, &scene, view);
    let drawn = shares(&drawn, 0);
    let full = drawn.iter().copied().fold(0.0, f64::max);
    (drawn.iter().map(|share| 1.0 - share / full).sum::<f64>() * 0.01, texel)
}

#[test]
fn shadow_thin_caster() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let expected = 40.0 * 0.1 * 10.0;
    for shadows in [Shadows::Hard, Shadows::Soft] {
        let mut errors = Vec::new();
        for map in [400, 800, 1600, 3200] {
            let (dark, texel) = shadow_of_poles(&mut renderer, map, shadows);
            let error = (dark / expected - 1.0).abs();
            println!("{shadows:?}, {map} texels of {texel:.3} m: {dark:.2} m² dark, {error:.3} off");
            assert!(error <= 0.2, "{shadows:?}, {map}: {dark} m², not {expected} m²");
            errors.push(error);
        }
        assert!(errors[3] <= errors[0], "{shadows:?}: more texels are worse, {errors:?}");
    }
}

#[test]
fn a_wall_of_one_sheet_keeps_the_sun_out_and_its_sides_apart() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for thickness in [0.0, 0.001, 0.01, 0.1] {
        let mut scene = town::empty();
        town::plane(&mut scene, (-30.0, -31.0), (32.0, 33.0), town::GROUND);
        let sheet = |x: f64, material: u32| {
            let corners = [(0.0, -25.0), (0.0, 25.0), (5.0, 25.0), (5.0, -25.0)];
            (corners.map(|(y, z)| DVec3::new(x, y, z)).to_vec(), material)
        };
        let faces = if thickness > 0.0 {
            vec![sheet(0.0, town::WALL), sheet(thickness, town::ROOF)]
        } else {
            vec![sheet(0.0, town::WALL)]
        };
        town::add(&mut scene, SceneClass::Building, Presence::Both, &faces);
        // The sun in the west at 45°: the shadow reaches from the first sheet to 5 m behind the second.
        let camera = above((4.0, 0.0), 0.05, (160, 40));
        let mut view = sunlit(&scene, camera, even_sun(45.0, 270.0), Shadows::Hard);
        view.quality.shadow_map = 512;
        let texel = texel_on_ground(&light(&scene, &view));
        assert!(view.outputs.iter().all(|o| o.selection.state == State::Before));
        let drawn = shares(&town::render(&mut renderer, &scene, view), 0);
        let row = &drawn[20 * 160..21 * 160];
        let dark = row.iter().map(|share| 1.0 - share).sum::<f64>() * 0.05;
        // All that lies farther than a texel from the foot and from the end is wholly dark.
        let inner = |i: &usize| (texel + thickness..5.0 - texel).contains(&((*i as f64 + 0.5) * 0.05));
        let leaks = (0..160).filter(inner).filter(|&i| row[i] > 0.01).count();
        println!("{thickness} m: {dark:.2} m of shadow, {leaks} leaks, a texel is {texel:.2} m");
        assert_eq!(leaks, 0, "{thickness} m");
        assert!((dark - 5.0 - thickness).abs() <= texel + 0.05, "{thickness} m: {dark} m");
    }
}
