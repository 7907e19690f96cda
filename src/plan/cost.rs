//! Cost: what a pass will move, predicted before it runs. In: a plan. Out: numbers by a simple model: every triangle that
//! is handed over is transformed once, every sample of its targets is written once, every texel of what it reads is read
//! once. Culling, overdraw, filters and tiles are not in it; `mansard cost` measures them.

use super::pass::{Pass, ViewPlan};
use super::resource::{Format, ResourceId, TextureKey};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    pub triangles: u64,
    /// Samples of its largest target.
    pub samples: u64,
    /// Texels of the maps and images that it reads.
    pub texels: u64,
    /// Written and read on the device, without vertices.
    pub bytes: u64,
}

impl Format {
    /// Of one texel.
    pub fn bytes(self) -> u64 {
        match self {
            Format::Field16 => 2,
            Format::Depth32 | Format::Srgb8 | Format::Id32 => 4,
            Format::Radiance16 | Format::Bounds32 => 8,
            Format::Linear32 => 16,
        }
    }
}

impl TextureKey {
    /// Of the whole image, all layers.
    pub fn texels(&self) -> u64 {
        let side = |texels: u32| u64::from(texels) * u64::from(self.supersample);
        side(self.width) * side(self.height) * u64::from(self.layers)
    }
}

impl Pass {
    /// What the pass costs in its view.
    pub fn cost(&self, view: &ViewPlan) -> Cost {
        let texture = |id: &ResourceId| view.resources[id.0].texture;
        let texels = |ids: &[ResourceId]| ids.iter().map(|id| texture(id).texels()).sum();
        let bytes = |id: &ResourceId| texture(id).texels() * texture(id).format.bytes();
        Cost {
            triangles: self.kind.draw().map_or(0, |draw| draw.triangles),
            samples: self.writes.iter().map(|id| texture(id).texels()).max().unwrap_or(0),
            texels: texels(&self.reads),
            bytes: self.reads.iter().chain(&self.writes).map(bytes).sum(),
        }
    }
}

impl std::ops::Add for Cost {
    type Output = Cost;

    fn add(self, other: Cost) -> Cost {
        Cost {
            triangles: self.triangles + other.triangles,
            samples: self.samples + other.samples,
            texels: self.texels + other.texels,
            bytes: self.bytes + other.bytes,
        }
    }
}
