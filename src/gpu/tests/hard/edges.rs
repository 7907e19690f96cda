//! Edges: no background through T-junctions, edges where they belong in masks and images, triangles far below a pixel.

use glam::{DVec2, DVec3};

use super::{centres, ids, labels, on_level, shares, sunlit, trace};
use crate::gpu::Renderer;
use crate::gpu::tests::town::{self, demand, gray, nadir, sun, view};
use crate::plan::demand::{Camera, Output, Projection, Shadows, State};
use crate::plan::{schedule, summarize, view::frame};
use crate::scene::{Group, Presence, Scene, SceneClass, TriMesh};

/// Two walls of 20 m that meet in an edge; the second has corners on it that the first has not.
fn walls() -> Scene {
    let mut scene = town::empty();
    let (foot, top) = (DVec3::new(0.1, -9.7, 0.3), DVec3::new(0.7, 10.3, -0.2));
    let along = |t: f64| foot + (top - foot) * t;
    let (left, right) = (DVec3::new(-14.3, 0.4, 6.1), DVec3::new(13.1, -0.3, 7.7));
    let mut faces = vec![(vec![foot + left, foot, top, top + left], town::WALL)];
    for (a, b) in [(0.0, 0.137), (0.137, 1.0 / 3.0), (1.0 / 3.0, 0.5), (0.5, 0.777), (0.777, 1.0)] {
        faces.push((vec![along(a), along(a) + right, along(b) + right, along(b)], town::ROOF));
    }
    town::add(&mut scene, SceneClass::Building, Presence::Both, &faces);
    scene
}

/// A camera 60 m away that looks at the origin.
fn around(azimuth: f64) -> Camera {
    let (right, up, forward) = frame(70.0 + 15.0 * libm::sin(azimuth), azimuth, azimuth + 171.0);
    let projection = Projection::Perspective { tan_x: 0.4, tan_y: 0.4 };
    Camera { position: -forward * 60.0, right, up, forward, projection, width: 128, height: 128, near: 20.0 }
}

/// Background pixels inside the silhouette, over 360 views.
fn pin_holes(renderer: &mut Renderer, scene: &Scene) -> (usize, usize) {
    let views: Vec<_> = (0..360).map(|i| labels(scene, around(f64::from(i)), Output::Instance)).collect();
    let plan = schedule(&views, &summarize(scene));
    renderer.upload(scene).expect("it uploads");
    let (mut inside, mut holes) = (0, 0);
    for (view, planned) in views.iter().zip(&plan.views) {
        let drawn = renderer.render(planned).expect("it renders");
        let traced = trace(scene, view, 1);
        let (drawn, truth) = (ids(&drawn, 0), ids(&traced.frame, 0));
        let inner = (1..127).flat_map(|y| (1..127).map(move |x| y * 128 + x));
        for i in inner {
            let around = [i - 129, i - 128, i - 127, i - 1, i, i + 1, i + 127, i + 128, i + 129];
            if around.iter().all(|&j| truth[j] != 0) {
                (inside, holes) = (inside + 1, holes + usize::from(drawn[i] == 0));
            }
        }
    }
    (inside, holes)
}

#[test]
fn t_junction() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let (inside, holes) = pin_holes(&mut renderer, &walls());
    println!("{holes} of {inside} pixels inside the silhouette show the background");
    assert!(inside > 200_000, "{inside}");
    assert_eq!(holes, 0);
}

/// A square of 30 m whose western edge crosses the image at `x` in its middle, leaning by `lean` metres per metre.
fn leaning(x: f64, lean: f64) -> Scene {
    let mut scene = town::empty();
    let corner = |x: f64, z: f64| DVec3::new(x + lean * z, 0.0, z);
    let face = vec![corner(x, -30.0), corner(x, 30.0), corner(x + 60.0, 30.0), corner(x + 60.0, -30.0)];
    town::add(&mut scene, SceneClass::Building, Presence::AfterOnly, &[(face, town::GROUND)]);
    scene
}

