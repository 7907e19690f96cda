//! Colour: sRGB-encoded values ↔ linear light (IEC 61966-2-1).

/// Linear red, green, blue.
pub type Rgb = [f64; 3];

pub fn linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The byte of an sRGB image; light outside 0..1 is clipped.
pub fn byte(linear: f64) -> u8 {
    let light = linear.clamp(0.0, 1.0);
    let encoded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// Linear light of every byte.
pub fn table() -> [f64; 256] {
    std::array::from_fn(|byte| linear(byte as f64 / 255.0))
}
