//! What a recipe means, checked: names are indices, units are metres and degrees, defaults are filled in.
//!
//! Made only by [`crate::spec::load`]. Draws are still open ([`Distribution`]); `plan` makes them.

use std::path::{Path, PathBuf};

use super::draw::{Distribution, pick};
pub use super::effects::{
    AmbientSpec, BandsSpec, CloudsSpec, EffectOverrides, EffectsSpec, ExposureSpec, GroundKindSpec, GroundSpec,
    HazeSpec, SensorSpec, ShadowsSpec, SunColour,
};
use super::filter::Filter;
use crate::geodata::feature::FeatureClass;
use crate::interpreter::seed::Seed;
use crate::source::{Access, AccessError, Span};

/// A whole recipe.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderSpec {
    pub scenes: Vec<SceneSpec>,
    /// In the order of the files; the number of a change in labels and in [`crate::scene::SceneObject::change`] is its
    /// index + 1. Where two changes draw the same feature, the first one has it.
    pub changes: Vec<ChangeSpec>,
    pub passes: Vec<PassSpec>,
    pub datasets: Vec<DatasetSpec>,
}

/// A file named in a recipe, as written.
#[derive(Clone, Debug, PartialEq)]
pub struct FileRef {
    /// As written, without the `mansard:` of shipped files.
    pub written: String,
    pub origin: Origin,
    pub span: Span,
}

/// What a path is relative to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The folder of the recipe that names it.
    Beside(PathBuf),
    /// The working folder: the user gave the path on the command line, which allows it wherever it is.
    CommandLine,
    /// A rule file that comes with the program (`"mansard:residential.cga"`).
    Shipped,
}

impl FileRef {
    /// The real path of a file that is not shipped; see [`Access::resolve`].
    ///
    /// # Panics
    /// On [`Origin::Shipped`], which has no path.
    pub fn resolve(&self, access: &Access) -> Result<PathBuf, AccessError> {
        match &self.origin {
            Origin::Beside(folder) => access.resolve(folder, &self.written),
            Origin::CommandLine => {
                let path = Path::new(&self.written);
                access.note(path);
                path.canonicalize().map_err(|source| AccessError::Io { path: self.written.clone(), source })
            }
            Origin::Shipped => unreachable!("shipped files are embedded, ask for their text"),
        }
    }
}

/// One place.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpec {
    pub name: String,
    pub span: Span,
    pub seed: u64,
    /// At least one.
    pub maps: Vec<FileRef>,
    /// Tiles; none means flat ground at height 0.
    pub elevations: Vec<FileRef>,
    /// `None`: the bounds of the maps.
    pub area: Option<AreaSpec>,
    /// First match wins.
    pub rules: Vec<RuleAssignment>,
    /// Values for tags that a feature does not have; first match for each tag wins.
    pub missing: Vec<MissingTag>,
}

/// What part of the map belongs to the scene, WGS 84 degrees.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaSpec {
    BoundingBox {
        west: f64,
        south: f64,
        east: f64,
        north: f64,
    },
    /// Metres east-west and north-south about a centre.
    Around {
        latitude: f64,
        longitude: f64,
        width: f64,
        height: f64,
    },
    /// (latitude, longitude) of at least three corners; either winding, not closed.
    Polygon(Vec<(f64, f64)>),
}

/// A rule file for the features that its filter takes.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleAssignment {
    pub file: FileRef,
    /// `None`: the rule file's own start rule.
    pub start: Option<String>,
    pub filter: Filter,
    /// Later entries win over earlier ones and over tags.
    pub attributes: Vec<AttributeSpec>,
    pub span: Span,
}

/// A value for an attribute of a rule file.
#[derive(Clone, Debug, PartialEq)]
pub struct AttributeSpec {
    pub name: String,
    pub value: AttributeValue,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum AttributeValue {
    Value(ValueSpec),
    /// The feature's tag; without the tag the default, without a default the rule file's own value.
    Tag {
        key: String,
        default: Option<ValueSpec>,
    },
}

/// A value in the rule language's three types, or how to draw one. Lengths in metres, angles in degrees, 40 % is 0.4.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueSpec {
    Number(Distribution),
    Bool(bool),
    Text(String),
    /// Alternatives with weights.
    TextChoice(Vec<(String, f64)>),
}

/// A value that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnValue {
    Number(f64),
    Bool(bool),
    Text(String),
}

impl ValueSpec {
    pub fn draw(&self, seed: Seed) -> DrawnValue {
        match self {
            ValueSpec::Number(distribution) => DrawnValue::Number(distribution.draw(seed)),
            ValueSpec::Bool(value) => DrawnValue::Bool(*value),
            ValueSpec::Text(value) => DrawnValue::Text(value.clone()),
            ValueSpec::TextChoice(alternatives) => {
                let weights: Vec<f64> = alternatives.iter().map(|(_, weight)| *weight).collect();
                DrawnValue::Text(alternatives[pick(&weights, seed.named("choice"))].0.clone())
            }
        }
    }
}

