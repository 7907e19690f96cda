//! Two snapshots → everything that differs between them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::error::ComparisonError;
use super::features::{FeaturesDifference, compare_features};
use super::inputs::{InputDifference, compare_inputs};
use super::meshes::{MeshDifference, compare_meshes};
use super::pixels::{Decoded, Kind, PixelDifference, compare_pixels, decode, kind};
use super::properties::{PropertyDifference, compare_properties};
use super::rules::{FileDifference, compare_rules};
use super::snapshot::{DatasetSnapshot, ImageSnapshot, SceneSnapshot, Snapshot, ViewSnapshot};
use super::views::{ViewsDifference, compare_views};
use crate::frame::Pixels;

/// What differs between A and B.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    pub a: String,
    pub b: String,
    /// Nothing that could be seen or learnt from differs: texts are compared by what they say.
    pub same: bool,
    pub inputs: Vec<InputDifference>,
    /// Name, in A, in B.
    pub arguments: Vec<(String, Option<String>, Option<String>)>,
    /// `None` where a side is a dataset, whose manifest does not hold the texts.
    pub recipe: Option<Vec<PropertyDifference>>,
    pub rules: Option<Vec<FileDifference>>,
    pub scenes: Vec<SceneDifference>,
    pub views: Vec<ViewsDifference>,
    /// What drew A and B, where it differs.
    pub renderers: Option<(String, String)>,
    /// `None` where images were not asked for or there are none.
    pub images: Option<ImagesDifference>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneDifference {
    pub scene: String,
    /// `a` or `b` where the other does not have it.
    pub only: Option<&'static str>,
    pub features: FeaturesDifference,
    pub meshes: MeshDifference,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ImagesDifference {
    pub compared: usize,
    /// Those that differ; labels come first, and of one kind what differs most.
    pub images: Vec<ImageDifference>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ImageDifference {
    pub dataset: String,
    pub view: String,
    pub image: String,
    /// Why the pixels cannot be compared; then there is nothing below.
    pub incomparable: Option<String>,
    pub kind: Option<Kind>,
    pub pixels: PixelDifference,
    /// Labels by name: from, to, how many pixels, most first.
    pub turned: Vec<(String, String, u64)>,
}

/// Compares two sides.
pub fn compare(a: &Snapshot, b: &Snapshot) -> Result<Difference, ComparisonError> {
    let both = a.meaning.as_ref().zip(b.meaning.as_ref());
    let mut out = Difference {
        a: a.label.clone(),
        b: b.label.clone(),
        same: false,
        inputs: compare_inputs(a, b),
        arguments: compare_arguments(&a.arguments, &b.arguments),
        recipe: both.map(|(a, b)| compare_properties(&a.properties, &b.properties)),
        rules: both.map(|(a, b)| compare_rules(&a.rules, &b.rules)),
        scenes: Vec::new(),
        views: Vec::new(),
        renderers: compare_renderers(a, b),
        images: None,
    };
    for (name, a, b) in pairs(&a.scenes, &b.scenes) {
        let nothing = SceneSnapshot::default();
        let only = if b.is_none() { Some("a") } else { a.is_none().then_some("b") };
        let (a, b) = (a.unwrap_or(&nothing), b.unwrap_or(&nothing));
        let (features, meshes) = (compare_features(a, b), compare_meshes(a, b));
        out.scenes.push(SceneDifference { scene: name.clone(), only, features, meshes });
    }
    for (name, of_a, of_b) in pairs(&a.datasets, &b.datasets) {
        let nothing = DatasetSnapshot::default();
        let (of_a, of_b) = (of_a.unwrap_or(&nothing), of_b.unwrap_or(&nothing));
        out.views.push(compare_views(name, of_a, of_b));
        if of_a.folder.is_some() && of_b.folder.is_some() {
            let found = compare_images(name, (a, of_a), (b, of_b))?;
            let images = out.images.get_or_insert_default();
            images.compared += found.compared;
            images.images.extend(found.images);
        }
    }
    out.same = is_same(&out);
    Ok(out)
}

/// Changed texts count by what they say, where that is known; renamed files do not count.
fn is_same(of: &Difference) -> bool {
    let known = of.recipe.is_some();
    let counts = |input: &&InputDifference| {
        input.fate.is_some() && !(known && (input.role == "recipe" || input.role == "rules"))
    };
    let files = of.rules.iter().flatten();
    of.inputs.iter().filter(counts).count() == 0
        && of.arguments.is_empty()
        && of.recipe.iter().flatten().count() == 0
        && files.filter(|file| !file.is_layout_only()).count() == 0
        && of.scenes.iter().all(|s| s.only.is_none() && s.features.is_none() && s.meshes.is_none())
        && of.views.iter().all(ViewsDifference::is_none)
        && of.images.iter().all(|images| images.images.is_empty())
}

/// By name; where each side has exactly one they belong together whatever they are called.
fn pairs<'a, T>(
    a: &'a BTreeMap<String, T>,
    b: &'a BTreeMap<String, T>,
) -> Vec<(&'a String, Option<&'a T>, Option<&'a T>)> {
    if let (1, 1, Some((_, a)), Some((name, b))) = (a.len(), b.len(), a.first_key_value(), b.first_key_value()) {
        return vec![(name, Some(a), Some(b))];
    }
    let mut names: Vec<&String> = a.keys().chain(b.keys()).collect();
    names.sort();
    names.dedup();
    names.into_iter().map(|name| (name, a.get(name), b.get(name))).collect()
}

fn compare_arguments(
    a: &BTreeMap<String, String>,
    b: &BTreeMap<String, String>,
) -> Vec<(String, Option<String>, Option<String>)> {
    let mut names: Vec<&String> = a.keys().chain(b.keys()).collect();
    names.sort();
    names.dedup();
    let one = |name: &String| (name.clone(), a.get(name).cloned(), b.get(name).cloned());
    names.into_iter().map(one).filter(|(_, a, b)| a != b).collect()
}

fn compare_renderers(a: &Snapshot, b: &Snapshot) -> Option<(String, String)> {
    let of = |side: &Snapshot| side.datasets.values().find_map(|dataset| dataset.renderer.clone());
    of(a).zip(of(b)).filter(|(a, b)| a != b)
}

fn compare_images(
    name: &str,
    a: (&Snapshot, &DatasetSnapshot),
    b: (&Snapshot, &DatasetSnapshot),
) -> Result<ImagesDifference, ComparisonError> {
    let shared = a.1.views.iter().filter_map(|(view, of_a)| Some((view, of_a, b.1.views.get(view)?)));
    let mut jobs: Vec<(&String, &String, Option<&ImageSnapshot>, Option<&ImageSnapshot>)> = Vec::new();
    for (view, of_a, of_b) in shared {
        jobs.extend(pairs(&of_a.images, &of_b.images).into_iter().map(|(image, a, b)| (view, image, a, b)));
    }
    let one = |(view, image, of_a, of_b): &(&String, &String, Option<&ImageSnapshot>, Option<&ImageSnapshot>)| {
        image_difference((name, view, image), (a, *of_a), (b, *of_b))
    };
    let found: Vec<Option<ImageDifference>> = jobs.par_iter().map(one).collect::<Result<_, _>>()?;
    let mut images: Vec<ImageDifference> = found.into_iter().flatten().collect();
    let share = |of: &ImageDifference| of.pixels.differing as f64 / of.pixels.pixels.max(1) as f64;
    // Those without a kind cannot be compared at all.
    images.sort_by(|x, y| x.kind.cmp(&y.kind).then(share(y).total_cmp(&share(x))));
    Ok(ImagesDifference { compared: jobs.len(), images })
}

type ImageSide<'a> = ((&'a Snapshot, &'a DatasetSnapshot), Option<&'a ImageSnapshot>);

