//! Metrics: an image and the truth → how far they are apart. Each is gathered over several windows and then read once.

pub mod edges;
pub mod labels;
pub mod light;
pub mod shadow;

/// Linear red, green, blue.
pub type Rgb = [f32; 3];

/// Luminance of linear light (ITU-R BT.709).
pub fn luminance([r, g, b]: Rgb) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}
