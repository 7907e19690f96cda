//! Recipes in, demands out.

mod effects;

use super::*;
use crate::geodata::feature::FeatureClass;
use crate::geodata::feature::{ObjectKind, Tags};
use crate::plan::change::{Candidate, draw_changes};
use crate::plan::effects::Shadows;
use crate::source::{Access, SourceMap};

const RECIPE: &str = "scene s { seed 3; map \"a.osm\" }\n\
    change fire { of building; share 40%; rules \"d.cga\" }\n\
    change paint { of building; share 25%; rules \"p.cga\"; non_target }\n\
    camera c { size 200 x 100; gsd 0.5m; fov 40deg; off_nadir uniform(5deg, 10deg); azimuth uniform(0deg, 360deg) }\n\
    camera top { size 64 x 64 }\n\
    sun { declination uniform(30deg, 140deg) }\neffects { shadows soft; ambient sky }\n\
    pass before { show all }\n\
    pass after { show all with fire }\n\
    pass mask { show only fire with both as mask }\n\
    pass labels { show all with all mark changed as class, mask, depth; shadows off }\n\
    dataset d { views 3 * c, top }\n";

fn load(text: &str) -> RenderSpec {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("r.render");
    std::fs::write(&path, text).expect("the temporary folder can be written");
    let access = Access::new(folder.path()).expect("the folder exists");
    let (spec, diagnostics) = crate::spec::load(&path.display().to_string(), &access, &mut SourceMap::default(), &[]);
    spec.unwrap_or_else(|| panic!("{diagnostics:?}"))
}

fn object(class: SceneClass, presence: Presence, change: u16) -> PlacedObject {
    PlacedObject { feature: None, class, presence, change, level: u8::from(change > 0), bounds: None }
}

/// Terrain, an untouched house, a burnt house in both states, a painted house in both states, a road.
fn summary() -> SceneSummary {
    let objects = vec![
        object(SceneClass::Terrain, Presence::Both, 0),
        object(SceneClass::Building, Presence::Both, 0),
        object(SceneClass::Building, Presence::BeforeOnly, 1),
        object(SceneClass::Building, Presence::AfterOnly, 1),
        object(SceneClass::Building, Presence::BeforeOnly, 2),
        object(SceneClass::Building, Presence::AfterOnly, 2),
        object(SceneClass::Highway, Presence::Both, 0),
    ];
    let bounds = (DVec3::new(-60.0, 90.0, -70.0), DVec3::new(50.0, 130.0, 40.0));
    SceneSummary { bounds, centre: DVec3::new(-5.0, 100.0, -15.0), objects }
}

fn all_views(text: &str) -> Vec<DrawnView> {
    let spec = load(text);
    views(&spec, &spec.datasets[0], 0, &summary())
}

fn value(view: &DrawnView, path: &str) -> f64 {
    view.draws.iter().find(|draw| draw.path == path).unwrap_or_else(|| panic!("no {path} in {:?}", view.draws)).value
}

#[test]
fn every_draw_lies_in_its_bounds_and_is_recorded() {
    for view in &all_views(RECIPE)[..3] {
        assert!((5.0..10.0).contains(&value(view, "camera.off_nadir")));
        assert!((30.0..140.0).contains(&value(view, "sun.declination")));
        assert_eq!(value(view, "camera.gsd"), 0.5);
        let down = view.demands[0].camera.forward.y;
        assert!((down + libm::cos(value(view, "camera.off_nadir").to_radians())).abs() < 1e-12);
        let sun = view.demands[0].sun.expect("colour is written");
        assert!((libm::sin(value(view, "sun.elevation").to_radians()) - sun.direction.y).abs() < 1e-12);
    }
}