/// `None` where the images are the same.
fn image_difference(
    (dataset, view, image): (&str, &str, &str),
    (a, image_a): ImageSide,
    (b, image_b): ImageSide,
) -> Result<Option<ImageDifference>, ComparisonError> {
    let mut out = ImageDifference {
        dataset: dataset.to_owned(),
        view: view.to_owned(),
        image: image.to_owned(),
        incomparable: None,
        kind: None,
        pixels: PixelDifference::default(),
        turned: Vec::new(),
    };
    let (Some(image_a), Some(image_b)) = (image_a, image_b) else {
        out.incomparable = Some(format!("only in {}", if image_a.is_some() { "A" } else { "B" }));
        return Ok(Some(out));
    };
    let output = image_b.output.as_deref();
    if same_bytes(&image_path(a.1, image_a), &image_path(b.1, image_b))
        && LabelNames::new(output, (a, view), (b, view)).in_b.is_empty()
    {
        return Ok(None);
    }
    let (decoded_a, decoded_b, names) = load_pair(view, (a, image_a), (b, image_b))?;
    match compare_pixels(&decoded_a, &decoded_b) {
        Err(why) => out.incomparable = Some(why),
        Ok(found) if found.differing == 0 => return Ok(None),
        Ok(found) => {
            let kind = kind(output, &decoded_b.pixels);
            if kind == Kind::Labels {
                out.turned = found.turned.iter().map(|&(x, y, n)| (names.of_a(x), names.of_b(y), n)).collect();
            }
            let greatest = found.greatest.filter(|_| kind != Kind::Labels);
            out.kind = Some(kind);
            let visible = if kind == Kind::Colour { found.visible } else { 0 };
            out.pixels = PixelDifference { greatest, visible, ..found };
        }
    }
    Ok(Some(out))
}

