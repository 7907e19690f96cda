//! Every shader is valid WGSL, whether or not there is an adapter.

use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::gpu::source::shader_source;
use crate::plan::effects::GroundKind;
use crate::plan::pass::{PipelineKey, Surface};
use crate::plan::shading::{Channels, ShadowFilter, Terms};

/// Every combination of terms that can meet.
fn shadings() -> Vec<PipelineKey> {
    let mut keys = Vec::new();
    let flags = [false, true];
    for surface in [Surface::Plain, Surface::Textured, Surface::Cutout] {
        for shadow in [ShadowFilter::Unshadowed, ShadowFilter::Hard, ShadowFilter::Soft] {
            for channels in [Channels::Rgb, Channels::Nir, Channels::Panchromatic, Channels::FalseColor] {
                for ground in [None, Some(GroundKind::Ash), Some(GroundKind::Puddles)] {
                    for bits in 0..16 {
                        let [occluded_sky, haze, cloud_shadow, cloud_cover] =
                            [0, 1, 2, 3].map(|b| flags[bits >> b & 1]);
                        let terms = Terms { shadow, occluded_sky, haze, cloud_shadow, cloud_cover, ground, channels };
                        keys.push(PipelineKey::Shade { surface, terms });
                    }
                }
            }
        }
    }
    keys
}

#[test]
fn every_shader_validates() {
    let others = [
        PipelineKey::ShadowMap { cutout: true },
        PipelineKey::ShadowBounds { first: true },
        PipelineKey::Resolve { supersample: 2, linear: true },
        PipelineKey::Ids { cutout: true },
        PipelineKey::Depth { cutout: true },
    ];
    for key in others.into_iter().chain(shadings()) {
        let source = shader_source(key);
        let module = wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
        let validated = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        validated.unwrap_or_else(|e| panic!("{}: {}", key.name(), e.emit_to_string(&source)));
    }
}
