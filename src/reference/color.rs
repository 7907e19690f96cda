//! Colour: the bands of light in the reference, and sRGB-encoded values → linear light (IEC 61966-2-1).

/// Linear red, green, blue; or the three channels of an image.
pub type Rgb = [f64; 3];

/// Linear red, green, blue and near infrared.
pub type Light = [f64; 4];

pub fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Linear light of every byte.
pub fn table() -> [f64; 256] {
    std::array::from_fn(|byte| linear(byte as f64 / 255.0))
}

/// Greatest albedo of a surface in the near infrared.
const MOST_INFRARED: f64 = 0.95;

/// An albedo with that in the near infrared: a gain on the luminance (Rec. 709).
pub fn with_infrared([r, g, b]: Rgb, gain: f64) -> Light {
    [r, g, b, (gain * (0.2126 * r + 0.7152 * g + 0.0722 * b)).min(MOST_INFRARED)]
}
