//! Outlines of shadows against polygons: length at every height of the sun, contact with the wall, casters outside the
//! image, the zenith.

use glam::DVec3;

use super::{above, even_sun, light, on_level, shares, sunlit, texel_on_ground};
use crate::gpu::Renderer;
use crate::gpu::tests::town::{self, nadir, tilted};
use crate::plan::demand::{Camera, Shadows, Sun};
use crate::scene::{Presence, Scene};

/// A box on the ground: least and greatest corner.
type Block = (DVec3, DVec3);

/// Whether the way from a point of the ground to the sun meets the box, grown by `grow` metres on its sides.
fn is_shadowed(block: Block, sun: &Sun, p: DVec3, grow: f64) -> bool {
    let (low, high) = (block.0 - DVec3::splat(grow), block.1 + DVec3::splat(grow));
    let top = block.1.y / sun.direction.y;
    let (mut first, mut last) = (0.0f64, top);
    for (p, d, low, high) in [(p.x, sun.direction.x, low.x, high.x), (p.z, sun.direction.z, low.z, high.z)] {
        if d.abs() < 1e-12 {
            if p < low || p > high {
                return false;
            }
        } else {
            let (a, b) = ((low - p) / d, (high - p) / d);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
    }
    first <= last
}

fn scene_of(block: Block, reach: f64) -> Scene {
    let mut scene = town::empty();
    town::plane(&mut scene, (-reach, -reach - 1.0), (reach + 2.0, reach), town::GROUND);
    town::block(&mut scene, Presence::Both, block.0, block.1);
    scene
}

/// Every pixel of the ground whose centre is farther than a texel from the outline is lit or dark as the box says.
/// Gives the number of pixels that were decided, dark and lit.
#[track_caller]
fn check(renderer: &mut Renderer, block: Block, reach: f64, camera: Camera, sun: Sun) -> (usize, usize) {
    let scene = scene_of(block, reach);
    let mut view = sunlit(&scene, camera, sun, Shadows::Hard);
    (view.quality.supersample, view.quality.shadow_map) = (1, 2048);
    let texel = texel_on_ground(&light(&scene, &view));
    let frame = town::render(renderer, &scene, view);
    let (mut dark, mut lit) = (0, 0);
    for (at, share) in super::centres(&camera).zip(shares(&frame, 0)) {
        let p = on_level(&camera, at, 0.0);
        let inside = |grow: f64| {
            p.cmpge(block.0 - DVec3::splat(grow)).all() && (p - DVec3::Y).cmple(block.1 + DVec3::splat(grow)).all()
        };
        if inside(0.01) {
            continue;
        }
        let (surely, maybe) = (is_shadowed(block, &sun, p, -texel), is_shadowed(block, &sun, p, texel));
        assert!(!surely || share < 0.5, "{p} is in the shadow and has {share} (texel {texel} m)");
        assert!(maybe || share > 0.5, "{p} is lit and has {share} (texel {texel} m)");
        (dark, lit) = (dark + usize::from(surely), lit + usize::from(!maybe));
    }
    (dark, lit)
}

const CUBE: Block = (DVec3::new(-5.0, 0.0, -5.0), DVec3::new(5.0, 10.0, 5.0));

fn length(elevation: f64) {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for azimuth in [0.0, 37.0, 90.0] {
        let sun = even_sun(elevation, azimuth);
        let tip = -sun.direction * (10.0 / sun.direction.y);
        let side = 24.0 + tip.x.abs().max(tip.z.abs());
        let camera = above((tip.x / 2.0 + 0.3, tip.z / 2.0 - 0.2), side / 400.0, (400, 400));
        let (dark, lit) = check(&mut renderer, CUBE, side, camera, sun);
        println!("{elevation}°, {azimuth}°: {dark} dark and {lit} lit pixels");
        assert!(lit > 40_000 && (dark > 300 || elevation > 80.0), "{dark}, {lit}");
    }
}

#[test]
fn shadow_length_0_5() {
    length(0.5);
}

#[test]
fn shadow_length_1() {
    length(1.0);
}

#[test]
fn shadow_length_2() {
    length(2.0);
}

#[test]
fn shadow_length_5() {
    length(5.0);
}

#[test]
fn shadow_length_20() {
    length(20.0);
}

#[test]
fn shadow_length_45() {
    length(45.0);
}

#[test]
fn shadow_length_89_99() {
    length(89.99);
}

#[test]
fn shadow_offscreen_caster() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // The image ends 300 m west of the tower, whose shadow is 549 m long.
    let tower = (DVec3::new(300.0, 0.0, -15.0), DVec3::new(330.0, 200.0, 15.0));
    let camera = above((-140.0, 3.0), 1.0, (280, 160));
    let (dark, lit) = check(&mut renderer, tower, 400.0, camera, even_sun(20.0, 90.0));
    assert!(dark > 6000 && lit > 20_000, "{dark}, {lit}");
}

