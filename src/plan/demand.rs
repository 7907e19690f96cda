//! What every view asks for, with all draws made: numbers only, no distributions, no defaults left open.

use glam::DVec3;

use crate::spec::render_spec::QualitySpec;

pub use super::effects::{Ambient, Look, Shadows};

/// How space is projected onto the image. Pixel (i, j) covers [i, i+1) × [j, j+1), j downwards, centre at +0.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Half extents of the image plane at distance 1 (tangents of the half angles).
    Perspective { tan_x: f64, tan_y: f64 },
    /// Half extents of the image in metres.
    Orthographic { half_x: f64, half_y: f64 },
}

/// A camera in world metres (x east, y up, z south). `right`, `up`, `forward` are orthonormal,
/// `right × up = -forward`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub position: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub forward: DVec3,
    pub projection: Projection,
    /// Pixels.
    pub width: u32,
    pub height: u32,
    /// Distance of the near plane, metres. The far plane lies behind the scene (reverse-Z).
    pub near: f64,
}

/// Metres: steps of [`Camera::to_origin`], so that it is added to positions without rounding.
const ORIGIN_STEP: f64 = 1.0 / 1024.0;

impl Camera {
    /// From the camera to where its axis enters the scene, the near plane.
    pub fn to_origin(&self) -> DVec3 {
        (self.forward * (self.near / ORIGIN_STEP)).round() * ORIGIN_STEP
    }

    /// The point about which positions are kept in 32 bits: differences within the scene then have their digits, however
    /// far away the camera is.
    pub fn origin(&self) -> DVec3 {
        self.position + self.to_origin()
    }
}

/// The sun as the renderer needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Unit vector from the ground towards the sun; `y > 0`.
    pub direction: DVec3,
    /// Angular diameter of the disc, degrees (0 for a point).
    pub disc_deg: f64,
    /// Irradiance on a surface facing the sun, linear RGB, 1 is the brightness that a white diffuse surface shows as white.
    pub irradiance: [f64; 3],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum State {
    Before,
    After,
}

/// Linear radiance where nothing is drawn: a dark, nearly neutral ground (sRGB 99, 102, 94).
pub const BACKGROUND: [f64; 3] = [0.125, 0.133, 0.112];

/// Which objects a pass draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// What the recipe asked for, for people; a pass may also show both states at once or some changes only.
    pub state: State,
    /// One flag per object of the scene. The flags say everything: an object that is not there in the pass's state has
    /// none, whatever [`crate::scene::Presence`] says.
    pub objects: std::sync::Arc<[bool]>,
}

/// What a pass writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Output {
    /// sRGB image, 8 bit.
    Color,
    /// 8-bit semantic class numbers.
    Class,
    /// 0 or 255: pixels whose nearest selected object belongs to the pass's `marked` objects.
    Mask,
    /// 8-bit change level (0 unchanged).
    Level,
    /// 32-bit instance numbers.
    Instance,
    /// Distance along the viewing direction in metres, 32-bit float; infinite where nothing is.
    Depth,
}

/// One image of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputDemand {
    /// Name of the recipe's pass.
    pub pass: String,
    pub output: Output,
    pub selection: Selection,
    /// For [`Output::Mask`]: one flag per object.
    pub marked: Option<std::sync::Arc<[bool]>>,
    /// What a colour image shows of light; [`Look::none`] for all others.
    pub look: Look,
}

/// Settings that trade accuracy for time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Samples per pixel side (2 means 2 × 2 samples).
    pub supersample: u32,
    /// Texels per side of the shadow map.
    pub shadow_map: u32,
    /// Samples of the shadow filter per side.
    pub shadow_samples: u32,
    /// Directions from which an occluded sky is seen.
    pub sky_samples: u32,
    /// Texels per side of the maps of clouds and of the state of the ground.
    pub field_map: u32,
}

impl From<&QualitySpec> for Quality {
    fn from(spec: &QualitySpec) -> Quality {
        let QualitySpec {
            supersample,
            shadow_map,
            shadow_samples,
            sky_samples,
            field_map,
            detail_m: _,
            curves: _,
            budget: _,
        } = *spec;
        Quality { supersample, shadow_map, shadow_samples, sky_samples, field_map }
    }
}

/// One view with everything drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewDemand {
    pub name: String,
    pub camera: Camera,
    pub sun: Option<Sun>,
    pub quality: Quality,
    pub outputs: Vec<OutputDemand>,
}
