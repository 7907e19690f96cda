//! Whole recipes in, specs and diagnostic codes out.

mod effects;

use std::fs;

use super::render_spec::{
    Amount, AreaSpec, AttributeValue, LayoutSpec, Lens, Origin, OutputSpec, RenderSpec, SetSpec, Split, StateSpec,
    SunPosition, ValueSpec,
};
use super::{draw::Distribution, dump_ast, load};
use crate::diagnostics::{Diagnostics, render};
use crate::source::{Access, SourceMap};

/// The sketch of the language's requirements.
const SKETCH: &str = r#"version 1

scene santa_rosa {
  seed       7
  map        "santa-rosa.osm.pbf"
  elevation  "santa-rosa.tif"
  area       center 38.4766, -122.7487  size 2km x 2km

  rules "rules/residential.cga"  for building[house | residential | detached | garage | apartments]
  rules "rules/industrial.cga"   for building            { wallHeight = 6 }
  rules "rules/street.cga"       for highway
  rules "rules/landcover.cga"    for landuse, natural, leisure
}

change burnt {
  of     building
  share  uniform(30%, 50%)
  rules  "rules/damage.cga"
}

camera satellite {
  size       3072 x 3072
  gsd        0.6m
  fov        30deg
  off_nadir  uniform(5deg, 10deg)
  azimuth    uniform(0deg, 360deg)
}

sun     { declination uniform(30deg, 140deg) }
effects { shadows soft   ambient sky }
quality { error 1% }

pass before { show all }
pass after  { show all  with burnt }
pass mask   { show only burnt  as class }

dataset syncw {
  views   satellite(off_nadir = 0deg), 4 * satellite
  layout  levir
}
"#;

/// A recipe with nothing but what is needed, and `more`.
fn small(more: &str) -> String {
    format!("scene s {{ map \"a.osm\" }}\ncamera c {{ size 64 x 64 }}\npass before {{ show all }}\n{more}")
}

fn load_files(files: &[(&str, &str)], arguments: &[(&str, &str)]) -> (Option<RenderSpec>, Diagnostics, SourceMap) {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("the temporary folder can be written");
    }
    let access = Access::new(folder.path()).expect("the folder exists");
    let mut sources = SourceMap::default();
    let arguments: Vec<(String, String)> = arguments.iter().map(|(n, v)| ((*n).into(), (*v).into())).collect();
    let path = folder.path().join(files[0].0).display().to_string();
    let (spec, diagnostics) = load(&path, &access, &mut sources, &arguments);
    (spec, diagnostics, sources)
}

#[track_caller]
fn loaded(text: &str) -> RenderSpec {
    let (spec, diagnostics, sources) = load_files(&[("r.render", text)], &[]);
    let shown: Vec<String> = diagnostics.iter().map(|d| render(d, &sources, false)).collect();
    spec.unwrap_or_else(|| panic!("{}", shown.join("\n")))
}

/// `code @ text under the span` of every diagnostic.
fn mistakes(text: &str) -> Vec<(&'static str, String)> {
    let (spec, diagnostics, sources) = load_files(&[("r.render", text)], &[]);
    assert_eq!(spec.is_none(), diagnostics.has_errors());
    let under = |d: &crate::diagnostics::Diagnostic| {
        sources.get(d.span.source).text[d.span.start as usize..d.span.end as usize].to_owned()
    };
    diagnostics.iter().map(|d| (d.code, under(d))).collect()
}

#[track_caller]
fn message(text: &str, code: &str) -> String {
    let (_, diagnostics, _) = load_files(&[("r.render", text)], &[]);
    let found: Vec<_> = diagnostics.iter().collect();
    assert_eq!(found.iter().map(|d| d.code).collect::<Vec<_>>(), [code], "{found:?}");
    format!("{} | {}", found[0].message, found[0].help.as_deref().unwrap_or(""))
}

