//! In: a `sun` block. Out: a [`SunSpec`].

use super::{Checker, get};
use crate::source::Span;
use crate::spec::ast::{Block, CallArgument, Expr, ExprKind, Property};
use crate::spec::draw::Distribution;
use crate::spec::effects::DEFAULT_INTENSITY;
use crate::spec::render_spec::{SunColour, SunPosition, SunSpec};
use crate::spec::units::Dimension;

/// Degrees; the mean angular diameter of the sun's disc.
pub const DEFAULT_DISC: f64 = 0.533;
/// Linear RGB; sunlight through a clear sky is a little warm.
pub const DEFAULT_COLOUR: [f64; 3] = [1.0, 0.96, 0.9];

/// Linke's, of clean air in the country.
pub const DEFAULT_TURBIDITY: f64 = 3.0;
/// From air without dust or water to a hazy industrial town.
const TURBIDITY: (f64, f64) = (2.0, 8.0);

const ANY_ANGLE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl Checker<'_> {
    pub fn sun(&mut self, block: &Block) -> Option<SunSpec> {
        let properties = &block.properties;
        let position = self.sun_position(properties, block.span);
        let disc = self.bounded(properties, "disc", Dimension::Angle, (0.0, 10.0));
        let intensity = self.bounded(properties, "intensity", Dimension::Plain, (0.0, 100.0));
        let colour = match get(properties, "colour") {
            Some(property) => self.colour(property),
            None => Some(SunColour::Fixed(DEFAULT_COLOUR)),
        };
        Some(SunSpec {
            span: block.span,
            position: position?,
            disc: disc.ok()?.unwrap_or(Distribution::Fixed(DEFAULT_DISC)),
            intensity: intensity.ok()?.unwrap_or(Distribution::Fixed(DEFAULT_INTENSITY)),
            colour: colour?,
        })
    }

    /// The sun of a recipe that says nothing about it: 45° high in the south-east.
    pub fn default_sun(span: Span) -> SunSpec {
        SunSpec {
            span,
            position: default_position(),
            disc: Distribution::Fixed(DEFAULT_DISC),
            intensity: Distribution::Fixed(DEFAULT_INTENSITY),
            colour: SunColour::Fixed(DEFAULT_COLOUR),
        }
    }

    fn sun_position(&mut self, properties: &[Property], span: Span) -> Option<SunPosition> {
        let angles = ["elevation", "azimuth"].into_iter().find_map(|key| get(properties, key));
        let arc = ["declination", "tilt", "turn"].into_iter().find_map(|key| get(properties, key));
        match (angles, arc) {
            (None, None) => Some(default_position()),
            (Some(_), Some(arc)) => {
                let message = "the sun stands by `elevation` and `azimuth` or on the arc of `declination`, not both";
                self.error("spec::over-determined", arc.span, message);
                None
            }
            (Some(_), None) => {
                let elevation = self.bounded(properties, "elevation", Dimension::Angle, ANY_ANGLE);
                let azimuth = self.bounded(properties, "azimuth", Dimension::Angle, ANY_ANGLE);
                let property = self.required(properties, "elevation", span, "a sun with an `azimuth`")?;
                let elevation = elevation.ok()??;
                let (low, high) = elevation.bounds();
                if low <= 0.0 {
                    return self.below_horizon(property, low);
                }
                if high > 90.0 {
                    let message = format!("`elevation` is at most 90deg, the zenith; here it can be {high}deg");
                    self.error("spec::out-of-range", property.span, message);
                    return None;
                }
                let azimuth = azimuth.ok()?.unwrap_or(Distribution::Fixed(180.0));
                Some(SunPosition::Angles { elevation, azimuth })
            }
            (None, Some(_)) => self.arc(properties, span),
        }
    }

    fn arc(&mut self, properties: &[Property], span: Span) -> Option<SunPosition> {
        let declination = self.bounded(properties, "declination", Dimension::Angle, ANY_ANGLE);
        let tilt = self.bounded(properties, "tilt", Dimension::Angle, (-89.0, 89.0));
        let turn = self.bounded(properties, "turn", Dimension::Angle, ANY_ANGLE);
        let property = self.required(properties, "declination", span, "a sun on an arc")?;
        let declination = declination.ok()??;
        let (low, high) = declination.bounds();
        if low <= 0.0 || high >= 180.0 {
            return self.below_horizon(property, if low <= 0.0 { low } else { 180.0 - high });
        }
        let or_zero = |angle: Option<Distribution>| angle.unwrap_or(Distribution::Fixed(0.0));
        Some(SunPosition::Arc { declination, tilt: or_zero(tilt.ok()?), turn: or_zero(turn.ok()?) })
    }

    fn below_horizon(&mut self, property: &Property, elevation: f64) -> Option<SunPosition> {
        let place = if elevation == 0.0 { "on it".to_owned() } else { format!("{}deg below it", -elevation) };
        let message = format!("the sun must stand above the horizon, `{property}` can put it {place}");
        let help = match property.key.text.as_str() {
            "declination" => "0deg is the eastern horizon, 90deg the top, 180deg the western horizon",
            _ => "elevation is more than 0deg and at most 90deg",
        };
        self.error_with_help("spec::sun-below-horizon", property.span, message, help);
        None
    }

    /// `"#ffeedd"` (sRGB), three linear numbers or a clear sky.
    fn colour(&mut self, property: &Property) -> Option<SunColour> {
        if let [value] = property.values.as_slice()
            && let ExprKind::Text(text) = &value.kind
        {
            let Some(colour) = hex_colour(text) else {
                self.wrong(value, "a colour such as `\"#ffeedd\"`");
                return None;
            };
            return Some(SunColour::Fixed(colour));
        }
        if let [value] = property.values.as_slice()
            && matches!(value.kind, ExprKind::Word(_) | ExprKind::Call { .. })
        {
            self.word(value, &["clear_sky"], &[])?;
            return self.clear_sky(value);
        }
        let [red, green, blue] = property.values.as_slice() else {
            let message = "a colour is `\"#ffeedd\"`, three linear numbers (red, green, blue) or `clear_sky`";
            self.error("spec::wrong-value", property.span, message);
            return None;
        };
        Some(SunColour::Fixed([self.radiance(red)?, self.radiance(green)?, self.radiance(blue)?]))
    }

    /// `clear_sky` or `clear_sky(TURBIDITY)`.
    fn clear_sky(&mut self, value: &Expr) -> Option<SunColour> {
        let ExprKind::Call { arguments, .. } = &value.kind else {
            return Some(SunColour::ClearSky { turbidity: Distribution::Fixed(DEFAULT_TURBIDITY) });
        };
        let [CallArgument { name: None, weight: None, value: turbidity }] = arguments.as_slice() else {
            self.wrong(value, "of the form `clear_sky` or `clear_sky(3)`");
            return None;
        };
        let drawn = self.distribution(turbidity, Dimension::Plain)?;
        self.within(&drawn, "the turbidity of a clear sky", turbidity, Dimension::Plain, TURBIDITY)?;
        Some(SunColour::ClearSky { turbidity: drawn })
    }

    /// A share or a plain number from 0 to 100.
    pub fn radiance(&mut self, value: &Expr) -> Option<f64> {
        let dimension = match &value.kind {
            ExprKind::Quantity { unit: Some(_), .. } => Dimension::Share,
            _ => Dimension::Plain,
        };
        let number = self.quantity(value, dimension)?;
        if !(0.0..=100.0).contains(&number) {
            self.error("spec::out-of-range", value.span, format!("`{value}` is not between 0 and 100"));
            return None;
        }
        Some(number)
    }
}

fn default_position() -> SunPosition {
    SunPosition::Angles { elevation: Distribution::Fixed(45.0), azimuth: Distribution::Fixed(135.0) }
}

/// `#rrggbb` in linear light (IEC 61966-2-1).
fn hex_colour(text: &str) -> Option<[f64; 3]> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii())?;
    let channel = |at: usize| {
        let encoded = f64::from(u8::from_str_radix(&digits[at..at + 2], 16).ok()?) / 255.0;
        Some(if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) })
    };
    Some([channel(0)?, channel(2)?, channel(4)?])
}
