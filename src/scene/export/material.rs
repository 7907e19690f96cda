//! Materials of a scene as glTF materials (reference 5.5, "glTF mapping"). In: materials, decoded textures, the uv sets
//! that meshes have. Out: glTF materials, and the images they need besides the scene's own.
//!
//! Roughness and metallic maps are packed into one image (green and blue). What glTF has no place for stands in the
//! material's extras under the names of the rule language.

use std::sync::Arc;

use gltf::json::extensions;
use gltf::json::extensions::texture::{
    TextureTransform, TextureTransformOffset, TextureTransformRotation, TextureTransformScale,
};
use gltf::json::extras::RawValue;
use gltf::json::material::{
    AlphaCutoff, AlphaMode, EmissiveFactor, NormalTexture, OcclusionTexture, PbrBaseColorFactor, PbrMetallicRoughness,
    StrengthFactor,
};
use gltf::json::texture::Info;
use gltf::json::validation::Checked;
use gltf::json::{self, Index};
use image::{Rgba, RgbaImage, imageops};
use serde_json::{Map, Value, json};

use crate::interpreter::material::{MapLayer, MapTransform, Material, OpacityMode, TextureMap};
use crate::scene::Scene;

pub const TRANSFORM_EXTENSION: &str = "KHR_texture_transform";

/// Textures by name: the scene's, then those made here.
pub struct Textures<'a> {
    scene: &'a Scene,
    pub made: Vec<(Arc<str>, RgbaImage)>,
    /// A texture is moved, turned or scaled.
    pub transformed: bool,
}

/// The uv sets of each material that lie in vertices: TEXCOORD_1 is the first of them, and so on.
pub fn uv_slots(scene: &Scene) -> Vec<Vec<u8>> {
    let mut slots = vec![Vec::new(); scene.materials.len()];
    for object in &scene.objects {
        for group in object.mesh.groups.iter().filter(|g| g.count > 0) {
            let maps = &scene.materials[group.material as usize].maps;
            let used = |set: &u8| maps.iter().any(|map| map.layer as u8 == *set);
            slots[group.material as usize].extend(object.mesh.uv_sets.iter().map(|(set, _)| *set).filter(used));
        }
    }
    for sets in &mut slots {
        sets.sort_unstable();
        sets.dedup();
    }
    slots
}

impl<'a> Textures<'a> {
    pub fn new(scene: &'a Scene) -> Self {
        Textures { scene, made: Vec::new(), transformed: false }
    }

    fn index(&self, name: &str) -> Option<u32> {
        let known = self.scene.textures.iter().position(|(n, _)| **n == *name);
        let made = || self.made.iter().position(|(n, _)| **n == *name).map(|i| i + self.scene.textures.len());
        known.or_else(made).map(|index| index as u32)
    }

    fn pixels(&self, name: &str) -> Option<&RgbaImage> {
        self.scene.textures.iter().find(|(n, _)| **n == *name).map(|(_, pixels)| &**pixels)
    }

