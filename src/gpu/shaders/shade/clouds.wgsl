// Clouds: one layer without thickness, between the ground and the sun, and between the ground and the camera.

struct Clouds {
    // From metres about the origin (x, z) to the maps: xy scale, zw offset.
    shadow: vec4<f32>,
    cover: vec4<f32>,
    color: vec4<f32>,
    // Height of the layer above the origin, metres.
    height: f32,
    unused0: f32,
    unused1: f32,
    unused2: f32,
};

@group(1) @binding(11) var<storage, read> clouds: Clouds;
@group(1) @binding(12) var field_sampler: sampler;
#if cloud_shadow
@group(1) @binding(13) var cloud_shadow_map: texture_2d<f32>;

fn sun_through_clouds(place: vec3<f32>) -> f32 {
    let rise = clouds.height - place.y;
    if rise <= 0.0 {
        return 1.0;
    }
    let at = place.xz + light.sun.xz * (rise / light.sun.y);
    let depth = textureSampleLevel(cloud_shadow_map, field_sampler, at * clouds.shadow.xy + clouds.shadow.zw, 0.0).r;
    return exp(-depth / light.sun.y);
}
#endif
#if cloud_cover
@group(1) @binding(14) var cloud_cover_map: texture_2d<f32>;

fn under_clouds(radiance: Light, place: vec3<f32>) -> Light {
    let path = path_to(place);
    let share = (clouds.height - place.y) / -path.y;
    if share <= 0.0 || share >= 1.0 {
        return radiance;
    }
    let at = place.xz - path.xz * share;
    let depth = textureSampleLevel(cloud_cover_map, field_sampler, at * clouds.cover.xy + clouds.cover.zw, 0.0).r;
    let kept = exp(-depth * length(path) / abs(path.y));
    return radiance * kept + to_light(clouds.color) * (1.0 - kept);
}
#endif