/// The value of a tag for features of the filter that lack it.
#[derive(Clone, Debug, PartialEq)]
pub struct MissingTag {
    pub filter: Filter,
    pub tag: String,
    pub value: ValueSpec,
    pub span: Span,
}

/// What differs between *before* and *after*.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangeSpec {
    pub name: String,
    pub span: Span,
    pub of: Filter,
    pub amount: Amount,
    /// At least one; the label of a level is its index + 1.
    pub levels: Vec<LevelSpec>,
    /// A change that must not be labelled: it is not part of `changed`.
    pub non_target: bool,
}

/// How many of the features that a change is `of` are changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Amount {
    All,
    /// 0..1.
    Share(Distribution),
    /// Whole numbers after rounding; at most all.
    Count(Distribution),
}

/// A degree of change.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSpec {
    /// The change's name where it has one level.
    pub name: String,
    /// Share of the changed features among the levels (positive; they need not add up to 1).
    pub weight: f64,
    pub effect: LevelEffect,
    pub span: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub enum LevelEffect {
    /// *After* is derived with these rules, first match wins.
    Rules(Vec<RuleAssignment>),
    /// There before, gone after.
    Demolished,
    /// Not there before; after it is derived with the scene's rules.
    Built,
}

/// How a view is taken; see `docs/render.md` for the one equation that ties size, gsd, fov and altitude.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraSpec {
    pub name: String,
    pub span: Span,
    /// Pixels.
    pub width: u32,
    pub height: u32,
    pub lens: Lens,
    /// Degrees between the line of sight and the vertical, 0..80.
    pub off_nadir: Distribution,
    /// Degrees clockwise from north: where the camera stands, seen from the target.
    pub azimuth: Distribution,
    /// Degrees clockwise from north to the top of the image.
    pub heading: Distribution,
}

/// Two of ground sample distance, field of view and altitude; the third follows from the image size.
/// Gsd (m) and altitude (m) hold at the target across the line of sight; fov (degrees) spans the image width.
#[derive(Clone, Debug, PartialEq)]
pub enum Lens {
    GsdFov { gsd: Distribution, fov: Distribution },
    GsdAltitude { gsd: Distribution, altitude: Distribution },
    FovAltitude { fov: Distribution, altitude: Distribution },
    Orthographic { gsd: Distribution },
}

/// Where the light comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct SunSpec {
    pub span: Span,
    pub position: SunPosition,
    /// Angular diameter in degrees; 0 is a point.
    pub disc: Distribution,
    /// Irradiance on a surface that faces the sun; 1 shows a white diffuse surface as white.
    pub intensity: Distribution,
    /// Linear RGB at intensity 1.
    pub colour: SunColour,
}

#[derive(Clone, Debug, PartialEq)]
pub enum SunPosition {
    /// Degrees above the horizon and clockwise from north.
    Angles { elevation: Distribution, azimuth: Distribution },
    /// The seed paper's arc in degrees: 0 the eastern horizon, 90 the top, 180 the western horizon; the arc is tilted
    /// towards the south by `tilt` and then turned clockwise by `turn`.
    Arc { declination: Distribution, tilt: Distribution, turn: Distribution },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualitySpec {
    /// Samples per pixel side.
    pub supersample: u32,
    /// Texels per side.
    pub shadow_map: u32,
    /// Shadow filter samples per side.
    pub shadow_samples: u32,
    /// Directions from which an occluded sky is seen.
    pub sky_samples: u32,
    /// Texels per side of the maps of clouds and of the state of the ground.
    pub field_map: u32,
    /// Facade detail that need not be derived: upright faces smaller than this in every direction, metres.
    pub detail_m: f64,
    /// Bands of planes from the eaves to the top of round roofs.
    pub curves: u32,
    /// Errors to keep: the knobs that the recipe does not give are then chosen by measuring.
    pub budget: Option<BudgetSpec>,
}

/// Greatest errors that images may have, and what is fixed all the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BudgetSpec {
    /// Root mean square error of linear light, of white.
    pub error: Option<f64>,
    /// Root mean square displacement of edges, pixels.
    pub edge: Option<f64>,
    /// Height of the ground mesh beside the elevation data, metres.
    pub height: Option<f64>,
    /// Least share of the true shadow, intersection over union.
    pub shadow: Option<f64>,
    pub fixed: FixedKnobs,
}

/// Knobs that the recipe gives beside a budget.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedKnobs {
    pub supersample: bool,
    pub shadow_map: bool,
    pub shadow_samples: bool,
    pub sky_samples: bool,
    pub field_map: bool,
}

