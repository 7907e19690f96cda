//! Ids: the number of the nearest object at each pixel's centre, and its depth.

use super::Drawing;
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::timing::Recorder;
use crate::plan::pass::{PipelineKey, Surface};
use crate::plan::resource::Format;

pub fn pipeline(gpu: &Gpu, layouts: &Layouts, module: &wgpu::ShaderModule, cutout: bool) -> wgpu::RenderPipeline {
    let groups = [&layouts.view, &layouts.texture];
    GeometryPipeline {
        label: PipelineKey::Ids { cutout }.name(),
        module,
        vertex: if cutout { "vs_ids_cutout" } else { "vs_ids" },
        fragment: Some((if cutout { "fs_ids_cutout" } else { "fs_ids" }, Some(Format::Id32))),
        attributes: true,
        groups: if cutout { &groups } else { &groups[..1] },
    }
    .create(gpu)
}

pub fn encode(recorder: &mut Recorder, drawing: &Drawing, ids: &Target, depth: &Target) {
    let mut pass = recorder.begin("ids", Some((&ids.view, wgpu::Color::TRANSPARENT)), Some(&depth.view));
    drawing.record(&mut pass, None, |surface| PipelineKey::Ids { cutout: surface == Surface::Cutout });
}
