//! Numbers that are not finite, in every place that a renderer reads: an error that says where, never a picture.

use glam::{DVec3, Vec2, Vec3};

use crate::gpu::tests::town::{self, demand, nadir, sun, view};
use crate::gpu::{GpuError, Renderer};
use crate::plan::demand::{Ambient, Output, Projection, State, ViewDemand};
use crate::plan::effects::{Bands, BitDepth, Clouds, GroundKind, GroundState, Haze, NirLight, Sensor};
use crate::reference::{Options, Tracer};
use crate::scene::Scene;

fn ordinary(scene: &Scene) -> ViewDemand {
    let mut view = view(nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 90.0), vec![demand(scene, Output::Color, State::Before)]);
    let look = &mut view.outputs[0].look;
    look.haze = Some(Haze { extinction: [1e-5; 3], scale_height: 8000.0, base: 0.0, airlight: [0.3; 3] });
    look.clouds = Some(Clouds { key: 1, cover: 0.2, height: 900.0, size: 400.0, depth: 3.0, color: [0.8; 3] });
    let around = vec![(glam::DVec2::ZERO, 4.0)].into();
    look.ground = Some(GroundState { key: 2, kind: GroundKind::Ash, strength: 0.5, reach: 9.0, around });
    let nir = NirLight { sun: 1.0, zenith: 0.2, ground: 0.1, extinction: 1e-6, airlight: 0.2 };
    let (depth, bands) = (BitDepth::Eight, Bands::FalseColor(nir));
    look.sensor = Some(Sensor { key: 3, psf: 0.5, exposure: 1.0, read_noise: 0.0, full_well: 0.0, depth, bands });
    view
}

/// A way to put a number into a demand, and what the error calls the place.
type Place = (&'static str, fn(&mut ViewDemand, f64));

const PLACES: &[Place] = &[
    ("the camera", |v, x| v.camera.position.x = x),
    ("the camera", |v, x| v.camera.right.y = x),
    ("the camera", |v, x| v.camera.up.z = x),
    ("the camera", |v, x| v.camera.forward.y = x),
    ("the camera", |v, x| v.camera.near = x),
    ("the camera", |v, x| v.camera.projection = Projection::Perspective { tan_x: x, tan_y: 1.0 }),
    ("the camera", |v, x| v.camera.projection = Projection::Orthographic { half_x: 1.0, half_y: x }),
    ("the sun", |v, x| v.sun.as_mut().expect("set").direction.x = x),
    ("the sun", |v, x| v.sun.as_mut().expect("set").direction.y = x),
    ("the sun", |v, x| v.sun.as_mut().expect("set").disc_deg = x),
    ("the sun", |v, x| v.sun.as_mut().expect("set").irradiance[2] = x),
    ("the ambient light", |v, x| v.outputs[0].look.ambient = Ambient::Constant([0.1, x, 0.1])),
    ("the ambient light", |v, x| {
        v.outputs[0].look.ambient = Ambient::Sky { zenith: [0.1; 3], ground: [0.1, 0.1, x], occluded: true };
    }),
    ("the haze", |v, x| v.outputs[0].look.haze.as_mut().expect("set").scale_height = x),
    ("the haze", |v, x| v.outputs[0].look.haze.as_mut().expect("set").airlight[0] = x),
    ("the clouds", |v, x| v.outputs[0].look.clouds.as_mut().expect("set").cover = x),
    ("the clouds", |v, x| v.outputs[0].look.clouds.as_mut().expect("set").color[1] = x),
    ("the state of the ground", |v, x| v.outputs[0].look.ground.as_mut().expect("set").reach = x),
    ("the state of the ground", |v, x| {
        v.outputs[0].look.ground.as_mut().expect("set").around = vec![(glam::DVec2::new(0.0, x), 1.0)].into();
    }),
    ("the sensor", |v, x| v.outputs[0].look.sensor.as_mut().expect("set").exposure = x),
    ("the sensor", |v, x| {
        let nir = NirLight { sun: 1.0, zenith: x, ground: 0.1, extinction: 1e-6, airlight: 0.2 };
        v.outputs[0].look.sensor.as_mut().expect("set").bands = Bands::Nir(nir);
    }),
];

const NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn a_demand_with_a_number_that_is_not_finite_is_refused() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(2);
    assert_eq!(town::plan(&scene, ordinary(&scene)).views[0].not_finite, None);
    renderer.upload(&scene).expect("it uploads");
    for (place, put) in PLACES {
        for number in NUMBERS {
            let mut demand = ordinary(&scene);
            put(&mut demand, number);
            let plan = town::plan(&scene, demand);
            match renderer.render(&plan.views[0]) {
                Err(GpuError::NotFinite { view, what }) => assert_eq!((view.as_str(), what), ("test", *place)),
                other => panic!("{number} in {place}: {other:?}"),
            }
        }
    }
}

#[test]
fn the_reference_refuses_the_same_cameras_and_suns() {
    let scene = town::town(2);
    let tracer = Tracer::new(&scene).expect("finite");
    for (place, put) in PLACES.iter().filter(|(place, _)| ["the camera", "the sun"].contains(place)) {
        for number in NUMBERS {
            let mut demand = ordinary(&scene);
            let look = &mut demand.outputs[0].look;
            (look.haze, look.clouds, look.ground, look.sensor) = (None, None, None, None);
            put(&mut demand, number);
            let options = Options { side: 1, passes: 2, ..Options::default() };
            assert!(tracer.render(&demand, &options).is_err(), "{number} in {place}");
        }
    }
}

#[track_caller]
fn refused(renderer: &mut Renderer, scene: &Scene, expected: &str) {
    match renderer.upload(scene) {
        Err(GpuError::NotFiniteMesh { object: 1, instance: 2, what, vertex: 3 }) => assert_eq!(what, expected),
        other => panic!("{other:?}"),
    }
    assert!(Tracer::new(scene).is_err(), "{expected}");
}

#[test]
fn a_mesh_with_a_number_that_is_not_finite_is_refused() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let sound = town::town(2);
    for number in NUMBERS {
        let mut scene = sound.clone();
        scene.objects[1].mesh.positions[3] = DVec3::new(0.0, number, 0.0);
        refused(&mut renderer, &scene, "position");
        scene = sound.clone();
        scene.objects[1].mesh.normals[3] = Vec3::new(0.0, 1.0, number as f32);
        refused(&mut renderer, &scene, "normal");
        scene = sound.clone();
        scene.objects[1].mesh.uvs[3] = Vec2::new(number as f32, 0.0);
        refused(&mut renderer, &scene, "texture coordinate");
    }
    // A refused scene is not half there.
    let plan = town::plan(
        &sound,
        view(nadir(0.0, 0.0, 1.0, 8, 8), sun(45.0, 90.0), vec![demand(&sound, Output::Mask, State::After)]),
    );
    assert!(matches!(renderer.render(&plan.views[0]), Err(GpuError::WrongScene(_))));
}
