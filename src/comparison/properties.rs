//! Properties of recipes. In: a checked [`RenderSpec`]. Out: every property by its path, with its value as text in the
//! recipe's units; and what differs between two lists of them. Places in the text are not part of a value. Structures are
//! taken apart by name, so that a new field does not compile until it is told here.

mod values;

use std::collections::BTreeMap;

use serde::Serialize;

pub use values::file_text;
use values::{amount, angle, area, effects, filter, lens, overrides, quality, rule_key, set, state, sun, value};

use crate::spec::render_spec::{
    AcquisitionSpec, AttributeSpec, AttributeValue, CameraSpec, ChangeSpec, DatasetSpec, LayoutSpec, LevelEffect,
    LevelSpec, MissingTag, OutputSpec, PassSpec, RenderSpec, RuleAssignment, SceneSpec, ViewSpec,
};

/// A property that differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PropertyDifference {
    /// Views that differ alike are one path with `*` in place of their names.
    pub path: String,
    /// `None` where the side does not have it.
    pub a: Option<String>,
    pub b: Option<String>,
    /// How many views differ alike; 1 for what is not about views.
    pub times: usize,
}

/// A list of properties in the order of the recipe.
type Properties = Vec<(String, String)>;

/// Every property of a recipe.
pub fn properties(spec: &RenderSpec) -> Properties {
    let RenderSpec { scenes, changes, passes, datasets } = spec;
    let mut out = Properties::new();
    scenes.iter().for_each(|scene| of_scene(scene, &mut out));
    changes.iter().for_each(|change| of_change(change, &mut out));
    passes.iter().for_each(|pass| of_pass(pass, spec, &mut out));
    datasets.iter().for_each(|dataset| of_dataset(dataset, spec, &mut out));
    let names = |names: Vec<&str>| names.join(", ");
    // Of changes that draw one object the first has it, and images follow the order of passes.
    out.push(("order of changes".to_owned(), names(changes.iter().map(|c| c.name.as_str()).collect())));
    out.push(("order of passes".to_owned(), names(passes.iter().map(|p| p.name.as_str()).collect())));
    out
}

fn of_scene(scene: &SceneSpec, out: &mut Properties) {
    let SceneSpec { name, span: _, seed, maps, elevations, area: extent, rules, missing } = scene;
    let at = format!("scene {name}");
    let files = |files: &[_]| files.iter().map(file_text).collect::<Vec<_>>().join(", ");
    out.push((format!("{at}.seed"), seed.to_string()));
    out.push((format!("{at}.map"), files(maps)));
    out.push((format!("{at}.elevation"), files(elevations)));
    out.push((format!("{at}.area"), extent.as_ref().map_or("the bounds of the maps".to_owned(), area)));
    of_rules(&at, rules, out);
    for MissingTag { filter: of, tag, value: fill, span: _ } in missing {
        out.push((format!("{at}.missing {tag} for {}", filter(of)), value(fill)));
    }
}

fn of_rules(at: &str, rules: &[RuleAssignment], out: &mut Properties) {
    let mut order = Vec::new();
    for rule in rules {
        let RuleAssignment { file: _, start, filter: _, attributes, span: _ } = rule;
        let key = rule_key(rule);
        out.push((format!("{at}.rules {key}"), start.clone().unwrap_or_else(|| "own start rule".to_owned())));
        for AttributeSpec { name, value: given, span: _ } in attributes {
            let text = match given {
                AttributeValue::Value(given) => value(given),
                AttributeValue::Tag { key, default: None } => format!("tag(\"{key}\")"),
                AttributeValue::Tag { key, default: Some(default) } => format!("tag(\"{key}\", {})", value(default)),
            };
            out.push((format!("{at}.rules {key}.{name}"), text));
        }
        order.push(key);
    }
    out.push((format!("{at}.order of rules"), order.join("; ")));
}

fn of_change(change: &ChangeSpec, out: &mut Properties) {
    let ChangeSpec { name, span: _, of, amount: how_many, levels, non_target } = change;
    let at = format!("change {name}");
    out.push((format!("{at}.of"), filter(of)));
    out.push((format!("{at}.amount"), amount(how_many)));
    out.push((format!("{at}.non_target"), non_target.to_string()));
    for (number, level) in levels.iter().enumerate() {
        let LevelSpec { name: called, weight, effect, span: _ } = level;
        let at = if levels.len() > 1 { format!("{at}.level {}", number + 1) } else { at.clone() };
        out.push((format!("{at}.name"), called.clone()));
        out.push((format!("{at}.share"), weight.to_string()));
        match effect {
            LevelEffect::Rules(rules) => of_rules(&at, rules, out),
            LevelEffect::Demolished => out.push((format!("{at}.effect"), "demolished".to_owned())),
            LevelEffect::Built => out.push((format!("{at}.effect"), "built".to_owned())),
        }
    }
}

