//! Textures of a scene. In: the materials' texture names. Out: decoded images in the scene, sorted by name; built-in ones are painted,
//! files are read through the allowed folders, with bounded sizes.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;

use image::{ImageReader, Limits, RgbaImage};

use super::error::PipelineError;
use crate::dataset::manifest::InputFile;
use crate::dataset::writer::sha256;
use crate::interpreter::material::Material;
use crate::scene::Scene;
use crate::scene::texture::builtin;
use crate::source::Access;

/// Largest side of a texture file, pixels; keeps a small file from filling the memory.
const LARGEST_SIDE: u32 = 8192;

/// Larger texture files are refused.
const MOST_BYTES: u64 = 256 << 20;

/// What loading found besides the images.
pub struct Loaded {
    /// Texture files by content.
    pub files: Vec<InputFile>,
    /// Names that exist nowhere.
    pub missing: Vec<String>,
}

/// Loads every texture that the scene's materials name into the scene. Files are named by their path below the run's
/// folder, so that a scene does not depend on where that folder lies.
pub fn load(scene: &mut Scene, access: &Access) -> Result<Loaded, PipelineError> {
    let names: BTreeSet<Arc<str>> = scene.materials.iter().filter_map(|m| m.colormap.clone()).collect();
    let mut loaded = Loaded { files: Vec::new(), missing: Vec::new() };
    let mut images = BTreeMap::new();
    for name in names {
        if name.starts_with("builtin:") {
            match builtin(&name) {
                Some(image) => drop(images.insert(name, Arc::new(image))),
                None => loaded.missing.push(name.to_string()),
            }
            continue;
        }
        match access.read(access.root(), &name, MOST_BYTES) {
            Ok((path, bytes)) => {
                let short: Arc<str> = below(&path, access).into();
                let hash = sha256(&bytes);
                loaded.files.push(InputFile {
                    role: "texture",
                    name: short.to_string(),
                    bytes: bytes.len() as u64,
                    sha256: hash,
                });
                let image = decode(bytes).map_err(|source| PipelineError::Texture { path, source })?;
                rename(&mut scene.materials, &name, &short);
                images.insert(short, Arc::new(image));
            }
            Err(error) => loaded.missing.push(error.to_string()),
        }
    }
    scene.textures = images.into_iter().collect();
    Ok(loaded)
}

/// A file's path below the first allowed folder that holds it, or its name alone.
fn below(path: &Path, access: &Access) -> String {
    let short = path.strip_prefix(access.root()).ok().or_else(|| path.file_name().map(Path::new)).unwrap_or(path);
    short.to_string_lossy().replace('\\', "/")
}

fn rename(materials: &mut [Arc<Material>], from: &str, to: &Arc<str>) {
    for material in materials.iter_mut().filter(|m| m.colormap.as_deref() == Some(from)) {
        Arc::make_mut(material).colormap = Some(to.clone());
    }
}

fn decode(bytes: Vec<u8>) -> image::ImageResult<RgbaImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(image::ImageError::IoError)?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    reader.limits(limits);
    Ok(reader.decode()?.to_rgba8())
}