#[test]
fn the_sketch_is_understood_whole() {
    let spec = loaded(SKETCH);
    let scene = &spec.scenes[0];
    assert_eq!((scene.seed, scene.rules.len(), scene.maps[0].written.as_str()), (7, 4, "santa-rosa.osm.pbf"));
    let area = AreaSpec::Around { latitude: 38.4766, longitude: -122.7487, width: 2000.0, height: 2000.0 };
    assert_eq!(scene.area, Some(area));
    let wall = AttributeValue::Value(ValueSpec::Number(Distribution::Fixed(6.0)));
    assert_eq!(scene.rules[1].attributes[0].value, wall);
    assert_eq!(spec.changes[0].amount, Amount::Share(Distribution::Uniform { low: 0.3, high: 0.5 }));
    let dataset = &spec.datasets[0];
    let names: Vec<&str> = dataset.views.iter().map(|view| view.name.as_str()).collect();
    assert_eq!(names[0], "santa_rosa_satellite_1");
    assert_eq!(names.len(), 5);
    assert_eq!(dataset.views[0].camera.off_nadir, Distribution::Fixed(0.0));
    assert_eq!(dataset.views[4].camera.off_nadir, Distribution::Uniform { low: 5.0, high: 10.0 });
    assert_eq!(spec.passes[1].state, StateSpec::After(vec![0]));
    assert_eq!(spec.passes[2].show, SetSpec::Change(0));
    assert_eq!(spec.passes[2].outputs, [(OutputSpec::Class, "mask".to_owned())]);
    assert!(matches!(dataset.sun.position, SunPosition::Arc { .. }));
    assert!(matches!(dataset.layout, LayoutSpec::Levir(_)));
    assert_eq!(spec.files().len(), 7);
}

#[test]
fn the_dump_reads_back_as_the_same_recipe() {
    let mut sources = SourceMap::default();
    let file = sources.add("a.render", SKETCH);
    let (once, _) = dump_ast(&file);
    let file = sources.add("b.render", once.as_str());
    let (twice, diagnostics) = dump_ast(&file);
    assert_eq!(once, twice);
    assert!(diagnostics.is_empty(), "{once}\n{diagnostics:?}");
    assert!(once.contains("views satellite(off_nadir = 0deg), 4 * satellite"), "{once}");
}

#[test]
fn one_recipe_shows_all_its_mistakes() {
    let text = "scene s {\n  map \"a.osm\"\n  seeed 7\n  area middle 3\n}\ncamera c {\n  gsd 0.6\n  fov 30 deg\n  \
                size 64 by 64\n}\ncamra d { }\npass p { show bulding }\n";
    let found: Vec<&str> = mistakes(text).iter().map(|(code, _)| *code).collect();
    assert_eq!(
        found,
        [
            "spec::unknown-property",
            "spec::syntax",
            "spec::missing-unit",
            "spec::syntax",
            "spec::syntax",
            "spec::unknown-block",
            "spec::unknown-name",
        ]
    );
}

#[test]
fn text_that_is_no_recipe_at_all_is_reported_and_what_follows_is_still_read() {
    let text =
        small("}}} ?\n%% what\ncamera d {\n gsd é\n fov \"open\n size ((64 x 64\n heading -5deg }\npass q { show }");
    let found = mistakes(&text);
    assert!(found.iter().filter(|(code, _)| *code == "spec::syntax").count() >= 4, "{found:?}");
    assert!(found.contains(&("spec::wrong-value", "show".to_owned())), "{found:?}");
    assert_eq!(mistakes(&small("pass q { show all"))[0], ("spec::syntax", "pass".to_owned()));
    assert_eq!(mistakes(&format!("scene s {{ area {} }}", "(".repeat(100_000)))[0].0, "spec::syntax");
}

#[test]
fn a_block_that_is_left_open_does_not_swallow_the_next_one() {
    for block in super::schema::BLOCKS {
        let text = format!("camera d {{ fov 30deg\n{} x {{\n}}\n", block.kind);
        let found = mistakes(&text);
        assert_eq!(found.iter().filter(|(code, _)| *code == "spec::syntax").count(), 1, "{text} {found:?}");
        assert!(!found.iter().any(|(code, _)| *code == "spec::unknown-property"), "{text} {found:?}");
    }
}

