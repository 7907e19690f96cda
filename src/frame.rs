//! Frame: the named CPU images of one view; imports nothing of ours.

/// Pixels of one image, row by row from the top, no padding.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// sRGB-encoded colour.
    Rgb8(Vec<u8>),
    /// Labels or masks, or one sRGB-encoded band.
    Gray8(Vec<u8>),
    /// Linear colour, 65535 is full scale.
    Rgb16(Vec<u16>),
    /// One linear band, 65535 is full scale.
    Gray16(Vec<u16>),
    /// Instance numbers.
    Id32(Vec<u32>),
    /// Metres.
    Float32(Vec<f32>),
}

/// One image as a pass of the recipe wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Name of the recipe's pass.
    pub pass: String,
    pub pixels: Pixels,
}

/// All images of one view.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    pub view: String,
    pub width: u32,
    pub height: u32,
    pub images: Vec<Image>,
}
