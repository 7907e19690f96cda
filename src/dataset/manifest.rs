//! `manifest.json`: everything that went into a dataset and everything that was drawn.
//!
//! It holds no clock time and no absolute path, so that the same run gives the same bytes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::writer::WrittenFile;
use crate::geodata::ledger::Ledger;

/// The whole manifest; fields stand in the file in this order.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    /// Version of this format.
    pub manifest: u32,
    pub generator: Generator,
    /// Text that must accompany everything made from the map.
    pub attribution: String,
    pub dataset: String,
    /// Name of the recipe's file; it is among the inputs.
    pub recipe: String,
    /// Values of the recipe's arguments given on the command line, without paths' folders.
    pub arguments: BTreeMap<String, String>,
    /// Recipe, rules, maps, elevation, textures and assets.
    pub inputs: Vec<InputFile>,
    pub renderer: RendererInfo,
    /// Semantic class names by the number in class images.
    pub classes: BTreeMap<u8, &'static str>,
    pub scenes: Vec<SceneRecord>,
    /// Error budgets, one for each scene; absent where the recipe has none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub budgets: Vec<BudgetRecord>,
    pub views: Vec<ViewRecord>,
    /// Every other file of the dataset.
    pub files: Vec<WrittenFile>,
}

#[derive(Clone, Debug, Serialize)]
pub struct Generator {
    pub name: &'static str,
    pub version: &'static str,
}

/// One input by content.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct InputFile {
    /// `recipe`, `rules`, `map`, `elevation`, `texture`, `asset`.
    pub role: &'static str,
    /// As the recipe or rule file names it.
    pub name: String,
    /// Where it lies below the recipe's folder, with `/`; absent for what lies elsewhere or comes with the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    pub bytes: u64,
    /// Of texts as they were decoded, of other files as they lie on disk.
    pub sha256: String,
}

/// What made the images.
#[derive(Clone, Debug, Serialize)]
pub struct RendererInfo {
    /// That of the adapter, or `reference`.
    pub backend: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adapter: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driver: Option<String>,
    /// Of the reference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples_per_pixel: Option<u32>,
}

/// One scene as it was built.
#[derive(Clone, Debug, Serialize)]
pub struct SceneRecord {
    pub name: String,
    pub seed: u64,
    /// Longitude and latitude of the local frame's origin, degrees (WGS 84).
    pub origin: [f64; 2],
    /// Hash of all meshes, materials and labels: equal hashes, equal geometry.
    pub geometry_sha256: String,
    pub features: usize,
    pub triangles: usize,
    /// Greatest vertical distance between the ground mesh and the elevation data, metres.
    pub terrain_error_m: f64,
    /// Upright faces smaller than this in every direction were not derived further, metres; 0 derives all.
    pub detail_m: f64,
    pub changes: Vec<ChangeRecord>,
    pub reports: BTreeMap<String, ReportRecord>,
    pub ledger: Ledger,
}

/// What a budget promised in a scene, what was chosen for it, and what it came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BudgetRecord {
    pub scene: String,
    pub chosen: ChosenRecord,
    pub limits: Vec<LimitRecord>,
}

/// Knobs as recipes write them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChosenRecord {
    pub antialiasing: u32,
    pub shadow_map: u32,
    pub shadow_samples: u32,
    pub sky_samples: u32,
    pub field_map: u32,
}

/// One promise: `error` and `shadow` are shares (of white; of shadow that is in its place), `edge` is in pixels,
/// `height` in metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LimitRecord {
    pub of: &'static str,
    pub promised: f64,
    /// In the windows that the settings were chosen by.
    pub calibrated: Option<f64>,
    /// In other windows; `null` where there was nothing to measure.
    pub achieved: Option<f64>,
}

/// Sums of one report key over all features, in the state *before*.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportRecord {
    pub count: u64,
    pub sum: f64,
    pub min: f64,
    pub max: f64,
}

/// One change block as it was drawn.
#[derive(Clone, Debug, Serialize)]
pub struct ChangeRecord {
    pub name: String,
    pub non_target: bool,
    /// Map objects that the change could have drawn.
    pub candidates: usize,
    /// The share that was drawn, 0..1.
    pub share: f64,
    /// Map ids and instance numbers of the changed features, with their level.
    pub changed: Vec<ChangedFeature>,
}

#[derive(Clone, Debug, Serialize)]
pub struct ChangedFeature {
    pub feature: String,
    pub instance: u32,
    pub level: u8,
}

/// One view with everything that was drawn for it.
#[derive(Clone, Debug, Serialize)]
pub struct ViewRecord {
    pub name: String,
    pub scene: String,
    pub split: &'static str,
    /// Path of the property → value.
    pub draws: BTreeMap<String, serde_json::Value>,
    pub acquisitions: Vec<AcquisitionRecord>,
    /// Image name → file.
    pub images: BTreeMap<String, WrittenFile>,
    /// Image name → what it holds, as recipes name it: `colour`, `class`, `mask`, `level`, `instance`, `depth`.
    pub outputs: BTreeMap<String, &'static str>,
    /// Image name → mean standard error of its linear light, of images that the reference made.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub standard_errors: BTreeMap<String, f64>,
}

/// Camera and sun of one acquisition, as used.
#[derive(Clone, Debug, Serialize)]
pub struct AcquisitionRecord {
    /// Names of the images taken with it.
    pub images: Vec<String>,
    pub width: u32,
    pub height: u32,
    /// Metres in the local frame: x east, y up, z south.
    pub position: [f64; 3],
    pub right: [f64; 3],
    pub up: [f64; 3],
    pub forward: [f64; 3],
    /// `perspective` with tangents of the half angles, or `orthographic` with half extents in metres.
    pub projection: &'static str,
    pub half_x: f64,
    pub half_y: f64,
    /// Degrees above the horizon and clockwise from north; absent without a sun.
    pub sun_elevation: Option<f64>,
    pub sun_azimuth: Option<f64>,
    /// Image name → what lit and took it besides sun and ambient light, where anything did.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub effects: BTreeMap<String, serde_json::Value>,
}

impl Manifest {
    /// The file's bytes: indented JSON with a final line break.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(self).expect("names and finite numbers serialise");
        bytes.push(b'\n');
        bytes
    }
}
