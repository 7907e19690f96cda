//! Sky maps: depth from one side of the sky after the other, each a layer.

use super::Drawing;
use crate::gpu::timing::Recorder;
use crate::plan::pass::{PipelineKey, Surface};

pub fn encode(recorder: &mut Recorder, drawing: &Drawing, layer: &wgpu::TextureView) {
    let mut pass = recorder.begin("sky_maps", None, Some(layer));
    drawing.record(&mut pass, None, |surface| PipelineKey::ShadowMap { cutout: surface == Surface::Cutout });
}
