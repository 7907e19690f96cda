//! Pools: render targets by the keys of the plan, made when first needed and kept for later views.

use std::collections::{BTreeMap, BTreeSet};

use super::device::Gpu;
use crate::plan::resource::{Format, TextureKey};

/// A render target and its size in samples.
#[derive(Clone, Debug)]
pub struct Target {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    pub size: (u32, u32),
}

#[derive(Default)]
pub struct TargetPool {
    targets: BTreeMap<TextureKey, Target>,
    made: BTreeSet<TextureKey>,
}

impl TargetPool {
    /// The target for `key`, of `size` samples: a tile of the planned texture.
    pub fn get(&mut self, gpu: &Gpu, key: TextureKey, size: (u32, u32)) -> Target {
        self.made.insert(key);
        self.targets.retain(|other, target| *other != key || target.size == size);
        self.targets.entry(key).or_insert_with(|| create(gpu, key, size)).clone()
    }

    /// Frees the targets that a view does not name.
    pub fn keep(&mut self, keys: impl Iterator<Item = TextureKey>) {
        let keys: BTreeSet<TextureKey> = keys.collect();
        self.targets.retain(|key, _| keys.contains(key));
    }

    /// How many different targets were ever made.
    pub fn created(&self) -> usize {
        self.made.len()
    }
}

fn create(gpu: &Gpu, key: TextureKey, size: (u32, u32)) -> Target {
    use wgpu::TextureUsages as Usage;
    let drawn = Usage::RENDER_ATTACHMENT;
    let usage = match key.format {
        Format::Depth32 if key.layers > 1 => drawn | Usage::TEXTURE_BINDING,
        Format::Depth32 => drawn | Usage::TEXTURE_BINDING | Usage::COPY_SRC,
        Format::Radiance16 | Format::Bounds32 => drawn | Usage::TEXTURE_BINDING,
        Format::Srgb8 | Format::Id32 | Format::Linear32 => drawn | Usage::COPY_SRC,
        Format::Field16 => Usage::TEXTURE_BINDING | Usage::COPY_DST,
    };
    let extent = wgpu::Extent3d { width: size.0, height: size.1, depth_or_array_layers: key.layers };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(key.format.name()),
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: texture_format(key.format),
        usage,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    Target { texture, view, size }
}

impl Target {
    /// One layer, to draw into.
    pub fn layer(&self, number: u32) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: number,
            array_layer_count: Some(1),
            ..Default::default()
        })
    }

    /// All layers, even if there is but one.
    pub fn layers(&self) -> wgpu::TextureView {
        let dimension = Some(wgpu::TextureViewDimension::D2Array);
        self.texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
    }
}

pub fn texture_format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::Depth32 => wgpu::TextureFormat::Depth32Float,
        Format::Radiance16 => wgpu::TextureFormat::Rgba16Float,
        Format::Srgb8 => wgpu::TextureFormat::Rgba8UnormSrgb,
        Format::Id32 => wgpu::TextureFormat::R32Uint,
        Format::Bounds32 => wgpu::TextureFormat::Rg32Float,
        Format::Field16 => wgpu::TextureFormat::R16Float,
        Format::Linear32 => wgpu::TextureFormat::Rgba32Float,
    }
}
