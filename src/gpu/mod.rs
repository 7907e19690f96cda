//! wgpu renderer.
