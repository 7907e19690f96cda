//! Every shader is valid WGSL, whether or not there is an adapter.

use wgpu::naga::front::wgsl;
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::gpu::pipelines::shader_source;

#[test]
fn every_shader_validates() {
    for stem in ["shadow_map", "shade", "resolve", "ids", "depth"] {
        let source = shader_source(stem);
        let module = wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
        let validated = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        validated.unwrap_or_else(|e| panic!("{stem}: {}", e.emit_to_string(source)));
    }
}
