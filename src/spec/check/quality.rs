//! In: a `quality` block. Out: explicit knobs.

use super::{Checker, get};
use crate::spec::ast::Block;
use crate::spec::render_spec::QualitySpec;
use crate::spec::units::Dimension;

/// Named sets of knobs.
const PRESETS: [(&str, QualitySpec); 3] = [
    ("draft", QualitySpec { supersample: 1, shadow_map: 2048, shadow_samples: 1, sky_samples: 8, field_map: 512 }),
    ("standard", QualitySpec { supersample: 2, shadow_map: 4096, shadow_samples: 4, sky_samples: 24, field_map: 1024 }),
    ("high", QualitySpec { supersample: 4, shadow_map: 8192, shadow_samples: 8, sky_samples: 64, field_map: 2048 }),
];

/// What a recipe without a `quality` block gets.
pub const STANDARD: QualitySpec = PRESETS[1].1;

impl Checker<'_> {
    /// The preset (`standard` if none is named) with the knobs that the block gives.
    pub fn quality(&mut self, block: &Block) -> Option<QualitySpec> {
        let properties = &block.properties;
        let preset = match get(properties, "preset") {
            Some(property) => {
                let words = PRESETS.map(|(name, _)| name);
                self.one(property)
                    .and_then(|value| self.word(value, &words, &[]))
                    .map(|word| PRESETS.iter().find(|(name, _)| *name == word).expect("the word is one of these").1)
            }
            None => Some(STANDARD),
        };
        let mut knob = |key: &str, low: u64, high: u64| match get(properties, key) {
            Some(property) => {
                self.one(property).and_then(|v| self.whole(v, Dimension::Pixels, low, high)).map(|n| Some(n as u32))
            }
            None => Some(None),
        };
        let shadow_map = knob("shadow_map", 64, 16_384);
        let shadow_samples = knob("shadow_samples", 1, 16);
        let samples = knob("antialiasing", 1, 64);
        let supersample = match samples? {
            Some(samples) => Some(self.per_side(samples, block)?),
            None => None,
        };
        let preset = preset?;
        Some(QualitySpec {
            supersample: supersample.unwrap_or(preset.supersample),
            shadow_map: shadow_map?.unwrap_or(preset.shadow_map),
            shadow_samples: shadow_samples?.unwrap_or(preset.shadow_samples),
            ..preset
        })
    }

    /// Samples of a pixel lie on a square grid.
    fn per_side(&mut self, samples: u32, block: &Block) -> Option<u32> {
        let side = (1..=8).find(|side| side * side == samples);
        if side.is_none() {
            let at = get(&block.properties, "antialiasing").map_or(block.span, |property| property.span);
            let message = format!("{samples} samples per pixel do not make a square grid");
            self.error_with_help("spec::out-of-range", at, message, "1, 4, 9, 16, 25, 36, 49 and 64 do");
        }
        side
    }
}