#[test]
fn another_view_pass_or_property_never_changes_a_draw() {
    let views = all_views(RECIPE);
    let more = all_views(
        &RECIPE
            .replace("views 3 * c, top", "views 2 * top, 7 * c")
            .replace("azimuth uniform(0deg, 360deg)", "azimuth uniform(0deg, 360deg); heading uniform(0deg, 9deg)")
            .replace("pass before", "pass other { show terrain; acquisition x }\npass before"),
    );
    let named = |name: &str| more.iter().find(|view| view.name == name).expect("the view is there");
    for view in &views {
        for path in ["camera.off_nadir", "camera.azimuth", "sun.declination"] {
            assert_eq!(value(view, path), value(named(&view.name), path), "{} {path}", view.name);
        }
    }
    assert_ne!(value(&views[0], "camera.azimuth"), value(&views[1], "camera.azimuth"));
    assert_ne!(
        value(&views[0], "camera.azimuth"),
        value(&all_views(&RECIPE.replace("seed 3", "seed 0"))[0], "camera.azimuth")
    );
}

#[test]
fn the_frame_is_orthonormal_and_nadir_has_north_at_the_top() {
    assert_eq!(frame(0.0, 77.0, 0.0), (DVec3::X, -DVec3::Z, -DVec3::Y));
    for (off_nadir, azimuth, heading) in [(0.0, 0.0, 90.0), (8.0, 200.0, 0.0), (80.0, 0.0, 0.0), (80.0, 180.0, 33.0)] {
        let (right, up, forward) = frame(off_nadir, azimuth, heading);
        assert!((right.cross(up) + forward).length() < 1e-12);
        for (a, b) in [(right, up), (up, forward), (forward, right)] {
            assert!(a.dot(b).abs() < 1e-12 && (a.length() - 1.0).abs() < 1e-12);
        }
    }
    // From the east the camera looks west.
    let (_, _, forward) = frame(10.0, 90.0, 0.0);
    assert!(forward.x < 0.0 && forward.z.abs() < 1e-12);
}

#[test]
fn the_scene_centre_is_in_the_middle_of_the_image_and_a_pixel_there_covers_the_gsd() {
    for view in all_views(RECIPE) {
        let camera = view.demands[0].camera;
        let to = summary().centre - camera.position;
        let (depth, Projection::Perspective { tan_x, tan_y }) = (to.dot(camera.forward), camera.projection) else {
            panic!("the cameras of the recipe are perspective");
        };
        assert!(to.dot(camera.right).abs() < 1e-9 && to.dot(camera.up).abs() < 1e-9);
        assert!((2.0 * depth * tan_x / f64::from(camera.width) - value(&view, "camera.gsd")).abs() < 1e-9);
        assert_eq!(tan_y / tan_x, f64::from(camera.height) / f64::from(camera.width));
        let (low, high) = summary().bounds;
        let nearest = [low, high]
            .iter()
            .flat_map(|a| [low, high].map(|b| [low, high].map(|c| DVec3::new(a.x, b.y, c.z))))
            .flatten()
            .map(|corner| (corner - camera.position).dot(camera.forward))
            .fold(f64::INFINITY, f64::min);
        assert!(camera.near < nearest && camera.near > 0.98 * nearest, "{} {nearest}", camera.near);
    }
}

#[test]
fn an_orthographic_camera_stands_outside_the_scene() {
    let text =
        RECIPE.replace("camera top { size 64 x 64 }", "camera top { projection orthographic; size 64 x 32; gsd 2m }");
    let camera = all_views(&text).last().expect("the recipe has views").demands[0].camera;
    assert_eq!(camera.projection, Projection::Orthographic { half_x: 64.0, half_y: 32.0 });
    assert!(camera.position.y > summary().bounds.1.y && camera.near > LEAST_NEAR);
}

#[test]
fn passes_select_objects_by_set_and_state() {
    let demand = &all_views(RECIPE)[0].demands[0];
    let flags = |name: &str| {
        let output = demand.outputs.iter().find(|output| output.pass == name).expect("the image is demanded");
        let bits = |flags: &[bool]| flags.iter().map(|&flag| if flag { '1' } else { '0' }).collect::<String>();
        (bits(&output.selection.objects), output.marked.as_ref().map(|marked| bits(marked)))
    };
    assert_eq!(flags("before"), ("1110101".into(), None));
    assert_eq!(flags("after"), ("1101101".into(), None));
    assert_eq!(flags("mask"), ("0011000".into(), Some("0011000".into())));
    assert_eq!(flags("labels_mask"), ("1101011".into(), Some("0001000".into())));
    let lights: Vec<_> = demand.outputs.iter().map(|output| (output.look.shadows, output.output)).collect();
    assert_eq!(lights[0], (Shadows::Soft, Output::Color));
    assert_eq!(lights[2], (Shadows::Off, Output::Mask));
}

