//! Resources: the textures that passes read and write, named and sized, before any exists.

/// Index into [`super::pass::ViewPlan::resources`]. Every write makes a new resource (a new version), so that the
/// order of passes can be read off the reads and writes alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceId(pub usize);

/// What one texel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Format {
    /// Reverse depth, 32-bit float: 1 nearest, 0 farthest.
    Depth32,
    /// Linear radiance, 16-bit float RGBA.
    Radiance16,
    /// sRGB-encoded colour, 8 bit RGBA.
    Srgb8,
    /// Object number + 1, 0 where nothing is; 32-bit unsigned.
    Id32,
    /// Greatest and least height of a block of a shadow map, metres, 32-bit float.
    Bounds32,
    /// A number, 16-bit float.
    Field16,
    /// Linear radiance, 32-bit float RGBA.
    Linear32,
}

impl Format {
    pub fn name(self) -> &'static str {
        match self {
            Format::Depth32 => "depth32",
            Format::Radiance16 => "radiance16",
            Format::Srgb8 => "srgb8",
            Format::Id32 => "id32",
            Format::Bounds32 => "bounds32",
            Format::Field16 => "field16",
            Format::Linear32 => "linear32",
        }
    }
}

/// A texture to allocate. Equal keys share one: no two of them are in use at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TextureKey {
    pub format: Format,
    /// Texels of the whole image, without supersampling.
    pub width: u32,
    pub height: u32,
    /// Samples per pixel side.
    pub supersample: u32,
    pub layers: u32,
    /// Tells apart textures that are alive together.
    pub number: u32,
    /// The renderer may allocate a tile of it and go over the image; a shadow map is there as a whole.
    pub tiled: bool,
}

/// One version of the contents of a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Resource {
    /// Stem of the pass that writes it, with a running number.
    pub name: String,
    /// Where it lives: resources whose lives do not overlap share a texture.
    pub texture: TextureKey,
}