/// A set of objects.
#[derive(Clone, Debug, PartialEq)]
pub enum SetSpec {
    All,
    Terrain,
    Class(FeatureClass),
    /// What the effect `vegetation` adds.
    Vegetation,
    /// Touched by this change.
    Change(usize),
    /// Touched by a change that is not `non_target`.
    Changed,
    Any(Vec<SetSpec>),
    Every(Vec<SetSpec>),
    Not(Box<SetSpec>),
}

/// In which state a pass sees the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StateSpec {
    Before,
    /// With these changes made (indices into [`RenderSpec::changes`]).
    After(Vec<usize>),
    /// All objects of *before* together with all of *after* these changes.
    Both(Vec<usize>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum OutputSpec {
    Colour,
    Class,
    Mask,
    Level,
    Instance,
    Depth,
}

/// Passes of one acquisition share the camera, the sun and the effects of a view; another acquisition draws its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AcquisitionSpec {
    pub name: String,
    pub camera: bool,
    pub sun: bool,
    pub effects: bool,
}

/// What is shown and what is written.
#[derive(Clone, Debug, PartialEq)]
pub struct PassSpec {
    pub name: String,
    pub span: Span,
    /// Only these objects are drawn; nothing else hides them.
    pub show: SetSpec,
    pub state: StateSpec,
    /// What a mask marks among the objects shown; `None`: everything shown.
    pub mark: Option<SetSpec>,
    /// At least one. Image names are the pass's name, or `pass_output` where it has several.
    pub outputs: Vec<(OutputSpec, String)>,
    /// What it says of effects, instead of the dataset's.
    pub effects: EffectOverrides,
    /// `None`: the view's own draws.
    pub acquisition: Option<AcquisitionSpec>,
}

/// One image geometry of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewSpec {
    /// `scene_camera_number`, unique in the dataset.
    pub name: String,
    /// Index into [`RenderSpec::scenes`].
    pub scene: usize,
    pub camera: CameraSpec,
    /// From 1, among the views of the same camera in the same scene: with the camera's name the key of all draws.
    pub number: u32,
    pub split: Split,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Split {
    Train,
    Val,
    Test,
}

impl Split {
    /// The folder or prefix that loaders expect.
    pub fn name(self) -> &'static str {
        match self {
            Split::Train => "train",
            Split::Val => "val",
            Split::Test => "test",
        }
    }
}

/// How files are laid out. In both LEVIR layouts the pair and its label have the folders that loaders expect; every
/// other image has a folder of its own name beside them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LayoutSpec {
    /// `<view>/<image>.png`.
    Plain,
    /// LEVIR-CD as open-cd reads it: `{train,val,test}/{A,B,label}/<view>.png`; in the label
    /// every value but 0 is written as 255.
    Levir(Pair),
    /// LEVIR-CD as torchgeo reads it: `{A,B,label}/{train,val,test}_<view>.png`, label likewise.
    LevirFlat(Pair),
}

/// Image names (of [`PassSpec::outputs`]) that make a pair and its label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    pub a: String,
    pub b: String,
    pub label: String,
}

/// Images to make in one run.
#[derive(Clone, Debug, PartialEq)]
pub struct DatasetSpec {
    pub name: String,
    pub span: Span,
    pub views: Vec<ViewSpec>,
    /// Indices into [`RenderSpec::passes`].
    pub passes: Vec<usize>,
    pub sun: SunSpec,
    pub effects: EffectsSpec,
    pub quality: QualitySpec,
    pub layout: LayoutSpec,
}

impl RenderSpec {
    /// Whether any image of any dataset shows plants.
    pub fn wants_vegetation(&self) -> bool {
        let of_dataset = |dataset: &DatasetSpec| {
            let passes = dataset.passes.iter().map(|&pass| &self.passes[pass]);
            dataset.effects.vegetation && passes.len() > 0
                || passes.into_iter().any(|pass| pass.effects.vegetation == Some(true))
        };
        self.datasets.iter().any(of_dataset)
    }

    /// Every file that the recipe names, in the order of the recipe, repeats included.
    pub fn files(&self) -> Vec<&FileRef> {
        let scenes = self.scenes.iter().flat_map(|scene| {
            scene.maps.iter().chain(&scene.elevations).chain(scene.rules.iter().map(|rule| &rule.file))
        });
        let levels = self.changes.iter().flat_map(|change| &change.levels).flat_map(|level| match &level.effect {
            LevelEffect::Rules(rules) => rules.as_slice(),
            LevelEffect::Demolished | LevelEffect::Built => &[],
        });
        scenes.chain(levels.map(|rule| &rule.file)).collect()
    }
}