#[test]
fn pixel_centre() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    // Half a metre per pixel; the edge leans by one pixel over the 64 rows, so rows together tell 1/64 pixel.
    for x in [0.0, 0.13, 0.25, -0.41] {
        let scene = leaning(x, 1.0 / 64.0);
        let camera = nadir(0.0, 0.0, 0.5, 64, 64);
        let mut demand = view(
            camera,
            sun(90.0, 0.0),
            [Output::Mask, Output::Color]
                .map(|o| {
                    let mut output = demand(&scene, o, State::After);
                    output.look.shadows = Shadows::Off;
                    output.look.ambient = crate::plan::demand::Ambient::Off;
                    output
                })
                .to_vec(),
        );
        demand.sun.as_mut().expect("set").irradiance = [0.9; 3];
        demand.quality.supersample = 8;
        let drawn = town::render(&mut renderer, &scene, demand);
        let covered = gray(&drawn, 0).iter().filter(|m| **m == 255).count() as f64 / 64.0;
        let shares = shares(&drawn, 1);
        // The first pixel of a row shows the background, the last the square.
        let (background, full) = (shares[0], shares[63]);
        let lit: f64 = shares.iter().map(|s| (s - background) / (full - background)).sum::<f64>() / 64.0;
        let (in_mask, in_image) = (64.0 - covered, 64.0 - lit);
        let expected = 32.0 + x / 0.5;
        println!("edge at {expected}: {in_mask:.3} in the mask, {in_image:.3} in the image");
        assert!((in_mask - expected).abs() <= 0.02 && (in_image - expected).abs() <= 0.02);
    }
}

#[test]
fn mask_vs_image() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = leaning(0.2, libm::tan(f64::to_radians(7.0)));
    let camera = nadir(0.0, 0.0, 0.5, 64, 64);
    // Sixteen rays to a side of a pixel are the centres of an image sixteen times as large.
    let fine = Camera { width: 1024, height: 1024, ..camera };
    let traced = trace(&scene, &labels_after(&scene, fine), 1);
    let share = |x: usize, y: usize| {
        let cells = (0..16).flat_map(|j| (0..16).map(move |i| (y * 16 + j) * 1024 + x * 16 + i));
        cells.filter(|&i| ids(&traced.frame, 0)[i] != 0).count() as f64 / 256.0
    };
    for supersample in [2, 4] {
        let mut view = labels_after(&scene, camera);
        view.quality.supersample = supersample;
        let drawn = town::render(&mut renderer, &scene, view);
        let (mut decided, mut partly) = (0, 0);
        for i in 0..64 * 64 {
            let share = share(i % 64, i / 64);
            if !(0.4..=0.6).contains(&share) {
                assert_eq!(ids(&drawn, 0)[i] != 0, share > 0.5, "({}, {}) is covered by {share}", i % 64, i / 64);
                (decided, partly) = (decided + 1, partly + usize::from(share > 0.0 && share < 1.0));
            }
        }
        assert!(decided > 4000 && partly > 40, "{decided}, {partly}");
    }
}

fn labels_after(scene: &Scene, camera: Camera) -> crate::plan::demand::ViewDemand {
    view(camera, sun(45.0, 0.0), vec![demand(scene, Output::Instance, State::After)])
}

/// A level square of 20 m, in `cells` × `cells` cells of two triangles.
fn tessellated(cells: u32) -> Scene {
    let mut mesh = TriMesh::default();
    let side = cells + 1;
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        let at = |k: u32| 20.0 * f64::from(k) / f64::from(cells) - 10.03;
        mesh.positions.push(DVec3::new(at(i), 0.0, at(j)));
        mesh.normals.push(glam::Vec3::Y);
        mesh.uvs.push(glam::Vec2::ZERO);
        if i < cells && j < cells {
            let (a, b) = (j * side + i, (j + 1) * side + i);
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let count = mesh.triangles.len() as u32;
    mesh.groups.push(Group { material: town::GROUND, first: 0, count });
    let mut scene = town::empty();
    town::add(&mut scene, SceneClass::Building, Presence::Both, &[]);
    scene.objects[0].mesh = mesh.into();
    scene
}

#[test]
fn triangles_smaller_than_a_pixel_cover_what_one_large_one_covers() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let camera = nadir(0.0, 0.0, 0.5, 64, 64);
    let mut drawn = |cells: u32, output: Output| {
        let scene = tessellated(cells);
        let view = match output {
            Output::Color => sunlit(&scene, camera, super::even_sun(60.0, 20.0), Shadows::Hard),
            _ => labels(&scene, camera, output),
        };
        town::render(&mut renderer, &scene, view)
    };
    let (one, one_color) = (drawn(1, Output::Instance), drawn(1, Output::Color));
    // 40 px across: triangles of 1/3 and of 1/12 pixel.
    for cells in [120, 480] {
        assert_eq!(ids(&drawn(cells, Output::Instance), 0), ids(&one, 0), "{cells} cells");
        let color = drawn(cells, Output::Color);
        let worst = town::rgb(&color, 0).iter().zip(town::rgb(&one_color, 0)).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(1), "{cells} cells: {worst:?}");
    }
    let inside = |at: DVec2| on_level(&camera, at, 0.0).abs().max_element() < 9.9;
    let covered = centres(&camera).zip(ids(&one, 0)).filter(|(at, id)| inside(*at) && **id == 1).count();
    assert_eq!(covered, centres(&camera).filter(|at| inside(*at)).count());
}
