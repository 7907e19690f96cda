//! A difference as text for people: what matters first, lists cut short.

use std::fmt::Write;

use super::difference::{Difference, ImageDifference, SceneDifference};
use super::meshes::{FeatureMeshes, Surface};
use super::pixels::{FAINT, Kind};
use super::rules::{Fate, FileDifference};
use super::views::{DrawDifference, ViewsDifference};

/// Lines of a list before it is cut.
const MOST: usize = 8;

/// The whole report; the last line says `same` or `different`.
pub fn difference_text(of: &Difference) -> String {
    let mut out = format!("A  {}\nB  {}\n\n", of.a, of.b);
    inputs(&mut out, of);
    recipe(&mut out, of);
    rules(&mut out, of);
    for scene in &of.scenes {
        let several = of.scenes.len() > 1;
        features(&mut out, scene, several);
        meshes(&mut out, scene, several);
    }
    of.views.iter().for_each(|views| draws(&mut out, views, of.views.len() > 1));
    images(&mut out, of);
    let _ = write!(out, "\n{}\n", if of.same { "same" } else { "different" });
    out
}

fn section(out: &mut String, name: &str, summary: &str) {
    let _ = writeln!(out, "{name:<10} {summary}");
}

/// Lines under a section, the first few of them.
fn list<T>(out: &mut String, items: &[T], line: impl Fn(&T) -> String) {
    for item in items.iter().take(MOST) {
        let _ = writeln!(out, "  {}", line(item));
    }
    if items.len() > MOST {
        let _ = writeln!(out, "  … and {} more", items.len() - MOST);
    }
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// `2 changed, 1 added`.
fn fates(all: impl Iterator<Item = Fate> + Clone) -> String {
    let count = |fate: Fate| all.clone().filter(|f| *f == fate).count();
    let words = [
        (Fate::Changed, "changed"),
        (Fate::Added, "added"),
        (Fate::Removed, "removed"),
        (Fate::Annotated, "annotated anew"),
    ];
    let told: Vec<String> = words
        .iter()
        .map(|(fate, word)| (count(*fate), word))
        .filter(|(n, _)| *n > 0)
        .map(|(n, word)| format!("{n} {word}"))
        .collect();
    told.join(", ")
}

fn mark(fate: Fate) -> char {
    match fate {
        Fate::Changed | Fate::Annotated => '~',
        Fate::Added => '+',
        Fate::Removed => '-',
    }
}

fn inputs(out: &mut String, of: &Difference) {
    let changed = fates(of.inputs.iter().filter_map(|input| input.fate));
    let renamed = of.inputs.iter().filter(|input| input.fate.is_none()).count();
    let renamed = if renamed > 0 { format!("{renamed} renamed") } else { String::new() };
    let parts: Vec<&str> = [changed.as_str(), &renamed].into_iter().filter(|part| !part.is_empty()).collect();
    section(out, "inputs", &if parts.is_empty() { "same".to_owned() } else { parts.join(", ") });
    let short =
        |sha256: &Option<String>| sha256.as_ref().map_or(String::new(), |sha256| sha256.chars().take(12).collect());
    list(out, &of.inputs, |input| {
        let was = input.was.as_ref().map_or(String::new(), |was| format!("{was} → "));
        let hashes = match input.fate {
            Some(Fate::Changed) => format!("  {} → {}", short(&input.sha256_a), short(&input.sha256_b)),
            _ => String::new(),
        };
        let mark = input.fate.map_or('=', mark);
        format!("{mark} {:<10}{was}{}{hashes}", input.role, input.name)
    });
    if !of.arguments.is_empty() {
        section(out, "arguments", &counted(of.arguments.len(), "argument"));
        let value = |value: &Option<String>| value.clone().unwrap_or_else(|| "not given".to_owned());
        list(out, &of.arguments, |(name, a, b)| format!("{name}  {} → {}", value(a), value(b)));
    }
}

fn recipe(out: &mut String, of: &Difference) {
    let Some(properties) = &of.recipe else {
        section(out, "recipe", "not compared: a dataset does not hold its recipe's text");
        return;
    };
    let summary = if properties.is_empty() { "same".to_owned() } else { properties_count(properties.len()) };
    section(out, "recipe", &summary);
    list(out, properties, |property| {
        let times = if property.times > 1 { format!(", in {} views", property.times) } else { String::new() };
        match (&property.a, &property.b) {
            (Some(a), Some(b)) => format!("~ {}  {a} → {b}{times}", property.path),
            (None, Some(b)) => format!("+ {}  {b}{times}", property.path),
            (Some(a), None) => format!("- {}  {a}{times}", property.path),
            (None, None) => property.path.clone(),
        }
    });
}

fn properties_count(n: usize) -> String {
    format!("{n} {}", if n == 1 { "property differs" } else { "properties differ" })
}

fn rules(out: &mut String, of: &Difference) {
    let Some(files) = &of.rules else {
        section(out, "rules", "not compared: a dataset does not hold its rules' texts");
        return;
    };
    let told: Vec<&FileDifference> = files.iter().filter(|file| !file.is_layout_only()).collect();
    let layout = files.len() - told.len();
    if told.is_empty() {
        let only = format!("same; only comments, layout or order differ in {}", counted(layout, "file"));
        section(out, "rules", if layout == 0 { "same" } else { &only });
        return;
    }
    let all = told.iter().flat_map(|file| &file.declarations).map(|declaration| declaration.fate);
    section(out, "rules", &format!("{} in {}", fates(all), counted(told.len(), "file")));
    for file in told.iter().take(MOST) {
        let was = file.was.as_ref().map_or(String::new(), |was| format!("{was} → "));
        let _ = writeln!(out, "  {} {was}{}", mark(file.fate), file.file);
        if file.fate != Fate::Changed {
            continue;
        }
        let mut below = String::new();
        list(&mut below, &file.declarations, |d| {
            let line = match (d.line_a, d.line_b) {
                (Some(a), Some(b)) if a == b => format!("line {a}"),
                (Some(a), Some(b)) => format!("line {a} → {b}"),
                (Some(a), None) => format!("line {a} of A"),
                (None, Some(b)) => format!("line {b}"),
                (None, None) => String::new(),
            };
            let note = if d.fate == Fate::Annotated { ", annotations" } else { "" };
            format!("{} {} {}, {line}{note}", mark(d.fate), d.what, d.name)
        });
        for line in below.lines() {
            let _ = writeln!(out, "  {line}");
        }
    }
    if told.len() > MOST {
        let _ = writeln!(out, "  … and {} more files", told.len() - MOST);
    }
}

/// The section's name with the scene's where there are several.
fn named(name: &str, scene: &str, several: bool) -> String {
    if several { format!("{name} {scene}") } else { name.to_owned() }
}

fn features(out: &mut String, scene: &SceneDifference, several: bool) {
    let found = &scene.features;
    let name = named("features", &scene.scene, several);
    if let Some(side) = scene.only {
        section(out, &name, &format!("the scene is only in {}", side.to_uppercase()));
    }
    if found.is_none() {
        section(out, &name, &format!("same ({})", found.count_b));
        return;
    }
    let (all, shared) = (fates(found.features.iter().map(|f| f.fate)), found.count_b - found.count(Fate::Added));
    let all = if all.is_empty() { "the same features".to_owned() } else { all };
    section(out, &name, &format!("{all} (A has {}, B {}, {shared} in both)", found.count_a, found.count_b));
    let share = |share: &Option<f64>| share.map_or("none".to_owned(), |s| format!("{:.2} %", 100.0 * s));
    list(out, &found.shares, |(change, a, b)| format!("~ change {change}: share drawn {} → {}", share(a), share(b)));
    list(out, &found.features, |feature| {
        let differs: Vec<String> = feature.differs.iter().map(|(what, a, b)| format!("{what} {a} → {b}")).collect();
        format!("{} {} ({})  {}", mark(feature.fate), feature.feature, feature.class, differs.join("; "))
            .trim_end()
            .to_owned()
    });
}

fn meshes(out: &mut String, scene: &SceneDifference, several: bool) {
    let found = &scene.meshes;
    let name = named("meshes", &scene.scene, several);
    let order = match found.reordered {
        0 => String::new(),
        n => format!("; {} in another order", counted(n, "mesh").replace("meshs", "meshes")),
    };
    if found.is_none() {
        section(out, &name, &format!("same ({} features, {} triangles{order})", found.compared, found.triangles_b));
        return;
    }
    let count = |state: fn(&FeatureMeshes) -> Surface| found.features.iter().filter(|f| !state(f).is_same()).count();
    let (before, after) = (count(|f| f.before), count(|f| f.after));
    let ground = if found.ground.is_some() { ", and the ground" } else { "" };
    section(
        out,
        &name,
        &format!(
            "{} of {} features differ ({before} before, {after} after){ground}; {} → {} triangles{order}",
            found.features.len(),
            found.compared,
            found.triangles_a,
            found.triangles_b
        ),
    );
    list(out, &found.features, |f| format!("~ {} ({})  {}", f.feature, f.class, both_states(f)));
    if let Some(ground) = &found.ground {
        let _ = writeln!(out, "  ~ ground  {}", both_states(ground));
    }
}

fn both_states(of: &FeatureMeshes) -> String {
    match (of.before.is_same(), of.after.is_same()) {
        _ if of.before == of.after => surface(of.before),
        (true, _) => format!("after: {}", surface(of.after)),
        (_, true) => format!("before: {}", surface(of.before)),
        _ => format!("before: {}; after: {}", surface(of.before), surface(of.after)),
    }
}

/// How a surface differs.
pub fn surface(surface: Surface) -> String {
    match surface {
        Surface::Same => "same".to_owned(),
        Surface::Reordered => "the same in another order".to_owned(),
        Surface::Look { triangles } => {
            format!("materials, normals or texture coordinates of {}", counted(triangles, "triangle"))
        }
        Surface::Shape { triangles_a, moved_m: Some(moved_m), .. } => {
            format!("moved by up to {}, {}", metres(moved_m), counted(triangles_a, "triangle"))
        }
        Surface::Shape { triangles_a: 0, triangles_b, .. } => format!("new, {}", counted(triangles_b, "triangle")),
        Surface::Shape { triangles_a, triangles_b: 0, .. } => format!("gone, {}", counted(triangles_a, "triangle")),
        Surface::Shape { triangles_a, triangles_b, gone, new, .. } => {
            format!("{triangles_a} → {triangles_b} triangles ({gone} gone, {new} new)")
        }
    }
}

fn metres(m: f64) -> String {
    if m >= 0.01 { format!("{m:.2} m") } else { format!("{m:.1e} m") }
}

fn draws(out: &mut String, views: &ViewsDifference, several: bool) {
    let name = named("draws", &views.dataset, several);
    if views.is_none() {
        section(out, &name, &format!("same ({})", counted(views.compared, "view")));
        return;
    }
    let mut of: Vec<&str> = views.draws.iter().chain(&views.acquisitions).map(|draw| draw.view.as_str()).collect();
    of.sort_unstable();
    of.dedup();
    section(out, &name, &format!("{} views differ of {} in both", of.len(), views.compared));
    list(out, &views.removed, |view| format!("- {view}"));
    list(out, &views.added, |view| format!("+ {view}"));
    // What follows from draws is told where nothing else explains it.
    let told = if views.draws.is_empty() { &views.acquisitions } else { &views.draws };
    list(out, &alike(told), |(draw, count)| {
        let others = if *count > 1 { format!(", and in {}", counted(count - 1, "more view")) } else { String::new() };
        format!("~ {}  {} → {}  ({}{others})", draw.path, number(&draw.a), number(&draw.b), draw.view)
    });
}

/// The first difference of each path, and how many views have one there; most first.
fn alike(draws: &[DrawDifference]) -> Vec<(&DrawDifference, usize)> {
    let mut out: Vec<(&DrawDifference, usize)> = Vec::new();
    for draw in draws {
        match out.iter_mut().find(|(known, _)| known.path == draw.path) {
            Some((_, count)) => *count += 1,
            None => out.push((draw, 1)),
        }
    }
    out.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    out
}

/// A drawn number with what people read of it.
fn number(value: &serde_json::Value) -> String {
    match value.as_f64() {
        Some(number) if number.fract() == 0.0 && number.abs() < 1e9 => format!("{number}"),
        Some(number) => {
            let digits = if number.abs() >= 100.0 { 2 } else { 4 };
            format!("{number:.digits$}")
        }
        None if value.is_null() => "none".to_owned(),
        None => value.to_string(),
    }
}

fn images(out: &mut String, of: &Difference) {
    if let Some((a, b)) = &of.renderers {
        section(out, "renderer", &format!("{a} → {b}"));
    }
    let Some(found) = &of.images else {
        let why = match of.views.is_empty() {
            true => "none: there is no dataset",
            false => "not compared: recipes are drawn with --pixels or -o",
        };
        section(out, "pixels", why);
        return;
    };
    if found.images.is_empty() {
        section(out, "pixels", &format!("same ({})", counted(found.compared, "image")));
        return;
    }
    section(out, "pixels", &format!("{} of {} differ", found.images.len(), counted(found.compared, "image")));
    list(out, &found.images, |image| format!("~ {}  {}", image_name(image), pixels_text(image)));
}

/// The name of an image.
fn image_name(image: &ImageDifference) -> String {
    format!("{}/{}", image.view, image.image)
}

/// How the pixels of an image differ.
pub fn pixels_text(image: &ImageDifference) -> String {
    if let Some(why) = &image.incomparable {
        return why.clone();
    }
    let of = &image.pixels;
    let share = format!("{} of pixels", percent(of.differing as f64 / of.pixels.max(1) as f64));
    match (image.kind, of.greatest) {
        (Some(Kind::Labels), _) => {
            let turned = |(from, to, count): &(String, String, u64)| format!("{count} {from} → {to}");
            let mut told: Vec<String> = image.turned.iter().take(3).map(turned).collect();
            if image.turned.len() > 3 {
                told.push(format!("… and {} more kinds", image.turned.len() - 3));
            }
            format!("{share}: {}", told.join(", "))
        }
        (Some(Kind::Depth), Some(greatest)) => format!("{share}, by up to {}", metres(greatest)),
        (_, greatest) => {
            let visible = percent(of.visible as f64 / of.pixels.max(1) as f64);
            format!("{share}, by up to {} of 255; {visible} by more than {FAINT}", number(&greatest.into()))
        }
    }
}

/// A share that is not 0 never reads so.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".to_owned(),
        p if p < 0.01 => "less than 0.01 %".to_owned(),
        p if p < 1.0 => format!("{p:.2} %"),
        p => format!("{p:.1} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_cut_and_shares_never_vanish() {
        let mut out = String::new();
        list(&mut out, &(0..10).collect::<Vec<_>>(), i32::to_string);
        assert!(out.ends_with("  7\n  … and 2 more\n"), "{out}");
        assert_eq!([0.0, 1e-9, 0.005, 0.123].map(percent), ["0 %", "less than 0.01 %", "0.50 %", "12.3 %"]);
    }

    #[test]
    fn surfaces_in_words() {
        let shape = |triangles_a, triangles_b, moved_m| {
            surface(Surface::Shape { triangles_a, triangles_b, gone: 1, new: 2, moved_m })
        };
        assert_eq!(shape(0, 7, None), "new, 7 triangles");
        assert_eq!(shape(1, 0, None), "gone, 1 triangle");
        assert_eq!(shape(3, 4, None), "3 → 4 triangles (1 gone, 2 new)");
        assert_eq!(shape(3, 3, Some(0.254)), "moved by up to 0.25 m, 3 triangles");
        assert_eq!(shape(3, 3, Some(1e-9)), "moved by up to 1.0e-9 m, 3 triangles");
    }
}
