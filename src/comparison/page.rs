//! A difference → files: `diff.json` with everything, a picture per view that differs, and `diff.html`, one page that
//! needs no other file and no script.

use std::fmt::Write;
use std::path::Path;

use base64::Engine;
use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;

use super::difference::{Difference, ImageDifference, load_pair};
use super::error::ComparisonError;
use super::features::FeatureDifference;
use super::meshes::FeatureMeshes;
use super::picture::{Canvas, strip};
use super::rules::Fate;
use super::snapshot::Snapshot;
use super::text::{difference_text, pixels_text, surface};
use super::views::DrawDifference;
use crate::cost::report::page::STYLE;
use crate::cost::report::picture::Picture;
use crate::cost::report::plot::escape;
use crate::output::{prepare_folder, write_bytes};

/// Rows of a table in the page; the file of numbers has all.
const MOST_ROWS: usize = 200;
const JPEG_QUALITY: u8 = 85;
/// Pictures in the page; the folder has all.
const MOST_PICTURES: usize = 24;

/// Writes everything into a folder, made if it is missing, and gives the names of the files.
pub fn write_pages(of: &Difference, a: &Snapshot, b: &Snapshot, folder: &Path) -> Result<Vec<String>, ComparisonError> {
    prepare_folder(folder)?;
    let mut names = Vec::new();
    let mut write = |name: String, bytes: &[u8]| -> Result<(), ComparisonError> {
        write_bytes(&folder.join(&name), bytes)?;
        names.push(name);
        Ok(())
    };
    let mut json = serde_json::to_vec_pretty(of).expect("names and numbers serialise");
    json.push(b'\n');
    write("diff.json".to_owned(), &json)?;
    let mut shown = Vec::new();
    let several = of.views.len() > 1;
    for (dataset, view, images) in differing_views(of) {
        let Some(picture) = picture(&images, a, b)? else { continue };
        let name = if several { format!("{dataset}-{view}") } else { view.to_owned() };
        write(format!("{}.png", plain(&name)), &picture.png())?;
        if shown.len() < MOST_PICTURES {
            let told = images.iter().map(|image| format!("{}: {}", image.image, pixels_text(image)));
            shown.push((view.to_owned(), told.collect::<Vec<_>>().join("; "), picture));
        }
    }
    write("diff.html".to_owned(), html(of, &shown).as_bytes())?;
    Ok(names)
}

/// A name that is a file's wherever it came from: recipes have no others, but manifests may come from anywhere.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

/// Views in the order of their names, with their images that differ.
fn differing_views(of: &Difference) -> Vec<(&str, &str, Vec<&ImageDifference>)> {
    let mut out: Vec<(&str, &str, Vec<&ImageDifference>)> = Vec::new();
    for image in of.images.iter().flat_map(|images| &images.images) {
        match out.iter_mut().find(|(dataset, view, _)| *dataset == image.dataset && *view == image.view) {
            Some((_, _, images)) => images.push(image),
            None => out.push((&image.dataset, &image.view, vec![image])),
        }
    }
    out.iter_mut().for_each(|(_, _, images)| images.sort_by(|x, y| x.image.cmp(&y.image)));
    out.sort_by(|x, y| (x.0, x.1).cmp(&(y.0, y.1)));
    out
}

/// The strips of a view's images; `None` if none can be compared.
fn picture(images: &[&ImageDifference], a: &Snapshot, b: &Snapshot) -> Result<Option<Picture>, ComparisonError> {
    let mut strips = Vec::new();
    for image in images {
        let Some(kind) = image.kind else { continue };
        let of = |side: &'_ Snapshot| {
            let own = side.datasets.get(&image.dataset).or_else(|| side.datasets.values().next()).cloned();
            own.expect("an image belongs to a dataset")
        };
        let (of_a, of_b) = (of(a), of(b));
        let find = |side: &super::snapshot::DatasetSnapshot| side.views[&image.view].images[&image.image].clone();
        let (image_a, image_b) = (find(&of_a), find(&of_b));
        let (left, right, _) = load_pair(&image.view, ((a, &of_a), &image_a), ((b, &of_b), &image_b))?;
        let result = format!("{}: {}", image.view, pixels_text(image).replace('→', "TO"));
        strips.push(strip(&left, &right, kind, &image.image, &result));
    }
    Ok((!strips.is_empty()).then(|| Canvas::stacked(&strips)))
}

/// A view's name, what differs, its strips.
type Shown = (String, String, Picture);

fn html(of: &Difference, shown: &[Shown]) -> String {
    let verdict = if of.same { "Nothing differs" } else { "They differ" };
    let mut out = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>{0} → {1}</title><style>{STYLE}{OWN_STYLE}</style></head><body><main>\
         <h1>{verdict}</h1><dl><dt>A</dt><dd><code>{0}</code></dd><dt>B</dt><dd><code>{1}</code></dd></dl>",
        escape(&of.a),
        escape(&of.b)
    );
    let text = difference_text(of);
    let body = text.split_once("\n\n").map_or(text.as_str(), |(_, body)| body);
    let _ = write!(out, "<pre class=\"summary\">{}</pre>", escape(body.trim_end()));
    pictures(&mut out, of, shown);
    recipe(&mut out, of);
    for scene in &of.scenes {
        features(&mut out, &scene.scene, &scene.features.features);
        meshes(&mut out, &scene.scene, &scene.meshes.features);
    }
    for views in &of.views {
        draws(&mut out, &views.dataset, &views.draws);
    }
    out.push_str("<p class=\"soft\">Every number is in <code>diff.json</code>, made by <code>mansard diff</code>.</p></main></body></html>\n");
    out
}

