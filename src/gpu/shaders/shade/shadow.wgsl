// Shadow: which share of the sun's light the shadow map leaves.

struct Shadow {
    // Rows of the map from metres about the origin: texel column, texel row, depth (1 nearest to the sun).
    texel_u: vec4<f32>,
    texel_v: vec4<f32>,
    depth: vec4<f32>,
    // Axes of the light frame; w of u, v: change of depth per texel for a slope of 1.
    u: vec4<f32>,
    v: vec4<f32>,
    // 1 / depth over which light fades in, so that rounding flips no sample.
    fade: f32,
    // 1 / texels per side.
    texel: f32,
    // Metres of the whole depth.
    range: f32,
    unused: f32,
};

@group(1) @binding(2) var<storage, read> shadow: Shadow;
@group(1) @binding(3) var shadow_map: texture_depth_2d;
@group(1) @binding(4) var gather_sampler: sampler;

// Share of the four texels around `center` (texels) that leave the light, blended between their centres, each
// compared with the depth that the receiver's plane has there (Isidoro 2006, "Shadow Mapping: GPU-based Tips and
// Techniques"), so that slopes need no bias that would detach shadows. `at` is the receiver.
fn open_share(center: vec2<f32>, at: vec3<f32>, slope: vec2<f32>, texel: f32, fade: f32) -> f32 {
    let start = center - 0.5;
    let first = floor(start);
    let part = start - first;
    let plane = at.z + dot(slope, first + 0.5 - at.xy);
    let stored = textureGather(shadow_map, gather_sampler, (first + 1.0) * texel);
    // Gather order: (0, 1), (1, 1), (1, 0), (0, 0).
    let expected = vec4<f32>(plane + slope.y, plane + slope.x + slope.y, plane + slope.x, plane);
    let open = saturate((expected - stored) * fade + 1.0);
    let low = 1.0 - part;
    return part.y * (low.x * open.x + part.x * open.y) + low.y * (low.x * open.w + part.x * open.z);
}
