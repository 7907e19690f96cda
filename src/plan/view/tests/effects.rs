//! Effects of recipes as demands.

use super::*;
use crate::plan::effects::{Ambient, Bands, BitDepth, GroundKind, NirLight};
use crate::plan::sun::to_angles;

const EFFECTS: &str = "effects { shadows soft; ambient sky; atmosphere haze visibility uniform(5km, 20km)\n\
    clouds uniform(20%, 60%) height 900m; ground ash share uniform(20%, 80%) within 9m\n\
    sensor psf uniform(0, 2) full_well 9000 depth 16bit }";

fn with(effects: &str) -> String {
    RECIPE.replace("effects { shadows soft; ambient sky }", effects)
}

fn looks(view: &DrawnView) -> Vec<(&str, &Look)> {
    view.demands.iter().flat_map(|d| &d.outputs).map(|o| (o.pass.as_str(), &o.look)).collect()
}

fn look_of(view: &DrawnView, name: &str) -> Look {
    looks(view).into_iter().find(|(pass, _)| *pass == name).expect("the image is demanded").1.clone()
}

#[test]
fn effects_that_nobody_asks_for_are_not_there_and_change_no_draw() {
    let (plain, all) = (all_views(RECIPE), all_views(&with(EFFECTS)));
    for (plain, all) in plain.iter().zip(&all) {
        assert!(looks(plain).iter().all(|(_, look)| **look == Look::plain(look.shadows, look.ambient)));
        for draw in &plain.draws {
            assert_eq!(value(all, &draw.path), draw.value, "{}", draw.path);
        }
        assert_eq!(plain.demands[0].camera, all.demands[0].camera);
        assert_eq!(plain.demands[0].sun, all.demands[0].sun);
        assert!(looks(all).iter().all(|(name, look)| ["before", "after"].contains(name) || **look == Look::none()));
    }
}

#[test]
fn draws_of_effects_are_recorded_and_differ_between_views_but_not_passes() {
    let views = all_views(&with(EFFECTS));
    let (first, second) = (look_of(&views[0], "before"), look_of(&views[1], "before"));
    let (haze, clouds) = (first.haze.expect("asked for"), first.clouds.expect("asked for"));
    assert_eq!((first.haze, first.clouds), (look_of(&views[0], "after").haze, look_of(&views[0], "after").clouds));
    assert_ne!((first.haze, first.clouds), (second.haze, second.clouds));
    assert!((haze.extinction[1] * value(&views[0], "effects.atmosphere.visibility") - 3.912).abs() < 1e-12);
    let ratio = haze.extinction[2] / haze.extinction[0];
    assert!((ratio - libm::pow(610.0 / 465.0, 1.3)).abs() < 1e-12, "{ratio}");
    assert_eq!((haze.scale_height, haze.base), (1200.0, 90.0));
    assert_eq!((clouds.cover, clouds.height), (value(&views[0], "effects.clouds.cover"), 1000.0));
    let sensors = ["before", "after"].map(|name| look_of(&views[0], name).sensor.expect("asked for"));
    assert_eq!((sensors[0].psf, sensors[0].depth, sensors[0].full_well), (sensors[1].psf, BitDepth::Sixteen, 9000.0));
    assert_ne!(sensors[0].key, sensors[1].key, "two images do not have the same noise");
    assert_eq!(sensors[0].psf, value(&views[0], "effects.sensor.psf"));
}

#[test]
fn a_pass_has_its_own_effects_under_its_own_name() {
    let text = with(EFFECTS).replace("show all with fire }", "show all with fire; clouds 90%; atmosphere off }");
    let view = &all_views(&text)[0];
    let (before, after) = (look_of(view, "before"), look_of(view, "after"));
    assert!(before.haze.is_some() && after.haze.is_none());
    let (one, other) = (before.clouds.expect("asked for"), after.clouds.expect("asked for"));
    assert_eq!((other.cover, one.key), (0.9, other.key));
    assert_eq!(value(view, "after.effects.clouds.cover"), 0.9);
    assert_eq!(value(view, "effects.clouds.cover"), one.cover);
}

#[test]
fn an_acquisition_redraws_effects_where_it_says_so() {
    let look = |words: &str| {
        let text =
            with(EFFECTS).replace("show all with fire }", &format!("show all with fire; acquisition b {words} }}"));
        let view = all_views(&text).remove(0);
        (look_of(&view, "before"), look_of(&view, "after"))
    };
    let (before, after) = look("redraw sun");
    let cover = |look: &Look| look.clouds.expect("asked for").cover;
    assert_eq!((cover(&before), before.clouds.map(|c| c.key)), (cover(&after), after.clouds.map(|c| c.key)));
    for words in ["", "redraw effects"] {
        let (before, after) = look(words);
        assert!(cover(&before) != cover(&after) && before.clouds.map(|c| c.key) != after.clouds.map(|c| c.key));
    }
}

