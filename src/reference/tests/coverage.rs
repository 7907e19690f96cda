//! Which pixels an object covers, and how far it is.

use glam::DVec3;

use super::{depth, numbers, render};
use crate::frame::Pixels;
use crate::gpu::tests::town::{self, demand, gray, nadir, sun, tilted, view};
use crate::plan::demand::{Output, Projection, State};
use crate::reference::{Options, ReferenceError, Tracer};
use crate::scene::{Presence, Scene};

/// A box whose top has its edges exactly on pixel borders: 8 to 24 in x, 4 to 12 in y of 32 × 16 pixels.
fn bordered() -> Scene {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (64.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-4.0, 0.0, -2.0), DVec3::new(4.0, 256.0, 2.0));
    scene
}

#[test]
fn a_square_on_pixel_borders_covers_exactly_its_pixels_in_both_projections() {
    let scene = bordered();
    let perspective = nadir(0.0, 0.0, 1.0, 32, 16);
    let parallel = Projection::Orthographic { half_x: 8.0, half_y: 4.0 };
    for projection in [perspective.projection, parallel] {
        let camera = crate::plan::demand::Camera { projection, near: 100.0, ..perspective };
        let outputs = [Output::Class, Output::Depth, Output::Instance].map(|o| demand(&scene, o, State::Before));
        let rendered = render(&scene, &view(camera, sun(45.0, 90.0), outputs.to_vec()), &Options::default());
        for (at, (&metres, &instance)) in depth(&rendered, 1).iter().zip(numbers(&rendered, 2)).enumerate() {
            let inside = (8..24).contains(&(at % 32)) && (4..12).contains(&(at / 32));
            let (number, distance) = if inside { (2, 256.0) } else { (1, 512.0) };
            assert_eq!((gray(&rendered.frame, 0)[at], instance, metres), (number, u32::from(number), distance), "{at}");
        }
    }
}

#[test]
fn depth_is_along_the_viewing_direction_and_starts_at_the_near_plane() {
    let scene = bordered();
    let camera = tilted(nadir(0.0, 0.0, 1.0, 32, 16), 30.0);
    let outputs = vec![demand(&scene, Output::Depth, State::Before)];
    let mut demand = view(camera, sun(45.0, 90.0), outputs);
    demand.outputs[0].selection.objects = [true, false].into();
    let rendered = render(&scene, &demand, &Options::default());
    let Projection::Perspective { tan_y, .. } = camera.projection else { panic!("perspective") };
    for (at, &metres) in depth(&rendered, 0).iter().enumerate() {
        // The ray through this row meets y = 0 where position.y + t (forward.y + s up.y) = 0.
        let up = (1.0 - 2.0 * ((at / 32) as f64 + 0.5) / 16.0) * tan_y;
        let exact = -camera.position.y / (camera.forward.y + up * camera.up.y);
        assert!((f64::from(metres) - exact).abs() < 1e-4, "{metres} is not {exact}");
    }
    demand.camera.near = 1000.0;
    assert!(depth(&render(&scene, &demand, &Options::default()), 0).iter().all(|d| d.is_infinite()));
}

#[test]
fn labels_are_those_of_the_nearest_selected_object() {
    let mut scene = bordered();
    scene.objects[1].level = 3;
    scene.objects[1].presence = Presence::AfterOnly;
    let camera = crate::plan::demand::Camera { near: 100.0, ..nadir(0.0, 0.0, 1.0, 32, 16) };
    let outputs = [Output::Mask, Output::Level].map(|o| [State::Before, State::After].map(|s| demand(&scene, o, s)));
    let rendered = render(&scene, &view(camera, sun(45.0, 90.0), outputs.concat()), &Options::default());
    let middle = 8 * 32 + 16;
    assert_eq!([0, 1, 2, 3].map(|i| gray(&rendered.frame, i)[middle]), [0, 255, 0, 3]);
    assert_eq!([0, 1, 2, 3].map(|i| gray(&rendered.frame, i)[0]), [0, 0, 0, 0]);
}

#[test]
fn holes_of_a_texture_are_not_there_and_v_runs_up() {
    let mut scene = town::empty();
    // The fence's texture is 4 m wide, its first half is solid.
    town::plane(&mut scene, (-16.0, -16.0), (16.0, 16.0), town::FENCE);
    let outputs = vec![demand(&scene, Output::Class, State::Before)];
    let rendered = render(&scene, &view(nadir(0.0, 0.0, 1.0, 16, 8), sun(90.0, 0.0), outputs), &Options::default());
    assert_eq!(gray(&rendered.frame, 0)[..8], [1, 1, 0, 0, 1, 1, 0, 0]);

    let mut scene = town::empty();
    let picture = image::RgbaImage::from_fn(16, 16, |_, y| image::Rgba(if y < 8 { [255; 4] } else { [0, 0, 0, 255] }));
    scene.textures[0].1 = std::sync::Arc::new(picture);
    let plane = town::plane(&mut scene, (-16.0, -16.0), (16.0, 16.0), town::TEXTURED);
    let mesh: &mut crate::scene::TriMesh = &mut scene.objects[plane].mesh;
    for (p, uv) in mesh.positions.iter().zip(&mut mesh.uvs) {
        *uv = glam::Vec2::new(0.5, if p.z < 0.0 { 1.0 } else { 0.0 });
    }
    let outputs = vec![demand(&scene, Output::Color, State::Before)];
    let rendered = render(&scene, &view(nadir(0.0, 0.0, 1.0, 16, 16), sun(60.0, 0.0), outputs), &Options::default());
    let red = |y: usize| town::rgb(&rendered.frame, 0)[(y * 16 + 8) * 3];
    assert!(red(3) > 200 && red(12) == 0, "{} above {}", red(3), red(12));
}

