//! Attributes: what vertices carry. In: the pipelines of a plan. Out: the attributes that any of them reads; the renderer
//! makes and uploads no other.

use std::collections::BTreeSet;

use super::pass::{PipelineKey, RenderPlan, Surface, ViewPlan};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Attribute {
    Position,
    Normal,
    /// Number of the material.
    Material,
    TextureCoordinates,
    /// Number of the object.
    Object,
}

impl Attribute {
    pub const ALL: [Attribute; 5] =
        [Attribute::Position, Attribute::Normal, Attribute::Material, Attribute::TextureCoordinates, Attribute::Object];

    pub fn name(self) -> &'static str {
        match self {
            Attribute::Position => "position",
            Attribute::Normal => "normal",
            Attribute::Material => "material",
            Attribute::TextureCoordinates => "texture coordinates",
            Attribute::Object => "object",
        }
    }

    /// Of one vertex on the device.
    pub fn bytes(self) -> u64 {
        match self {
            Attribute::Position => 12,
            Attribute::Normal | Attribute::TextureCoordinates => 8,
            Attribute::Material | Attribute::Object => 4,
        }
    }
}

impl PipelineKey {
    /// What its vertices carry, sorted; none for pipelines that draw no triangles of the scene.
    pub fn attributes(self) -> &'static [Attribute] {
        use Attribute::{Material, Normal, Object, Position, TextureCoordinates};
        match self {
            PipelineKey::ShadowMap { cutout: false } | PipelineKey::Depth { cutout: false } => &[Position],
            PipelineKey::ShadowMap { cutout: true } | PipelineKey::Depth { cutout: true } => {
                &[Position, TextureCoordinates]
            }
            PipelineKey::Ids { cutout: false } => &[Position, Object],
            PipelineKey::Ids { cutout: true } => &[Position, TextureCoordinates, Object],
            PipelineKey::Shade { surface: Surface::Plain, .. } => &[Position, Normal, Material],
            PipelineKey::Shade { .. } => &[Position, Normal, Material, TextureCoordinates],
            PipelineKey::ShadowBounds { .. } | PipelineKey::Resolve { .. } => &[],
        }
    }
}

impl RenderPlan {
    /// What the vertices of the scene must carry for all views.
    pub fn attributes(&self) -> BTreeSet<Attribute> {
        let passes = self.views.iter().flat_map(ViewPlan::passes);
        passes.flat_map(|pass| &pass.pipelines).flat_map(|key| key.attributes()).copied().collect()
    }
}
