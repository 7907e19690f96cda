//! The material a leaf carries out of derivation.

use std::sync::Arc;

pub use crate::cga::builtins::MapLayer;
use crate::cga::builtins::{Attr, MapPart, MaterialAttr};

/// How opacity is meant (CGA `material.opacitymap.mode`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum OpacityMode {
    #[default]
    Blend,
    /// There where it reaches the cutoff, absent elsewhere.
    Mask,
    Opaque,
}

/// Where a texture lies on its uv set: a point at uv shows the texel at `offset + turn(scale * uv)`; v runs up
/// (reference 8, A30).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapTransform {
    pub scale: [f64; 2],
    pub offset: [f64; 2],
    /// Degrees, counter-clockwise about (0, 0).
    pub rotation: f64,
}

/// A texture of a layer besides the colour.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureMap {
    /// Its number is that of its uv set; faces without that set use set 0.
    pub layer: MapLayer,
    /// File or `builtin:` name.
    pub path: Arc<str>,
    pub transform: MapTransform,
}

/// Look of a surface. Colours are sRGB-encoded 0..1 as CGA's `color` gives them; linearised by the renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: Arc<str>,
    /// sRGB-encoded, 0..1.
    pub color: [f64; 3],
    /// 0 transparent .. 1 opaque.
    pub opacity: f64,
    pub opacity_mode: OpacityMode,
    pub opacity_cutoff: f64,
    /// 0 smooth .. 1 rough (CGA `material.roughness`).
    pub roughness: f64,
    pub metallic: f64,
    /// sRGB-encoded, 0..1.
    pub emissive: [f64; 3],
    pub double_sided: bool,
    /// File or `builtin:` name of the colour texture, uv set 0.
    pub colormap: Option<Arc<str>>,
    pub colormap_transform: MapTransform,
    /// Textures of the other layers, sorted by layer.
    pub maps: Vec<TextureMap>,
    /// Every other material attribute that was set, by name without the `material.` prefix, sorted by name.
    pub other: Vec<(Arc<str>, Arc<str>)>,
}

impl Material {
    /// The texture of a layer besides the colour.
    pub fn map(&self, layer: MapLayer) -> Option<&TextureMap> {
        self.maps.iter().find(|map| map.layer == layer)
    }
}

impl TextureMap {
    /// As in attributes, such as `bumpmap`.
    pub fn layer_name(&self) -> &'static str {
        let name = Attr::Material(MaterialAttr::Map(self.layer, MapPart::Path)).info().name;
        name.strip_prefix("material.").unwrap_or(name)
    }
}

impl OpacityMode {
    pub fn name(self) -> &'static str {
        match self {
            OpacityMode::Blend => "blend",
            OpacityMode::Mask => "mask",
            OpacityMode::Opaque => "opaque",
        }
    }
}

impl MapTransform {
    pub const IDENTITY: MapTransform = MapTransform { scale: [1.0; 2], offset: [0.0; 2], rotation: 0.0 };

    /// Where the texel lies that a point at uv shows; v runs up.
    pub fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.sin_cos();
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        [cos * u - sin * v + self.offset[0], sin * u + cos * v + self.offset[1]]
    }

    pub fn sin_cos(&self) -> (f64, f64) {
        let radians = self.rotation.to_radians();
        (libm::sin(radians), libm::cos(radians))
    }
}

impl Default for MapTransform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Default for Material {
    fn default() -> Self {
        Material {
            name: "".into(),
            color: [1.0; 3],
            opacity: 1.0,
            opacity_mode: OpacityMode::Blend,
            opacity_cutoff: 0.5,
            roughness: 1.0,
            metallic: 0.0,
            emissive: [0.0; 3],
            double_sided: true,
            colormap: None,
            colormap_transform: MapTransform::IDENTITY,
            maps: Vec::new(),
            other: Vec::new(),
        }
    }
}
