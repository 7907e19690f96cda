//! Depth: reverse depth at pixel centres, without object numbers.

use super::{Drawing, begin};
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::plan::pass::{PipelineKey, Surface};

pub fn pipeline(gpu: &Gpu, layouts: &Layouts, module: &wgpu::ShaderModule, cutout: bool) -> wgpu::RenderPipeline {
    let groups = [&layouts.view, &layouts.texture];
    GeometryPipeline {
        label: PipelineKey::Depth { cutout }.name(),
        module,
        vertex: if cutout { "vs_depth_cutout" } else { "vs_depth" },
        fragment: cutout.then_some(("fs_depth_cutout", None)),
        attributes: cutout,
        groups: if cutout { &groups } else { &groups[..1] },
        constants: &[],
    }
    .create(gpu)
}

pub fn encode(encoder: &mut wgpu::CommandEncoder, drawing: &Drawing, depth: &Target) {
    let mut pass = begin(encoder, "depth", None, Some(depth));
    drawing.record(&mut pass, None, |surface| PipelineKey::Depth { cutout: surface == Surface::Cutout });
}
