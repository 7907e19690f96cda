//! Shadow map: depth from the sun, 1 nearest.

use super::Drawing;
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::timing::Recorder;
use crate::plan::pass::{PipelineKey, Surface};

pub fn pipeline(gpu: &Gpu, layouts: &Layouts, module: &wgpu::ShaderModule, cutout: bool) -> wgpu::RenderPipeline {
    let groups = [&layouts.view, &layouts.texture];
    GeometryPipeline {
        label: PipelineKey::ShadowMap { cutout }.name(),
        module,
        vertex: if cutout { "vs_shadow_map_cutout" } else { "vs_shadow_map" },
        fragment: cutout.then_some(("fs_shadow_map_cutout", None)),
        attributes: cutout,
        groups: if cutout { &groups } else { &groups[..1] },
    }
    .create(gpu)
}

pub fn encode(recorder: &mut Recorder, drawing: &Drawing, depth: &Target) {
    let mut pass = recorder.begin("shadow_map", None, Some(&depth.view));
    drawing.record(&mut pass, None, |surface| PipelineKey::ShadowMap { cutout: surface == Surface::Cutout });
}
