//! Which pixels an object covers, and how far it is: known from its corners.

use glam::DVec3;

use super::town::{self, demand, gray, nadir, plan, sun, tilted, view};
use crate::frame::Pixels;
use crate::plan::demand::{Output, Projection, State};
use crate::scene::Presence;

/// A box whose top has its edges exactly on pixel borders: 8 to 24 in x, 4 to 12 in y of 32 × 16 pixels.
fn bordered() -> crate::scene::Scene {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    // At height 256 of 512 a pixel of 1 m on the ground is half a metre.
    let (low, high) = (DVec3::new(-4.0, 0.0, -2.0), DVec3::new(4.0, 256.0, 2.0));
    town::block(&mut scene, Presence::Both, low, high);
    scene
}

#[test]
fn a_square_on_pixel_borders_covers_exactly_its_pixels() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = bordered();
    let mut camera = nadir(0.0, 0.0, 1.0, 32, 16);
    camera.near = 100.0;
    let outputs = [Output::Class, Output::Depth, Output::Instance].map(|o| demand(&scene, o, State::Before));
    let frame = town::render(&mut renderer, &scene, view(camera, sun(45.0, 90.0), outputs.to_vec()));
    let Pixels::Float32(depth) = &frame.images[1].pixels else { panic!("depth is float") };
    let Pixels::Id32(instance) = &frame.images[2].pixels else { panic!("instances are numbers") };
    for y in 0..16 {
        for x in 0..32 {
            let inside = (8..24).contains(&x) && (4..12).contains(&y);
            let (class, metres) = if inside { (2, 256.0) } else { (1, 512.0) };
            let at = y * 32 + x;
            assert_eq!(gray(&frame, 0)[at], class, "class at ({x}, {y})");
            assert_eq!(instance[at], u32::from(class), "instance at ({x}, {y})");
            assert!((depth[at] - metres).abs() < 1e-3, "depth {} at ({x}, {y})", depth[at]);
        }
    }
}

#[test]
fn nothing_is_zero_and_infinitely_far() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (0.0, -64.0), (64.0, 64.0), town::GROUND);
    let outputs = [Output::Class, Output::Depth].map(|o| demand(&scene, o, State::Before)).to_vec();
    let frame = town::render(&mut renderer, &scene, view(nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 90.0), outputs));
    let Pixels::Float32(depth) = &frame.images[1].pixels else { panic!("depth is float") };
    assert_eq!(gray(&frame, 0)[..8], [0, 0, 0, 0, 1, 1, 1, 1]);
    assert!(depth[0].is_infinite() && depth[7] == 512.0, "{depth:?}");
}

#[test]
fn parallel_projection_measures_the_same_depth() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = bordered();
    let mut camera = nadir(0.0, 0.0, 1.0, 32, 16);
    camera.projection = Projection::Orthographic { half_x: 8.0, half_y: 4.0 };
    camera.near = 10.0;
    let outputs = [Output::Class, Output::Depth].map(|o| demand(&scene, o, State::Before)).to_vec();
    let frame = town::render(&mut renderer, &scene, view(camera, sun(45.0, 90.0), outputs));
    let Pixels::Float32(depth) = &frame.images[1].pixels else { panic!("depth is float") };
    let classes: Vec<u8> = gray(&frame, 0)[8 * 32..9 * 32].to_vec();
    assert_eq!(classes, [vec![1; 8], vec![2; 16], vec![1; 8]].concat());
    assert!((depth[0] - 512.0).abs() < 1e-3 && (depth[8 * 32 + 16] - 256.0).abs() < 1e-3);
}

#[test]
fn a_cut_out_texture_has_holes_in_the_labels() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    // The fence's texture is 4 m wide, its first half is solid.
    town::plane(&mut scene, (-16.0, -16.0), (16.0, 16.0), town::FENCE);
    let outputs = vec![demand(&scene, Output::Class, State::Before), demand(&scene, Output::Color, State::Before)];
    let frame = town::render(&mut renderer, &scene, view(nadir(0.0, 0.0, 1.0, 16, 8), sun(90.0, 0.0), outputs));
    assert_eq!(gray(&frame, 0)[..8], [1, 1, 0, 0, 1, 1, 0, 0]);
}