/// A summary whose burnt house is 30 m by 10 m, in both states.
fn burnt_summary() -> SceneSummary {
    let mut summary = summary();
    let house = Some((DVec3::new(-15.0, 100.0, 20.0), DVec3::new(15.0, 110.0, 30.0)));
    for object in &mut summary.objects {
        object.bounds = Some(summary.bounds);
        if object.change == 1 {
            object.bounds = house;
        }
    }
    // Ground that the fire takes over is a piece of the terrain that reaches from house to house.
    let piece = PlacedObject { level: 0, ..object(SceneClass::Terrain, Presence::BeforeOnly, 1) };
    summary.objects.push(PlacedObject { bounds: Some(summary.bounds), ..piece });
    summary
}

#[test]
fn ash_lies_about_what_burnt_once_it_has() {
    let spec = load(&with(EFFECTS).replace("pass mask", "pass both { show all with all }\npass mask"));
    let views = views(&spec, &spec.datasets[0], 0, &burnt_summary());
    assert_eq!(look_of(&views[0], "before").ground, None);
    let ash = look_of(&views[0], "after").ground.expect("asked for");
    assert_eq!(look_of(&views[1], "after").ground.as_ref(), Some(&ash), "it lies there in every view");
    // The painted house of `with all` is no target.
    assert_eq!(look_of(&views[0], "both").ground.as_ref(), Some(&ash));
    assert_eq!((ash.kind, ash.reach), (GroundKind::Ash, 9.0));
    assert_eq!(ash.strength, value(&views[0], "effects.ground.share"));
    let expected = [-10.0, 0.0, 10.0].map(|x| (glam::DVec2::new(x, -25.0), 5.0));
    assert_eq!(ash.around.len(), 3);
    for (found, expected) in ash.around.iter().zip(expected) {
        assert!((found.0 - expected.0).length() < 1e-9 && found.1 == expected.1, "{found:?}");
    }
}

#[test]
fn a_clear_sky_lights_by_the_height_of_the_sun() {
    let low =
        with(EFFECTS).replace("sun { declination uniform(30deg, 140deg) }", "sun { elevation 8deg; colour clear_sky }");
    let view = &all_views(&low)[0];
    let sun = view.demands[0].sun.expect("colour is written");
    assert_eq!(value(view, "sun.turbidity"), 3.0);
    assert!(sun.irradiance[0] > 1.8 * sun.irradiance[2], "a low sun is red {:?}", sun.irradiance);
    let Ambient::Sky { zenith, occluded: false, .. } = look_of(view, "before").ambient else { panic!("a sky") };
    assert!(zenith[2] > zenith[0], "{zenith:?}");
    let bright = all_views(&low.replace("clear_sky", "clear_sky; intensity 1.7"))[0].demands[0].sun.expect("a sun");
    assert!((bright.irradiance[1] / sun.irradiance[1] - 2.0).abs() < 1e-12);
    assert!((to_angles(sun.direction).0 - 8.0).abs() < 1e-9);
}

#[test]
fn bands_of_a_sensor_have_their_light_and_exposure_follows_it() {
    let look = |ambient: &str, sensor: &str| {
        let text = with(&format!("effects {{ ambient {ambient}; atmosphere haze; sensor {sensor} }}"));
        let view = all_views(&text.replace("declination uniform(30deg, 140deg)", "elevation 30deg; colour clear_sky"));
        (look_of(&view[0], "before"), view[0].demands[0].sun.expect("a sun"))
    };
    let (nir, sun) = look("sky", "bands nir exposure auto");
    let sensor = nir.sensor.expect("asked for");
    let Bands::Nir(NirLight { sun: beam, zenith, ground, extinction, airlight }) = sensor.bands else { panic!("nir") };
    let red = nir.haze.expect("asked for");
    assert!(extinction < red.extinction[0] && airlight > 0.0 && zenith < 0.2 && ground > zenith);
    assert!(beam > sun.irradiance[2]);
    assert!((sensor.exposure * (0.5 * beam + zenith) - 1.0).abs() < 1e-12);
    let (rgb, _) = look("constant(20%)", "exposure auto");
    let level: f64 = sun.irradiance.iter().map(|band| 0.5 * band + 0.2).sum::<f64>() / 3.0;
    assert!((rgb.sensor.expect("asked for").exposure * level - 1.0).abs() < 1e-12);
    let (dark, _) = look("off", "bands panchromatic");
    let Bands::Panchromatic(light) = dark.sensor.expect("asked for").bands else { panic!("panchromatic") };
    assert_eq!((light.zenith, light.ground), (0.0, 0.0));
}

#[test]
fn vegetation_is_shown_only_where_the_effect_is_on() {
    let mut summary = summary();
    summary.objects.push(object(SceneClass::Vegetation, Presence::Both, 0));
    let flags = |text: &str| -> Vec<(String, bool)> {
        let spec = load(text);
        let views = views(&spec, &spec.datasets[0], 0, &summary);
        let shown = |o: &OutputDemand| (o.pass.clone(), o.selection.objects[7]);
        views[0].demands.iter().flat_map(|d| &d.outputs).map(shown).collect()
    };
    assert!(flags(RECIPE).iter().all(|(_, shown)| !shown));
    let text = with("effects { vegetation trees }")
        .replace("changed as class, mask, depth", "changed as class; vegetation off");
    let found = flags(&text.replace(" mark changed", ""));
    let expected = [("before", true), ("after", true), ("mask", false), ("labels", false)];
    assert_eq!(found, expected.map(|(name, shown)| (name.to_owned(), shown)));
}