/// Metres between the foot of a wall and its shadow, and the texel on the ground.
fn gap(renderer: &mut Renderer, elevation: f64) -> (f64, f64) {
    let scene = scene_of(CUBE, 60.0);
    let camera = above((15.0, 0.0), 0.01, (4000, 4));
    let mut view = sunlit(&scene, camera, even_sun(elevation, 270.0), Shadows::Hard);
    (view.quality.supersample, view.quality.shadow_map) = (1, 177);
    let texel = texel_on_ground(&light(&scene, &view));
    let frame = town::render(renderer, &scene, view);
    let east_of_wall = shares(&frame, 0)[4000..8000].iter().skip(1000).take_while(|share| **share > 0.5).count();
    (east_of_wall as f64 * 0.01, texel)
}

#[test]
fn shadow_contact() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for elevation in [5.0, 20.0, 45.0, 80.0] {
        let (gap, texel) = gap(&mut renderer, elevation);
        println!("{elevation}°: the shadow begins {gap:.2} m from the wall, a texel is {texel:.2} m");
        assert!(gap <= texel, "{elevation}°: {gap} m, a texel is {texel} m");
    }
}

#[test]
fn shadow_zenith() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = scene_of(CUBE, 40.0);
    let sun = Sun { direction: DVec3::Y, ..even_sun(90.0, 0.0) };
    for camera in [above((0.0, 0.0), 0.25, (160, 160)), tilted(nadir(0.0, 0.0, 0.25, 160, 160), 40.0)] {
        let view = sunlit(&scene, camera, sun, Shadows::Hard);
        let light = light(&scene, &view);
        assert!(light.u.is_finite() && light.v.is_finite() && light.texel.is_finite());
        // Walls have no sun and the ground under the box is hidden: shadows change nothing that is seen.
        let shadowed = town::render(&mut renderer, &scene, view);
        let open = town::render(&mut renderer, &scene, sunlit(&scene, camera, sun, Shadows::Off));
        let differ = town::rgb(&shadowed, 0).iter().zip(town::rgb(&open, 0)).filter(|(a, b)| a.abs_diff(**b) > 1);
        assert_eq!(differ.count(), 0);
    }
}

#[test]
fn shadow_zenith_near() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = scene_of(CUBE, 40.0);
    let camera = above((0.0, 0.0), 0.1, (240, 240));
    for azimuth in [0.0, 37.0, 135.0, 260.0] {
        for elevation in [89.9, 89.9999, 90.0] {
            let view = sunlit(&scene, camera, even_sun(elevation, azimuth), Shadows::Hard);
            let reach = texel_on_ground(&light(&scene, &view)) + 10.0 / libm::tan(f64::to_radians(elevation));
            let frame = town::render(&mut renderer, &scene, view);
            for (at, share) in super::centres(&camera).zip(shares(&frame, 0)) {
                let p = on_level(&camera, at, 0.0);
                let outside = p.x.abs().max(p.z.abs()) - 5.0;
                assert!(outside < reach + 0.1 || share > 0.5, "{elevation}°, {azimuth}°: {share} at {p}");
            }
        }
    }
}
