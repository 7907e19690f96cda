// Depth: reverse depth at pixel centres.

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
};

@vertex
fn vs_depth(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return to_panel(position);
}

@vertex
fn vs_depth_cutout(@location(0) position: vec3<f32>, @location(2) uv: vec2<f32>) -> Corner {
    return Corner(to_panel(position), uv);
}

@fragment
fn fs_depth_cutout(corner: Corner) {
    if is_hole(textureSample(color_texture, color_sampler, corner.uv).a) {
        discard;
    }
}
