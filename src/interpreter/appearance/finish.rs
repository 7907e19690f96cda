//! What an [`Appearance`] comes to. In: attributes that were set. Out: a [`Material`] with defaults filled in.

use super::{Appearance, COLORMAP, name_of};
use crate::cga::builtins::{Attr, MapLayer, MapPart, MaterialAttr as M};
use crate::interpreter::material::{MapTransform, Material, OpacityMode, TextureMap};
use crate::interpreter::value::Value;

const LAYERS: [MapLayer; 10] = [
    MapLayer::Color,
    MapLayer::Bump,
    MapLayer::Dirt,
    MapLayer::Specular,
    MapLayer::Opacity,
    MapLayer::Normal,
    MapLayer::Emissive,
    MapLayer::Occlusion,
    MapLayer::Roughness,
    MapLayer::Metallic,
];

impl Appearance {
    /// The material with defaults filled in.
    pub fn material(&self) -> Material {
        let default = Material::default();
        let mut out = Material {
            name: self.name.clone().unwrap_or(default.name),
            color: self.color.map(|c| c.unwrap_or(1.0)),
            opacity: self.opacity.unwrap_or(default.opacity),
            roughness: self.roughness.unwrap_or(default.roughness),
            metallic: self.metallic.unwrap_or(default.metallic),
            colormap: self.colormap.clone().filter(|path| !path.is_empty()),
            ..default
        };
        // Most materials have a colour and a texture and nothing else.
        if !self.other.is_empty() {
            self.finish(&mut out);
        }
        out
    }

    fn finish(&self, out: &mut Material) {
        let share = |attr| self.number(attr).clamp(0.0, 1.0);
        out.emissive = [0, 1, 2].map(|channel| share(M::Emissive(channel)));
        out.double_sided = self.get(M::DoubleSided).is_none_or(|value| value.to_bool());
        out.opacity_cutoff = share(M::OpacityCutoff);
        out.opacity_mode = match self.get(M::OpacityMode) {
            Some(Value::String(mode)) if &*mode == "mask" => OpacityMode::Mask,
            Some(Value::String(mode)) if &*mode == "opaque" => OpacityMode::Opaque,
            _ => OpacityMode::Blend,
        };
        out.colormap_transform = self.transform(MapLayer::Color);
        for layer in LAYERS.into_iter().filter(|layer| M::Map(*layer, MapPart::Path) != COLORMAP) {
            if let Some(Value::String(path)) = self.get(M::Map(layer, MapPart::Path))
                && !path.is_empty()
            {
                out.maps.push(TextureMap { layer, path, transform: self.transform(layer) });
            }
        }
        let kept = self.other.iter().filter(|(name, _)| !is_finished(name));
        out.other = kept.map(|(name, value)| (name.clone(), value.to_text())).collect();
    }

    fn number(&self, attr: M) -> f64 {
        self.get(attr).unwrap_or_else(|| Appearance::default_value(attr)).to_float()
    }

    fn transform(&self, layer: MapLayer) -> MapTransform {
        let part = |part| self.number(M::Map(layer, part));
        MapTransform {
            scale: [part(MapPart::ScaleU), part(MapPart::ScaleV)],
            offset: [part(MapPart::OffsetU), part(MapPart::OffsetV)],
            rotation: part(MapPart::Rotation),
        }
    }
}

/// Whether an attribute has a field of its own in the material.
fn is_finished(name: &str) -> bool {
    match Attr::from_name(&format!("material.{name}")).map(|row| row.attr) {
        Some(Attr::Material(attr)) => {
            matches!(attr, M::Emissive(_) | M::DoubleSided | M::OpacityMode | M::OpacityCutoff | M::Map(..))
                && name_of(attr) == name
        }
        _ => false,
    }
}
