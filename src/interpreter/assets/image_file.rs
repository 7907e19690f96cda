//! What is known of an image without decoding it. In: the bytes of a file, or a `builtin:` name. Out: its size and
//! whether it has an alpha channel.

use std::io::Cursor;

use image::{ImageDecoder, ImageFormat, ImageReader};

/// Size in pixels and channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageInfo {
    pub width: u32,
    pub height: u32,
    pub has_alpha: bool,
}

/// Sides of the images that are always there, pixels.
pub const BUILTIN_SIDE: u32 = 128;

/// Every image that is always there; `scene::texture` paints them.
pub const BUILTIN_IMAGES: &[&str] = &[
    "builtin:white",
    "builtin:roof_tiles",
    "builtin:shingles",
    "builtin:sheet_metal",
    "builtin:gravel",
    "builtin:plaster",
    "builtin:brick",
    "builtin:concrete",
    "builtin:facade",
    "builtin:asphalt",
    "builtin:paving",
    "builtin:grass",
    "builtin:meadow",
    "builtin:farmland",
    "builtin:forest",
    "builtin:soil",
    "builtin:ground",
    "builtin:sand",
    "builtin:rock",
    "builtin:water",
    "builtin:ash",
    "builtin:rubble",
    "builtin:default",
    "builtin:uvtest.png",
    "builtin:unknowntexture.png",
];

pub fn builtin_image(name: &str) -> Option<ImageInfo> {
    let known = BUILTIN_IMAGES.contains(&name);
    known.then_some(ImageInfo { width: BUILTIN_SIDE, height: BUILTIN_SIDE, has_alpha: false })
}

/// `extension` tells the format where the bytes do not.
pub fn read(bytes: &[u8], extension: &str) -> Result<ImageInfo, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    if let (None, Some(format)) = (reader.format(), ImageFormat::from_extension(extension)) {
        reader.set_format(format);
    }
    let decoder = reader.into_decoder().map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions();
    Ok(ImageInfo { width, height, has_alpha: decoder.color_type().has_alpha() })
}
