// Shade: linear radiance of diffuse surfaces under the sun and an ambient sky.
//
// Light is computed per vertex (normals are constant over faces, smooth over terrain); a fragment only weighs it with
// the texture and with what the terms of the image ask for.

#if infrared
// Red, green, blue, near infrared.
alias Light = vec4<f32>;
#else
alias Light = vec3<f32>;
#endif

struct Lamp {
    // Towards the sun.
    sun: vec4<f32>,
    // Irradiance of a surface facing the sun, and radiance of the ambient light from above and below.
    irradiance: vec4<f32>,
    zenith: vec4<f32>,
    ground: vec4<f32>,
};

@group(1) @binding(0) var<storage, read> light: Lamp;
// Linear colour of each material; the fourth number is near-infrared albedo over luminance.
@group(1) @binding(1) var<storage, read> materials: array<vec4<f32>>;
#if texture
@group(2) @binding(0) var color_texture: texture_2d<f32>;
@group(2) @binding(1) var color_sampler: sampler;
#endif

struct Vertex {
    @location(0) position: vec3<f32>,
    // w is 1 where both sides of the surface may be seen.
    @location(1) normal: vec4<f32>,
#if texture
    @location(2) uv: vec2<f32>,
#endif
    @location(4) material: u32,
};

struct Corner {
    @builtin(position) position: vec4<f32>,
    // Light of the sky and of the unshadowed sun; times the material's albedo unless `albedo` is apart.
    @location(0) sky: Light,
    @location(1) sun: Light,
#if texture
    @location(2) uv: vec2<f32>,
#endif
#if shadow
    // Texel and depth in the shadow map; change of depth per texel along the surface.
    @location(3) shadow: vec3<f32>,
    @location(4) slope: vec2<f32>,
#endif
#if soft
    // Height as in the map's bounds.
    @location(5) height: f32,
#endif
#if place
    // Metres about the origin.
    @location(6) place: vec3<f32>,
#endif
#if normal
    @location(7) normal: vec3<f32>,
#endif
#if occluded_sky
    // Light of the ground, which nothing hides.
    @location(8) below: Light,
#endif
#if albedo
    // Of the material, with its fourth number.
    @location(9) albedo: vec4<f32>,
#endif
};

// Steepest slope of a receiver against the light that is followed; beyond it the cosine dims the sun to 0.5 %.
const LEAST_COSINE: f32 = 0.005;

fn to_light(value: vec4<f32>) -> Light {
#if infrared
    return value;
#else
    return value.rgb;
#endif
}

@vertex
fn vs_shade(vertex: Vertex) -> Corner {
    let eye = select(vertex.position + view.to_origin.xyz, view.forward.xyz, view.forward.w > 0.5);
    let away = vertex.normal.w > 0.5 && dot(vertex.normal.xyz, eye) > 0.0;
    let normal = normalize(select(vertex.normal.xyz, -vertex.normal.xyz, away));
    let material = materials[vertex.material];
#if albedo
    let albedo = Light(1.0);
#else
    let albedo = material.rgb;
#endif
    let cosine = dot(normal, light.sun.xyz);

    var corner: Corner;
    corner.position = to_panel(vertex.position);
#if occluded_sky
    let up = 0.5 + 0.5 * normal.y;
    corner.sky = albedo * to_light(light.zenith) * up;
    corner.below = albedo * to_light(light.ground) * (1.0 - up);
#else
    corner.sky = albedo * mix(to_light(light.ground), to_light(light.zenith), 0.5 + 0.5 * normal.y);
#endif
    corner.sun = albedo * to_light(light.irradiance) * max(cosine, 0.0);
#if texture
    corner.uv = vertex.uv;
#endif
#if shadow
    let p = vec4<f32>(vertex.position, 1.0);
    corner.shadow = vec3<f32>(dot(shadow.texel_u, p), dot(shadow.texel_v, p), dot(shadow.depth, p));
    let run = vec2<f32>(dot(normal, shadow.u.xyz) * shadow.u.w, dot(normal, shadow.v.xyz) * shadow.v.w);
    corner.slope = -run / max(cosine, LEAST_COSINE);
#endif
#if soft
    corner.height = vertex.position.y + disc.lift;
#endif
#if place
    corner.place = vertex.position;
#endif
#if normal
    corner.normal = normal;
#endif
#if albedo
    corner.albedo = material;
#endif
    return corner;
}

@fragment
fn fs_shade(corner: Corner) -> @location(0) vec4<f32> {
#if texture
    let texel = textureSample(color_texture, color_sampler, corner.uv);
#endif
#if cutout
    if texel.a < 0.5 {
        discard;
    }
#endif
#if occluded_sky
    let normal = normalize(corner.normal);
    let sky = corner.sky * sky_share(corner.place, normal, corner.position.xy) + corner.below;
#else
    let sky = corner.sky;
#endif
#if shadow
    var sun = corner.sun * lit_share(corner);
#else
    var sun = corner.sun;
#endif
#if cloud_shadow
    sun *= sun_through_clouds(corner.place);
#endif
    var radiance = sky + sun;
#if albedo
    var material = corner.albedo;
#if texture
    material = vec4<f32>(material.rgb * texel.rgb, material.a);
#endif
    var albedo = to_light(material);
#if infrared
    albedo.a = min(MOST_INFRARED, material.a * dot(material.rgb, LUMINANCE));
#endif
#if ground
    let share = ground_share(corner.place, corner.normal);
    albedo = mix(albedo, ground_albedo(albedo), share);
#endif
    radiance *= albedo;
#if puddles
    radiance += to_light(light.zenith) * (share * mirrored(corner.place, corner.normal));
#endif
#else
#if texture
    radiance *= texel.rgb;
#endif
#endif
#if haze
    radiance = through_haze(radiance, corner.place);
#endif
#if cloud_cover
    radiance = under_clouds(radiance, corner.place);
#endif
#if nir
    return vec4<f32>(radiance.aaa, 1.0);
#endif
#if panchromatic
    return vec4<f32>(vec3<f32>(dot(radiance, vec4<f32>(0.25))), 1.0);
#endif
#if false_color
    return vec4<f32>(radiance.arg, 1.0);
#endif
#if rgb
    return vec4<f32>(radiance, 1.0);
#endif
}
