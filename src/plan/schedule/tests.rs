//! What a plan holds, and above all what it does not hold.

use super::*;
use crate::plan::demand::{Ambient, Camera, Look, Projection, Quality, Selection, Shadows, State, Sun};
use crate::plan::dump;
use crate::plan::pass::Counts;

fn object(instance: u32, surfaces: &[Surface]) -> ObjectSummary {
    let bounds = Some((DVec3::splat(-10.0), DVec3::splat(10.0)));
    ObjectSummary { bounds, class: 2, instance, level: 1, triangles: 12, surfaces: surfaces.to_vec() }
}

fn objects() -> Vec<ObjectSummary> {
    vec![object(1, &[Surface::Plain]), object(2, &[Surface::Textured]), object(2, &[Surface::Plain])]
}

fn output(output: Output, state: State) -> OutputDemand {
    OutputDemand {
        pass: format!("{output:?} {state:?}").to_lowercase(),
        output,
        selection: Selection { state, objects: [true, state == State::Before, state == State::After].into() },
        marked: Some([false, true, true].into()),
        look: Look::plain(Shadows::Soft, Ambient::Constant([0.2; 3])),
    }
}

fn view(outputs: Vec<OutputDemand>) -> ViewDemand {
    let camera = Camera {
        position: DVec3::new(0.0, 100.0, 0.0),
        right: DVec3::X,
        up: DVec3::NEG_Z,
        forward: DVec3::NEG_Y,
        projection: Projection::Perspective { tan_x: 0.1, tan_y: 0.1 },
        width: 64,
        height: 48,
        near: 50.0,
    };
    let sun = Sun { direction: DVec3::new(0.6, 0.8, 0.0), disc_deg: 0.53, irradiance: [1.0; 3] };
    let quality = Quality { supersample: 2, shadow_map: 256, shadow_samples: 3, sky_samples: 4, field_map: 64 };
    ViewDemand { name: "v".into(), camera, sun: Some(sun), quality, outputs }
}

fn stems(plan: &RenderPlan) -> Vec<&'static str> {
    plan.views.iter().flat_map(ViewPlan::passes).map(|p| p.kind.stem()).collect()
}

#[test]
fn mask_alone_needs_one_pass_two_targets_one_pipeline() {
    let plan = schedule(&[view(vec![output(Output::Mask, State::After)])], &objects());
    assert_eq!(stems(&plan), ["ids"]);
    assert_eq!(plan.counts(), Counts { passes: 1, textures: 2, pipelines: 1 });
    let skipped: Vec<_> = plan.views[0].skipped.iter().map(|s| s.what.as_str()).collect();
    assert_eq!(skipped, ["shading", "shadow map"]);
}

#[test]
fn labels_of_one_selection_share_a_pass_and_depth_joins_them() {
    let all = [Output::Mask, Output::Class, Output::Level, Output::Instance, Output::Depth];
    let plan = schedule(&[view(all.map(|o| output(o, State::Before)).to_vec())], &objects());
    assert_eq!(stems(&plan), ["ids"]);
    assert_eq!(plan.views[0].stages[0].products.len(), 5);
}

#[test]
fn depth_alone_has_no_ids() {
    let plan = schedule(&[view(vec![output(Output::Depth, State::Before)])], &objects());
    assert_eq!(stems(&plan), ["depth"]);
    assert_eq!(plan.counts(), Counts { passes: 1, textures: 1, pipelines: 1 });
}

#[test]
fn before_and_after_have_a_shadow_map_each_in_one_texture() {
    let outputs = vec![output(Output::Color, State::Before), output(Output::Color, State::After)];
    let plan = schedule(&[view(outputs)], &objects());
    assert_eq!(stems(&plan), ["shadow_map", "shadow_bounds", "shade", "resolve"].repeat(2));
    // shadow map, its bounds, fine and coarse, radiance, its depth, colour; shadow_map, two for bounds, plain, textured, resolve.
    assert_eq!(plan.counts(), Counts { passes: 8, textures: 6, pipelines: 6 });
    let lights: Vec<_> = plan.views[0]
        .passes()
        .filter_map(|p| if let PassKind::ShadowMap { light, .. } = &p.kind { Some(*light) } else { None })
        .collect();
    assert_eq!(lights[0], lights[1], "the frame must not depend on the state, or unchanged shadows would move");
}

#[test]
fn equal_colours_are_shaded_once_and_other_light_shares_the_map() {
    let mut dim = output(Output::Color, State::After);
    dim.look.ambient = Ambient::Off;
    let twice = output(Output::Color, State::After);
    let plan = schedule(&[view(vec![twice.clone(), twice, dim])], &objects());
    assert_eq!(stems(&plan), ["shadow_map", "shadow_bounds", "shade", "resolve", "shade", "resolve"]);
}

#[test]
fn no_sun_and_no_shadows_make_no_map() {
    let mut night = view(vec![output(Output::Color, State::After)]);
    night.sun = night.sun.map(|s| Sun { direction: DVec3::new(0.8, -0.6, 0.0), ..s });
    let mut flat = view(vec![output(Output::Color, State::After)]);
    flat.outputs[0].look.shadows = Shadows::Off;
    let plan = schedule(&[night, flat], &objects());
    assert_eq!(stems(&plan), ["shade", "resolve", "shade", "resolve"]);
    assert_eq!(plan.views[0].skipped[0].reason, "no sun above the horizon");
    assert_eq!(plan.views[1].skipped[0].reason, "shadows are off");
}

#[test]
fn only_selected_objects_with_a_visible_surface_are_drawn() {
    let mut objects = objects();
    let drawn = |objects: &[ObjectSummary]| {
        let plan = schedule(&[view(vec![output(Output::Class, State::After)])], objects);
        let pass = plan.views[0].passes().next().expect("one pass");
        pass.kind.draw().expect("it draws").objects.to_vec()
    };
    assert_eq!(drawn(&objects), [true, false, true]);
    objects[0].surfaces.clear();
    assert_eq!(drawn(&objects), [false, false, true]);
}

#[test]
fn every_read_was_written_before() {
    let outputs = [Output::Color, Output::Mask, Output::Depth].map(|o| output(o, State::After)).to_vec();
    let plan = schedule(&[view(outputs)], &objects());
    let mut written = std::collections::BTreeSet::new();
    for pass in plan.views[0].passes() {
        assert!(pass.reads.iter().all(|r| written.contains(r)));
        assert!(pass.writes.iter().all(|w| written.insert(*w)), "a resource is written once");
    }
}

#[test]
fn dumps_name_every_pass() {
    let outputs = [Output::Color, Output::Mask].map(|o| output(o, State::After)).to_vec();
    let plan = schedule(&[view(outputs)], &objects());
    let (text, dot, json) = (dump::text(&plan), dump::dot(&plan), dump::json(&plan));
    assert!(text.contains("1 views, 5 passes, 8 render targets"), "{text}");
    for stem in ["shadow_map", "shadow_bounds", "shade", "resolve", "ids"] {
        assert!(text.contains(stem) && dot.contains(stem), "{stem}");
    }
    assert_eq!(json["views"][0]["passes"].as_array().map(Vec::len), Some(5));
}