fn image_path(side: &DatasetSnapshot, image: &ImageSnapshot) -> PathBuf {
    side.folder.as_ref().expect("images lie in a folder").join(&image.path)
}

/// Files that cannot be read are not the same; whoever decodes them says why.
fn same_bytes(a: &Path, b: &Path) -> bool {
    matches!((std::fs::read(a), std::fs::read(b)), (Ok(a), Ok(b)) if a == b)
}

/// Reads an image of both sides; instance numbers are those of B.
pub fn load_pair<'a>(
    view: &str,
    (a, image_a): ((&'a Snapshot, &'a DatasetSnapshot), &'a ImageSnapshot),
    (b, image_b): ((&'a Snapshot, &'a DatasetSnapshot), &'a ImageSnapshot),
) -> Result<(Decoded, Decoded, LabelNames<'a>), ComparisonError> {
    let (mut of_a, of_b) = (decode(&image_path(a.1, image_a))?, decode(&image_path(b.1, image_b))?);
    let names = LabelNames::new(image_b.output.as_deref(), (a, view), (b, view));
    names.renumber(&mut of_a.pixels);
    Ok((of_a, of_b, names))
}

/// What the numbers of a label image mean on both sides.
pub struct LabelNames<'a> {
    output: Option<&'a str>,
    classes: &'a BTreeMap<u8, String>,
    /// Numbers of instance images of both sides.
    instances: Option<[&'a BTreeMap<u32, String>; 2]>,
    /// A's numbers that B has for other features or not at all → numbers in B, or beyond all of them.
    in_b: BTreeMap<u32, u32>,
}

/// Instance numbers of features that B does not have begin here.
const BEYOND: u32 = 1 << 31;

impl<'a> LabelNames<'a> {
    fn new(
        output: Option<&'a str>,
        (a, view): ((&'a Snapshot, &'a DatasetSnapshot), &str),
        (b, _): ((&'a Snapshot, &'a DatasetSnapshot), &str),
    ) -> Self {
        let scene = |(side, dataset): (&'a Snapshot, &'a DatasetSnapshot)| {
            let view: &ViewSnapshot = dataset.views.get(view)?;
            Some(&side.scenes.get(&view.scene)?.instances)
        };
        let instances = match output {
            Some("instance") => scene(a).zip(scene(b)).map(|(a, b)| [a, b]),
            _ => None,
        };
        let mut in_b = BTreeMap::new();
        if let Some([of_a, of_b]) = instances {
            let numbers: BTreeMap<&String, u32> = of_b.iter().map(|(number, name)| (name, *number)).collect();
            for (number, name) in of_a {
                let other = numbers.get(name).copied().unwrap_or(BEYOND + number);
                if other != *number {
                    in_b.insert(*number, other);
                }
            }
        }
        LabelNames { output, classes: &b.1.classes, instances, in_b }
    }

    /// Gives A's features the numbers that B has for them.
    fn renumber(&self, pixels: &mut Pixels) {
        if let Pixels::Id32(ids) = pixels
            && !self.in_b.is_empty()
        {
            ids.iter_mut().for_each(|id| *id = self.in_b.get(id).copied().unwrap_or(*id));
        }
    }

    fn of_a(&self, number: u32) -> String {
        match (self.instances, number.checked_sub(BEYOND)) {
            (Some([of_a, _]), Some(own)) => of_a.get(&own).cloned().unwrap_or_else(|| own.to_string()),
            _ => self.of_b(number),
        }
    }

    fn of_b(&self, number: u32) -> String {
        let class = || u8::try_from(number).ok().and_then(|class| self.classes.get(&class)).cloned();
        let instance = || self.instances.and_then(|[_, of_b]| of_b.get(&number)).cloned();
        let named = match self.output {
            Some("class") => class(),
            Some("instance") => instance(),
            Some("mask") => Some(if number == 0 { "unmarked" } else { "marked" }.to_owned()),
            Some("level") => Some(format!("level {number}")),
            _ => None,
        };
        let nothing = || if number == 0 { "nothing".to_owned() } else { number.to_string() };
        named.unwrap_or_else(nothing)
    }
}
