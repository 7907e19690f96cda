//! A verification as text for people: what is wrong, then how much is right.

use std::fmt::Write;

use super::{DatasetVerification, FileFate, FileVerification, Verification};
use crate::comparison::pixels::Kind;
use crate::comparison::text::percent;

/// Files named for each fate.
const MOST: usize = 12;

/// The whole report; the last line says `verified` or `not verified`.
pub fn verification_text(of: &Verification) -> String {
    let mut out = String::new();
    let version = match &of.versions {
        [made, own] if made == own => String::new(),
        [made, own] => format!("; made by mansard {made}, verified by mansard {own}"),
    };
    let _ = writeln!(out, "{:<10} {} with the content that the manifest says{version}", "inputs", of.inputs);
    for line in &of.gathered {
        let _ = writeln!(out, "  = {line}");
    }
    of.datasets.iter().for_each(|dataset| dataset_text(&mut out, dataset, of.datasets.len() > 1));
    let close = of.datasets.iter().flat_map(|d| &d.files).any(|file| file.fate == FileFate::Close);
    let verdict = match (of.verified, close) {
        (false, _) => "not verified",
        (true, true) => "verified, colours the same within 1/255 on another adapter",
        (true, false) => "verified",
    };
    let undrawn = of.datasets.iter().all(|dataset| dataset.drawn_again_by.is_none());
    let undrawn = if undrawn { "; images were not drawn again" } else { "" };
    let _ = write!(out, "\n{verdict}{undrawn}\n");
    out
}

fn dataset_text(out: &mut String, dataset: &DatasetVerification, several: bool) {
    if several {
        let _ = writeln!(out, "\n{:<10} {}", "dataset", dataset.dataset);
    }
    let _ = writeln!(out, "{:<10} {}", "made by", dataset.made_by);
    if let Some(again) = &dataset.drawn_again_by {
        let same = if *again == dataset.made_by { "the same".to_owned() } else { again.clone() };
        let _ = writeln!(out, "{:<10} {same}", "again by");
    }
    for scene in &dataset.scenes {
        let [made, again] = scene.geometry_sha256.each_ref().map(|sha256| short(sha256));
        let told =
            if made == again { format!("same, {made}") } else { format!("different: {made}, made again {again}") };
        let _ = writeln!(out, "{:<10} {}: {told}", "geometry", scene.scene);
    }
    manifest(out, dataset);
    let counts = [
        FileFate::Same,
        FileFate::Close,
        FileFate::Unchecked,
        FileFate::Different,
        FileFate::Altered,
        FileFate::Missing,
        FileFate::Unexpected,
        FileFate::Extra,
    ]
    .map(|fate| (fate, dataset.files.iter().filter(|file| file.fate == fate).count()));
    let counts: Vec<String> =
        counts.iter().filter(|(_, n)| *n > 0).map(|(fate, n)| format!("{n} {}", word(*fate))).collect();
    let _ = writeln!(out, "{:<10} {}", "files", counts.join(", "));
    let mut before: Option<(FileFate, usize)> = None;
    for file in dataset.files.iter().filter(|file| !matches!(file.fate, FileFate::Same | FileFate::Unchecked)) {
        let count = before.filter(|(fate, _)| *fate == file.fate).map_or(0, |(_, count)| count);
        before = Some((file.fate, count + 1));
        if count < MOST {
            let _ = writeln!(out, "  {:<11} {}{}", word(file.fate), file.path, detail(file));
        } else if count == MOST {
            let all = dataset.files.iter().filter(|other| other.fate == file.fate).count();
            let _ = writeln!(out, "  {:<11} … and {} more", word(file.fate), all - MOST);
        }
    }
}

fn manifest(out: &mut String, dataset: &DatasetVerification) {
    let found = &dataset.manifest;
    if found.is_empty() {
        let _ = writeln!(out, "{:<10} same", "manifest");
        return;
    }
    let _ = writeln!(
        out,
        "{:<10} {} differ from a manifest made now",
        "manifest",
        match found.len() {
            1 => "1 value".to_owned(),
            n => format!("{n} values"),
        }
    );
    for difference in found.iter().take(MOST) {
        let _ = writeln!(out, "  ~ {}  {}, made again {}", difference.path, difference.a, difference.b);
    }
    if found.len() > MOST {
        let _ = writeln!(out, "  … and {} more", found.len() - MOST);
    }
}

fn word(fate: FileFate) -> &'static str {
    match fate {
        FileFate::Missing => "missing",
        FileFate::Altered => "altered",
        FileFate::Different => "different",
        FileFate::Unexpected => "unexpected",
        FileFate::Extra => "extra",
        FileFate::Close => "close",
        FileFate::Unchecked => "as the manifest says",
        FileFate::Same => "same",
    }
}

fn short(sha256: &str) -> String {
    sha256.chars().take(16).collect()
}

/// What there is to say about a file behind its name.
fn detail(file: &FileVerification) -> String {
    let image = file.image.as_ref().map(|image| {
        if let Some(why) = &image.incomparable {
            return why.clone();
        }
        if image.differing == 0 {
            return "the pixels are the same, the file is not".to_owned();
        }
        let share = percent(image.differing as f64 / image.pixels.max(1) as f64);
        let what = match image.kind {
            Kind::Labels => "labels",
            Kind::Colour => "colours",
            Kind::Depth => "depths",
        };
        let greatest = match (image.kind, image.greatest) {
            (Kind::Colour, Some(greatest)) => format!(" by up to {greatest:.1} of 255"),
            (Kind::Depth, Some(greatest)) => format!(" by up to {greatest:.2e} m"),
            _ => String::new(),
        };
        format!("{} {what} ({share}) differ{greatest}", image.differing)
    });
    let manifest = file.sha256.as_ref().and_then(|[manifest, _, _]| manifest.clone());
    let here = file.sha256.as_ref().and_then(|[_, here, _]| here.clone());
    let again = file.sha256.as_ref().and_then(|[_, _, again]| again.clone());
    let hashes = match (file.fate, manifest, here, again) {
        (FileFate::Altered, Some(manifest), Some(here), again) => {
            let again = match again {
                Some(again) if again == manifest => ", and made again it is as the manifest says",
                Some(_) => ", and made again it is a third",
                None => "",
            };
            Some(format!("the manifest says {}, the file has {}{again}", short(&manifest), short(&here)))
        }
        (FileFate::Different, Some(manifest), _, Some(again)) if file.image.is_none() => {
            Some(format!("{}, made again {}", short(&manifest), short(&again)))
        }
        (FileFate::Unexpected, Some(_), _, None) => Some("made again, it does not come about".to_owned()),
        (FileFate::Unexpected, None, _, _) => {
            Some("made again, it comes about; the manifest does not name it".to_owned())
        }
        _ => None,
    };
    let all: Vec<String> = [hashes, image].into_iter().flatten().collect();
    if all.is_empty() { String::new() } else { format!(": {}", all.join("; ")) }
}
