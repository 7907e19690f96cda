//! What is made for a plan: exactly what it says.

use super::town::{self, demand, gray, nadir, plan, sun, view};
use crate::plan::Counts;
use crate::plan::demand::{Ambient, Look, Output, Shadows, State};
use crate::plan::effects::{Bands, BitDepth, Clouds, GroundKind, GroundState, Haze, NirLight, Sensor};
use crate::scene::Presence;

#[test]
fn masks_alone_make_no_shadow_map_and_no_shading() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(4);
    let outputs = vec![demand(&scene, Output::Mask, State::After)];
    let plan = plan(&scene, view(nadir(0.0, 0.0, 1.0, 64, 64), sun(45.0, 90.0), outputs));
    renderer.upload(&scene).expect("it uploads");
    let frame = renderer.render(&plan.views[0]).expect("it renders");
    let drawn = plan.counts().triangles;
    assert_eq!(renderer.created(), Counts { passes: 1, textures: 2, pipelines: 1, attributes: 2, triangles: drawn });
    assert!(gray(&frame, 0).contains(&255) && gray(&frame, 0).contains(&0));
}

#[test]
fn everything_makes_what_the_plan_counts() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(4);
    let all = [Output::Color, Output::Class, Output::Mask, Output::Level, Output::Instance, Output::Depth];
    let outputs = [State::Before, State::After].map(|state| all.map(|o| demand(&scene, o, state)).to_vec()).concat();
    let plan = plan(&scene, view(nadir(0.0, 0.0, 0.5, 64, 64), sun(45.0, 90.0), outputs));
    renderer.upload(&scene).expect("it uploads");
    let frame = renderer.render(&plan.views[0]).expect("it renders");
    assert_eq!(renderer.created(), plan.counts());
    let names: Vec<&str> = frame.images.iter().map(|image| image.pass.as_str()).collect();
    assert_eq!(names[..3], ["color before", "class before", "mask before"]);
    assert_eq!(names.len(), 12);
}

#[test]
fn mask_is_what_colour_shows_of_the_marked_objects() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(4);
    let outputs = [Output::Mask, Output::Instance].map(|o| demand(&scene, o, State::After)).to_vec();
    let frame = town::render(&mut renderer, &scene, view(nadir(0.0, 0.0, 0.25, 128, 128), sun(45.0, 90.0), outputs));
    let crate::frame::Pixels::Id32(instances) = &frame.images[1].pixels else { panic!("instances are numbers") };
    for (mask, &instance) in gray(&frame, 0).iter().zip(instances) {
        let object = instance.checked_sub(1).map(|i| &scene.objects[i as usize]);
        assert!(object.is_none_or(|o| o.presence != Presence::BeforeOnly), "an absent object was drawn");
        assert_eq!(*mask == 255, object.is_some_and(|o| o.presence == Presence::AfterOnly));
    }
}

#[test]
fn twice_gives_the_same_bytes() {
    let scene = town::town(5);
    let outputs = [Output::Color, Output::Instance].map(|o| demand(&scene, o, State::After)).to_vec();
    let demand = view(nadir(0.0, 0.0, 0.5, 160, 160), sun(40.0, 200.0), outputs);
    let once = || super::renderer().map(|mut renderer| town::render(&mut renderer, &scene, demand.clone()));
    assert_eq!(once(), once());
}

#[test]
fn renderer_may_move_to_another_thread() {
    fn is_send<T: Send>() {}
    is_send::<crate::gpu::Renderer>();
}

/// The passes that a change of a look adds, and the change.
type Effect = (&'static [&'static str], Box<dyn Fn(&mut Look)>);

/// One for every effect.
fn effects() -> Vec<Effect> {
    let haze = Haze { extinction: [1e-4; 3], scale_height: 900.0, base: 0.0, airlight: [0.3; 3] };
    // Above the tests' camera, and below it.
    let high = Clouds { key: 1, cover: 0.4, height: 2000.0, size: 300.0, depth: 2.0, color: [0.8; 3] };
    let low = Clouds { height: 100.0, ..high };
    let light = NirLight { sun: 0.8, zenith: 0.1, ground: 0.1, extinction: 1e-5, airlight: 0.1 };
    let sensor = Sensor {
        key: 1,
        psf: 0.0,
        exposure: 1.0,
        read_noise: 0.0,
        full_well: 0.0,
        depth: BitDepth::Eight,
        bands: Bands::Rgb,
    };
    let around: std::sync::Arc<[_]> = [(glam::DVec2::ZERO, 20.0)].into();
    let ground = move |kind| GroundState { key: 2, kind, strength: 0.6, reach: 10.0, around: around.clone() };
    let (ash, puddles) = (ground(GroundKind::Ash), ground(GroundKind::Puddles));
    let sky = Ambient::Sky { zenith: [0.2; 3], ground: [0.1; 3], occluded: true };
    vec![
        (&["shadow_map"], Box::new(|look| look.shadows = Shadows::Hard)),
        (&["shadow_map", "shadow_bounds"], Box::new(|look| look.shadows = Shadows::Soft)),
        (&["sky_maps"], Box::new(move |look| look.ambient = sky)),
        (&[], Box::new(move |look| look.haze = Some(haze))),
        (&["cloud_map"], Box::new(move |look| look.clouds = Some(high))),
        (&["cloud_map", "cloud_map"], Box::new(move |look| look.clouds = Some(low))),
        (&["ground_map"], Box::new(move |look| look.ground = Some(ash.clone()))),
        (&["ground_map"], Box::new(move |look| look.ground = Some(puddles.clone()))),
        (&[], Box::new(move |look| look.sensor = Some(sensor))),
        (&[], Box::new(move |look| look.sensor = Some(Sensor { bands: Bands::Nir(light), ..sensor }))),
    ]
}

