//! Materials of a scene, each once. In: the materials of leaves. Out: their numbers, in the order they were first met.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::interpreter::material::{MapLayer, MapTransform, Material, OpacityMode, TextureMap};

/// What makes two materials the same, in an order: exact bits of numbers, names as text.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    name: Arc<str>,
    numbers: [u64; 10],
    modes: (OpacityMode, bool),
    colormap: Option<(Arc<str>, [u64; 5])>,
    maps: Vec<(MapLayer, Arc<str>, [u64; 5])>,
    other: Vec<(Arc<str>, Arc<str>)>,
}

impl Key {
    fn new(m: &Material) -> Self {
        let ([r, g, b], [er, eg, eb]) = (m.color, m.emissive);
        let numbers = [r, g, b, m.opacity, m.roughness, m.metallic, er, eg, eb, m.opacity_cutoff];
        let map = |map: &TextureMap| (map.layer, map.path.clone(), bits(&map.transform));
        Key {
            name: m.name.clone(),
            numbers: numbers.map(f64::to_bits),
            modes: (m.opacity_mode, m.double_sided),
            colormap: m.colormap.clone().map(|path| (path, bits(&m.colormap_transform))),
            maps: m.maps.iter().map(map).collect(),
            other: m.other.clone(),
        }
    }
}

fn bits(t: &MapTransform) -> [u64; 5] {
    [t.scale[0], t.scale[1], t.offset[0], t.offset[1], t.rotation].map(f64::to_bits)
}

/// Collects materials.
#[derive(Default)]
pub struct Palette {
    materials: Vec<Arc<Material>>,
    numbers: BTreeMap<Key, u32>,
}

impl Palette {
    /// The number of a material, new or known.
    pub fn number(&mut self, material: &Arc<Material>) -> u32 {
        *self.numbers.entry(Key::new(material)).or_insert_with(|| {
            self.materials.push(material.clone());
            (self.materials.len() - 1) as u32
        })
    }

    pub fn into_materials(self) -> Vec<Arc<Material>> {
        self.materials
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_materials_have_one_number() {
        let mut palette = Palette::default();
        let red = Material { color: [1.0, 0.0, 0.0], ..Material::default() };
        assert_eq!(palette.number(&Arc::new(red.clone())), 0);
        assert_eq!(palette.number(&Arc::new(Material::default())), 1);
        assert_eq!(palette.number(&Arc::new(red)), 0);
        assert_eq!(palette.into_materials().len(), 2);
    }
}
