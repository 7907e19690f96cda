// Ground: ash or puddles on what looks up.

struct Ground {
    // From metres about the origin (x, z) to the map: xy scale, zw offset.
    frame: vec4<f32>,
};

@group(1) @binding(15) var<storage, read> ground: Ground;
@group(1) @binding(16) var ground_sampler: sampler;
@group(1) @binding(17) var ground_map: texture_2d<f32>;

fn ground_share(place: vec3<f32>, normal: vec3<f32>) -> f32 {
    let at = place.xz * ground.frame.xy + ground.frame.zw;
    let share = textureSampleLevel(ground_map, ground_sampler, at, 0.0).r;
    return select(0.0, share, normalize(normal).y > 0.5);
}

fn ground_albedo(bare: Light) -> Light {
#if ash
    return Light(ASH_ALBEDO);
#else
    return bare * WET_ALBEDO;
#endif
}
#if puddles

// Schlick 1994.
fn mirrored(place: vec3<f32>, normal: vec3<f32>) -> f32 {
    let cosine = saturate(-dot(normalize(path_to(place)), normalize(normal)));
    return WATER_MIRRORS + (1.0 - WATER_MIRRORS) * pow(1.0 - cosine, 5.0);
}
#endif
