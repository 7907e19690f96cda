//! The material a leaf carries out of derivation.

use std::sync::Arc;

/// Look of a surface. Colours are sRGB-encoded 0..1 as CGA's `color` gives them; linearised by the renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: Arc<str>,
    /// sRGB-encoded, 0..1.
    pub color: [f64; 3],
    /// 0 transparent .. 1 opaque.
    pub opacity: f64,
    /// 0 smooth .. 1 rough (CGA `material.roughness`).
    pub roughness: f64,
    pub metallic: f64,
    /// File or `builtin:` name of the colour texture, uv set 0.
    pub colormap: Option<Arc<str>>,
    /// Every other material attribute that was set, by name without the `material.` prefix, sorted by name.
    pub other: Vec<(Arc<str>, Arc<str>)>,
}

impl Default for Material {
    fn default() -> Self {
        Material {
            name: "".into(),
            color: [1.0; 3],
            opacity: 1.0,
            roughness: 1.0,
            metallic: 0.0,
            colormap: None,
            other: Vec::new(),
        }
    }
}