#[test]
fn v_runs_up_in_textures() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    // Upper half of the image white, lower half black.
    let picture = image::RgbaImage::from_fn(16, 16, |_, y| image::Rgba(if y < 8 { [255; 4] } else { [0, 0, 0, 255] }));
    scene.textures[0].1 = std::sync::Arc::new(picture);
    let plane = town::plane(&mut scene, (-16.0, -16.0), (16.0, 16.0), town::TEXTURED);
    // North is up in the image and has the greater v.
    for (p, uv) in scene.objects[plane].mesh.positions.clone().iter().zip(&mut scene.objects[plane].mesh.uvs) {
        *uv = glam::Vec2::new(0.5, if p.z < 0.0 { 1.0 } else { 0.0 });
    }
    let outputs = vec![demand(&scene, Output::Color, State::Before)];
    let frame = town::render(&mut renderer, &scene, view(nadir(0.0, 0.0, 1.0, 16, 16), sun(60.0, 0.0), outputs));
    let red = |y: usize| town::rgb(&frame, 0)[(y * 16 + 8) * 3];
    assert!(red(3) > 200 && red(12) == 0, "{} above {}", red(3), red(12));
}

#[test]
fn images_wider_than_any_viewport_have_every_pixel_in_its_place() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::empty();
    // Strips of 100 pixels, alternately there and not.
    for i in (0..220).step_by(2) {
        town::plane(&mut scene, (f64::from(i) * 10.0, -4.0), (f64::from(i + 1) * 10.0, 4.0), town::GROUND);
    }
    let width = 22_000;
    let mut camera = nadir(1100.0, 0.0, 0.1, width, 2);
    camera.projection = Projection::Orthographic { half_x: 1100.0, half_y: 0.1 };
    let outputs = vec![demand(&scene, Output::Instance, State::Before)];
    let frame = town::render(&mut renderer, &scene, view(camera, sun(60.0, 0.0), outputs));
    let Pixels::Id32(ids) = &frame.images[0].pixels else { panic!("instances are numbers") };
    for (i, &id) in ids.iter().enumerate() {
        let strip = (i as u32 % width) / 100;
        let expected = if strip.is_multiple_of(2) { strip / 2 + 1 } else { 0 };
        assert_eq!(id, expected, "pixel {}", i as u32 % width);
    }
}

#[test]
fn a_scene_far_from_the_origin_looks_the_same() {
    let Some(mut renderer) = super::renderer() else { return };
    let mut scene = town::town(6);
    // Positions on a 2^-16 m grid, so that the shift of UTM size is exact.
    for object in &mut scene.objects {
        object.mesh.positions.iter_mut().for_each(|p| *p = (*p * 65536.0).round() / 65536.0);
    }
    let outputs = [Output::Color, Output::Instance, Output::Depth].map(|o| demand(&scene, o, State::Before)).to_vec();
    let mut view = view(tilted(nadir(0.0, 0.0, 0.5, 192, 160), 20.0), sun(30.0, 140.0), outputs);
    view.camera.position = (view.camera.position * 65536.0).round() / 65536.0;
    let here = town::render(&mut renderer, &scene, view.clone());
    let shift = DVec3::new(524_288.0, 128.0, -4_194_304.0);
    for object in &mut scene.objects {
        object.mesh.positions.iter_mut().for_each(|p| *p += shift);
    }
    view.camera.position += shift;
    assert_eq!(here, town::render(&mut renderer, &scene, view));
}

#[test]
fn a_plan_for_another_scene_is_refused() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(2);
    let outputs = vec![demand(&scene, Output::Mask, State::After)];
    let plan = plan(&scene, view(nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 90.0), outputs));
    renderer.upload(&town::town(3)).expect("it uploads");
    assert!(matches!(renderer.render(&plan.views[0]), Err(crate::gpu::GpuError::WrongScene(_))));
}
