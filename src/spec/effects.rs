//! What a recipe says of light beside the scene's surfaces, checked: defaults are filled in, draws are still open.

use super::draw::Distribution;

/// Of the sun; leaves room for the sky, so that a white roof under sun and sky is not far above white.
pub const DEFAULT_INTENSITY: f64 = 0.85;

/// Colour of the sun at intensity 1.
#[derive(Clone, Debug, PartialEq)]
pub enum SunColour {
    /// Linear RGB.
    Fixed([f64; 3]),
    /// By the height of the sun and the turbidity (Linke) of the air; the sky follows too.
    ClearSky { turbidity: Distribution },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowsSpec {
    Off,
    Hard,
    Soft,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AmbientSpec {
    Off,
    /// Linear RGB.
    Constant([f64; 3]),
    Sky {
        /// Whether the scene hides parts of it.
        occluded: bool,
    },
}

/// Haze near the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct HazeSpec {
    /// Metres at which a black object keeps 2 % of contrast.
    pub visibility: Distribution,
    /// Metres over which it thins out to 1/e.
    pub scale_height: Distribution,
}

#[derive(Clone, Debug, PartialEq)]
pub struct CloudsSpec {
    /// 0..1.
    pub cover: Distribution,
    /// Metres above the ground in the middle of the scene.
    pub height: Distribution,
    /// Metres across.
    pub size: Distribution,
    /// Optical depth.
    pub depth: Distribution,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroundKindSpec {
    Ash,
    Puddles,
}

/// What lies about the features that a change touched.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundSpec {
    pub kind: GroundKindSpec,
    /// Of the ground next to a feature, 0..1.
    pub share: Distribution,
    /// Metres from a feature.
    pub within: Distribution,
}

#[derive(Clone, Debug, PartialEq)]
pub enum ExposureSpec {
    /// A factor.
    Factor(Distribution),
    /// White level ground in sun and sky is as bright as white.
    Auto,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandsSpec {
    Rgb,
    Nir,
    Panchromatic,
    FalseColour,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SensorSpec {
    /// Pixels, standard deviation.
    pub psf: Distribution,
    pub exposure: ExposureSpec,
    /// Standard deviation, of full scale.
    pub noise: Distribution,
    /// Electrons; `None` is no shot noise.
    pub full_well: Option<Distribution>,
    /// 8 or 16.
    pub bits: u8,
    pub bands: BandsSpec,
}

/// All effects of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectsSpec {
    pub shadows: ShadowsSpec,
    pub ambient: AmbientSpec,
    pub atmosphere: Option<HazeSpec>,
    pub clouds: Option<CloudsSpec>,
    pub ground: Option<GroundSpec>,
    /// Trees and bushes of the map.
    pub vegetation: bool,
    pub sensor: Option<SensorSpec>,
}

/// What a block says of effects; `None` where it says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectOverrides {
    pub shadows: Option<ShadowsSpec>,
    pub ambient: Option<AmbientSpec>,
    pub atmosphere: Option<Option<HazeSpec>>,
    pub clouds: Option<Option<CloudsSpec>>,
    pub ground: Option<Option<GroundSpec>>,
    pub vegetation: Option<bool>,
    pub sensor: Option<Option<SensorSpec>>,
}

impl EffectsSpec {
    /// Every effect is off unless asked for.
    pub const OFF: EffectsSpec = EffectsSpec {
        shadows: ShadowsSpec::Off,
        ambient: AmbientSpec::Off,
        atmosphere: None,
        clouds: None,
        ground: None,
        vegetation: false,
        sensor: None,
    };

    /// These effects, but for what `over` says.
    pub fn with(&self, over: &EffectOverrides) -> EffectsSpec {
        EffectsSpec {
            shadows: over.shadows.unwrap_or(self.shadows),
            ambient: over.ambient.unwrap_or(self.ambient),
            atmosphere: over.atmosphere.clone().unwrap_or_else(|| self.atmosphere.clone()),
            clouds: over.clouds.clone().unwrap_or_else(|| self.clouds.clone()),
            ground: over.ground.clone().unwrap_or_else(|| self.ground.clone()),
            vegetation: over.vegetation.unwrap_or(self.vegetation),
            sensor: over.sensor.clone().unwrap_or_else(|| self.sensor.clone()),
        }
    }
}
