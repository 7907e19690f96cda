//! Shade: linear radiance under the sun and the sky, with the share of the sun that a shadow map leaves.

use glam::DVec3;

use super::{Drawing, begin};
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::tiles::light_rows;
use crate::plan::demand::{Ambient, BACKGROUND, Sun};
use crate::plan::light::LightFrame;
use crate::plan::pass::{PipelineKey, ShadowFilter, Surface};
use crate::plan::resource::Format;

/// Distance, metres along the ray, within which a caster's shadow fades in: a constant against rounding, and a share
/// of a texel for smooth normals that differ from the plane of their triangle.
const FADE_METRES: f64 = 0.04;
const FADE_TEXELS: f64 = 0.5;

/// `Light` of `shaders/shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct LightUniform {
    rows: [[f32; 4]; 3],
    u: [f32; 4],
    v: [f32; 4],
    sun: [f32; 4],
    irradiance: [f32; 4],
    zenith: [f32; 4],
    ground: [f32; 4],
}

pub fn light_uniform(origin: DVec3, sun: Option<&Sun>, ambient: Ambient, light: Option<&LightFrame>) -> LightUniform {
    let vector = |v: DVec3, w: f64| v.extend(w).as_vec4().to_array();
    let color = |c: [f64; 3], w: f64| vector(DVec3::from_array(c), w);
    let (zenith, ground) = match ambient {
        Ambient::Off => ([0.0; 3], [0.0; 3]),
        Ambient::Constant(radiance) => (radiance, radiance),
        Ambient::Sky { zenith, ground, .. } => (zenith, ground),
    };
    let direction = sun.map_or(DVec3::Y, |s| s.direction);
    let irradiance = sun.map_or([0.0; 3], |s| s.irradiance);
    let unshadowed = LightUniform {
        rows: [[0.0; 4]; 3],
        u: [0.0; 4],
        v: [0.0; 4],
        sun: vector(direction, 0.0),
        irradiance: color(irradiance, 0.0),
        zenith: color(zenith, 0.0),
        ground: color(ground, 0.0),
    };
    let Some(light) = light else { return unshadowed };
    let range = light.high - light.low;
    let fade = (FADE_METRES + FADE_TEXELS * light.texel.max_element()) / range;
    LightUniform {
        rows: light_rows(light, origin).map(|row| row.map(|c| c as f32)),
        u: vector(light.u, light.texel.x / range),
        v: vector(light.v, light.texel.y / range),
        sun: vector(direction, 1.0 / fade),
        irradiance: color(irradiance, 1.0 / f64::from(light.size)),
        ..unshadowed
    }
}

pub fn pipeline(
    gpu: &Gpu,
    layouts: &Layouts,
    module: &wgpu::ShaderModule,
    surface: Surface,
    shadow: ShadowFilter,
) -> wgpu::RenderPipeline {
    let (entry, gathers) = match (surface, shadow) {
        (Surface::Plain, ShadowFilter::Unshadowed) => ("fs_plain", None),
        (Surface::Textured, ShadowFilter::Unshadowed) => ("fs_textured", None),
        (Surface::Cutout, ShadowFilter::Unshadowed) => ("fs_cutout", None),
        (Surface::Plain, ShadowFilter::Box { gathers }) => ("fs_plain_shadow", Some(gathers)),
        (Surface::Textured, ShadowFilter::Box { gathers }) => ("fs_textured_shadow", Some(gathers)),
        (Surface::Cutout, ShadowFilter::Box { gathers }) => ("fs_cutout_shadow", Some(gathers)),
    };
    let light = if gathers.is_some() { &layouts.shadowed_light } else { &layouts.light };
    let groups = [&layouts.view, light, &layouts.texture];
    let constants = gathers.map(|g| ("GATHERS", f64::from(g)));
    GeometryPipeline {
        label: PipelineKey::Shade { surface, shadow }.name(),
        module,
        vertex: "vs_shade",
        fragment: Some((entry, Some(Format::Radiance16))),
        attributes: true,
        groups: if surface == Surface::Plain { &groups[..2] } else { &groups },
        constants: constants.as_slice(),
    }
    .create(gpu)
}

/// Bind group of the light with, if there is one, the shadow map.
pub fn light_group(
    gpu: &Gpu,
    layouts: &Layouts,
    uniform: &LightUniform,
    materials: &wgpu::Buffer,
    shadow_map: Option<&Target>,
) -> wgpu::BindGroup {
    let buffer = gpu.uniform("light", uniform);
    let mut resources = vec![buffer.as_entire_binding(), materials.as_entire_binding()];
    if let Some(target) = shadow_map {
        resources.push(wgpu::BindingResource::TextureView(&target.view));
        resources.push(wgpu::BindingResource::Sampler(&layouts.gather_sampler));
    }
    let entry = |(i, resource)| wgpu::BindGroupEntry { binding: i as u32, resource };
    let entries: Vec<_> = resources.into_iter().enumerate().map(entry).collect();
    let layout = if shadow_map.is_some() { &layouts.shadowed_light } else { &layouts.light };
    let descriptor = wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries };
    gpu.device.create_bind_group(&descriptor)
}

pub fn encode(
    encoder: &mut wgpu::CommandEncoder,
    drawing: &Drawing,
    light: &wgpu::BindGroup,
    shadow: ShadowFilter,
    (radiance, depth): (&Target, &Target),
) {
    let [r, g, b] = BACKGROUND;
    let mut pass = begin(encoder, "shade", Some((radiance, wgpu::Color { r, g, b, a: 1.0 })), Some(depth));
    drawing.record(&mut pass, Some(light), |surface| PipelineKey::Shade { surface, shadow });
}
