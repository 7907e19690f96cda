//! In: a `quality` block. Out: explicit knobs, and the errors to keep where a budget is to choose them.

use super::{Checker, get};
use crate::geometry::roof::CURVE_BANDS;
use crate::spec::ast::{Block, Property};
use crate::spec::render_spec::{BudgetSpec, FixedKnobs, QualitySpec};
use crate::spec::units::Dimension;

/// Named sets of knobs, on the frontier of time and errors in the scenes of `docs/accuracy.md`.
pub const PRESETS: [(&str, QualitySpec); 3] = [
    ("draft", knobs(1, 1024, 1, 8, 512)),
    ("standard", knobs(2, 4096, 4, 24, 1024)),
    ("high", knobs(4, 8192, 8, 64, 2048)),
];

const fn knobs(
    supersample: u32,
    shadow_map: u32,
    shadow_samples: u32,
    sky_samples: u32,
    field_map: u32,
) -> QualitySpec {
    QualitySpec {
        supersample,
        shadow_map,
        shadow_samples,
        sky_samples,
        field_map,
        detail_m: 0.0,
        curves: CURVE_BANDS,
        budget: None,
    }
}

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
        let sky_samples = knob("sky_samples", 1, 256);
        let field_map = knob("field_map", 64, 8192);
        let curves = knob("curves", 1, 64);
        let samples = knob("antialiasing", 1, 64);
        let supersample = match samples? {
            Some(samples) => Some(self.per_side(samples, block)?),
            None => None,
        };
        let detail = self.limit(properties, "detail", Dimension::Length, (0.0, 10.0));
        let budget = self.budget(properties);
        let preset = preset?;
        Some(QualitySpec {
            supersample: supersample.unwrap_or(preset.supersample),
            shadow_map: shadow_map?.unwrap_or(preset.shadow_map),
            shadow_samples: shadow_samples?.unwrap_or(preset.shadow_samples),
            sky_samples: sky_samples?.unwrap_or(preset.sky_samples),
            field_map: field_map?.unwrap_or(preset.field_map),
            detail_m: detail?.unwrap_or(preset.detail_m),
            curves: curves?.unwrap_or(preset.curves),
            budget: budget?,
        })
    }

    /// The errors to keep; `Some(None)` where none is given.
    fn budget(&mut self, properties: &[Property]) -> Option<Option<BudgetSpec>> {
        let error = self.limit(properties, "error", Dimension::Share, (1e-4, 0.5));
        let edge = self.limit(properties, "edge", Dimension::Pixels, (1e-3, 1.0));
        let height = self.limit(properties, "height", Dimension::Length, (1e-3, 1000.0));
        let shadow = self.limit(properties, "shadow", Dimension::Share, (0.01, 0.9999));
        let (error, edge, height, shadow) = (error?, edge?, height?, shadow?);
        let Some(first) = ["error", "edge", "height", "shadow"].into_iter().find_map(|key| get(properties, key)) else {
            return Some(None);
        };
        if let Some(preset) = get(properties, "preset") {
            let message = format!("`preset` fixes what the budget `{}` is to choose", first.key.text);
            let help = "leave one of the two out; single knobs such as `shadow_map 8192` may stand beside a budget";
            self.error_with_help("spec::over-determined", preset.span, message, help);
            return None;
        }
        let given = |key: &str| get(properties, key).is_some();
        let fixed = FixedKnobs {
            supersample: given("antialiasing"),
            shadow_map: given("shadow_map"),
            shadow_samples: given("shadow_samples"),
            sky_samples: given("sky_samples"),
            field_map: given("field_map"),
        };
        Some(Some(BudgetSpec { error, edge, height, shadow, fixed }))
    }

    /// One number between two others; `Some(None)` where the property is not given.
    fn limit(
        &mut self,
        properties: &[Property],
        key: &str,
        dimension: Dimension,
        (low, high): (f64, f64),
    ) -> Option<Option<f64>> {
        let Some(property) = get(properties, key) else { return Some(None) };
        let value = self.one(property)?;
        let number = self.quantity(value, dimension)?;
        if !(low..=high).contains(&number) {
            let unit = dimension.usual_unit();
            let scale = if dimension == Dimension::Share { 100.0 } else { 1.0 };
            let (low, high) = (low * scale, high * scale);
            let message = format!("`{key}` lies between {low}{unit} and {high}{unit}, `{value}` does not");
            self.error("spec::out-of-range", value.span, message);
            return None;
        }
        Some(Some(number))
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
