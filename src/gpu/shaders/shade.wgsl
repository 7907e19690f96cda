// Shade: linear radiance of diffuse surfaces under the sun and an ambient sky.
//
// Light is computed per vertex (normals are constant over faces, smooth over terrain); a fragment only weighs it with
// the texture and with the share of the sun that the shadow map leaves.

// Width of the shadow filter in texels is 2 GATHERS - 1.
override GATHERS: u32 = 1u;

struct Light {
    // Rows of the map from metres about the origin: texel column, texel row, depth (1 nearest to the sun).
    texel_u: vec4<f32>,
    texel_v: vec4<f32>,
    depth: vec4<f32>,
    // Axes of the light frame; w of u, v: change of depth per texel for a slope of 1.
    u: vec4<f32>,
    v: vec4<f32>,
    // Towards the sun; w: 1 / depth over which light fades in, so that rounding flips no sample.
    sun: vec4<f32>,
    // Irradiance of a surface facing the sun; w: 1 / texels per side.
    irradiance: vec4<f32>,
    zenith: vec4<f32>,
    ground: vec4<f32>,
};

@group(1) @binding(0) var<uniform> light: Light;
// Linear colour of each material.
@group(1) @binding(1) var<storage, read> materials: array<vec4<f32>>;
@group(1) @binding(2) var shadow_map: texture_depth_2d;
@group(1) @binding(3) var gather_sampler: sampler;
@group(2) @binding(0) var color_texture: texture_2d<f32>;
@group(2) @binding(1) var color_sampler: sampler;

struct Vertex {
    @location(0) position: vec3<f32>,
    // w is 1 where both sides of the surface may be seen.
    @location(1) normal: vec4<f32>,
    @location(2) uv: vec2<f32>,
    @location(4) material: u32,
};

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Radiance reflected from the sky and from the unshadowed sun.
    @location(0) sky: vec3<f32>,
    @location(1) sun: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Texel and depth in the shadow map; change of depth per texel along the surface.
    @location(3) shadow: vec3<f32>,
    @location(4) slope: vec2<f32>,
};

// Steepest slope of a receiver against the light that is followed; beyond it the cosine dims the sun to 0.5 %.
const LEAST_COSINE: f32 = 0.005;

@vertex
fn vs_shade(vertex: Vertex) -> Corner {
    let eye = select(vertex.position + view.to_origin.xyz, view.forward.xyz, view.forward.w > 0.5);
    let away = vertex.normal.w > 0.5 && dot(vertex.normal.xyz, eye) > 0.0;
    let normal = normalize(select(vertex.normal.xyz, -vertex.normal.xyz, away));
    let albedo = materials[vertex.material].rgb;
    let p = vec4<f32>(vertex.position, 1.0);
    let cosine = dot(normal, light.sun.xyz);

    var corner: Corner;
    corner.position = to_panel(vertex.position);
    corner.sky = albedo * mix(light.ground.rgb, light.zenith.rgb, 0.5 + 0.5 * normal.y);
    corner.sun = albedo * light.irradiance.rgb * max(cosine, 0.0);
    corner.uv = vertex.uv;
    corner.shadow = vec3<f32>(dot(light.texel_u, p), dot(light.texel_v, p), dot(light.depth, p));
    let run = vec2<f32>(dot(normal, light.u.xyz) * light.u.w, dot(normal, light.v.xyz) * light.v.w);
    corner.slope = -run / max(cosine, LEAST_COSINE);
    return corner;
}

// Share of the sun's light that arrives: a box filter over texels, each compared with the depth that the receiver's
// plane has at the centre of that texel (Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques"), so that
// slopes need no bias that would detach shadows.
fn lit_share(at: vec3<f32>, slope: vec2<f32>) -> f32 {
    let width = f32(2u * GATHERS - 1u);
    let start = at.xy - 0.5 * width;
    let first = floor(start);
    let part = start - first;
    let plane = at.z + dot(slope, first + 0.5 - at.xy);
    var sum = 0.0;
    for (var j = 0u; j < GATHERS; j++) {
        for (var i = 0u; i < GATHERS; i++) {
            let texel = vec2<f32>(f32(2u * i), f32(2u * j));
            let stored = textureGather(shadow_map, gather_sampler, (first + texel + 1.0) * light.irradiance.w);
            // Gather order: (0, 1), (1, 1), (1, 0), (0, 0).
            let corner = plane + dot(slope, texel);
            let expected = vec4<f32>(corner + slope.y, corner + slope.x + slope.y, corner + slope.x, corner);
            let open = saturate((expected - stored) * light.sun.w + 1.0);
            let low = select(vec2<f32>(1.0), 1.0 - part, vec2<bool>(i == 0u, j == 0u));
            let high = select(vec2<f32>(1.0), part, vec2<bool>(i + 1u == GATHERS, j + 1u == GATHERS));
            sum += high.y * (low.x * open.x + high.x * open.y) + low.y * (low.x * open.w + high.x * open.z);
        }
    }
    return sum / (width * width);
}

@fragment
fn fs_plain(corner: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(corner.sky + corner.sun, 1.0);
}

@fragment
fn fs_plain_shadow(corner: Corner) -> @location(0) vec4<f32> {
    return vec4<f32>(corner.sky + corner.sun * lit_share(corner.shadow, corner.slope), 1.0);
}

@fragment
fn fs_textured(corner: Corner) -> @location(0) vec4<f32> {
    let texel = textureSample(color_texture, color_sampler, corner.uv);
    return vec4<f32>(texel.rgb * (corner.sky + corner.sun), 1.0);
}

@fragment
fn fs_textured_shadow(corner: Corner) -> @location(0) vec4<f32> {
    let texel = textureSample(color_texture, color_sampler, corner.uv);
    return vec4<f32>(texel.rgb * (corner.sky + corner.sun * lit_share(corner.shadow, corner.slope)), 1.0);
}

@fragment
fn fs_cutout(corner: Corner) -> @location(0) vec4<f32> {
    let texel = textureSample(color_texture, color_sampler, corner.uv);
    if texel.a < 0.5 {
        discard;
    }
    return vec4<f32>(texel.rgb * (corner.sky + corner.sun), 1.0);
}

@fragment
fn fs_cutout_shadow(corner: Corner) -> @location(0) vec4<f32> {
    let texel = textureSample(color_texture, color_sampler, corner.uv);
    if texel.a < 0.5 {
        discard;
    }
    return vec4<f32>(texel.rgb * (corner.sky + corner.sun * lit_share(corner.shadow, corner.slope)), 1.0);
}
