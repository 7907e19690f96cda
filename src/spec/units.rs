//! Units of literals: what they measure and how they come to metres, degrees and plain numbers.

/// What a number measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Metres.
    Length,
    /// Degrees.
    Angle,
    /// 40 % is 0.4.
    Share,
    /// Pixels or texels.
    Pixels,
    /// Bits of a number.
    Bits,
    /// No unit.
    Plain,
}

/// A unit: its dimension and its size in that dimension's own unit.
const UNITS: &[(&str, Dimension, f64)] = &[
    ("m", Dimension::Length, 1.0),
    ("km", Dimension::Length, 1000.0),
    ("cm", Dimension::Length, 0.01),
    ("mm", Dimension::Length, 0.001),
    ("ft", Dimension::Length, 0.3048),
    ("deg", Dimension::Angle, 1.0),
    ("°", Dimension::Angle, 1.0),
    ("rad", Dimension::Angle, 180.0 / std::f64::consts::PI),
    ("%", Dimension::Share, 0.01),
    ("px", Dimension::Pixels, 1.0),
    ("bit", Dimension::Bits, 1.0),
];

pub fn is_unit(text: &str) -> bool {
    UNITS.iter().any(|(unit, ..)| *unit == text)
}

/// The dimension and size of a unit.
pub fn unit(text: &str) -> Option<(Dimension, f64)> {
    UNITS.iter().find(|(unit, ..)| *unit == text).map(|(_, dimension, size)| (*dimension, *size))
}

impl Dimension {
    /// The unit to offer first.
    pub fn usual_unit(self) -> &'static str {
        match self {
            Dimension::Length => "m",
            Dimension::Angle => "deg",
            Dimension::Share => "%",
            Dimension::Pixels => "px",
            Dimension::Bits => "bit",
            Dimension::Plain => "",
        }
    }

    /// As messages name it.
    pub fn name(self) -> &'static str {
        match self {
            Dimension::Length => "a length",
            Dimension::Angle => "an angle",
            Dimension::Share => "a share",
            Dimension::Pixels => "a number of pixels",
            Dimension::Bits => "a number of bits",
            Dimension::Plain => "a plain number",
        }
    }

    /// All units that fit, as messages list them.
    pub fn units(self) -> String {
        let fitting = UNITS.iter().filter(|(_, dimension, _)| *dimension == self);
        fitting.map(|(unit, ..)| format!("`{unit}`")).collect::<Vec<_>>().join(", ")
    }
}
