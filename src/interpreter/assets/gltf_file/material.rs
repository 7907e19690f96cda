//! Materials of a glTF file. In: the document, and how to find the images it names. Out: [`Appearance`]s, and which of
//! the file's texture coordinates each layer uses.

use gltf::material::AlphaMode;
use gltf::texture::TextureTransform;

use crate::cga::builtins::{MapLayer, MapPart, MaterialAttr};
use crate::interpreter::appearance::Appearance;
use crate::interpreter::value::Value;

/// One material as the rule language sees it.
#[derive(Clone, Debug, Default)]
pub struct Read {
    pub appearance: Appearance,
    /// Number of the file's texture coordinates by layer.
    pub coordinates: Vec<(MapLayer, u32)>,
}

/// Gives an image of the file a name that textures are loaded by; `None` where there is none.
pub type NameImage<'a> = &'a dyn Fn(&gltf::Image) -> Option<String>;

/// A reference to a texture.
struct Reference<'a> {
    texture: gltf::Texture<'a>,
    coordinates: u32,
    transform: Option<TextureTransform<'a>>,
}

impl<'a> From<gltf::texture::Info<'a>> for Reference<'a> {
    fn from(info: gltf::texture::Info<'a>) -> Self {
        let transform = info.texture_transform();
        let moved = transform.as_ref().and_then(TextureTransform::tex_coord);
        Reference { texture: info.texture(), coordinates: moved.unwrap_or(info.tex_coord()), transform }
    }
}

/// Reads one material.
pub fn read(material: &gltf::Material, name_image: NameImage) -> Read {
    let mut out = Read::default();
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, alpha] = pbr.base_color_factor().map(f64::from);
    let emissive = material.emissive_factor().map(|c| srgb_encoded(f64::from(c)));
    let look = &mut out.appearance;
    if let Some(name) = material.name() {
        look.set(MaterialAttr::Name, Value::text(name));
    }
    for (channel, linear) in (0..).zip([r, g, b]) {
        look.set(MaterialAttr::Color(channel), Value::Float(srgb_encoded(linear)));
    }
    for (channel, c) in (0..).zip(emissive).filter(|(_, c)| *c > 0.0) {
        look.set(MaterialAttr::Emissive(channel), Value::Float(c));
    }
    look.set(MaterialAttr::Opacity, Value::Float(alpha));
    look.set(MaterialAttr::Roughness, Value::Float(f64::from(pbr.roughness_factor())));
    look.set(MaterialAttr::Metallic, Value::Float(f64::from(pbr.metallic_factor())));
    look.set(MaterialAttr::DoubleSided, Value::Bool(material.double_sided()));
    let mode = match material.alpha_mode() {
        AlphaMode::Opaque => "opaque",
        AlphaMode::Mask => "mask",
        AlphaMode::Blend => "blend",
    };
    look.set(MaterialAttr::OpacityMode, Value::text(mode));
    if let Some(cutoff) = material.alpha_cutoff() {
        look.set(MaterialAttr::OpacityCutoff, Value::Float(f64::from(cutoff)));
    }
    let mut layers = |info: Option<Reference>, layers: &[MapLayer]| {
        for &layer in layers {
            info.iter().for_each(|info| out.layer(layer, info, name_image));
        }
    };
    let color: &[MapLayer] = match material.alpha_mode() {
        AlphaMode::Opaque => &[MapLayer::Color],
        _ => &[MapLayer::Color, MapLayer::Opacity],
    };
    layers(pbr.base_color_texture().map(Reference::from), color);
    layers(pbr.metallic_roughness_texture().map(Reference::from), &[MapLayer::Roughness, MapLayer::Metallic]);
    layers(material.emissive_texture().map(Reference::from), &[MapLayer::Emissive]);
    let plain = |texture, coordinates| Some(Reference { texture, coordinates, transform: None });
    layers(material.normal_texture().and_then(|n| plain(n.texture(), n.tex_coord())), &[MapLayer::Normal]);
    layers(material.occlusion_texture().and_then(|o| plain(o.texture(), o.tex_coord())), &[MapLayer::Occlusion]);
    out
}

impl Read {
    fn layer(&mut self, layer: MapLayer, info: &Reference, name_image: NameImage) {
        let Some(name) = name_image(&info.texture.source()) else { return };
        let mut set = |part, value| self.appearance.set(MaterialAttr::Map(layer, part), value);
        set(MapPart::Path, Value::text(name));
        if let Some(transform) = &info.transform {
            let [[ou, ov], [su, sv]] = [transform.offset(), transform.scale()].map(|p| p.map(f64::from));
            let rotation = f64::from(transform.rotation());
            // The file counts v downwards; see `scene::export::material` for the way back.
            let (sin, cos) = (libm::sin(rotation), libm::cos(rotation));
            for (part, x) in [
                (MapPart::ScaleU, su),
                (MapPart::ScaleV, sv),
                (MapPart::OffsetU, ou + sin * sv),
                (MapPart::OffsetV, 1.0 - ov - cos * sv),
                (MapPart::Rotation, rotation.to_degrees()),
            ] {
                set(part, Value::Float(x));
            }
        }
        self.coordinates.push((layer, info.coordinates));
    }
}

/// IEC 61966-2-1.
fn srgb_encoded(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 };
    // Rounding would leave white a little grey.
    if linear == 1.0 { 1.0 } else { encoded }
}
