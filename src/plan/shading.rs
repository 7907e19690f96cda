//! Shading: which terms of light an image has, and the maps in which each is looked up. Data only.

use std::sync::Arc;

use glam::DVec2;

use super::demand::{Ambient, Sun};
use super::effects::{Bands, Clouds, GroundKind, GroundState, Haze};
use super::light::LightFrame;
use super::resource::ResourceId;

/// How shadows are looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ShadowFilter {
    #[default]
    Unshadowed,
    /// Of a point: the map's texels, blended between their centres.
    Hard,
    /// Of a disc: as wide as the disc's image through what stands in the way.
    Soft,
}

/// Which channels of light become the image's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channels {
    #[default]
    Rgb,
    Nir,
    Panchromatic,
    FalseColor,
}

impl From<Bands> for Channels {
    fn from(bands: Bands) -> Channels {
        match bands {
            Bands::Rgb => Channels::Rgb,
            Bands::Nir(_) => Channels::Nir,
            Bands::Panchromatic(_) => Channels::Panchromatic,
            Bands::FalseColor(_) => Channels::FalseColor,
        }
    }
}

/// The terms of a shading: what is not among them is in no shader, no uniform and no texture of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Terms {
    pub shadow: ShadowFilter,
    pub occluded_sky: bool,
    pub haze: bool,
    /// Clouds between a point and the sun.
    pub cloud_shadow: bool,
    /// Clouds between a point and the camera.
    pub cloud_cover: bool,
    pub ground: Option<GroundKind>,
    pub channels: Channels,
}

impl Terms {
    /// Stable words, for names of pipelines and for the conditions in shaders.
    pub fn words(self) -> Vec<&'static str> {
        let shadow = match self.shadow {
            ShadowFilter::Unshadowed => None,
            ShadowFilter::Hard => Some("hard"),
            ShadowFilter::Soft => Some("soft"),
        };
        let ground = self.ground.map(|kind| match kind {
            GroundKind::Ash => "ash",
            GroundKind::Puddles => "puddles",
        });
        let channels = match self.channels {
            Channels::Rgb => None,
            Channels::Nir => Some("nir"),
            Channels::Panchromatic => Some("panchromatic"),
            Channels::FalseColor => Some("false_color"),
        };
        let flag = |on: bool, word| on.then_some(word);
        let sky = flag(self.occluded_sky, "occluded_sky");
        let clouds = [flag(self.cloud_shadow, "cloud_shadow"), flag(self.cloud_cover, "cloud_cover")];
        [shadow, sky, flag(self.haze, "haze"), clouds[0], clouds[1], ground, channels].into_iter().flatten().collect()
    }
}

/// A shadow map and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowLook {
    pub frame: LightFrame,
    pub map: ResourceId,
    pub soft: Option<SoftLook>,
}

/// What the shadow of a disc needs besides the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftLook {
    /// Highest and lowest point of each block of the map, and of blocks of blocks.
    pub bounds: ResourceId,
    /// Most looks into the map, for the search of what stands in the way and for the filter each.
    pub samples: u32,
    /// World height of the scene's top, metres.
    pub top: f64,
}

/// Depth maps from all sides of the sky.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyLook {
    pub maps: ResourceId,
    /// One per layer of the maps.
    pub frames: Arc<[LightFrame]>,
    /// Samples of a pixel look into every `subsets`-th map, each from another one on.
    pub subsets: u32,
}

/// Rectangle of the plan (x east, y north) that a map of `size × size` texels covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldFrame {
    pub low: DVec2,
    pub high: DVec2,
    pub size: u32,
}

impl FieldFrame {
    /// Plan position of a texel's centre.
    pub fn center(&self, column: u32, row: u32) -> DVec2 {
        let share = (DVec2::new(f64::from(column), f64::from(row)) + 0.5) / f64::from(self.size);
        self.low + (self.high - self.low) * share
    }
}

/// A function of the plan that is looked up in a map.
#[derive(Clone, Debug, PartialEq)]
pub enum Field {
    /// Vertical optical depth.
    Clouds(Clouds),
    /// Share of the ground that is covered.
    Ground(GroundState),
}

impl Field {
    pub fn value(&self, plan: DVec2) -> f64 {
        match self {
            Field::Clouds(clouds) => clouds.optical_depth(plan),
            Field::Ground(ground) => ground.coverage(plan),
        }
    }

    pub fn stem(&self) -> &'static str {
        match self {
            Field::Clouds(_) => "cloud_map",
            Field::Ground(_) => "ground_map",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldLook {
    pub frame: FieldFrame,
    pub map: ResourceId,
}

/// Everything that lights a shading.
#[derive(Clone, Debug, PartialEq)]
pub struct Illumination {
    /// `None` where none is above the horizon.
    pub sun: Option<Sun>,
    pub ambient: Ambient,
    pub shadow: Option<ShadowLook>,
    pub sky: Option<SkyLook>,
    pub haze: Option<Haze>,
    /// Where either of the next two is.
    pub clouds: Option<Clouds>,
    pub cloud_shadow: Option<FieldLook>,
    pub cloud_cover: Option<FieldLook>,
    pub ground: Option<(GroundKind, FieldLook)>,
    pub bands: Bands,
}

impl Illumination {
    pub fn terms(&self) -> Terms {
        Terms {
            shadow: match &self.shadow {
                None => ShadowFilter::Unshadowed,
                Some(ShadowLook { soft: None, .. }) => ShadowFilter::Hard,
                Some(ShadowLook { soft: Some(_), .. }) => ShadowFilter::Soft,
            },
            occluded_sky: self.sky.is_some(),
            haze: self.haze.is_some(),
            cloud_shadow: self.cloud_shadow.is_some(),
            cloud_cover: self.cloud_cover.is_some(),
            ground: self.ground.map(|(kind, _)| kind),
            channels: self.bands.into(),
        }
    }

    /// Maps that the shading reads.
    pub fn reads(&self) -> Vec<ResourceId> {
        let soft = self.shadow.iter().filter_map(|shadow| shadow.soft).map(|soft| soft.bounds);
        let shadow = self.shadow.iter().map(|shadow| shadow.map).chain(soft);
        let sky = self.sky.iter().map(|sky| sky.maps);
        let ground = self.ground.map(|(_, look)| look);
        let fields = [self.cloud_shadow, self.cloud_cover, ground].into_iter().flatten().map(|look| look.map);
        shadow.chain(sky).chain(fields).collect()
    }
}