/// Cuts, repeats and swaps pieces of recipes: whatever comes out, checking it ends with diagnostics or a spec.
#[test]
fn no_text_makes_checking_panic() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let access = Access::new(folder.path()).expect("the folder exists");
    let path = folder.path().join("r.render");
    let source: Vec<char> = SKETCH.chars().collect();
    let rounds = std::env::var("MANSARD_FUZZ_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(100u64);
    for round in 0..rounds {
        let seed = crate::interpreter::seed::Seed::root(round);
        let mut text = source.clone();
        for step in 0..1 + round % 5 {
            let number = |name: &str, below: usize| (seed.part(step).named(name).unit() * below as f64) as usize;
            let from = number("from", text.len());
            let length = number("length", 40).min(text.len() - from);
            let piece: Vec<char> = match number("kind", 4) {
                0 => text.drain(from..from + length).collect(),
                1 => text[from..from + length].to_vec(),
                2 => ["{", "}", "(", "\"", "$x", "é", "1e999m", "x", "[", "!", "choice(", ",", "\n"]
                    [number("text", 13)]
                .chars()
                .collect(),
                _ => text[from..from + length].iter().rev().copied().collect(),
            };
            let at = number("at", text.len() + 1);
            text.splice(at..at, piece);
        }
        let text: String = text.into_iter().collect();
        fs::write(&path, &text).expect("the temporary folder can be written");
        let mut sources = SourceMap::default();
        let (spec, diagnostics) = load(&path.display().to_string(), &access, &mut sources, &[]);
        assert_eq!(spec.is_none(), diagnostics.has_errors(), "{text}");
        for diagnostic in diagnostics.iter() {
            render(diagnostic, &sources, false);
        }
        dump_ast(&sources.files()[0]);
    }
}

#[test]
fn names_that_were_meant_are_offered() {
    let text = small("dataset d { views sattelite\n layout levirr }").replace("camera c", "camera satellite");
    let (_, diagnostics, _) = load_files(&[("r.render", &text)], &[]);
    let help: Vec<_> = diagnostics.iter().filter_map(|d| d.help.as_deref()).collect();
    assert_eq!(help, ["did you mean `satellite`?", "did you mean `levir`?"]);
}

#[test]
fn a_number_without_a_unit_says_which_fits() {
    let found = message(&small("camera d { gsd 0.6 }"), "spec::missing-unit");
    assert_eq!(found, "`0.6` has no unit, but a length is due | write `0.6m`; these fit: `m`, `km`, `cm`, `mm`, `ft`");
    let found = message(&small("camera d { fov 30m }"), "spec::wrong-unit");
    assert_eq!(found, "`30m` is a length, but an angle is due | these fit: `deg`, `°`, `rad`");
    message(&small("camera d { fov 30furlongs }"), "spec::unknown-unit");
    message(&small("change x { of building\n share 0.3\n effect demolished }"), "spec::missing-unit");
}

#[test]
fn gsd_fov_altitude_and_size_that_contradict_are_shown_with_the_numbers() {
    let found = message(
        &small("camera d { size 3072 x 3072; gsd 0.6m; fov 30deg; altitude 1000m }"),
        "spec::camera-contradiction",
    );
    assert_eq!(
        found,
        "size, gsd, fov and altitude contradict each other: 3072 pixels of 0.6m under 30deg need an altitude of \
         3439.5m, but it is 1000m | leave one out, or take gsd 0.17445m, or fov 85.327deg"
    );
    loaded(&small("camera d { size 3072 x 3072; gsd 0.6m; fov 30deg; altitude 3439m }"));
    message(&small("camera d { gsd 0.6m; fov uniform(20deg, 30deg); altitude 900m }"), "spec::over-determined");
    message(&small("camera d { projection orthographic; gsd 0.6m; fov 30deg }"), "spec::over-determined");
}

