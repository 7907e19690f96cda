// Ids: object number + 1 of the nearest surface at pixel centres.

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) id: u32,
    @location(1) uv: vec2<f32>,
};

struct PlainCorner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) id: u32,
};

@vertex
fn vs_ids(@location(0) position: vec3<f32>, @location(3) object: u32) -> PlainCorner {
    return PlainCorner(to_panel(position), object + 1u);
}

@fragment
fn fs_ids(corner: PlainCorner) -> @location(0) u32 {
    return corner.id;
}

@vertex
fn vs_ids_cutout(
    @location(0) position: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) object: u32,
) -> Corner {
    return Corner(to_panel(position), object + 1u, uv);
}

@fragment
fn fs_ids_cutout(corner: Corner) -> @location(0) u32 {
    if is_hole(textureSample(color_texture, color_sampler, corner.uv).a) {
        discard;
    }
    return corner.id;
}
