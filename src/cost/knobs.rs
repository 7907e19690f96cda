//! Knobs: everything that trades accuracy for time → the settings to measure, and what is not measured and why.

use super::bench::Setting;
use super::errors::Metric;
use crate::gpu::{Positions, TextureFilter};
use crate::plan::demand::{Ambient, Look, Quality, Shadows};

/// One knob with the settings to try.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    pub name: &'static str,
    /// In what its error is best told.
    pub metric: Metric,
    /// What it is, in a sentence.
    pub about: &'static str,
    pub values: Vec<Value>,
}

/// One value of a knob: what it does to a setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    pub name: String,
    pub change: Change,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    Supersample(u32),
    ShadowMap(u32),
    ShadowSamples(u32),
    SkySamples(u32),
    FieldMap(u32),
    Shadows(Shadows),
    Texture(TextureFilter),
    Positions(Positions),
    Tile(u32),
}

impl Change {
    pub fn apply(self, setting: &Setting) -> Setting {
        let mut setting = *setting;
        match self {
            Change::Supersample(n) => setting.quality.supersample = n,
            Change::ShadowMap(n) => setting.quality.shadow_map = n,
            Change::ShadowSamples(n) => setting.quality.shadow_samples = n,
            Change::SkySamples(n) => setting.quality.sky_samples = n,
            Change::FieldMap(n) => setting.quality.field_map = n,
            Change::Shadows(shadows) => setting.shadows = Some(shadows),
            Change::Texture(filter) => setting.texture = filter,
            Change::Positions(positions) => setting.positions = positions,
            Change::Tile(samples) => setting.tile = samples,
        }
        setting
    }
}

/// A knob that is not measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unswept {
    pub knob: &'static str,
    pub reason: &'static str,
}

/// Settings so fine that what is left is the error of the one knob that is coarser.
pub const FINE: Quality =
    Quality { supersample: 6, shadow_map: 8192, shadow_samples: 12, sky_samples: 128, field_map: 4096 };

/// What the scene and the look have, so that knobs of what is not there are left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subject<'a> {
    pub look: &'a Look,
    pub sun: bool,
    pub textures: bool,
}

impl Subject<'_> {
    pub fn shadows(&self) -> bool {
        self.sun && self.look.shadows != Shadows::Off
    }

    pub fn sky(&self) -> bool {
        matches!(self.look.ambient, Ambient::Sky { occluded: true, .. })
    }

    pub fn fields(&self) -> bool {
        self.look.clouds.is_some() || self.look.ground.is_some()
    }
}

fn numbers(values: &[u32], name: impl Fn(u32) -> String, change: fn(u32) -> Change) -> Vec<Value> {
    values.iter().map(|&n| Value { name: name(n), change: change(n) }).collect()
}

fn named<T: Copy>(values: &[(&str, T)], change: fn(T) -> Change) -> Vec<Value> {
    values.iter().map(|&(name, value)| Value { name: name.to_owned(), change: change(value) }).collect()
}

/// The knobs to sweep in a scene of this look.
pub fn knobs(subject: Subject) -> Vec<Knob> {
    let mut knobs = vec![Knob {
        name: "antialiasing",
        metric: Metric::Edge,
        about: "samples per pixel: how well a pixel is the mean of its area",
        values: numbers(&[1, 2, 3, 4, 5, 6, 7, 8], |n| (n * n).to_string(), Change::Supersample),
    }];
    if subject.shadows() {
        knobs.extend(shadow_knobs(subject));
    }
    if subject.sky() {
        knobs.push(Knob {
            name: "sky_samples",
            metric: Metric::Light,
            about: "directions from which a partly hidden sky is seen",
            values: numbers(&[4, 8, 16, 24, 32, 64, 128], |n| n.to_string(), Change::SkySamples),
        });
    }
    if subject.fields() {
        knobs.push(Knob {
            name: "field_map",
            metric: Metric::Light,
            about: "texels per side of the maps of clouds and of what lies on the ground",
            values: numbers(&[128, 256, 512, 1024, 2048, 4096], |n| n.to_string(), Change::FieldMap),
        });
    }
    knobs.extend(drawing_knobs(subject));
    knobs
}