#[test]
fn what_a_camera_leaves_open_follows_or_has_a_default() {
    let lens = |properties: &str| {
        let spec = loaded(&small(&format!("camera d {{ {properties} }}\ndataset x {{ views d }}")));
        let camera = &spec.datasets[0].views[0].camera;
        (camera.lens.clone(), camera.width)
    };
    let fixed = Distribution::Fixed;
    assert_eq!(lens(""), (Lens::GsdFov { gsd: fixed(0.6), fov: fixed(30.0) }, 1024));
    assert_eq!(lens("altitude 1km"), (Lens::FovAltitude { fov: fixed(30.0), altitude: fixed(1000.0) }, 1024));
    assert_eq!(lens("altitude 1km; gsd 50cm"), (Lens::GsdAltitude { gsd: fixed(0.5), altitude: fixed(1000.0) }, 1024));
    // 2 · 1000 · tan 45° / 2
    assert_eq!(lens("altitude 1km; gsd 2m; fov 90deg").1, 1000);
}

#[test]
fn the_sun_must_stand_above_the_horizon() {
    for sun in ["elevation -5deg", "elevation uniform(-1deg, 40deg)", "elevation normal(20deg, 7deg)", "elevation 0deg"]
    {
        message(&small(&format!("sun {{ {sun} }}")), "spec::sun-below-horizon");
    }
    let found = message(&small("sun { declination uniform(30deg, 200deg) }"), "spec::sun-below-horizon");
    assert!(found.contains("20deg below it"), "{found}");
    loaded(&small("sun { elevation uniform(1deg, 90deg); azimuth uniform(0deg, 360deg) }"));
    message(&small("sun { elevation 30deg; declination 40deg }"), "spec::over-determined");
    message(&small("sun { date 2019-06-21; time 18:30Z }").replace("; time 18:30Z", ""), "spec::not-supported-yet");
}

#[test]
fn every_part_of_the_language_that_is_not_evaluated_says_so() {
    for text in [
        "scene t { map \"a.osm\"\n imagery \"o.tif\" }",
        "camera d { target center jitter 10m }",
        "camera d { projection true_ortho }",
        "camera d { position offset(east = 10m, north = 5m, up = 900m) }",
        "camera d { clip near 10m far 5km }",
        "sun { time 18:30+02:00 }",
        "sun { place 38.4, -122.7 }",
        "pass p { show all as normal }",
        "pass p { show building[house] }",
        "change x { of building\n within bbox 1, 2, 3, 4\n effect built }",
        "dataset d { views c\n tiles 512 x 512 overlap 64 }",
        "dataset d { views c\n format png16 }",
        "dataset d { views c\n correction ortho }",
        "dataset d { views c\n layout xbd }",
    ] {
        message(&small(text), "spec::not-supported-yet");
    }
}

#[test]
fn blocks_extend_others_and_come_from_other_files() {
    let main = "use \"cameras.render\"\nscene s { map \"a.osm\"; rules \"x.cga\" for building }\n\
                scene t : s { seed 8; map \"b.osm\", \"c.osm\" }\npass before { show all }\n\
                dataset d { views low, high\n scenes t, s }";
    let cameras = "use \"r.render\"\ncamera high { size 64 x 32; gsd 1m; fov 20deg }\n\
                   camera low : high { gsd auto; altitude 300m }";
    let (spec, diagnostics, _) = load_files(&[("r.render", main), ("cameras.render", cameras)], &[]);
    let spec = spec.unwrap_or_else(|| panic!("{diagnostics:?}"));
    let views = &spec.datasets[0].views;
    let names: Vec<&str> = views.iter().map(|view| view.name.as_str()).collect();
    assert_eq!(names, ["t_low_1", "t_high_1", "s_low_1", "s_high_1"]);
    assert_eq!(views[0].camera.height, 32);
    assert!(matches!(views[0].camera.lens, Lens::FovAltitude { .. }));
    assert_eq!((spec.scenes[1].maps.len(), spec.scenes[1].rules.len(), spec.scenes[1].seed), (2, 1, 8));
    assert_eq!(mistakes("camera a : b { }\ncamera b : a { }")[0].0, "spec::circular-extension");
    assert_eq!(mistakes("camera a : nothing { }")[0].0, "spec::unknown-name");
}