#[test]
fn passes_without_colour_have_no_sun() {
    let text = RECIPE.replace("dataset d {", "dataset d { passes mask;");
    assert_eq!(all_views(&text)[0].demands[0].sun, None);
}

#[test]
fn an_acquisition_has_its_own_camera_and_sun_and_leaves_the_others_alone() {
    let text = RECIPE.replace("with fire }", "with fire; acquisition second redraw sun }");
    let (plain, view) = (&all_views(RECIPE)[0], &all_views(&text)[0]);
    assert_eq!(view.demands.len(), 2);
    assert_eq!(view.demands[0].camera, view.demands[1].camera);
    assert_eq!(view.demands[0].sun, plain.demands[0].sun);
    assert_ne!(view.demands[0].sun, view.demands[1].sun);
    assert!((30.0..140.0).contains(&value(view, "second.sun.declination")));
    let text = RECIPE.replace("with fire }", "with fire; acquisition second }");
    let both = &all_views(&text)[0];
    assert_ne!(both.demands[0].camera, both.demands[1].camera);
    assert_eq!(both.demands[1].sun, view.demands[1].sun);
}

fn ways(ids: impl IntoIterator<Item = i64>) -> Vec<FeatureId> {
    ids.into_iter().map(|id| FeatureId { kind: ObjectKind::Way, id, part: 0 }).collect()
}

fn changed(text: &str, ids: &[FeatureId]) -> (Vec<Option<(usize, usize)>>, Vec<crate::plan::change::ChangeRecord>) {
    let spec = load(text);
    let tags = Tags::new();
    let features: Vec<Candidate> = ids.iter().map(|id| (*id, FeatureClass::Building, &tags)).collect();
    let (changed, records) = draw_changes(&spec, &spec.scenes[0], &features);
    (changed.into_iter().map(|c| c.map(|c| (c.change, c.level))).collect(), records)
}

#[test]
fn a_share_is_met_exactly_and_another_feature_moves_at_most_one() {
    let (flags, records) = changed(RECIPE, &ways(0..1000));
    let burnt =
        |flags: &[Option<(usize, usize)>]| -> Vec<bool> { flags.iter().map(|f| matches!(f, Some((0, _)))).collect() };
    let before = burnt(&flags);
    assert_eq!(before.iter().filter(|&&burnt| burnt).count(), 400);
    assert_eq!((records[0].drawn, records[0].candidates, records[1].drawn), (400, 1000, 250));
    // The second change draws by itself and loses about 40 % of its objects to the first.
    assert!((70..130).contains(&records[1].overruled), "{}", records[1].overruled);
    let after = burnt(&changed(RECIPE, &ways(0..1002)).0);
    let moved = before.iter().zip(&after).filter(|(a, b)| a != b).count();
    assert!(moved <= 1, "{moved}");
    let mut backwards = burnt(&changed(RECIPE, &ways((0..1000).rev())).0);
    backwards.reverse();
    assert_eq!(before, backwards);
}

#[test]
fn parts_of_one_object_change_together_and_levels_follow_their_shares() {
    let text = RECIPE
        .replace("rules \"d.cga\" }", "level low share 75% rules \"d.cga\"\n level gone share 25% effect demolished }");
    let ids: Vec<FeatureId> = ways(0..2000).into_iter().flat_map(|id| [id, FeatureId { part: 1, ..id }]).collect();
    let (flags, _) = changed(&text, &ids);
    assert!(flags.chunks(2).all(|pair| pair[0] == pair[1]));
    let count = |level| flags.iter().filter(|flag| **flag == Some((0, level))).count() / 2;
    assert_eq!(count(0) + count(1), 800);
    assert!((160..240).contains(&count(1)), "{}", count(1));
    let (counted, records) = changed(&RECIPE.replace("share 40%", "count 7"), &ways(0..50));
    assert_eq!(counted.iter().filter(|flag| matches!(flag, Some((0, _)))).count(), 7);
    assert_eq!(records[0].share, 0.14);
    assert_eq!(changed(RECIPE, &[]).0, []);
}