/// Knobs of the renderer that recipes do not have.
fn drawing_knobs(subject: Subject) -> Vec<Knob> {
    let filters = [
        ("nearest", TextureFilter::Nearest),
        ("bilinear", TextureFilter::Bilinear),
        ("trilinear", TextureFilter::Trilinear),
        ("anisotropic 8", TextureFilter::Anisotropic),
    ];
    let roundings =
        [("f32 about the scene's origin", Positions::AboutOrigin), ("f64 to the camera", Positions::AboutCamera)];
    let mut knobs = vec![
        Knob {
            name: "positions",
            metric: Metric::Label,
            about: "where coordinates are rounded to 32 bits",
            values: named(&roundings, Change::Positions),
        },
        Knob {
            name: "tile",
            metric: Metric::Label,
            about: "samples per side of the pieces that an image is drawn in",
            values: numbers(&[512, 1024, 2048, 4096], |n| n.to_string(), Change::Tile),
        },
    ];
    if subject.textures {
        knobs.push(Knob {
            name: "texture filter",
            metric: Metric::Light,
            about: "how textures are looked up where a pixel covers many texels",
            values: named(&filters, Change::Texture),
        });
    }
    knobs
}

fn shadow_knobs(subject: Subject) -> Vec<Knob> {
    let texels = |n: u32| n.to_string();
    let methods = [("off", Shadows::Off), ("hard", Shadows::Hard), ("soft", Shadows::Soft)];
    let mut knobs = vec![
        Knob {
            name: "shadow method",
            metric: Metric::Light,
            about: "how the sun's shadows are made; the truth is the recipe's own kind",
            values: named(&methods, Change::Shadows),
        },
        Knob {
            name: "shadow_map",
            metric: Metric::Shadow,
            about: "texels per side of the map of what the sun sees",
            values: numbers(&[512, 1024, 2048, 4096, 8192], texels, Change::ShadowMap),
        },
    ];
    if subject.look.shadows == Shadows::Soft {
        knobs.push(Knob {
            name: "shadow_samples",
            metric: Metric::Light,
            about: "samples per side of the filter that makes penumbras",
            values: numbers(&[1, 2, 4, 6, 8, 12, 16], texels, Change::ShadowSamples),
        });
    }
    knobs
}

/// What is not swept here, and why.
pub fn unswept(subject: Subject) -> Vec<Unswept> {
    let mut list = vec![Unswept {
        knob: "roof method",
        reason: "there is one, the straight skeleton on an exact grid; what fails its checks is counted in the ledger",
    }];
    let absent = [
        (!subject.shadows(), "shadow_map", "the recipe has no shadows, or no sun"),
        (subject.shadows() && subject.look.shadows != Shadows::Soft, "shadow_samples", "hard shadows take one sample"),
        (!subject.sky(), "sky_samples", "nothing hides the sky in this recipe"),
        (!subject.fields(), "field_map", "the recipe has neither clouds nor a state of the ground"),
        (!subject.textures, "texture filter", "the scene has no textures"),
    ];
    list.extend(absent.iter().filter(|a| a.0).map(|&(_, knob, reason)| Unswept { knob, reason }));
    list
}

/// Settings of several knobs at once, coarse to fine: what the overall frontier is made of.
pub fn combinations(subject: Subject, own: Quality) -> Vec<(String, Quality)> {
    let maps: &[(u32, u32)] =
        if subject.shadows() { &[(1024, 1), (2048, 4), (4096, 4), (8192, 8)] } else { &[(64, 1)] };
    let skies: &[u32] = if subject.sky() { &[8, 24, 64] } else { &[1] };
    let mut all = Vec::new();
    for &supersample in &[1, 2, 3, 4, 6] {
        for &(shadow_map, shadow_samples) in maps {
            for &sky_samples in skies {
                let mut name = vec![format!("{} samples", supersample * supersample)];
                if subject.shadows() {
                    name.push(format!("map {shadow_map}, filter {shadow_samples}"));
                }
                if subject.sky() {
                    name.push(format!("sky {sky_samples}"));
                }
                let quality = Quality { supersample, shadow_map, shadow_samples, sky_samples, ..own };
                all.push((name.join(", "), quality));
            }
        }
    }
    all
}