const OWN_STYLE: &str = "pre.summary{background:var(--band);padding:1rem;overflow-x:auto;font-size:.86rem;line-height:1.45}\
.strip img{max-width:100%;height:auto;border:1px solid var(--line)}td{white-space:normal;text-align:left}th{text-align:left}";

fn pictures(out: &mut String, of: &Difference, shown: &[Shown]) {
    let Some(images) = &of.images else { return };
    if images.images.is_empty() {
        return;
    }
    let views = differing_views(of).len();
    out.push_str("<h2>Pictures</h2><p class=\"soft\">A, B, and how much each pixel differs. Pixels that are the same are dim.</p>");
    for (view, told, picture) in shown {
        let _ = write!(
            out,
            "<figure class=\"strip\"><img alt=\"{0}: A, B, difference\" src=\"{1}\"><figcaption><b>{0}</b>: {2}</figcaption></figure>",
            escape(view),
            jpeg_uri(picture),
            escape(told)
        );
    }
    if views > shown.len() {
        let _ = write!(out, "<p class=\"soft\">… and {} more views in this folder.</p>", views - shown.len());
    }
}

/// For the `src` of an `<img>`; a fourth of what a PNG file takes, which the folder has.
fn jpeg_uri(picture: &Picture) -> String {
    let mut bytes = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
    if encoder.encode(&picture.bytes, picture.width, picture.height, ExtendedColorType::Rgb8).is_err() {
        // Higher than JPEG has numbers for.
        return picture.data_uri();
    }
    format!("data:image/jpeg;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes))
}

/// A table with as many rows as people read.
fn table<T>(out: &mut String, title: &str, heads: &[&str], rows: &[T], cells: impl Fn(&T) -> Vec<String>) {
    if rows.is_empty() {
        return;
    }
    let _ = write!(out, "<h2>{}</h2><div class=\"wide\"><table><tr>", escape(title));
    for head in heads {
        let _ = write!(out, "<th>{head}</th>");
    }
    out.push_str("</tr>");
    for row in rows.iter().take(MOST_ROWS) {
        out.push_str("<tr>");
        for cell in cells(row) {
            let _ = write!(out, "<td>{}</td>", escape(&cell));
        }
        out.push_str("</tr>");
    }
    out.push_str("</table></div>");
    if rows.len() > MOST_ROWS {
        let _ = write!(out, "<p class=\"soft\">… and {} more.</p>", rows.len() - MOST_ROWS);
    }
}

fn word(fate: Fate) -> String {
    match fate {
        Fate::Removed => "removed",
        Fate::Added => "added",
        Fate::Changed => "changed",
        Fate::Annotated => "annotations",
    }
    .to_owned()
}

fn recipe(out: &mut String, of: &Difference) {
    let value = |value: &Option<String>| value.clone().unwrap_or_else(|| "–".to_owned());
    table(out, "Recipe", &["property", "A", "B", "views"], of.recipe.as_deref().unwrap_or_default(), |p| {
        let times = if p.times > 1 { p.times.to_string() } else { String::new() };
        vec![p.path.clone(), value(&p.a), value(&p.b), times]
    });
    let files = of.rules.as_deref().unwrap_or_default();
    let rows: Vec<_> = files.iter().flat_map(|file| file.declarations.iter().map(move |d| (file, d))).collect();
    let line = |line: Option<usize>| line.map_or("–".to_owned(), |line| line.to_string());
    table(out, "Rules", &["file", "what", "", "line in A", "line in B"], &rows, |(file, d)| {
        let what = format!("{} {}", d.what, d.name);
        vec![file.file.clone(), what, word(d.fate), line(d.line_a), line(d.line_b)]
    });
}

fn features(out: &mut String, scene: &str, features: &[FeatureDifference]) {
    table(out, &format!("Features of {scene}"), &["feature", "class", "", "what"], features, |feature| {
        let differs: Vec<String> = feature.differs.iter().map(|(what, a, b)| format!("{what}: {a} → {b}")).collect();
        vec![feature.feature.clone(), feature.class.clone(), word(feature.fate), differs.join("; ")]
    });
}

fn meshes(out: &mut String, scene: &str, meshes: &[FeatureMeshes]) {
    table(out, &format!("Meshes of {scene}"), &["feature", "class", "before", "after"], meshes, |of| {
        vec![of.feature.clone(), of.class.clone(), surface(of.before), surface(of.after)]
    });
}

fn draws(out: &mut String, dataset: &str, draws: &[DrawDifference]) {
    table(out, &format!("Draws of {dataset}"), &["view", "property", "A", "B"], draws, |draw| {
        vec![draw.view.clone(), draw.path.clone(), draw.a.to_string(), draw.b.to_string()]
    });
}
