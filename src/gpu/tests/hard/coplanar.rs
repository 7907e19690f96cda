//! Layers at one height: roads on hills, floors and roads in one plane. The ground mesh has one triangle at each place;
//! where faces of objects coincide the upper class is drawn.

use glam::{DAffine2, DMat2, DVec2, DVec3};

use super::{centres, on_level};
use crate::frame::Pixels;
use crate::geodata::elevation::Raster;
use crate::geodata::projection::LocalFrame;
use crate::geodata::terrain::{Terrain, Voids};
use crate::geometry::Polygon;
use crate::gpu::tests::town::{self, demand, gray, nadir, sun, tilted, view};
use crate::plan::demand::{Camera, Output, State, ViewDemand};
use crate::reference::{Options, Tracer};
use crate::scene::ground::{GroundLayer, GroundMesh, Surface, build_ground};
use crate::scene::{Group, Presence, Scene, SceneClass, TriMesh};

/// Posts every 10 m, 300 m to each side.
fn terrain(height: impl Fn(DVec2) -> f64) -> Terrain {
    let frame = LocalFrame::new(10.0, 50.0).expect("on the earth");
    let crs = "+proj=tmerc +lat_0=50 +lon_0=10 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +no_defs";
    let (count, step, half) = (61usize, 10.0, DVec2::splat(300.0));
    let to_plan = DMat2::from_diagonal(DVec2::new(step, -step));
    let transform = DAffine2::from_mat2_translation(to_plan, DVec2::new(-305.0, 305.0));
    let post = |k: usize| DVec2::new((k % count) as f64 * step - 300.0, 300.0 - (k / count) as f64 * step);
    let heights = (0..count * count).map(|k| height(post(k)) as f32).collect();
    let raster = Raster::of_cells(crs, transform, count, heights);
    Terrain::from_rasters(frame, -half, half, vec![raster], Voids::Fill).expect("heights everywhere")
}

fn polygon(corners: &[(f64, f64)]) -> Polygon {
    Polygon { outer: corners.iter().map(|&c| c.into()).collect(), holes: Vec::new() }
}

fn layer(polygon: Polygon, priority: i32, payload: u32) -> GroundLayer {
    GroundLayer { polygons: vec![polygon], priority, payload, surface: Surface::Drape }
}

fn area() -> Polygon {
    polygon(&[(-250.0, -250.0), (250.0, -250.0), (250.0, 250.0), (-250.0, 250.0)])
}

/// Adds the triangles of some payloads as one object, lifted.
fn object(scene: &mut Scene, class: SceneClass, ground: &GroundMesh, of: &dyn Fn(Option<u32>) -> bool, lift: f64) {
    let triangles: Vec<[u32; 3]> = ground.triangles.iter().filter(|(_, p)| of(*p)).map(|(t, _)| *t).collect();
    let count = triangles.len() as u32;
    let mesh = TriMesh {
        positions: ground.positions.iter().map(|p| *p + DVec3::Y * lift).collect(),
        normals: ground.normals(),
        uvs: vec![glam::Vec2::ZERO; ground.positions.len()],
        uv_sets: Vec::new(),
        triangles,
        groups: vec![Group { material: town::GROUND, first: 0, count }],
    };
    let number = town::add(scene, class, Presence::Both, &[]);
    scene.objects[number].mesh = mesh.into();
}

fn classes(scene: &Scene, camera: Camera) -> ViewDemand {
    view(camera, sun(45.0, 90.0), vec![demand(scene, Output::Class, State::Before)])
}

