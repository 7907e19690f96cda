//! What is made for a plan: exactly what it says.

use super::town::{self, demand, gray, nadir, plan, sun, view};
use crate::plan::Counts;
use crate::plan::demand::{Output, State};
use crate::scene::Presence;

#[test]
fn masks_alone_make_no_shadow_map_and_no_shading() {
    let Some(mut renderer) = super::renderer() else { return };
    let scene = town::town(4);
    let outputs = vec![demand(&scene, Output::Mask, State::After)];
    let plan = plan(&scene, view(nadir(0.0, 0.0, 1.0, 64, 64), sun(45.0, 90.0), outputs));
    renderer.upload(&scene).expect("it uploads");
    let frame = renderer.render(&plan.views[0]).expect("it renders");
    assert_eq!(renderer.created(), Counts { passes: 1, textures: 2, pipelines: 1 });
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