#[test]
fn every_effect_makes_what_it_needs_and_nothing_without_it() {
    let scene = town::town(2);
    let mut plain = demand(&scene, Output::Color, State::After);
    plain.look = Look::plain(Shadows::Off, Ambient::Constant([0.2; 3]));
    let of = |output| view(nadir(0.0, 0.0, 1.0, 64, 64), sun(45.0, 90.0), vec![output]);
    let base = plan(&scene, of(plain.clone()));
    let stems = |plan: &crate::plan::RenderPlan| plan.views[0].passes().map(|p| p.kind.stem()).collect::<Vec<_>>();
    assert_eq!(stems(&base), ["shade", "resolve"]);
    let text = crate::plan::dump::text(&base);
    for absent in ["shadow map", "sky maps", "haze", "clouds", "state of the ground", "sensor"] {
        assert!(text.contains(&format!("no {absent}: ")), "{absent}: {text}");
    }
    for (added, change) in effects() {
        let Some(mut renderer) = super::renderer() else { return };
        let mut output = plain.clone();
        change(&mut output.look);
        let asked = plan(&scene, of(output));
        assert_eq!(stems(&asked), [added, &["shade", "resolve"]].concat());
        let more = asked.counts().textures - base.counts().textures;
        // The bounds of a shadow map are two: of blocks, and of blocks of blocks.
        let maps = added.len() + added.iter().filter(|stem| **stem == "shadow_bounds").count();
        assert_eq!(more, maps, "{added:?}");
        renderer.upload(&scene).expect("it uploads");
        renderer.render(&asked.views[0]).expect("it renders");
        assert_eq!(renderer.created(), asked.counts(), "{added:?}");
        let keys = |plan: &crate::plan::RenderPlan| {
            plan.views[0].passes().flat_map(|p| p.pipelines.clone()).collect::<std::collections::BTreeSet<_>>()
        };
        assert!(keys(&asked) != keys(&base) || added.is_empty(), "{added:?}");
    }
}

#[test]
fn an_effect_that_can_not_be_seen_changes_nothing() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(2);
    let plain = demand(&scene, Output::Color, State::After);
    let mut unseen = plain.clone();
    let around = [(glam::DVec2::new(9000.0, 0.0), 20.0)].into();
    unseen.look.ground = Some(GroundState { key: 2, kind: GroundKind::Ash, strength: 0.6, reach: 10.0, around });
    unseen.look.clouds = Some(Clouds { key: 1, cover: 0.0, height: 900.0, size: 300.0, depth: 2.0, color: [0.8; 3] });
    let frames = [plain, unseen].map(|output| {
        let demand = view(nadir(0.0, 0.0, 1.0, 64, 64), sun(45.0, 90.0), vec![output]);
        let counts = plan(&scene, demand.clone()).counts();
        (town::render(&mut renderer, &scene, demand), counts)
    });
    assert!(frames[0] == frames[1]);
}

#[test]
fn passes_are_timed_on_demand() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(2);
    let demand = view(nadir(0.0, 0.0, 1.0, 64, 64), sun(45.0, 90.0), vec![demand(&scene, Output::Color, State::After)]);
    town::render(&mut renderer, &scene, demand.clone());
    assert!(renderer.timings().is_empty());
    renderer.set_timed(true);
    town::render(&mut renderer, &scene, demand);
    let stems: Vec<&str> = renderer.timings().iter().map(|(stem, _)| stem.as_str()).collect();
    assert_eq!(stems, ["shadow_map", "shadow_bounds", "shade", "resolve"]);
    assert!(renderer.timings().iter().all(|(_, seconds)| (0.0..60.0).contains(seconds)), "{:?}", renderer.timings());
}
