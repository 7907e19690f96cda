//! The gallery of hard footprints. In: `../shared/hard-cases/footprints.geojson`. Out: `docs/hard-cases.md` and a drawing
//! per case, as they must be. `MANSARD_BLESS=1` writes them.

#[expect(dead_code, reason = "the library's own tests ask for footprints by name")]
#[path = "../../src/geometry/hard_cases.rs"]
mod footprints;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use mansard::geometry::repair::{Note, Options, Repaired, Verdict, repair};
use mansard::geometry::roof::{Roof, RoofPart, Slope, hip};
use mansard::geometry::{Polygon, Ring};
use serde_json::Value;

use footprints::{features, rings};

const INTRODUCTION: &str = "# Hard footprints

Every named footprint of `../shared/hard-cases/footprints.geojson` as Mansard sees it: the outline as it came (red, dashed
where it was repaired), the straight skeleton, and the hip roof of 45 degrees with its faces shaded by the side they look
to (light from the north-west). A test draws them again and compares: `cargo test --test it hard_cases`;
`MANSARD_BLESS=1` writes what differs. Nothing is welded and nothing is too small here (`weld` and `min_area` are 0).
The most finely divided cases are drawn without inner lines; those of more than 1,000 vertices are left out.
";

/// Width of a drawing with its margin, in its own units.
const SIZE: f64 = 100.0;
const MARGIN: f64 = 4.0;

/// Most edges of a roof that is drawn face by face, so that drawings stay small.
const MOST_EDGES: usize = 130;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

fn text<'a>(feature: &'a Value, key: &str) -> &'a str {
    feature["properties"][key].as_str().unwrap_or_else(|| panic!("a case has no {key}"))
}

/// The outcome in words.
fn outcome(repaired: &Repaired) -> String {
    match repaired.verdict {
        Verdict::Ok => "ok".to_owned(),
        Verdict::Rejected(why) => format!("rejected: {why}"),
        Verdict::Repaired => {
            let done: Vec<String> = repaired.notes.iter().filter(|n| n.is_repair()).map(in_words).collect();
            let (before, after) = (repaired.area_before, repaired.area_after);
            format!("repaired: {}; {before:.6} m² became {after:.6} m²", done.join(", "))
        }
    }
}

fn in_words(note: &Note) -> String {
    match note {
        Note::DoubledPointsRemoved(n) => format!("{n} doubled points removed"),
        Note::OutlineReversed => "outline turned".to_owned(),
        Note::HolesReversed(n) => format!("{n} holes turned"),
        Note::CrossingsResolved => "crossings resolved".to_owned(),
        Note::SplitIntoParts(n) => format!("split into {n} parts"),
        Note::SmallPartsDropped(n) => format!("{n} parts dropped"),
        Note::EmptyHolesDropped(n) => format!("{n} empty holes dropped"),
    }
}

/// From plan metres to the drawing: y goes down.
struct View {
    low: DVec2,
    high: DVec2,
    scale: f64,
}

impl View {
    /// Around all points that have a place on paper.
    fn of(points: impl Iterator<Item = DVec2> + Clone) -> View {
        let plain = points.filter(|p| p.is_finite() && p.abs().max_element() < 1e12);
        let low = plain.clone().fold(DVec2::INFINITY, DVec2::min);
        let high = plain.fold(DVec2::NEG_INFINITY, DVec2::max);
        let extent = (high - low).max_element();
        View { low, high, scale: if extent > 0.0 { (SIZE - 2.0 * MARGIN) / extent } else { 1.0 } }
    }

    /// A closed path; points without a place on paper are left out.
    fn path(&self, ring: impl IntoIterator<Item = DVec2>) -> String {
        let place = |p: DVec2| {
            let p = DVec2::new(p.x - self.low.x, self.high.y - p.y) * self.scale + MARGIN;
            // A tenth of a unit is less than a pixel; no negative zero.
            let [x, y] = p.to_array().map(|c| (c * 10.0).round() / 10.0 + 0.0);
            format!("{x} {y}")
        };
        let ring = ring.into_iter().filter(|p| p.is_finite() && p.abs().max_element() < 1e12);
        let mut places: Vec<String> = ring.map(place).collect();
        places.dedup();
        if places.is_empty() { String::new() } else { format!("M{}Z", places.join("L")) }
    }
}

/// The drawing of a case; `None` if it has no point with a place.
fn draw(rings: &[Ring], repaired: &Repaired) -> Option<String> {
    let points = rings.iter().flatten().copied();
    let view = View::of(points);
    if !view.low.is_finite() {
        return None;
    }
    let mut svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {SIZE} {SIZE}\">\n");
    for polygon in &repaired.polygons {
        let roof = hip(polygon, Slope::Angle(45.0), 0.0, false).expect("a repaired outline has a roof");
        let fine = polygon.rings().map(Vec::len).sum::<usize>() > MOST_EDGES;
        svg.push_str(&if fine { plain_faces(&view, polygon.rings()) } else { faces(&view, &roof) });
    }
    let dashes = if repaired.verdict == Verdict::Ok { "" } else { " stroke-dasharray=\"2 1\"" };
    let outline: String = rings.iter().map(|r| view.path(thinned(r))).collect();
    writeln!(svg, "<path d=\"{outline}\" fill=\"none\" stroke=\"#c22\" stroke-width=\".6\"{dashes}/>").expect("text");
    svg.push_str("</svg>\n");
    Some(svg)
}

