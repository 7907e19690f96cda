//! Textures of a scene. In: the materials' texture names. Out: decoded images, sorted by name; built-in ones are painted,
//! files are read through the allowed folders, with bounded sizes.

use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use image::{ImageReader, Limits, RgbaImage};

use super::error::PipelineError;
use crate::interpreter::material::Material;
use crate::scene::texture::builtin;
use crate::source::Access;

/// Largest side of a texture file, pixels; keeps a small file from filling the memory.
const LARGEST_SIDE: u32 = 8192;

/// A texture by name; `missing` lists names that exist nowhere.
pub struct Textures {
    pub images: Vec<(Arc<str>, Arc<RgbaImage>)>,
    pub missing: Vec<String>,
}

/// Loads every texture that the materials name.
pub fn load(materials: &[Arc<Material>], access: &Access) -> Result<Textures, PipelineError> {
    let names: BTreeSet<Arc<str>> = materials.iter().filter_map(|m| m.colormap.clone()).collect();
    let mut textures = Textures { images: Vec::new(), missing: Vec::new() };
    for name in names {
        if name.starts_with("builtin:") {
            match builtin(&name) {
                Some(image) => textures.images.push((name, Arc::new(image))),
                None => textures.missing.push(name.to_string()),
            }
            continue;
        }
        match access.read(Path::new(""), &name) {
            Ok((path, bytes)) => {
                let image = decode(bytes).map_err(|source| PipelineError::Texture { path, source })?;
                textures.images.push((name, Arc::new(image)));
            }
            Err(error) => textures.missing.push(error.to_string()),
        }
    }
    Ok(textures)
}

fn decode(bytes: Vec<u8>) -> image::ImageResult<RgbaImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(image::ImageError::IoError)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    reader.limits(limits);
    Ok(reader.decode()?.to_rgba8())
}
