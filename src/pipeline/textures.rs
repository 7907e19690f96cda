//! Textures of a scene. In: the textures that materials name. Out: decoded images in the scene, sorted by name; built-in
//! ones are painted, files are read through the allowed folders, with bounded sizes.
//!
//! The colour texture of a material carries its opacity: the alpha channel is that of the opacity map (its alpha
//! channel if it has one, else its brightness), and 1 without one. An opacity map on another uv set than the colour's is
//! taken to lie on the same.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::imageops::{FilterType, resize};
use image::{ImageFormat, ImageReader, Limits, Luma, Rgba, RgbaImage};

use super::error::PipelineError;
use super::record::below_root;
use crate::dataset::manifest::InputFile;
use crate::dataset::writer::sha256;
use crate::interpreter::FileAssets;
use crate::interpreter::material::{MapLayer, Material, OpacityMode};
use crate::scene::Scene;
use crate::scene::texture::builtin;
use crate::source::Access;

/// Largest side of a texture file, pixels; keeps a small file from filling the memory.
const LARGEST_SIDE: u32 = 8192;

/// What loading found besides the images.
#[derive(Default)]
pub struct Loaded {
    /// Texture files by content.
    pub files: Vec<InputFile>,
    /// Names that exist nowhere.
    pub missing: Vec<String>,
}

/// An image under the name that the scene calls it by.
#[derive(Clone)]
struct Texture {
    name: Arc<str>,
    pixels: Arc<RgbaImage>,
    has_alpha: bool,
}

/// Images of the scene before, by the names in materials and by those in the scene.
#[derive(Default)]
pub struct Kept {
    files: BTreeMap<Arc<str>, KeptFile>,
    composed: BTreeMap<Arc<str>, Composed>,
}

struct KeptFile {
    texture: Texture,
    /// `None` for a built-in one.
    file: Option<InputFile>,
    path: PathBuf,
}

/// A colour texture with an opacity map, as they were, and what became of them.
struct Composed {
    of: [Option<Arc<RgbaImage>>; 2],
    texture: Texture,
}

struct Loader<'a> {
    assets: &'a FileAssets,
    kept: &'a mut Kept,
    /// By the names in materials; `None` for what is missing.
    read: BTreeMap<Arc<str>, Option<Texture>>,
    /// By the names in the scene.
    images: BTreeMap<Arc<str>, Arc<RgbaImage>>,
    loaded: Loaded,
}

/// Loads every texture that the scene's materials name into the scene. Files are named by their path below the run's
/// folder, so that a scene does not depend on where that folder lies.
pub fn load(scene: &mut Scene, assets: &FileAssets, kept: &mut Kept) -> Result<Loaded, PipelineError> {
    let mut loader = Loader { assets, kept, read: BTreeMap::new(), images: BTreeMap::new(), loaded: Loaded::default() };
    for material in &mut scene.materials {
        if material.colormap.is_some() || !material.maps.is_empty() {
            loader.material(Arc::make_mut(material))?;
        }
    }
    scene.textures = loader.images.into_iter().collect();
    loader.loaded.files.sort();
    loader.loaded.files.dedup();
    Ok(loader.loaded)
}

