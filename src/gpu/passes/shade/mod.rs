//! Shade: linear radiance of what a tile shows, under the light that the plan names.

mod bindings;
mod uniforms;

use super::Drawing;
use crate::gpu::device::Gpu;
use crate::gpu::pipelines::{GeometryPipeline, Layouts};
use crate::gpu::pools::Target;
use crate::gpu::timing::Recorder;
use crate::plan::demand::BACKGROUND;
use crate::plan::effects::{Bands, with_red_as_infrared};
use crate::plan::pass::{PipelineKey, Surface};
use crate::plan::resource::Format;
use crate::plan::shading::Terms;

pub use bindings::{Lit, group, layout};

pub fn pipeline(
    gpu: &Gpu,
    layouts: &Layouts,
    light: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    (surface, terms): (Surface, Terms),
) -> wgpu::RenderPipeline {
    let groups = [&layouts.view, light, &layouts.texture];
    GeometryPipeline {
        label: PipelineKey::Shade { surface, terms }.name(),
        module,
        vertex: "vs_shade",
        fragment: Some(("fs_shade", Some(Format::Radiance16))),
        attributes: true,
        groups: if surface == Surface::Plain { &groups[..2] } else { &groups },
    }
    .create(gpu)
}

pub fn encode(
    recorder: &mut Recorder,
    drawing: &Drawing,
    light: &wgpu::BindGroup,
    (terms, bands): (Terms, Bands),
    (radiance, depth): (&Target, &Target),
) {
    let [r, g, b] = bands.of(with_red_as_infrared(BACKGROUND));
    let clear = wgpu::Color { r, g, b, a: 1.0 };
    let mut pass = recorder.begin("shade", Some((&radiance.view, clear)), Some(&depth.view));
    drawing.record(&mut pass, Some(light), |surface| PipelineKey::Shade { surface, terms });
}
