//! Demands of the window show what the recipe's would.

use super::*;
use crate::plan::demand::Projection;
use crate::plan::effects::Look;

const QUALITY: Quality =
    Quality { supersample: 3, shadow_map: 4096, shadow_samples: 5, sky_samples: 64, field_map: 1024 };

fn camera() -> Camera {
    let (right, up, forward) = crate::plan::view::frame(20.0, 180.0, 0.0);
    let projection = Projection::Orthographic { half_x: 10.0, half_y: 10.0 };
    Camera { position: DVec3::Y * 50.0, right, up, forward, projection, width: 8, height: 8, near: 0.1 }
}

fn object(class: SceneClass, presence: Presence, change: u16) -> PlacedObject {
    PlacedObject { feature: None, class, presence, change, level: u8::from(change > 0), bounds: None }
}

/// Terrain, a house that burns (before, after), a road.
fn objects() -> Vec<PlacedObject> {
    vec![
        object(SceneClass::Terrain, Presence::Both, 0),
        object(SceneClass::Building, Presence::BeforeOnly, 1),
        object(SceneClass::Building, Presence::AfterOnly, 1),
        object(SceneClass::Highway, Presence::Both, 0),
    ]
}

fn image(pass: &str, output: Output, state: State, flags: [bool; 4]) -> OutputDemand {
    let look = Look::plain(Shadows::Soft, Ambient::Sky { zenith: [0.2; 3], ground: [0.1; 3], occluded: true });
    OutputDemand {
        pass: pass.to_owned(),
        output,
        selection: Selection { state, objects: flags.into() },
        marked: (output == Output::Mask).then(|| [false, true, true, false].into()),
        look: if output == Output::Color { look } else { Look::none() },
    }
}

fn view(outputs: Vec<OutputDemand>) -> DrawnView {
    let demand = ViewDemand { name: "v".to_owned(), camera: camera(), sun: Some(NOON), quality: QUALITY, outputs };
    DrawnView { view: 0, name: "v".to_owned(), demands: vec![demand], draws: Vec::new() }
}

fn recipe() -> DrawnView {
    view(vec![
        image("before", Output::Color, State::Before, [true, true, false, true]),
        image("after", Output::Color, State::After, [true, false, true, true]),
        image("mask", Output::Mask, State::After, [false, true, true, false]),
    ])
}

fn flags(demand: &ViewDemand) -> Vec<bool> {
    demand.outputs[0].selection.objects.to_vec()
}

#[test]
fn the_recipes_own_image_is_asked_for() {
    let (view, objects) = (recipe(), objects());
    for (at, kind) in [Kind::Before, Kind::After, Kind::Mask].into_iter().enumerate() {
        let made = demand(&view, &objects, kind, camera(), Layers::default(), Care::Full);
        let own = &view.demands[0].outputs[at];
        assert_eq!(made.outputs[0], OutputDemand { pass: PICTURE.to_owned(), ..own.clone() });
        assert_eq!((made.quality, made.sun), (QUALITY, (kind != Kind::Mask).then_some(NOON)));
        let others: Vec<Output> = made.outputs[1..].iter().map(|output| output.output).collect();
        assert_eq!(others, [Output::Instance, Output::Depth]);
    }
}

#[test]
fn a_layer_that_is_off_is_gone_from_every_image() {
    let mut layers = Layers::default();
    layers.set(SceneClass::Building, false);
    assert!(!layers.shows(SceneClass::Building) && layers.shows(SceneClass::Vegetation));
    let made = demand(&recipe(), &objects(), Kind::Mask, camera(), layers, Care::Full);
    assert!(made.outputs.iter().all(|output| !output.selection.objects[1] && !output.selection.objects[2]));
    assert_eq!(made.outputs[0].marked.as_deref(), Some(&[false; 4][..]));
    layers.set(SceneClass::Building, true);
    assert_eq!(layers, Layers::default());
}

#[test]
fn states_without_an_image_are_made() {
    let only_after = view(vec![image("after", Output::Color, State::After, [true, false, true, true])]);
    let before = demand(&only_after, &objects(), Kind::Before, camera(), Layers::default(), Care::Full);
    assert_eq!(flags(&before), [true, true, false, true]);
    assert_eq!(before.outputs[0].look, only_after.demands[0].outputs[0].look);
    let mask = demand(&only_after, &objects(), Kind::Mask, camera(), Layers::default(), Care::Full);
    assert_eq!(mask.outputs[0].marked.as_deref(), Some(&[false, true, true, false][..]));
    assert_eq!(mask.sun, None);
}

#[test]
fn drafts_are_cheap_and_show_the_same_things() {
    let draft = demand(&recipe(), &objects(), Kind::After, camera(), Layers::default(), Care::Draft);
    assert_eq!((draft.quality.supersample, draft.quality.shadow_samples, draft.outputs.len()), (1, 1, 1));
    assert_eq!(draft.outputs[0].look.shadows, Shadows::Hard);
    assert!(matches!(draft.outputs[0].look.ambient, Ambient::Sky { occluded: false, .. }));
    assert_eq!(flags(&draft), [true, false, true, true]);
}