#[test]
fn coplanar_road() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let terrain = terrain(|p| 12.0 * libm::sin(p.x * 0.03) * libm::cos(p.y * 0.025));
    let road = polygon(&[(-240.0, -31.0), (235.0, 22.0), (236.0, 34.0), (-241.0, -18.0)]);
    let whole = build_ground(&area(), &terrain, 0.1, &[]).expect("a ground");
    let divided = build_ground(&area(), &terrain, 0.1, &[layer(road, 1, 7)]).expect("a ground");
    for lift in [0.0, 0.02, 0.05] {
        let mut scene = town::empty();
        if lift == 0.0 {
            object(&mut scene, SceneClass::Terrain, &divided, &|p| p.is_none(), 0.0);
            object(&mut scene, SceneClass::Highway, &divided, &|p| p == Some(7), 0.0);
        } else {
            // The ground goes on below, with the same corners as the road where that is.
            object(&mut scene, SceneClass::Terrain, &divided, &|_| true, 0.0);
            object(&mut scene, SceneClass::Highway, &divided, &|p| p == Some(7), lift);
        }
        assert!(whole.triangles.len() > 1000);
        let tracer = Tracer::new(&scene).expect("finite");
        for (distance, tilt) in [(200.0, 0.0), (1000.0, 20.0), (3000.0, 20.0)] {
            let mut camera = nadir(0.0, 0.0, 0.6, 200, 200);
            let scale = distance / 512.0;
            camera.position.y = distance;
            let tan = 0.6 * 100.0 / distance;
            camera.projection = crate::plan::demand::Projection::Perspective { tan_x: tan, tan_y: tan };
            camera = Camera { near: 60.0 * scale, ..tilted(camera, tilt) };
            let traced = tracer.render(&classes(&scene, camera), &Options { side: 1, passes: 2, ..Options::default() });
            let Pixels::Gray8(truth) = traced.expect("it renders").frame.images.swap_remove(0).pixels else {
                panic!("labels")
            };
            let around = |i: usize| [i - 201, i - 200, i - 199, i - 1, i, i + 1, i + 199, i + 200, i + 201];
            for step in 0..6 {
                camera.position += DVec3::new(1e-3, 0.0, 0.4e-3) * f64::from(step.min(1));
                let drawn = town::render(&mut renderer, &scene, classes(&scene, camera));
                let inner = (1..199).flat_map(|y| (1..199).map(move |x| y * 200 + x));
                let decided = inner.filter(|&i| around(i).iter().all(|&j| truth[j] == truth[i]));
                let wrong = decided.filter(|&i| gray(&drawn, 0)[i] != truth[i]).count();
                assert_eq!(wrong, 0, "lift {lift}, from {distance} m, step {step}");
            }
            assert!(truth.iter().filter(|c| **c == SceneClass::Highway as u8).count() > 2000);
        }
    }
}

#[test]
fn coplanar_footprint() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let terrain = terrain(|_| 3.0);
    let parts = [
        (polygon(&[(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]), 3, SceneClass::Building),
        (polygon(&[(-60.0, 11.0), (60.0, 13.0), (60.0, 31.0), (-60.0, 29.0)]), 2, SceneClass::Highway),
        (polygon(&[(-45.0, -45.0), (45.0, -45.0), (45.0, 45.0), (-45.0, 45.0)]), 1, SceneClass::Landuse),
    ];
    let camera = tilted(nadir(0.0, 0.0, 0.5, 200, 200), 30.0);
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let layers: Vec<_> = order.iter().map(|&i| layer(parts[i].0.clone(), parts[i].1, i as u32)).collect();
        let ground = build_ground(&area(), &terrain, 0.1, &layers).expect("a ground");
        let mut scene = town::empty();
        object(&mut scene, SceneClass::Terrain, &ground, &|p| p.is_none(), 0.0);
        for &i in &order {
            object(&mut scene, parts[i].2, &ground, &|p| p == Some(i as u32), 0.0);
        }
        let drawn = town::render(&mut renderer, &scene, classes(&scene, camera));
        let mut decided = 0;
        for (at, &class) in centres(&camera).zip(gray(&drawn, 0)) {
            let p = on_level(&camera, at, 3.0);
            let near =
                [(0.02, 0.0), (-0.02, 0.0), (0.0, 0.02), (0.0, -0.02)].map(|d| DVec2::new(p.x, -p.z) + DVec2::from(d));
            let owner = |p: DVec2| parts.iter().find(|(polygon, ..)| polygon.contains(p)).map_or(1, |(.., c)| *c as u8);
            let owners = near.map(owner);
            if owners.iter().all(|o| *o == owners[0]) {
                assert_eq!(class, owners[0], "{p}, listed as {order:?}");
                decided += 1;
            }
        }
        assert!(decided > 38_000, "{decided}");
    }
}

#[test]
fn of_equal_faces_the_upper_class_is_seen_whatever_the_order() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let upper_first = [
        SceneClass::Building,
        SceneClass::Highway,
        SceneClass::Water,
        SceneClass::Leisure,
        SceneClass::Natural,
        SceneClass::Landuse,
        SceneClass::Terrain,
    ];
    let corners = [(-40.0, -40.0), (-40.0, 40.0), (40.0, 40.0), (40.0, -40.0)].map(|(x, z)| DVec3::new(x, 0.1 * x, z));
    for (above, below) in upper_first.iter().zip(&upper_first[1..]) {
        for pair in [[*above, *below], [*below, *above]] {
            let mut scene = town::empty();
            for class in pair {
                town::add(&mut scene, class, Presence::Both, &[(corners.to_vec(), town::GROUND)]);
            }
            for camera in [nadir(0.0, 0.0, 0.5, 64, 64), tilted(nadir(0.0, 0.0, 0.5, 64, 64), 60.0)] {
                let drawn = town::render(&mut renderer, &scene, classes(&scene, camera));
                assert!(gray(&drawn, 0).iter().all(|c| *c == *above as u8), "{above:?} over {below:?}");
                let tracer = Tracer::new(&scene).expect("finite");
                let options = Options { side: 1, passes: 2, ..Options::default() };
                let traced = tracer.render(&classes(&scene, camera), &options).expect("it renders");
                assert_eq!(gray(&traced.frame, 0), gray(&drawn, 0));
            }
        }
    }
}
