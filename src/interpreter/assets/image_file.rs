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
const TILE: u32 = 128;

/// Every built-in image with its sides; `scene::texture` paints them.
pub const BUILTIN_IMAGES: &[(&str, u32)] = &[
    ("builtin:default", 16),
    ("builtin:uvtest.png", 256),
    ("builtin:unknowntexture.png", 64),
    ("builtin:white", TILE),
    ("builtin:roof_tiles", TILE),
    ("builtin:shingles", TILE),
    ("builtin:sheet_metal", TILE),
    ("builtin:gravel", TILE),
    ("builtin:plaster", TILE),
    ("builtin:brick", TILE),
    ("builtin:concrete", TILE),
    ("builtin:facade", TILE),
    ("builtin:asphalt", TILE),
    ("builtin:paving", TILE),
    ("builtin:grass", TILE),
    ("builtin:meadow", TILE),
    ("builtin:farmland", TILE),
    ("builtin:forest", TILE),
    ("builtin:soil", TILE),
    ("builtin:ground", TILE),
    ("builtin:sand", TILE),
    ("builtin:rock", TILE),
    ("builtin:water", TILE),
    ("builtin:ash", TILE),
    ("builtin:rubble", TILE),
];

pub fn builtin(name: &str) -> Option<ImageInfo> {
    let (_, side) = BUILTIN_IMAGES.iter().find(|(known, _)| *known == name)?;
    Some(ImageInfo { width: *side, height: *side, has_alpha: false })
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
