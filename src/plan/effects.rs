//! Effects: what light meets on its way beside the scene's surfaces. In: numbers that a recipe and a clear-sky model
//! give. Out: what both renderers are to evaluate, each in its own way. Data; shadows and ambient light alone are drawn
//! so far, nothing makes the others.

use std::sync::Arc;

use glam::DVec2;

/// How a colour image is lit and taken. An effect that is `None` or `Off` costs nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    pub shadows: Shadows,
    pub ambient: Ambient,
    pub haze: Option<Haze>,
    pub clouds: Option<Clouds>,
    pub ground: Option<GroundState>,
    pub sensor: Option<Sensor>,
}

impl Look {
    /// Sun and ambient light alone.
    pub fn plain(shadows: Shadows, ambient: Ambient) -> Look {
        Look { shadows, ambient, haze: None, clouds: None, ground: None, sensor: None }
    }

    /// What an image that is not colour has.
    pub fn none() -> Look {
        Look::plain(Shadows::Off, Ambient::Off)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    Off,
    /// Of a point in the middle of the sun's disc.
    Hard,
    /// Of the sun's whole disc.
    Soft,
}

/// Light that comes from everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ambient {
    Off,
    /// The same radiance from every direction, linear RGB; nothing hides it.
    Constant([f64; 3]),
    /// A sky of radiance `zenith` over a ground of radiance `ground`, linear RGB.
    Sky {
        zenith: [f64; 3],
        ground: [f64; 3],
        /// Whether the scene hides parts of the sky; what hides it is black.
        occluded: bool,
    },
}

/// Haze that thins out with height: what a path of length s takes away and what it adds,
/// `radiance · t + airlight · (1 - t)` with `t = exp(-∫ extinction · exp(-(y - base) / scale_height) ds)` per channel
/// (Koschmieder 1924). It lies on the path from a surface to the camera; where nothing is drawn there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Haze {
    /// Per metre at the height `base`, linear RGB.
    pub extinction: [f64; 3],
    /// Metres over which it falls to 1/e.
    pub scale_height: f64,
    /// World height, metres.
    pub base: f64,
    /// Radiance of an endless path, linear RGB.
    pub airlight: [f64; 3],
}

/// One layer of clouds without thickness. A path that crosses it at plan position p under the angle with cosine c to the
/// vertical keeps `exp(-optical_depth(p) / c)` of its light. That holds for the sun's light on its way down (their
/// shadows) and for what a camera above the layer sees of the ground; the rest is the radiance `color`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clouds {
    pub key: u64,
    /// Share of the sky that is covered, 0..1.
    pub cover: f64,
    /// World height, metres.
    pub height: f64,
    /// Metres across of the largest puffs.
    pub size: f64,
    /// Optical depth (vertical) of their middles.
    pub depth: f64,
    /// Radiance of an opaque cloud seen from above, linear RGB.
    pub color: [f64; 3],
}

/// What lies on the ground around changed features: the albedo of surfaces that look up (normal y over ½) goes to
/// that of its kind by the share covered.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundState {
    pub key: u64,
    pub kind: GroundKind,
    /// Share covered next to a changed feature, 0..1.
    pub strength: f64,
    /// Metres beyond a feature's edge at which nothing is left.
    pub reach: f64,
    /// Discs about the changed features: centre and radius in the plan, metres.
    pub around: Arc<[(DVec2, f64)]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum GroundKind {
    /// Grey, dull, with soft borders.
    Ash,
    /// Dark wet ground with sharp borders that reflects the sky.
    Puddles,
}

/// From linear radiance to the numbers of an image file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    pub key: u64,
    /// Standard deviation of a Gaussian point-spread function, pixels; 0 is none beyond the pixel's own area.
    pub psf: f64,
    /// Factor on radiance.
    pub exposure: f64,
    /// Standard deviation of what is added to every value, of full scale.
    pub read_noise: f64,
    /// Electrons at full scale, whose count fluctuates by its square root; 0 is no shot noise.
    pub full_well: f64,
    pub depth: BitDepth,
    pub bands: Bands,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitDepth {
    /// sRGB-encoded bands of 8 bits.
    Eight,
    /// Linear bands of 16 bits.
    Sixteen,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bands {
    Rgb,
    /// Near infrared alone, one band.
    Nir(NirLight),
    /// The mean of red, green, blue and near infrared, one band.
    Panchromatic(NirLight),
    /// Near infrared, red, green: the false colours in which vegetation is red.
    FalseColor(NirLight),
}

/// The light of the near-infrared band, in the units of the other three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NirLight {
    pub sun: f64,
    pub zenith: f64,
    pub ground: f64,
    /// Per metre; the haze of this band.
    pub extinction: f64,
    pub airlight: f64,
}