impl Loader<'_> {
    /// Gives a material's textures the names of the scene.
    fn material(&mut self, material: &mut Material) -> Result<(), PipelineError> {
        let opacity = match (material.opacity_mode, material.map(MapLayer::Opacity)) {
            (OpacityMode::Opaque, _) | (_, None) => None,
            (_, Some(map)) => self.texture(&map.path.clone())?,
        };
        let color = match material.colormap.take() {
            Some(path) => self.texture(&path)?,
            None => None,
        };
        material.colormap = self.composed(color, opacity).map(|texture| self.keep(texture));
        for mut map in std::mem::take(&mut material.maps) {
            if let Some(texture) = self.texture(&map.path)? {
                // The opacity map is in the colour texture; its own name is kept.
                map.path = if map.layer == MapLayer::Opacity { texture.name } else { self.keep(texture) };
                material.maps.push(map);
            }
        }
        Ok(())
    }

    /// [`color_with_opacity`], done once for the same images.
    fn composed(&mut self, color: Option<Texture>, opacity: Option<Texture>) -> Option<Texture> {
        let pixels = |texture: &Option<Texture>| texture.as_ref().map(|texture| texture.pixels.clone());
        let of = [pixels(&color), pixels(&opacity)];
        let name =
            |texture: &Option<Texture>| texture.as_ref().map_or_else(String::new, |texture| texture.name.to_string());
        let key: Arc<str> = format!("{}|{}", name(&color), name(&opacity)).into();
        let is_same = |a: &Option<Arc<RgbaImage>>, b: &Option<Arc<RgbaImage>>| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        if let Some(known) = self.kept.composed.get(&key)
            && known.of.iter().zip(&of).all(|(a, b)| is_same(a, b))
        {
            return Some(known.texture.clone());
        }
        let texture = color_with_opacity(color, opacity)?;
        self.kept.composed.insert(key, Composed { of, texture: texture.clone() });
        Some(texture)
    }

    fn keep(&mut self, texture: Texture) -> Arc<str> {
        self.images.insert(texture.name.clone(), texture.pixels);
        texture.name
    }

    fn texture(&mut self, path: &Arc<str>) -> Result<Option<Texture>, PipelineError> {
        if let Some(known) = self.read.get(path) {
            return Ok(known.clone());
        }
        let texture = if path.starts_with("builtin:") { self.builtin(path) } else { self.file(path)? };
        if texture.is_none() {
            self.loaded.missing.push(path.to_string());
        }
        self.read.insert(path.clone(), texture.clone());
        Ok(texture)
    }

    fn builtin(&mut self, path: &Arc<str>) -> Option<Texture> {
        if let Some(known) = self.kept.files.get(path) {
            return Some(known.texture.clone());
        }
        let texture = Texture { name: path.clone(), pixels: Arc::new(builtin(path)?), has_alpha: false };
        let kept = KeptFile { texture: texture.clone(), file: None, path: PathBuf::new() };
        self.kept.files.insert(path.clone(), kept);
        Some(texture)
    }

    /// Reads a file, and decodes it if it has another content than before.
    fn file(&mut self, named: &Arc<str>) -> Result<Option<Texture>, PipelineError> {
        let Ok((path, bytes)) = self.assets.texture(named) else { return Ok(None) };
        let name = below(&path, named, self.assets.access());
        let (size, hash) = (bytes.len() as u64, sha256(&bytes));
        let place = below_root(&path, self.assets.access());
        let file = InputFile { role: "texture", name: name.clone(), path: place, bytes: size, sha256: hash };
        self.loaded.files.push(file.clone());
        if let Some(known) = self.kept.files.get(named)
            && known.file.as_ref() == Some(&file)
            && known.path == path
        {
            return Ok(Some(known.texture.clone()));
        }
        let image = decode(&path, bytes).map_err(|source| PipelineError::Texture { path: path.clone(), source })?;
        let has_alpha = image.color().has_alpha();
        let texture = Texture { name: name.into(), pixels: Arc::new(image.to_rgba8()), has_alpha };
        let kept = KeptFile { texture: texture.clone(), file: Some(file), path };
        self.kept.files.insert(named.clone(), kept);
        Ok(Some(texture))
    }
}

/// A file's path below the first allowed folder that holds it, or its name alone; with the number of the image for one
/// that lies inside another file.
fn below(path: &Path, named: &str, access: &Access) -> String {
    let short = path.strip_prefix(access.root()).ok().or_else(|| path.file_name().map(Path::new)).unwrap_or(path);
    let mark = named.find("#image:").map_or("", |at| &named[at..]);
    short.to_string_lossy().replace('\\', "/") + mark
}