#[test]
fn inputs_are_bound_on_the_command_line() {
    let text = "input map : files\ninput window : value = -122.7, 38.4, -122.6, 38.5\ninput side : value = 64\n\
                scene s { map $map; area bbox $window }\ncamera c { size $side x $side }\npass before { show all }";
    let (spec, diagnostics, _) =
        load_files(&[("r.render", text)], &[("map", "/data/a.osm.pbf, b.osm"), ("side", "9px")]);
    let spec = spec.unwrap_or_else(|| panic!("{diagnostics:?}"));
    let maps: Vec<_> = spec.scenes[0].maps.iter().map(|map| (map.written.as_str(), &map.origin)).collect();
    assert_eq!(maps, [("/data/a.osm.pbf", &Origin::CommandLine), ("b.osm", &Origin::CommandLine)]);
    assert_eq!(
        spec.scenes[0].area,
        Some(AreaSpec::BoundingBox { west: -122.7, south: 38.4, east: -122.6, north: 38.5 })
    );
    let codes = |arguments: &[(&str, &str)]| {
        let (_, diagnostics, sources) = load_files(&[("r.render", text)], arguments);
        let place = |d: &crate::diagnostics::Diagnostic| sources.get(d.span.source).name.to_string();
        diagnostics.iter().map(|d| (d.code, place(d).starts_with("--set"))).collect::<Vec<_>>()
    };
    assert_eq!(codes(&[]), [("spec::missing-input", false)]);
    assert_eq!(codes(&[("map", "a"), ("sidee", "3")]), [("spec::unknown-input", true)]);
    assert_eq!(codes(&[("map", "a"), ("side", "many")]), [("spec::wrong-value", true); 1]);
    assert_eq!(codes(&[("map", "a"), ("window", "1, 2, 3")]), [("spec::wrong-value", false)]);
    assert_eq!(codes(&[("map", "a"), ("window", "} {")]), [("spec::syntax", true)]);
}

#[test]
fn a_recipe_with_open_inputs_can_be_checked() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("r.render");
    let text = small("input seed : value\ninput cut : value\nscene t { map $seed; seed $seed; area bbox $cut }");
    fs::write(&path, text).expect("the temporary folder can be written");
    let access = Access::new(folder.path()).expect("the folder exists");
    let found = super::check(&path.display().to_string(), &access, &mut SourceMap::default(), &[]);
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn changes_have_levels_and_need_something_to_do() {
    let spec = loaded(&small(
        "change fire { of building, way/12\n count 5\n non_target\n level minor share 70% rules \"mansard:damage.cga\" \
         { ash = 20% }\n level gone share 30% effect demolished }",
    ));
    let change = &spec.changes[0];
    assert_eq!((change.levels.len(), change.non_target), (2, true));
    assert_eq!(change.levels[1].weight, 0.3);
    let files: Vec<_> = spec.files().iter().map(|file| (file.written.as_str(), file.origin.clone())).collect();
    assert_eq!(files[1], ("damage.cga", Origin::Shipped));
    message(&small("change fire { of building }"), "spec::missing-property");
    message(&small("change fire { of building\n share 30%\n count 3\n effect built }"), "spec::over-determined");
    message(&small("change fire { of building\n share uniform(90%, 110%)\n effect built }"), "spec::out-of-range");
    message(&small("change building { of building\n effect built }"), "spec::reserved-name");
}

