//! Passes: what is drawn, with which light, into what; and the plan that orders them. Data only.
//!
//! A *stage* is a run of passes that is repeated for every tile of the image before the next stage begins, so that
//! only its own textures are alive together.

use std::sync::Arc;

use super::demand::{Camera, Output, State};
use super::effects::Sensor;
use super::light::LightFrame;
use super::resource::{Resource, ResourceId};
use super::shading::{Field, FieldFrame, Illumination, Terms};

/// How a surface must be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Surface {
    /// One colour.
    Plain,
    /// Opaque texture.
    Textured,
    /// Texture with holes: texels of alpha under one half are not there.
    Cutout,
}

/// One pipeline to compile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PipelineKey {
    ShadowMap {
        cutout: bool,
    },
    /// The first reads the shadow map, the other its blocks.
    ShadowBounds {
        first: bool,
    },
    Shade {
        surface: Surface,
        terms: Terms,
    },
    Resolve {
        supersample: u32,
        linear: bool,
    },
    Ids {
        cutout: bool,
    },
    Depth {
        cutout: bool,
    },
}

/// Objects that a pass draws: one flag per object, the selected ones that have a visible surface.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawSet {
    pub state: State,
    pub objects: Arc<[bool]>,
    pub triangles: u64,
}

#[derive(Clone, Debug, PartialEq)]
pub enum PassKind {
    /// Depth from the sun.
    ShadowMap { draw: DrawSet, light: LightFrame },
    /// Highest and lowest point of every block of a shadow map.
    ShadowBounds { light: LightFrame },
    /// Depth from all sides of the sky, one layer each.
    SkyMaps { draw: DrawSet, frames: Arc<[LightFrame]> },
    /// A function of the plan, evaluated on the CPU.
    Field { field: Box<Field>, frame: FieldFrame },
    /// Linear radiance.
    Shade { draw: DrawSet, light: Box<Illumination> },
    /// Mean of the samples of a pixel in linear light, then sRGB unless `linear`.
    Resolve { supersample: u32, linear: bool },
    /// Object numbers at pixel centres, one sample, never blended.
    Ids { draw: DrawSet },
    /// Depth at pixel centres alone.
    Depth { draw: DrawSet },
}

impl PassKind {
    /// The word that the pass, its shader, its labels and its resources share.
    pub fn stem(&self) -> &'static str {
        match self {
            PassKind::ShadowMap { .. } => "shadow_map",
            PassKind::ShadowBounds { .. } => "shadow_bounds",
            PassKind::SkyMaps { .. } => "sky_maps",
            PassKind::Field { field, .. } => field.stem(),
            PassKind::Shade { .. } => "shade",
            PassKind::Resolve { .. } => "resolve",
            PassKind::Ids { .. } => "ids",
            PassKind::Depth { .. } => "depth",
        }
    }

    pub fn draw(&self) -> Option<&DrawSet> {
        match self {
            PassKind::ShadowMap { draw, .. }
            | PassKind::SkyMaps { draw, .. }
            | PassKind::Shade { draw, .. }
            | PassKind::Ids { draw }
            | PassKind::Depth { draw } => Some(draw),
            PassKind::ShadowBounds { .. } | PassKind::Field { .. } | PassKind::Resolve { .. } => None,
        }
    }
}

/// One pass with all it may touch: the renderer opens no other resource and compiles no other pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    pub kind: PassKind,
    pub reads: Vec<ResourceId>,
    pub writes: Vec<ResourceId>,
    pub pipelines: Vec<PipelineKey>,
}

/// How texels become the pixels of an image file. Tables are indexed by what [`PassKind::Ids`] writes.
#[derive(Clone, Debug, PartialEq)]
pub enum Encoding {
    /// RGB bytes as they are.
    Color,
    /// Linear radiance that a sensor takes.
    Sensor(Sensor),
    /// 8-bit label of each object.
    Label(Arc<[u8]>),
    /// 32-bit label of each object.
    Number(Arc<[u32]>),
    /// Metres along the viewing direction from reverse depth; infinite at 0.
    Distance,
}

/// An image that leaves the renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    /// Place among the view's demanded outputs.
    pub index: usize,
    /// Name of the recipe's pass.
    pub pass: String,
    pub output: Output,
    pub source: ResourceId,
    pub encoding: Encoding,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Repeated per tile of the image; a shadow map is drawn once.
    pub tiled: bool,
    pub passes: Vec<Pass>,
    pub products: Vec<Product>,
}

/// Something that is not done, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    pub what: String,
    pub reason: String,
}

/// Everything that is done for one view.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewPlan {
    pub name: String,
    pub camera: Camera,
    /// Distance of the far plane along the viewing direction, metres: depth runs from it (0) to `camera.near` (1).
    pub far: f64,
    /// What of the demand has a number that is not finite: renderers refuse such a plan.
    pub not_finite: Option<&'static str>,
    pub resources: Vec<Resource>,
    pub stages: Vec<Stage>,
    pub skipped: Vec<Skipped>,
}

impl ViewPlan {
    pub fn passes(&self) -> impl Iterator<Item = &Pass> {
        self.stages.iter().flat_map(|stage| &stage.passes)
    }
}

/// Everything that the renderer will do, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderPlan {
    pub views: Vec<ViewPlan>,
}

/// How much a plan (or a renderer that ran it) makes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pub passes: usize,
    /// Render targets; the textures of materials are not among them.
    pub textures: usize,
    pub pipelines: usize,
}

impl RenderPlan {
    pub fn counts(&self) -> Counts {
        use std::collections::BTreeSet;
        let passes = || self.views.iter().flat_map(ViewPlan::passes);
        let textures: BTreeSet<_> = self.views.iter().flat_map(|v| &v.resources).map(|r| r.texture).collect();
        let pipelines: BTreeSet<_> = passes().flat_map(|p| &p.pipelines).collect();
        Counts { passes: passes().count(), textures: textures.len(), pipelines: pipelines.len() }
    }
}
