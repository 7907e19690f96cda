//! Bindings of shading: the terms of an image → the bind group layout of its light, and the group itself. Both hold
//! what the terms use and nothing else; the numbers are those of the parts of `shaders/shade`.

use std::collections::BTreeMap;

use glam::DVec3;

use super::uniforms::{self, CloudsUniform, DiscUniform, HazeUniform, LampUniform, ShadowUniform};
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::Layouts;
use crate::gpu::pools::Target;
use crate::plan::resource::ResourceId;
use crate::plan::shading::{Illumination, ShadowFilter, Terms};

/// Bind group layout of the light for these terms.
pub fn layout(gpu: &Gpu, terms: Terms) -> wgpu::BindGroupLayout {
    let entries = entries(terms);
    let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some("light"), entries: &entries };
    gpu.device.create_bind_group_layout(&descriptor)
}

fn entries(terms: Terms) -> Vec<wgpu::BindGroupLayoutEntry> {
    use wgpu::{BufferBindingType as Buffer, SamplerBindingType as Sampler, TextureSampleType as Texel};
    let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
    let both = vertex | fragment;
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let storage = buffer(Buffer::Storage { read_only: true });
    let texture =
        |sample_type, view_dimension| wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let flat = |sample_type| texture(sample_type, wgpu::TextureViewDimension::D2);
    let field = flat(Texel::Float { filterable: true });
    let (gathers, blends) =
        (wgpu::BindingType::Sampler(Sampler::NonFiltering), wgpu::BindingType::Sampler(Sampler::Filtering));
    let clouds = terms.cloud_shadow || terms.cloud_cover;
    let (shadow, soft) = (terms.shadow != ShadowFilter::Unshadowed, terms.shadow == ShadowFilter::Soft);
    let sky_maps = texture(Texel::Depth, wgpu::TextureViewDimension::D2Array);
    let all = [
        (true, 0, both, storage),
        (true, 1, vertex, storage),
        (shadow, 2, both, storage),
        (shadow, 3, fragment, flat(Texel::Depth)),
        (shadow, 4, fragment, gathers),
        (soft, 5, both, storage),
        (soft, 6, fragment, flat(Texel::Float { filterable: false })),
        (terms.occluded_sky, 7, fragment, storage),
        (terms.occluded_sky, 8, fragment, sky_maps),
        (terms.occluded_sky, 9, fragment, gathers),
        (terms.haze, 10, fragment, storage),
        (clouds, 11, fragment, storage),
        (clouds, 12, fragment, blends),
        (terms.cloud_shadow, 13, fragment, field),
        (terms.cloud_cover, 14, fragment, field),
        (terms.ground.is_some(), 15, fragment, storage),
        (terms.ground.is_some(), 16, fragment, blends),
        (terms.ground.is_some(), 17, fragment, field),
    ];
    let entry = |(_, binding, visibility, ty)| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    all.into_iter().filter(|(used, ..)| *used).map(entry).collect()
}

/// A light and where its maps are.
pub struct Lit<'a> {
    /// About which positions are kept.
    pub origin: DVec3,
    pub light: &'a Illumination,
    /// Samples per pixel side.
    pub side: u32,
    pub materials: &'a wgpu::Buffer,
    pub targets: &'a BTreeMap<ResourceId, Target>,
}

enum Bound<'a> {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(&'a wgpu::Sampler),
}

impl Bound<'_> {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Bound::Buffer(buffer) => buffer.as_entire_binding(),
            Bound::View(view) => wgpu::BindingResource::TextureView(view),
            Bound::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

/// Bind group of the light in a layout that [`layout`] made for its terms.
pub fn group(gpu: &Gpu, layouts: &Layouts, layout: &wgpu::BindGroupLayout, lit: &Lit) -> wgpu::BindGroup {
    let bound = bound(gpu, layouts, lit);
    let entries: Vec<_> = bound
        .iter()
        .map(|(binding, bound)| wgpu::BindGroupEntry { binding: *binding, resource: bound.resource() })
        .collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries };
    gpu.device.create_bind_group(&descriptor)
}

fn bound<'a>(gpu: &Gpu, layouts: &'a Layouts, lit: &Lit) -> Vec<(u32, Bound<'a>)> {
    let Lit { origin, light, side, materials, targets } = *lit;
    let view = |id: ResourceId| Bound::View(targets[&id].view.clone());
    let lamp = gpu.stored("lamp", &LampUniform::new(light));
    let mut bound = vec![(0, Bound::Buffer(lamp)), (1, Bound::Buffer(materials.clone()))];
    if let Some(shadow) = &light.shadow {
        let uniform = gpu.stored("shadow", &ShadowUniform::new(origin, &shadow.frame));
        bound.extend([
            (2, Bound::Buffer(uniform)),
            (3, view(shadow.map)),
            (4, Bound::Sampler(&layouts.gather_sampler)),
        ]);
        if let Some(soft) = &shadow.soft {
            let disc = light.sun.map_or(0.0, |sun| sun.disc_deg);
            let uniform = gpu.stored("disc", &DiscUniform::new(origin, &shadow.frame, soft, disc));
            bound.extend([(5, Bound::Buffer(uniform)), (6, view(soft.bounds))]);
        }
    }
    if let Some(look) = &light.sky {
        let views = gpu.buffer("sky", &uniforms::sky(origin, look, side), wgpu::BufferUsages::STORAGE);
        let maps = Bound::View(targets[&look.maps].layers());
        bound.extend([(7, Bound::Buffer(views)), (8, maps), (9, Bound::Sampler(&layouts.gather_sampler))]);
    }
    if let Some(haze) = &light.haze {
        bound.push((10, Bound::Buffer(gpu.stored("haze", &HazeUniform::new(origin, haze, light)))));
    }
    let clouds = [(13, light.cloud_shadow), (14, light.cloud_cover)];
    if clouds.iter().any(|(_, look)| look.is_some()) {
        let uniform = gpu.stored("clouds", &CloudsUniform::new(origin, light));
        bound.extend([(11, Bound::Buffer(uniform)), (12, Bound::Sampler(&layouts.linear_sampler))]);
        bound.extend(clouds.into_iter().filter_map(|(binding, look)| Some((binding, view(look?.map)))));
    }
    if let Some((_, look)) = &light.ground {
        let uniform = gpu.stored("ground", &uniforms::field_row(origin, &look.frame));
        let sampler = Bound::Sampler(&layouts.linear_sampler);
        bound.extend([(15, Bound::Buffer(uniform)), (16, sampler), (17, view(look.map))]);
    }
    bound
}
