// Occluded sky: the share of the sky above a surface that nothing hides, from maps of depth from many directions. The
// weights are normalised, so that an open surface of any slope sees all of it.

struct SkyView {
    // Rows of the map from metres about the origin: texel column, texel row, depth (1 nearest to the sky).
    texel_u: vec4<f32>,
    texel_v: vec4<f32>,
    depth: vec4<f32>,
    // Unit vector; w: the solid angle it stands for, relative to the zenith's.
    towards: vec4<f32>,
    // Depth per texel for a slope of 1, over the row's length; z: 1 / depth over which light fades in.
    scale: vec4<f32>,
};

struct Sky {
    // Samples per pixel side; into how many sets the views are dealt.
    side: u32,
    subsets: u32,
    // 1 / texels per side.
    texel: f32,
    count: u32,
    views: array<SkyView>,
};

@group(1) @binding(7) var<storage, read> sky: Sky;
@group(1) @binding(8) var sky_maps: texture_depth_2d_array;
@group(1) @binding(9) var sky_sampler: sampler;

fn sky_open(at: vec3<f32>, slope: vec2<f32>, layer: u32, fade: f32) -> f32 {
    let start = at.xy - 0.5;
    let first = floor(start);
    let part = start - first;
    let plane = at.z + dot(slope, first + 0.5 - at.xy);
    let stored = textureGather(sky_maps, sky_sampler, (first + 1.0) * sky.texel, layer);
    let expected = vec4<f32>(plane + slope.y, plane + slope.x + slope.y, plane + slope.x, plane);
    let open = saturate((expected - stored) * fade + 1.0);
    let low = 1.0 - part;
    return part.y * (low.x * open.x + part.x * open.y) + low.y * (low.x * open.w + part.x * open.z);
}

fn sky_share(place: vec3<f32>, normal: vec3<f32>, pixel: vec2<f32>) -> f32 {
    let p = vec4<f32>(place, 1.0);
    let sample = vec2<u32>(pixel) % vec2<u32>(sky.side);
    var open = 0.0;
    var all = 0.0;
    // No more rounds where the driver reads zeros, as llvmpipe does beside the triangle.
    for (var k = (sample.y * sky.side + sample.x) % sky.subsets; k < sky.count; k += sky.subsets) {
        let one = sky.views[k];
        let cosine = dot(normal, one.towards.xyz);
        if cosine > LEAST_COSINE {
            let at = vec3<f32>(dot(one.texel_u, p), dot(one.texel_v, p), dot(one.depth, p));
            let run = vec2<f32>(dot(normal, one.texel_u.xyz), dot(normal, one.texel_v.xyz)) * one.scale.xy;
            let weight = cosine * one.towards.w;
            open += weight * sky_open(at, -run / cosine, k, one.scale.z);
            all += weight;
        }
    }
    // A surface that looks down sees no sky.
    return open / max(all, 1e-6);
}
