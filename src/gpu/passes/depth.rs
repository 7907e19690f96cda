//! Depth: reverse depth at pixel centres, without object numbers.

use super::Drawing;
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::timing::Recorder;
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
    }
    .create(gpu)
}

pub fn encode(recorder: &mut Recorder, drawing: &Drawing, depth: &Target) {
    let mut pass = recorder.begin("depth", None, Some(&depth.view));
    drawing.record(&mut pass, None, |surface| PipelineKey::Depth { cutout: surface == Surface::Cutout });
}
