//! Object summary: what the planner must know of each object, taken from the scene once.

use std::sync::Arc;

use glam::DVec3;

use super::pass::Surface;
use crate::interpreter::material::{Material, OpacityMode};
use crate::scene::{Scene, SceneObject};

/// Opacity (of the material, or material times texel) under which a surface is not there. Half-transparent surfaces
/// are drawn opaque: labels need a decision, and colour, shadow and label must agree on it.
pub const OPAQUE_FROM: f64 = 0.5;

/// One object of the scene as the planner sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectSummary {
    /// Least and greatest corner, metres; `None` for an empty mesh.
    pub bounds: Option<(DVec3, DVec3)>,
    pub class: u8,
    pub instance: u32,
    pub level: u8,
    pub triangles: u64,
    /// Kinds of surface it has, sorted, without invisible ones.
    pub surfaces: Vec<Surface>,
}

/// One summary per object, in the scene's order.
pub fn summarize(scene: &Scene) -> Vec<ObjectSummary> {
    let surfaces = material_surfaces(scene);
    scene.objects.iter().map(|object| summarize_object(object, &surfaces)).collect()
}

/// How each material of the scene is drawn; `None` is invisible.
pub fn material_surfaces(scene: &Scene) -> Vec<Option<Surface>> {
    let alpha = |t: &image::RgbaImage| t.pixels().map(|p| p.0[3]).min().unwrap_or(u8::MAX);
    let alphas: Vec<u8> = scene.textures.iter().map(|(_, texture)| alpha(texture)).collect();
    scene.materials.iter().map(|m| surface(m, scene.textures.as_slice(), &alphas)).collect()
}

/// Opacity under which a surface of the material is not there.
fn there_from(material: &Material) -> f64 {
    match material.opacity_mode {
        OpacityMode::Blend => OPAQUE_FROM,
        OpacityMode::Mask => material.opacity_cutoff,
        OpacityMode::Opaque => 0.0,
    }
}

/// Alpha, 0..1, under which a texel is a hole in a surface of the material: there its opacity times alpha is too low.
pub fn least_alpha(material: &Material) -> f64 {
    let from = there_from(material);
    if from > 0.0 { from / material.opacity } else { 0.0 }
}

/// `alphas`: the least of each texture.
fn surface(material: &Material, textures: &[(Arc<str>, Arc<image::RgbaImage>)], alphas: &[u8]) -> Option<Surface> {
    if material.opacity < there_from(material) {
        return None;
    }
    let texture = material.colormap.as_ref().and_then(|n| textures.binary_search_by(|(name, _)| name.cmp(n)).ok());
    Some(match texture {
        None => Surface::Plain,
        Some(t) if f64::from(alphas[t]) < least_alpha(material) * 255.0 => Surface::Cutout,
        Some(_) => Surface::Textured,
    })
}

fn summarize_object(object: &SceneObject, surfaces: &[Option<Surface>]) -> ObjectSummary {
    let mesh = &object.mesh;
    let bounds = mesh.bounds();
    let mut kinds: Vec<Surface> =
        mesh.groups.iter().filter(|g| g.count > 0).filter_map(|g| surfaces[g.material as usize]).collect();
    kinds.sort();
    kinds.dedup();
    ObjectSummary {
        bounds,
        class: object.class as u8,
        instance: object.instance,
        level: object.level,
        triangles: mesh.triangles.len() as u64,
        surfaces: kinds,
    }
}