#[test]
fn a_tilted_roof_covers_its_plan() {
    let mut scene = town::empty();
    let p = |x: f64, z: f64| DVec3::new(x, 10.0 + 0.7 * x - 0.3 * z, z);
    let face = vec![p(-3.3, -2.1), p(-4.1, 5.2), p(6.4, 4.4), p(5.0, -3.9)];
    town::add(&mut scene, crate::scene::SceneClass::Building, Presence::Both, &[(face.clone(), town::ROOF)]);
    let mut camera = nadir(0.0, 0.0, 1.0, 800, 800);
    camera.projection = Projection::Orthographic { half_x: 8.0, half_y: 8.0 };
    let outputs = vec![demand(&scene, Output::Instance, State::Before)];
    let rendered = render(&scene, &view(camera, sun(45.0, 90.0), outputs), &Options::default());
    let covered = numbers(&rendered, 0).iter().filter(|n| **n == 1).count() as f64 * 0.02 * 0.02;
    let area: f64 = (0..4).map(|i| (face[i], face[(i + 1) % 4])).map(|(a, b)| (a.x * b.z - b.x * a.z) / 2.0).sum();
    assert!((covered - area.abs()).abs() < 0.02, "{covered} m² instead of {}", area.abs());
}

#[test]
fn a_scene_far_from_the_origin_looks_the_same() {
    let mut scene = town::town(3);
    // Positions on a 2^-16 m grid, so that the shift is exact.
    for object in &mut scene.objects {
        object.mesh.positions.iter_mut().for_each(|p| *p = (*p * 65536.0).round() / 65536.0);
    }
    let outputs = [Output::Color, Output::Instance, Output::Depth].map(|o| demand(&scene, o, State::Before)).to_vec();
    let mut view = view(tilted(nadir(0.0, 0.0, 0.5, 64, 48), 20.0), sun(30.0, 140.0), outputs);
    view.camera.position = (view.camera.position * 65536.0).round() / 65536.0;
    let options = Options { side: 1, passes: 2, ..Options::default() };
    let here = render(&scene, &view, &options);
    for shift in [DVec3::new(524_288.0, 128.0, -4_194_304.0), DVec3::new(6_291_456.0, 0.0, 6_291_456.0)] {
        let mut moved = scene.clone();
        for object in &mut moved.objects {
            object.mesh.positions.iter_mut().for_each(|p| *p += shift);
        }
        let mut view = view.clone();
        view.camera.position += shift;
        assert!(here == render(&moved, &view, &options), "shifted by {shift}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let mut scene = bordered();
    let outputs = vec![demand(&scene, Output::Class, State::Before)];
    let mut demand = view(nadir(0.0, 0.0, 1.0, 4, 4), sun(45.0, 90.0), outputs);
    let tracer = Tracer::new(&scene).expect("finite");
    demand.camera.position.x = f64::INFINITY;
    let refused = tracer.render(&demand, &Options::default());
    assert!(matches!(refused, Err(ReferenceError::NotFiniteView { what: "the camera", .. })), "{refused:?}");
    scene.objects[1].mesh.positions[2].y = f64::NAN;
    let refused = Tracer::new(&scene).err();
    let expected = |e: &ReferenceError| matches!(e, ReferenceError::NotFinite { object: 1, vertex: 2, .. });
    assert!(refused.as_ref().is_some_and(expected), "{refused:?}");
}

#[test]
fn demands_of_another_scene_and_single_passes_are_refused() {
    let scene = bordered();
    let tracer = Tracer::new(&scene).expect("finite");
    let other = town::town(2);
    let demand = view(nadir(0.0, 0.0, 1.0, 4, 4), sun(45.0, 90.0), vec![demand(&other, Output::Mask, State::After)]);
    let refused = tracer.render(&demand, &Options::default());
    assert!(matches!(refused, Err(ReferenceError::WrongScene(_))), "{refused:?}");
    let refused = tracer.render(&demand, &Options { passes: 1, ..Options::default() });
    assert!(matches!(refused, Err(ReferenceError::BadSampling { passes: 1, .. })), "{refused:?}");
}

#[test]
fn a_scene_of_nothing_is_background() {
    let scene = town::empty();
    let outputs = [Output::Color, Output::Instance].map(|o| demand(&scene, o, State::Before)).to_vec();
    let rendered = render(&scene, &view(nadir(0.0, 0.0, 1.0, 2, 2), sun(45.0, 90.0), outputs), &Options::default());
    assert_eq!(town::rgb(&rendered.frame, 0), [99, 102, 94].repeat(4));
    assert_eq!(rendered.frame.images[1].pixels, Pixels::Id32(vec![0; 4]));
}