fn of_pass(pass: &PassSpec, spec: &RenderSpec, out: &mut Properties) {
    let PassSpec { name, span: _, show, state: seen, mark, outputs, effects: own, acquisition } = pass;
    let at = format!("pass {name}");
    out.push((format!("{at}.show"), set(show, spec)));
    out.push((format!("{at}.with"), state(seen, spec)));
    out.push((format!("{at}.mark"), mark.as_ref().map_or("everything shown".to_owned(), |mark| set(mark, spec))));
    let word = |output: &OutputSpec| format!("{output:?}").to_lowercase();
    let outputs: Vec<String> = outputs.iter().map(|(output, image)| format!("{} as {image}", word(output))).collect();
    out.push((format!("{at}.outputs"), outputs.join(", ")));
    let taken = acquisition.as_ref().map_or("the view's own".to_owned(), |acquisition| {
        let AcquisitionSpec { name, camera, sun, effects } = acquisition;
        let redrawn = [(camera, "camera"), (sun, "sun"), (effects, "effects")];
        let redrawn: Vec<&str> = redrawn.iter().filter(|(anew, _)| **anew).map(|(_, what)| *what).collect();
        format!("{name}, redraws {}", redrawn.join(", "))
    });
    out.push((format!("{at}.acquisition"), taken));
    overrides(&at, own, out);
}

fn of_dataset(dataset: &DatasetSpec, spec: &RenderSpec, out: &mut Properties) {
    let DatasetSpec { name, span: _, views, passes, sun: light, effects: with, quality: fine, layout } = dataset;
    let at = format!("dataset {name}");
    for view in views {
        of_view(&at, view, spec, out);
    }
    let passes: Vec<&str> = passes.iter().map(|&pass| spec.passes[pass].name.as_str()).collect();
    out.push((format!("{at}.passes"), passes.join(", ")));
    let layout = match layout {
        LayoutSpec::Plain => "plain".to_owned(),
        LayoutSpec::Levir(pair) => format!("levir({}, {}, {})", pair.a, pair.b, pair.label),
        LayoutSpec::LevirFlat(pair) => format!("levir_flat({}, {}, {})", pair.a, pair.b, pair.label),
    };
    out.push((format!("{at}.layout"), layout));
    sun(&format!("{at}.sun"), light, out);
    effects(&format!("{at}.effects"), with, out);
    quality(&format!("{at}.quality"), fine, out);
}

/// Stands between the names of a dataset and a view.
const VIEW: &str = ".view ";

fn of_view(at: &str, view: &ViewSpec, spec: &RenderSpec, out: &mut Properties) {
    let ViewSpec { name, scene, camera, number: which, split } = view;
    let CameraSpec { name: taken, span: _, width, height, lens: optics, off_nadir, azimuth, heading } = camera;
    let mut add = |what: &str, value: String| out.push((format!("{at}{VIEW}{name}.{what}"), value));
    add("scene", spec.scenes[*scene].name.clone());
    add("camera", format!("{taken} {which}"));
    add("split", split.name().to_owned());
    add("size", format!("{width} x {height}"));
    lens(optics).into_iter().for_each(|(what, value)| add(what, value));
    add("off_nadir", angle(off_nadir));
    add("azimuth", angle(azimuth));
    add("heading", angle(heading));
}

/// What differs, in the order of B, what B lacks last.
pub fn compare_properties(a: &[(String, String)], b: &[(String, String)]) -> Vec<PropertyDifference> {
    let of_a: BTreeMap<&str, &str> = a.iter().map(|(path, value)| (path.as_str(), value.as_str())).collect();
    let of_b: BTreeMap<&str, &str> = b.iter().map(|(path, value)| (path.as_str(), value.as_str())).collect();
    let gone = a.iter().filter(|(path, _)| !of_b.contains_key(path.as_str()));
    let mut out: Vec<PropertyDifference> = Vec::new();
    for (path, _) in b.iter().chain(gone) {
        let [a, b] = [&of_a, &of_b].map(|side| side.get(path.as_str()).map(|value| (*value).to_owned()));
        // That something came or went says where it stands already.
        let told = path.contains("order of ") && hold_other_names(&a, &b);
        if a == b || told {
            continue;
        }
        let path = without_view(path);
        match out.iter_mut().find(|known| known.path == path && known.a == a && known.b == b) {
            Some(known) => known.times += 1,
            None => out.push(PropertyDifference { path, a, b, times: 1 }),
        }
    }
    out
}

/// Whether two lists do not hold the same names.
fn hold_other_names(a: &Option<String>, b: &Option<String>) -> bool {
    let names = |list: &Option<String>| {
        let mut names: Vec<String> =
            list.iter().flat_map(|l| l.split([';', ','])).map(|name| name.trim().to_owned()).collect();
        names.sort();
        names
    };
    names(a) != names(b)
}

fn without_view(path: &str) -> String {
    let Some((dataset, rest)) = path.split_once(VIEW) else { return path.to_owned() };
    rest.split_once('.').map_or_else(|| path.to_owned(), |(_, tail)| format!("{dataset}{VIEW}*.{tail}"))
}