#[test]
fn passes_show_sets_in_states() {
    let spec = loaded(&small(
        "change fire { of building; effect demolished }\nchange paint { of building; effect built; non_target }\n\
         pass p { show (building | highway) & !fire, terrain with fire as colour, depth\n acquisition second redraw sun }\n\
         pass q { show all with both mark changed as mask\n shadows off }\npass r { show only fire with both(fire) as mask }",
    ));
    let p = &spec.passes[1];
    assert_eq!(p.state, StateSpec::After(vec![0]));
    assert!(matches!(&p.show, SetSpec::Any(sets) if sets.len() == 2), "{:?}", p.show);
    let images: Vec<&str> = p.outputs.iter().map(|(_, name)| name.as_str()).collect();
    assert_eq!(images, ["p_colour", "p_depth"]);
    let acquisition = p.acquisition.as_ref().expect("given");
    assert_eq!((acquisition.camera, acquisition.sun), (false, true));
    assert_eq!(spec.passes[2].state, StateSpec::Both(vec![0, 1]));
    assert_eq!(spec.passes[2].mark, Some(SetSpec::Changed));
    assert_eq!(spec.passes[3].state, StateSpec::Both(vec![0]));
    message(&small("pass p { show all mark changed }"), "spec::wrong-value");
    message(&small("pass p { show all with fier }"), "spec::unknown-name");
}

#[test]
fn datasets_split_by_scene_and_check_their_layout() {
    let passes = "pass after { show all }\npass mask { show all as mask }\nscene t : s { seed 1 }\n";
    let spec =
        loaded(&small(&format!("{passes}dataset d {{ views 2 * c\n split train s test t\n layout levir_flat }}")));
    let splits: Vec<Split> = spec.datasets[0].views.iter().map(|view| view.split).collect();
    assert_eq!(splits, [Split::Train, Split::Train, Split::Test, Split::Test]);
    let found = message(
        &small("dataset d { views c; layout levir(a = before, b = before, label = mask) }"),
        "spec::unknown-name",
    );
    assert!(found.starts_with("there is no image `mask`"), "{found}");
    let text = format!("{passes}dataset d {{ views c; layout levir(label = after) }}");
    message(&small(&text), "spec::wrong-value");
    message(
        &small("sun a { elevation 3deg }\nsun b { elevation 4deg }\ndataset d { views c }"),
        "spec::ambiguous-block",
    );
    message(&small("dataset d { views 0 * c }"), "spec::out-of-range");
}

#[test]
fn values_of_attributes_and_missing_tags() {
    let spec = loaded(&small(
        "scene t { map \"a.osm\"\n rules \"mansard:building.cga\" start Lot for building[yes & height > 3m] {\n \
         height = tag(\"building:height\", 6m), colour = choice(70%: \"#fff\", 30%: \"#000\"), flat = true\n \
         angle = uniform(20deg, 30deg) }\n missing building[house] { height = normal(6m, 1m); \"building:levels\" = 2 } }",
    ));
    let scene = &spec.scenes[1];
    assert_eq!(scene.rules[0].start.as_deref(), Some("Lot"));
    assert_eq!(scene.rules[0].attributes.len(), 4);
    let default = Some(ValueSpec::Number(Distribution::Fixed(6.0)));
    assert_eq!(scene.rules[0].attributes[0].value, AttributeValue::Tag { key: "building:height".into(), default });
    let tags: Vec<&str> = scene.missing.iter().map(|missing| missing.tag.as_str()).collect();
    assert_eq!(tags, ["height", "building:levels"]);
    let found = message(&small("scene t { map \"a.osm\"; missing { roof = gabled } }"), "spec::wrong-value");
    assert!(found.ends_with("a text is written `\"gabled\"`"), "{found}");
}

