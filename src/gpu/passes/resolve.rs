//! Resolve: k × k linear radiances → one pixel, sRGB or linear.

use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{Layouts, Pipelines, pipeline_layout};
use crate::gpu::pools::{Target, texture_format};
use crate::gpu::timing::Recorder;
use crate::plan::pass::PipelineKey;
use crate::plan::resource::Format;

pub fn pipeline(
    gpu: &Gpu,
    layouts: &Layouts,
    module: &wgpu::ShaderModule,
    supersample: u32,
    linear: bool,
) -> wgpu::RenderPipeline {
    let label = PipelineKey::Resolve { supersample, linear }.name();
    let format = if linear { Format::Linear32 } else { Format::Srgb8 };
    let constants = [("SAMPLES", f64::from(supersample))];
    let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(&label),
        layout: Some(&pipeline_layout(gpu, &label, &[&layouts.resolve])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_resolve"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(if supersample.is_multiple_of(2) { "fs_resolve_even" } else { "fs_resolve_odd" }),
            compilation_options: options,
            targets: &[Some(texture_format(format).into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

pub fn encode(
    recorder: &mut Recorder,
    gpu: &Gpu,
    pipelines: &Pipelines,
    key: PipelineKey,
    (radiance, color): (&Target, &Target),
    area: (u32, u32),
) {
    let layouts = &pipelines.layouts;
    let entries = [
        wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&radiance.view) },
        wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&layouts.linear_sampler) },
    ];
    let descriptor = wgpu::BindGroupDescriptor { label: Some("resolve"), layout: &layouts.resolve, entries: &entries };
    let group = gpu.device.create_bind_group(&descriptor);
    let mut pass = recorder.begin("resolve", Some((&color.view, wgpu::Color::BLACK)), None);
    pass.set_scissor_rect(0, 0, area.0, area.1);
    pass.set_pipeline(pipelines.get(key));
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}
