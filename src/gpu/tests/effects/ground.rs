//! State of the ground: what ash and puddles leave of the albedo, where they lie, what water mirrors.

use glam::{DVec2, DVec3};

use super::{albedo, difference, ground_points, linear, look, plane};
use crate::gpu::tests::town::{self, nadir, sun};
use crate::plan::demand::Ambient;
use crate::plan::effects::{GroundKind, GroundState};
use crate::scene::Presence;

fn state(kind: GroundKind) -> GroundState {
    let around = [(DVec2::new(4.0, 3.0), 10.0), (DVec2::new(-30.0, -20.0), 5.0)].into();
    GroundState { key: 5, kind, strength: 0.7, reach: 20.0, around }
}

#[test]
fn the_ground_is_covered_as_the_field_says() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = plane(100.0);
    let camera = nadir(-10.0, 2.0, 1.0, 96, 80);
    let sun = sun(50.0, 200.0);
    for (kind, bounds) in [(GroundKind::Ash, (0.02, 1e-3)), (GroundKind::Puddles, (0.1, 2e-3))] {
        let ground = state(kind);
        let mut view = look(&scene, camera, Some(sun));
        view.outputs[0].look.ambient = Ambient::Constant([0.3; 3]);
        view.outputs[0].look.ground = Some(ground.clone());
        (view.quality.supersample, view.quality.field_map) = (1, 1024);
        let drawn = linear(&town::render(&mut renderer, &scene, view), 0);
        let light = |p: &DVec3| {
            let share = ground.coverage(DVec2::new(p.x, -p.z));
            let cosine = camera.position.y / (camera.position - *p).length();
            std::array::from_fn(|c| {
                let albedo = albedo()[c] * (1.0 - share) + kind.albedo(albedo()[c]) * share;
                albedo * (0.3 + sun.irradiance[c] * sun.direction.y) + share * kind.mirrored(cosine) * 0.3
            })
        };
        let expected: Vec<[f64; 3]> = ground_points(&camera).iter().map(light).collect();
        let (worst, mean) = difference(&drawn, &expected);
        let changed = expected.iter().filter(|e| (e[0] - expected[0][0]).abs() > 0.02).count();
        println!("{kind:?}: worst {worst:.5}, mean {mean:.6}, {changed} pixels changed");
        assert!(worst < bounds.0 && mean < bounds.1, "{kind:?}: worst {worst}, mean {mean}");
        assert!(changed > 300, "{changed} pixels have {kind:?}");
    }
}

#[test]
fn walls_and_far_ground_stay_as_they_are() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = plane(100.0);
    town::block(&mut scene, Presence::Both, DVec3::new(0.0, 0.0, -8.0), DVec3::new(12.0, 10.0, 4.0));
    let camera = town::tilted(nadir(0.0, 0.0, 0.5, 96, 80), 40.0);
    let mut clean = look(&scene, camera, Some(sun(50.0, 150.0)));
    clean.quality.supersample = 1;
    let mut ashen = clean.clone();
    // All of the ground near the box: only its walls are left.
    let around = [(DVec2::new(6.0, 2.0), 500.0)].into();
    ashen.outputs[0].look.ground = Some(GroundState { strength: 1.0, around, ..state(GroundKind::Ash) });
    let mut ids = clean.clone();
    ids.outputs = vec![town::demand(&scene, crate::plan::demand::Output::Instance, crate::plan::demand::State::Before)];
    let [clean, ashen] = [clean, ashen].map(|view| linear(&town::render(&mut renderer, &scene, view), 0));
    let sides = clean.iter().zip(&ashen).filter(|(a, b)| a == b).count();
    assert!((200..2000).contains(&sides), "{sides} pixels are the same");

    let mut far = look(&scene, camera, Some(sun(50.0, 150.0)));
    let around = [(DVec2::new(4000.0, 0.0), 50.0)].into();
    far.outputs[0].look.ground = Some(GroundState { around, ..state(GroundKind::Ash) });
    let plan = town::plan(&scene, far);
    assert!(plan.views[0].passes().all(|pass| pass.kind.stem() != "ground_map"));
    assert!(plan.views[0].skipped.iter().any(|s| s.reason == "no changed feature in view"));
}