#[test]
fn places_and_areas_are_checked() {
    for (area, code) in [
        ("center -122.7, 38.4 size 2km x 2km", "spec::out-of-range"),
        ("bbox -122.6, 38.4, -122.7, 38.5", "spec::wrong-value"),
        ("bbox 1, 2, 3", "spec::wrong-value"),
        ("center 1, 2", "spec::wrong-value"),
        ("polygon (1, 2), (3, 4)", "spec::wrong-value"),
        ("center 1, 2 size 2 x 2", "spec::missing-unit"),
        ("center 1, 2 size 0m", "spec::out-of-range"),
    ] {
        let (_, diagnostics, _) =
            load_files(&[("r.render", &small(&format!("scene t {{ map \"a.osm\"; area {area} }}")))], &[]);
        assert!(diagnostics.iter().all(|d| d.code == code) && diagnostics.has_errors(), "{area} {diagnostics:?}");
    }
    loaded(&small("scene t { map \"a.osm\"; area polygon (1, 2), (3, 4), (5deg, 6deg) }"));
}

#[test]
fn files_that_cannot_be_used_are_reported_where_they_are_named() {
    let codes =
        |text: &str| mistakes(text).into_iter().map(|(code, under)| format!("{code} {under}")).collect::<Vec<_>>();
    assert_eq!(codes("use \"no.render\"\nscene s { map \"a.osm\" }"), ["spec::unreadable-file \"no.render\""]);
    assert_eq!(
        codes("use \"../../x.render\"\nscene s { map \"a.osm\" }"),
        ["spec::unreadable-file \"../../x.render\""]
    );
    assert_eq!(codes("pass p { show all }"), ["spec::missing-block "]);
    assert_eq!(codes("version 2\nscene s { map \"a.osm\" }"), ["spec::unknown-version 2"]);
    let (spec, diagnostics) =
        load("/no/such.render", &Access::new("/".as_ref()).expect("there is a root"), &mut SourceMap::default(), &[]);
    assert!(spec.is_none() && diagnostics.iter().any(|d| d.code == "spec::unreadable-file"));
}

/// A recipe of the repository.
fn example(path: &str, arguments: &[(&str, &str)]) -> (Option<RenderSpec>, Diagnostics) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(path);
    let access = Access::new(path.parent().expect("a file has a folder")).expect("the folder is there");
    let arguments: Vec<(String, String)> = arguments.iter().map(|(n, v)| ((*n).into(), (*v).into())).collect();
    load(&path.display().to_string(), &access, &mut SourceMap::default(), &arguments)
}

#[test]
fn the_examples_load() {
    let (spec, diagnostics) = example("riverside/riverside.render", &[]);
    let spec = spec.unwrap_or_else(|| panic!("{diagnostics:?}"));
    assert_eq!((spec.scenes[0].rules.len(), spec.datasets[0].views.len()), (5, 3));
    let (spec, diagnostics) = example("effects/hazeldown.render", &[]);
    let spec = spec.unwrap_or_else(|| panic!("{diagnostics:?}"));
    assert!(spec.datasets[0].effects.vegetation && spec.passes[3].effects.sensor.is_some());
    let inputs = [("map", "a.osm,b.osm"), ("elevation", "c.tif"), ("window", "-122.7240,38.4182,-122.7010,38.4362")];
    let (spec, diagnostics) = example("syncw/syncw.render", &inputs);
    let spec = spec.unwrap_or_else(|| panic!("{diagnostics:?}"));
    let dataset = &spec.datasets[0];
    assert_eq!((spec.scenes[0].maps.len(), dataset.views.len(), dataset.views[0].camera.width), (2, 5, 3072));
    assert_eq!(spec.passes[1].acquisition, spec.passes[2].acquisition);
    let small = [inputs.as_slice(), &[("side", "64"), ("inclined", "1"), ("redraw", "sun")]].concat();
    let spec = example("syncw/syncw.render", &small).0.expect("the inputs are good");
    assert_eq!((spec.datasets[0].views.len(), spec.datasets[0].views[1].camera.height), (2, 64));
    let (none, diagnostics) = example("syncw/syncw.render", &[]);
    assert!(none.is_none() && diagnostics.iter().all(|d| d.code == "spec::missing-input"), "{diagnostics:?}");
    assert_eq!(diagnostics.iter().count(), 3);
}