/// The colour texture with the opacity in its alpha channel.
fn color_with_opacity(color: Option<Texture>, opacity: Option<Texture>) -> Option<Texture> {
    let Some(opacity) = opacity else {
        let color = color?;
        if !color.has_alpha {
            return Some(color);
        }
        let mut pixels = (*color.pixels).clone();
        pixels.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
        let name = format!("{}|opaque", color.name).into();
        return Some(Texture { name, pixels: Arc::new(pixels), has_alpha: false });
    };
    let same = |color: &Texture| color.name == opacity.name && color.has_alpha;
    if color.as_ref().is_some_and(same) {
        return color;
    }
    let name = format!("{}|{}", color.as_ref().map_or("", |c| &*c.name), opacity.name).into();
    let mut pixels = match color {
        Some(color) => (*color.pixels).clone(),
        None => RgbaImage::from_pixel(opacity.pixels.width(), opacity.pixels.height(), Rgba([255; 4])),
    };
    let share = |pixel: &Rgba<u8>| if opacity.has_alpha { pixel.0[3] } else { brightness(pixel) };
    let mut alpha = image::GrayImage::from_fn(opacity.pixels.width(), opacity.pixels.height(), |x, y| {
        Luma([share(opacity.pixels.get_pixel(x, y))])
    });
    if alpha.dimensions() != pixels.dimensions() {
        alpha = resize(&alpha, pixels.width(), pixels.height(), FilterType::Triangle);
    }
    pixels.pixels_mut().zip(alpha.pixels()).for_each(|(pixel, alpha)| pixel.0[3] = alpha.0[0]);
    Some(Texture { name, pixels: Arc::new(pixels), has_alpha: true })
}

/// Rec. 709.
fn brightness(pixel: &Rgba<u8>) -> u8 {
    let [r, g, b, _] = pixel.0.map(f64::from);
    (0.2126 * r + 0.7152 * g + 0.0722 * b).round() as u8
}

/// The file's bytes are bounded; here the pixels are, before any is decoded.
fn decode(path: &Path, bytes: Vec<u8>) -> image::ImageResult<image::DynamicImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(image::ImageError::IoError)?;
    if let (None, Ok(format)) = (reader.format(), ImageFormat::from_path(path)) {
        reader.set_format(format);
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    reader.limits(limits);
    reader.decode()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(name: &str, pixels: &[[u8; 4]], has_alpha: bool) -> Option<Texture> {
        let image = RgbaImage::from_fn(pixels.len() as u32, 1, |x, _| Rgba(pixels[x as usize]));
        Some(Texture { name: name.into(), pixels: Arc::new(image), has_alpha })
    }

    #[track_caller]
    fn composed(color: Option<Texture>, opacity: Option<Texture>, name: &str, alpha: &[u8]) {
        let texture = color_with_opacity(color, opacity).expect("there is one");
        let found: Vec<u8> = texture.pixels.pixels().map(|p| p.0[3]).collect();
        assert_eq!((&*texture.name, found.as_slice()), (name, alpha));
    }

    #[test]
    fn opacity_lies_in_the_alpha_channel() {
        let leaf = || texture("leaf", &[[9, 9, 9, 0], [9, 9, 9, 200]], true);
        let wall = || texture("wall", &[[9, 9, 9, 255]; 2], false);
        let mask = || texture("mask", &[[0, 0, 0, 255], [255, 255, 255, 255]], false);
        composed(leaf(), leaf(), "leaf", &[0, 200]);
        composed(leaf(), None, "leaf|opaque", &[255, 255]);
        composed(wall(), None, "wall", &[255, 255]);
        composed(wall(), mask(), "wall|mask", &[0, 255]);
        composed(wall(), leaf(), "wall|leaf", &[0, 200]);
        composed(None, mask(), "|mask", &[0, 255]);
        assert!(color_with_opacity(None, None).is_none());
    }

    #[test]
    fn an_image_that_would_fill_the_memory_is_refused() {
        let mut png = Cursor::new(Vec::new());
        image::GrayImage::new(LARGEST_SIDE + 1, 1).write_to(&mut png, ImageFormat::Png).expect("memory is writable");
        let error = decode(Path::new("wide.png"), png.into_inner()).expect_err("it is too wide");
        assert!(matches!(error, image::ImageError::Limits(_)), "{error}");
    }
}