/// At most some hundreds of points of a ring.
fn thinned(ring: &[DVec2]) -> impl Iterator<Item = DVec2> + '_ {
    ring.iter().copied().step_by(ring.len() / 400 + 1)
}

fn plain_faces<'a>(view: &View, rings: impl Iterator<Item = &'a Ring>) -> String {
    let outline: String = rings.map(|r| view.path(thinned(r))).collect();
    format!("<path d=\"{outline}\" fill=\"#ddd\" fill-rule=\"evenodd\"/>\n")
}

/// The roof planes, shaded by aspect; their borders are the skeleton.
fn faces(view: &View, roof: &Roof) -> String {
    let light = DVec3::new(-1.0, 2.0, -1.0).normalize();
    let mut svg = String::from("<g stroke=\"#246\" stroke-width=\".4\" stroke-linejoin=\"round\">\n");
    for (face, part) in roof.mesh.faces.iter().zip(&roof.parts) {
        if *part == RoofPart::Bottom {
            continue;
        }
        let ring = face.outer.iter().map(|&n| roof.mesh.positions[n as usize]);
        let path = view.path(ring.map(|p| DVec2::new(p.x, -p.z)));
        let shade = (150.0 + 100.0 * roof.mesh.normal(face).dot(light)).round() as u8;
        writeln!(svg, "<path d=\"{path}\" fill=\"#{shade:02x}{shade:02x}{shade:02x}\"/>").expect("text");
    }
    svg + "</g>\n"
}

/// The page and the drawings, by file name.
fn gallery(features: &[Value]) -> (String, Vec<(String, String)>) {
    let mut page = INTRODUCTION.to_owned();
    let mut drawings = Vec::new();
    let mut classes: Vec<&str> = features.iter().map(|f| text(f, "class")).collect();
    classes.sort_unstable();
    classes.dedup();
    for class in classes {
        write!(page, "\n## {class}\n\n| | case | why it is hard | outcome |\n| --- | --- | --- | --- |\n")
            .expect("text");
        for feature in features.iter().filter(|f| text(f, "class") == class) {
            let (name, rings) = (text(feature, "name"), rings(feature));
            let repaired = repair(&rings, &Options { weld: 0.0, min_area: 0.0 });
            let picture = draw(&rings, &repaired).map(|svg| {
                let file = format!("{}.svg", name.replace(|c: char| !(c.is_alphanumeric() || c == '-'), "_"));
                let image = format!("<img src=\"images/hard-cases/{file}\" width=\"140\" alt=\"{name}\">");
                drawings.push((file, svg));
                image
            });
            let (why, outcome) = (text(feature, "why").replace('|', "\\|"), outcome(&repaired));
            let picture = picture.unwrap_or_default();
            writeln!(page, "| {picture} | `{name}` | {why} | {outcome} |").expect("text");
        }
    }
    (page, drawings)
}

#[test]
fn the_gallery_shows_what_the_program_does() {
    let Some(mut features) = features() else { return };
    // The largest take seconds in a debug build.
    features.retain(|f| f["properties"]["vertices"].as_u64().is_none_or(|n| n <= 1000));
    let (page, drawings) = gallery(&features);
    let folder = docs().join("images/hard-cases");
    if std::env::var("MANSARD_BLESS").is_ok_and(|v| v == "1") {
        std::fs::create_dir_all(&folder).expect("docs is writable");
        for (file, svg) in &drawings {
            std::fs::write(folder.join(file), svg).expect("docs is writable");
        }
        std::fs::write(docs().join("hard-cases.md"), &page).expect("docs is writable");
        return;
    }
    let there = |path: PathBuf| std::fs::read_to_string(path).unwrap_or_default();
    assert_eq!(there(docs().join("hard-cases.md")), page, "MANSARD_BLESS=1 writes docs/hard-cases.md");
    for (file, svg) in drawings {
        assert_eq!(there(folder.join(&file)), svg, "{file} differs; MANSARD_BLESS=1 writes it");
    }
}

/// What comes out is what the shared file expects.
#[test]
fn every_hard_footprint_has_the_expected_outcome() {
    for feature in features().unwrap_or_default() {
        let verdict = match repair(&rings(&feature), &Options { weld: 0.0, min_area: 0.0 }).verdict {
            Verdict::Ok => "ok",
            Verdict::Repaired => "repaired",
            Verdict::Rejected(_) => "rejected",
        };
        let p = &feature["properties"];
        let accepted = p["also_accept"].as_array().is_some_and(|all| all.iter().any(|v| v == verdict));
        assert!(p["expect"] == verdict || accepted, "{}: {verdict}, expected {}", p["name"], p["expect"]);
    }
}
