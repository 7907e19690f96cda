//! Shade: linear radiance under the sun and the sky, with the share of the sun that a shadow map leaves.

use glam::DVec3;

use super::{Drawing, begin};
use crate::gpu::BACKGROUND;
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::tiles::light_rows;
use crate::plan::demand::{Ambient, Sun};
use crate::plan::light::LightFrame;
use crate::plan::pass::{PipelineKey, ShadowFilter, Surface};
use crate::plan::resource::Format;

/// Metres by which receivers are lifted towards the sun against rounding, and the share of a texel for smooth
/// normals that differ from the plane of their triangle.
const LIFT_METRES: f64 = 0.02;
const LIFT_TEXELS: f64 = 0.25;

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

pub fn light_uniform(camera: DVec3, sun: Option<&Sun>, ambient: Ambient, light: Option<&LightFrame>) -> LightUniform {
    let vector = |v: DVec3, w: f64| v.extend(w).as_vec4().to_array();
    let color = |c: [f64; 3], w: f64| vector(DVec3::from_array(c), w);
    let (zenith, ground) = match ambient {
        Ambient::Off => ([0.0; 3], [0.0; 3]),
        Ambient::Constant(radiance) => (radiance, radiance),
        Ambient::Sky { zenith, ground } => (zenith, ground),
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
    let lift = (LIFT_METRES + LIFT_TEXELS * light.texel.max_element()) / range;
    LightUniform {
        rows: light_rows(light, camera).map(|row| row.map(|c| c as f32)),
        u: vector(light.u, light.texel.x / range),
        v: vector(light.v, light.texel.y / range),
        sun: vector(direction, lift),
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
    let texture = (surface != Surface::Plain).then_some(&layouts.texture);
    let groups = [Some(&layouts.view), texture, Some(&layouts.light), Some(&layouts.shadow)];
    let constants = gathers.map(|g| ("GATHERS", f64::from(g)));
    GeometryPipeline {
        label: PipelineKey::Shade { surface, shadow }.name(),
        module,
        vertex: "vs_shade",
        fragment: Some((entry, Some(Format::Radiance16))),
        attributes: true,
        groups: if gathers.is_some() { &groups } else { &groups[..3] },
        constants: constants.as_slice(),
    }
    .create(gpu)
}

/// Bind groups of the light and, if there is one, of the shadow map.
pub fn groups(
    gpu: &Gpu,
    layouts: &Layouts,
    uniform: &LightUniform,
    materials: &wgpu::Buffer,
    shadow_map: Option<&Target>,
) -> Vec<wgpu::BindGroup> {
    let buffer = gpu.uniform("light", uniform);
    let group = |label: &str, layout: &wgpu::BindGroupLayout, resources: [wgpu::BindingResource; 2]| {
        let [first, second] = resources;
        let entries = [
            wgpu::BindGroupEntry { binding: 0, resource: first },
            wgpu::BindGroupEntry { binding: 1, resource: second },
        ];
        let descriptor = wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries };
        gpu.device.create_bind_group(&descriptor)
    };
    let mut groups =
        vec![group("light", &layouts.light, [buffer.as_entire_binding(), materials.as_entire_binding()])];
    if let Some(target) = shadow_map {
        let view = wgpu::BindingResource::TextureView(&target.view);
        let sampler = wgpu::BindingResource::Sampler(&layouts.gather_sampler);
        groups.push(group("shadow map", &layouts.shadow, [view, sampler]));
    }
    groups
}

pub fn encode(
    encoder: &mut wgpu::CommandEncoder,
    drawing: &Drawing,
    groups: &[wgpu::BindGroup],
    shadow: ShadowFilter,
    (radiance, depth): (&Target, &Target),
) {
    let [r, g, b] = BACKGROUND;
    let mut pass = begin(encoder, "shade", Some((radiance, wgpu::Color { r, g, b, a: 1.0 })), Some(depth));
    let groups: Vec<&wgpu::BindGroup> = groups.iter().collect();
    drawing.record(&mut pass, &groups, |surface| PipelineKey::Shade { surface, shadow });
}
