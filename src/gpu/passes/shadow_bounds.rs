//! Shadow bounds: shadow map → how high and how low the points in each of its blocks are, then in blocks of blocks.

use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{Layouts, Pipelines, pipeline_layout};
use crate::gpu::pools::{Target, texture_format};
use crate::gpu::timing::Recorder;
use crate::plan::light::LightFrame;
use crate::plan::pass::PipelineKey;
use crate::plan::resource::Format;

pub fn pipeline(gpu: &Gpu, layouts: &Layouts, module: &wgpu::ShaderModule, first: bool) -> wgpu::RenderPipeline {
    let label = PipelineKey::ShadowBounds { first }.name();
    let layout = if first { &layouts.first_bounds } else { &layouts.coarse_bounds };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&label),
        layout: Some(&pipeline_layout(gpu, &label, &[layout])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_bounds"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(if first { "fs_first" } else { "fs_coarse" }),
            compilation_options: Default::default(),
            targets: &[Some(texture_format(Format::Bounds32).into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Height above the frame's anchor of a point of the map, as a row over texel column, texel row, depth and 1.
pub fn height_row(light: &LightFrame) -> [f64; 4] {
    let (across, along) = (light.u.y * light.texel.x, light.v.y * light.texel.y);
    let climb = light.direction.y;
    let corner = light.corner.x * across + light.corner.y * along + light.low * climb;
    [across, along, (light.high - light.low) * climb, corner]
}

pub fn encode(
    recorder: &mut Recorder,
    gpu: &Gpu,
    pipelines: &Pipelines,
    light: &LightFrame,
    (map, blocks, all): (&Target, &Target, &Target),
) {
    let layouts = &pipelines.layouts;
    let uniform = gpu.stored("shadow bounds", &height_row(light).map(|c| c as f32));
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    let of_map = [
        entry(0, uniform.as_entire_binding()),
        entry(1, wgpu::BindingResource::TextureView(&map.view)),
        entry(2, wgpu::BindingResource::Sampler(&layouts.gather_sampler)),
    ];
    let of_blocks = [entry(3, wgpu::BindingResource::TextureView(&blocks.view))];
    let steps =
        [(true, &layouts.first_bounds, &of_map[..], blocks), (false, &layouts.coarse_bounds, &of_blocks[..], all)];
    for (first, layout, entries, target) in steps {
        let descriptor = wgpu::BindGroupDescriptor { label: Some("shadow bounds"), layout, entries };
        let group = gpu.device.create_bind_group(&descriptor);
        let mut pass = recorder.begin("shadow_bounds", Some((&target.view, wgpu::Color::BLACK)), None);
        pass.set_pipeline(pipelines.get(PipelineKey::ShadowBounds { first }));
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, DVec3};

    #[test]
    fn heights_are_those_of_the_points() {
        let direction = DVec3::new(0.3, 0.5, -0.8).normalize();
        let (u, v) = crate::plan::light::across(direction);
        let anchor = DVec3::new(100.0, 20.0, -50.0);
        let (texel, corner) = (DVec2::new(0.2, 0.3), DVec2::new(-40.0, 17.0));
        let light = LightFrame { anchor, u, v, direction, texel, corner, size: 64, low: -9.0, high: 31.0 };
        let p = anchor + DVec3::new(3.0, 7.0, -2.0);
        let [column, row, depth] =
            crate::gpu::tiles::light_rows(&light, DVec3::ZERO).map(|r| DVec3::new(r[0], r[1], r[2]).dot(p) + r[3]);
        let [a, b, c, d] = height_row(&light);
        assert!((a * column + b * row + c * depth + d - 7.0).abs() < 1e-9);
    }
}