    /// One material; `slots` are its uv sets behind TEXCOORD_0.
    pub fn material(&mut self, m: &Material, slots: &[u8]) -> json::Material {
        let [r, g, b] = m.color.map(|c| srgb_to_linear(c) as f32);
        let color = m.colormap.as_deref().and_then(|name| self.info(name, 0, &m.colormap_transform));
        let (rough_metal, roughness, metallic) = self.roughness_and_metallic(m, slots);
        let emissive = m.map(MapLayer::Emissive).and_then(|map| self.layer(map, slots));
        // A map stands for the scalar.
        let emissive_factor = if emissive.is_some() { [1.0; 3] } else { m.emissive.map(|c| srgb_to_linear(c) as f32) };
        let mode = alpha_mode(m);
        json::Material {
            name: (!m.name.is_empty()).then(|| m.name.to_string()),
            alpha_mode: Checked::Valid(mode),
            alpha_cutoff: (mode == AlphaMode::Mask).then_some(AlphaCutoff(m.opacity_cutoff as f32)),
            double_sided: m.double_sided,
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([r, g, b, m.opacity as f32]),
                base_color_texture: color,
                metallic_factor: StrengthFactor(metallic as f32),
                roughness_factor: StrengthFactor(roughness as f32),
                metallic_roughness_texture: rough_metal,
                ..PbrMetallicRoughness::default()
            },
            normal_texture: m.map(MapLayer::Normal).and_then(|map| self.layer(map, slots)).map(|info| NormalTexture {
                index: info.index,
                scale: 1.0,
                tex_coord: info.tex_coord,
                extensions: others(&info).map(|others| extensions::material::NormalTexture { others }),
                extras: None,
            }),
            occlusion_texture: m.map(MapLayer::Occlusion).and_then(|map| self.layer(map, slots)).map(|info| {
                OcclusionTexture {
                    index: info.index,
                    strength: StrengthFactor(1.0),
                    tex_coord: info.tex_coord,
                    extensions: others(&info).map(|others| extensions::material::OcclusionTexture { others }),
                    extras: None,
                }
            }),
            emissive_texture: emissive,
            emissive_factor: EmissiveFactor(emissive_factor),
            extras: self.extras(m, slots),
            ..json::Material::default()
        }
    }

    fn layer(&mut self, map: &TextureMap, slots: &[u8]) -> Option<Info> {
        self.info(&map.path, coordinates(map, slots), &map.transform)
    }

    fn info(&mut self, name: &str, tex_coord: u32, transform: &MapTransform) -> Option<Info> {
        let index = Index::new(self.index(name)?);
        let moved = (*transform != MapTransform::IDENTITY).then(|| downwards(transform, tex_coord));
        self.transformed |= moved.is_some();
        let extensions = moved.map(|moved| extensions::texture::Info {
            texture_transform: Some(moved),
            ..extensions::texture::Info::default()
        });
        Some(Info { index, tex_coord, extensions, extras: None })
    }

    /// The packed texture, and the factors: a map stands for its scalar.
    fn roughness_and_metallic(&mut self, m: &Material, slots: &[u8]) -> (Option<Info>, f64, f64) {
        let maps = [MapLayer::Roughness, MapLayer::Metallic].map(|layer| m.map(layer));
        let pixels = maps.map(|map| map.and_then(|map| self.pixels(&map.path)));
        let Some(map) = maps.into_iter().zip(&pixels).find(|(_, p)| p.is_some()).and_then(|(map, _)| map) else {
            return (None, m.roughness, m.metallic);
        };
        let name = |i: usize| maps[i].filter(|_| pixels[i].is_some()).map_or("", |map| &*map.path);
        let name: Arc<str> = match (name(0), name(1)) {
            (rough, metal) if rough == metal => rough.into(),
            (rough, metal) => format!("{rough}+{metal}").into(),
        };
        if self.index(&name).is_none() {
            let packed = packed(pixels[0], pixels[1]);
            self.made.push((name.clone(), packed));
        }
        let info = self.info(&name, coordinates(map, slots), &map.transform);
        let factor = |i: usize, scalar: f64| if pixels_present(&maps, self, i) { 1.0 } else { scalar };
        (info, factor(0, m.roughness), factor(1, m.metallic))
    }

    /// Attributes without a place of their own, by name; textures with their index and coordinates.
    fn extras(&self, m: &Material, slots: &[u8]) -> Option<Box<RawValue>> {
        let mut fields: Map<String, Value> =
            m.other.iter().map(|(name, value)| (name.to_string(), Value::String(value.to_string()))).collect();
        for map in &m.maps {
            if matches!(map.layer, MapLayer::Bump | MapLayer::Dirt | MapLayer::Specular) {
                let t = &map.transform;
                let value = json!({
                    "name": &*map.path, "index": self.index(&map.path), "texCoord": coordinates(map, slots),
                    "scale": t.scale, "offset": t.offset, "rotation": t.rotation
                });
                fields.insert(map.layer_name().to_owned(), value);
            }
        }
        let text = (!fields.is_empty()).then(|| Value::Object(fields).to_string())?;
        Some(RawValue::from_string(text).expect("serde_json writes valid JSON"))
    }
}

fn pixels_present(maps: &[Option<&TextureMap>; 2], textures: &Textures, i: usize) -> bool {
    maps[i].is_some_and(|map| textures.pixels(&map.path).is_some())
}

/// Which TEXCOORD a layer uses: that of its own set, else that of set 0.
fn coordinates(map: &TextureMap, slots: &[u8]) -> u32 {
    slots.iter().position(|set| *set == map.layer as u8).map_or(0, |slot| slot as u32 + 1)
}

/// The extension of a texture for the blocks that have no field for it.
fn others(info: &Info) -> Option<Map<String, Value>> {
    let moved = info.extensions.as_ref()?.texture_transform.as_ref()?;
    let value = serde_json::to_value(moved).expect("finite numbers serialise");
    Some(Map::from_iter([(TRANSFORM_EXTENSION.to_owned(), value)]))
}

/// Green from the roughness map, blue from the metallic map; 1 where there is none, so that the factor counts.
fn packed(rough: Option<&RgbaImage>, metal: Option<&RgbaImage>) -> RgbaImage {
    let size = rough.or(metal).map_or((1, 1), RgbaImage::dimensions);
    let fitted = |image: &RgbaImage| match image.dimensions() == size {
        true => image.clone(),
        false => imageops::resize(image, size.0, size.1, imageops::FilterType::Triangle),
    };
    let (rough, metal) = (rough.map(fitted), metal.map(fitted));
    let channel = |image: &Option<RgbaImage>, x, y, c: usize| image.as_ref().map_or(255, |i| i.get_pixel(x, y).0[c]);
    RgbaImage::from_fn(size.0, size.1, |x, y| Rgba([255, channel(&rough, x, y, 1), channel(&metal, x, y, 2), 255]))
}

fn alpha_mode(m: &Material) -> AlphaMode {
    let translucent = m.opacity < 1.0 || m.map(MapLayer::Opacity).is_some();
    match m.opacity_mode {
        OpacityMode::Blend if translucent => AlphaMode::Blend,
        OpacityMode::Mask if translucent => AlphaMode::Mask,
        _ => AlphaMode::Opaque,
    }
}

/// The transform for texture coordinates whose v runs down.
fn downwards(t: &MapTransform, tex_coord: u32) -> TextureTransform {
    let (sin, cos) = t.sin_cos();
    let [su, sv] = t.scale;
    let offset = [t.offset[0] - sin * sv, 1.0 - t.offset[1] - cos * sv];
    TextureTransform {
        offset: TextureTransformOffset(offset.map(|x| x as f32)),
        rotation: TextureTransformRotation(t.rotation.to_radians() as f32),
        scale: TextureTransformScale([su as f32, sv as f32]),
        // Absent it would be written as `null`, which is no number.
        tex_coord: Some(tex_coord),
        extras: None,
    }
}

/// IEC 61966-2-1.
fn srgb_to_linear(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests;
