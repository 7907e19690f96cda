//! In: an `effects` block, or what a pass says of effects. Out: an [`EffectsSpec`], [`EffectOverrides`].

use super::{Checker, get};
use crate::spec::ast::{Block, Expr, ExprKind, Property};
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{
    AmbientSpec, BandsSpec, CloudsSpec, EffectOverrides, EffectsSpec, ExposureSpec, GroundKindSpec, GroundSpec,
    HazeSpec, SensorSpec, ShadowsSpec,
};
use crate::spec::units::Dimension;

/// Words of `bands`; two spellings of one of them.
const BANDS: [(&str, BandsSpec); 5] = [
    ("rgb", BandsSpec::Rgb),
    ("nir", BandsSpec::Nir),
    ("panchromatic", BandsSpec::Panchromatic),
    ("false_colour", BandsSpec::FalseColour),
    ("false_color", BandsSpec::FalseColour),
];

/// A clause with a number: its word, what it measures and between which numbers it lies.
type Number = (&'static str, Dimension, (f64, f64));

const ENDLESS: f64 = f64::INFINITY;
const VISIBILITY: Number = ("visibility", Dimension::Length, (100.0, 1e6));
const SCALE_HEIGHT: Number = ("scale_height", Dimension::Length, (10.0, 1e5));
const CLOUD_HEIGHT: Number = ("height", Dimension::Length, (50.0, 20_000.0));
const CLOUD_SIZE: Number = ("size", Dimension::Length, (10.0, 1e5));
const CLOUD_DEPTH: Number = ("depth", Dimension::Plain, (0.0, 1000.0));
const GROUND_SHARE: Number = ("share", Dimension::Share, (0.0, 1.0));
const GROUND_WITHIN: Number = ("within", Dimension::Length, (0.1, 10_000.0));
const PSF: Number = ("psf", Dimension::Pixels, (0.0, 20.0));
const EXPOSURE: Number = ("exposure", Dimension::Plain, (0.0, 1000.0));
const NOISE: Number = ("noise", Dimension::Share, (0.0, 1.0));
const FULL_WELL: Number = ("full_well", Dimension::Plain, (1.0, ENDLESS));

impl Checker<'_> {
    pub fn effects(&mut self, block: &Block) -> Option<EffectsSpec> {
        Some(EffectsSpec::OFF.with(&self.effect_overrides(&block.properties)?))
    }

    /// What the properties say of effects, all mistakes reported.
    pub fn effect_overrides(&mut self, properties: &[Property]) -> Option<EffectOverrides> {
        let shadows = self.given_effect(properties, "shadows", Self::shadows);
        let ambient = self.given_effect(properties, "ambient", Self::ambient);
        let atmosphere = self.given_effect(properties, "atmosphere", Self::atmosphere);
        let clouds = self.given_effect(properties, "clouds", Self::clouds);
        let ground = self.given_effect(properties, "ground", Self::ground);
        let vegetation = self.given_effect(properties, "vegetation", Self::vegetation);
        let sensor = self.given_effect(properties, "sensor", Self::sensor);
        Some(EffectOverrides {
            shadows: shadows?,
            ambient: ambient?,
            atmosphere: atmosphere?,
            clouds: clouds?,
            ground: ground?,
            vegetation: vegetation?,
            sensor: sensor?,
        })
    }

    /// `Some(None)` where the property is not given, `None` where it is wrong.
    fn given_effect<T>(
        &mut self,
        properties: &[Property],
        key: &str,
        read: fn(&mut Self, &Property) -> Option<T>,
    ) -> Option<Option<T>> {
        match get(properties, key) {
            Some(property) => read(self, property).map(Some),
            None => Some(None),
        }
    }

    fn shadows(&mut self, property: &Property) -> Option<ShadowsSpec> {
        let value = self.one(property)?;
        Some(match self.bare_word(value, &["off", "hard", "soft"])? {
            "off" => ShadowsSpec::Off,
            "hard" => ShadowsSpec::Hard,
            _ => ShadowsSpec::Soft,
        })
    }

    fn ambient(&mut self, property: &Property) -> Option<AmbientSpec> {
        const FORM: &str = "of the form `constant(30%)` or `constant(20%, 25%, 30%)`";
        let value = self.one(property)?;
        let word = self.word(value, &["off", "constant", "sky", "sky_with_occlusion"], &[])?;
        match (word, &value.kind) {
            ("off", ExprKind::Word(_)) => Some(AmbientSpec::Off),
            ("sky", ExprKind::Word(_)) => Some(AmbientSpec::Sky { occluded: false }),
            ("sky_with_occlusion", ExprKind::Word(_)) => Some(AmbientSpec::Sky { occluded: true }),
            ("constant", ExprKind::Call { arguments, .. }) => {
                let read: Vec<f64> = arguments.iter().map_while(|argument| self.radiance(&argument.value)).collect();
                match (read.as_slice(), arguments.len()) {
                    ([grey], 1) => Some(AmbientSpec::Constant([*grey; 3])),
                    ([red, green, blue], 3) => Some(AmbientSpec::Constant([*red, *green, *blue])),
                    (read, written) => {
                        if read.len() == written {
                            self.wrong(value, FORM);
                        }
                        None
                    }
                }
            }
            ("constant", _) => {
                self.wrong(value, FORM);
                None
            }
            _ => {
                self.wrong(value, "one of `off`, `sky`, `sky_with_occlusion` and `constant(30%)`");
                None
            }
        }
    }

    /// `off`, or `haze visibility 20km scale_height 1200m`.
    fn atmosphere(&mut self, property: &Property) -> Option<Option<HazeSpec>> {
        let value = self.one(property)?;
        if self.bare_word(value, &["off", "haze"])? == "off" {
            return self.off(property);
        }
        let visibility = self.number(property, VISIBILITY, 20_000.0);
        let scale_height = self.number(property, SCALE_HEIGHT, 1200.0);
        Some(Some(HazeSpec { visibility: visibility?, scale_height: scale_height? }))
    }

    /// `off`, or `30% height 1500m size 400m depth 8`.
    fn clouds(&mut self, property: &Property) -> Option<Option<CloudsSpec>> {
        let value = self.one(property)?;
        if let ExprKind::Word(_) = &value.kind {
            let off = is_word(value, "off");
            if !off {
                self.wrong(value, "`off` or the share of the sky that clouds cover, such as `30%`");
            }
            return off.then(|| self.off(property)).flatten();
        }
        let cover = self.distribution(value, Dimension::Share);
        let cover = cover.and_then(|cover| {
            self.within(&cover, "the share of the sky that clouds cover", value, Dimension::Share, (0.0, 1.0))?;
            Some(cover)
        });
        let height = self.number(property, CLOUD_HEIGHT, 1500.0);
        let size = self.number(property, CLOUD_SIZE, 400.0);
        let depth = self.number(property, CLOUD_DEPTH, 8.0);
        Some(Some(CloudsSpec { cover: cover?, height: height?, size: size?, depth: depth? }))
    }

    /// `off`, or `ash share 40% within 25m`.
    fn ground(&mut self, property: &Property) -> Option<Option<GroundSpec>> {
        let value = self.one(property)?;
        let kind = match self.bare_word(value, &["off", "ash", "puddles"])? {
            "off" => return self.off(property),
            "ash" => GroundKindSpec::Ash,
            _ => GroundKindSpec::Puddles,
        };
        let share = self.number(property, GROUND_SHARE, 0.4);
        let within = self.number(property, GROUND_WITHIN, 25.0);
        Some(Some(GroundSpec { kind, share: share?, within: within? }))
    }

    fn vegetation(&mut self, property: &Property) -> Option<bool> {
        let value = self.one(property)?;
        Some(self.bare_word(value, &["off", "trees"])? == "trees")
    }

    /// `off`, or any of `psf 0.6px exposure 1.2 noise 1% full_well 20000 depth 16bit bands nir`.
    fn sensor(&mut self, property: &Property) -> Option<Option<SensorSpec>> {
        if !property.values.is_empty() {
            let value = self.one(property)?;
            self.bare_word(value, &["off"])?;
            return self.off(property);
        }
        if property.clauses.is_empty() {
            let help = "write `sensor off`, or what it does: `sensor psf 0.6px noise 1% depth 16bit`";
            self.error_with_help("spec::wrong-value", property.span, "`sensor` says nothing", help);
            return None;
        }
        let psf = self.number(property, PSF, 0.0);
        let exposure = self.exposure(property);
        let noise = self.number(property, NOISE, 0.0);
        let full_well = self.given(property, FULL_WELL);
        let bits = self.bits(property);
        let bands = self.bands(property);
        Some(Some(SensorSpec {
            psf: psf?,
            exposure: exposure?,
            noise: noise?,
            full_well: full_well?,
            bits: bits?,
            bands: bands?,
        }))
    }

    fn exposure(&mut self, property: &Property) -> Option<ExposureSpec> {
        if let Some(value) = self.clause_value(property, "exposure")?
            && let ExprKind::Word(_) = value.kind
        {
            if is_word(value, "auto") {
                return Some(ExposureSpec::Auto);
            }
            self.wrong(value, "`auto` or a number such as `1.2`");
            return None;
        }
        self.number(property, EXPOSURE, 1.0).map(ExposureSpec::Factor)
    }

    fn bits(&mut self, property: &Property) -> Option<u8> {
        let Some(value) = self.clause_value(property, "depth")? else { return Some(8) };
        let bits = self.quantity(value, Dimension::Bits)?;
        if bits != 8.0 && bits != 16.0 {
            self.wrong(value, "`8bit` or `16bit`");
            return None;
        }
        Some(bits as u8)
    }

    fn bands(&mut self, property: &Property) -> Option<BandsSpec> {
        let Some(value) = self.clause_value(property, "bands")? else { return Some(BandsSpec::Rgb) };
        let word = self.bare_word(value, &BANDS.map(|(name, _)| name))?;
        Some(BANDS.iter().find(|(name, _)| *name == word).expect("the word is one of these").1)
    }

    /// A word without arguments.
    fn bare_word(&mut self, value: &Expr, words: &[&'static str]) -> Option<&'static str> {
        let word = self.word(value, words, &[])?;
        if let ExprKind::Call { .. } = value.kind {
            self.wrong(value, &format!("a word alone: `{word}` takes nothing in brackets"));
            return None;
        }
        Some(word)
    }

    /// An effect that is off has no settings.
    fn off<T>(&mut self, property: &Property) -> Option<Option<T>> {
        if let Some(clause) = property.clauses.first() {
            let message = format!("`{} off` has no `{}`", property.key.text, clause.word.text);
            self.error("spec::wrong-value", clause.word.span, message);
            return None;
        }
        Some(None)
    }

    /// The only value of a clause; `Some(None)` where it is not given.
    fn clause_value<'p>(&mut self, property: &'p Property, word: &str) -> Option<Option<&'p Expr>> {
        match property.clause(word) {
            Some(clause) => self.one_of(&clause.values, word, clause.word.span).map(Some),
            None => Some(None),
        }
    }

    fn given(&mut self, property: &Property, (word, dimension, bounds): Number) -> Option<Option<Distribution>> {
        let Some(value) = self.clause_value(property, word)? else { return Some(None) };
        let drawn = self.distribution(value, dimension)?;
        self.within(&drawn, &format!("`{word}`"), value, dimension, bounds)?;
        Some(Some(drawn))
    }

    fn number(&mut self, property: &Property, number: Number, default: f64) -> Option<Distribution> {
        Some(self.given(property, number)?.unwrap_or(Distribution::Fixed(default)))
    }
}

fn is_word(value: &Expr, word: &str) -> bool {
    matches!(&value.kind, ExprKind::Word(found) if found == word)
}
