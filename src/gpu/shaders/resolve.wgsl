// Resolve: mean of the SAMPLES × SAMPLES linear radiances of a pixel; the target encodes to sRGB.

override SAMPLES: u32 = 1u;

@group(0) @binding(0) var radiance: texture_2d<f32>;
@group(0) @binding(1) var linear_sampler: sampler;

@vertex
fn vs_resolve(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

// Odd numbers of samples: one load each.
@fragment
fn fs_resolve_odd(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = vec2<u32>(position.xy) * SAMPLES;
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < SAMPLES; j++) {
        for (var i = 0u; i < SAMPLES; i++) {
            sum += textureLoad(radiance, first + vec2<u32>(i, j), 0).rgb;
        }
    }
    return vec4<f32>(sum / f32(SAMPLES * SAMPLES), 1.0);
}

// Even numbers: a bilinear look-up where four samples meet is their mean.
@fragment
fn fs_resolve_even(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let first = floor(position.xy) * f32(SAMPLES) + 1.0;
    let scale = 1.0 / vec2<f32>(textureDimensions(radiance));
    var sum = vec3<f32>(0.0);
    for (var j = 0u; j < SAMPLES; j += 2u) {
        for (var i = 0u; i < SAMPLES; i += 2u) {
            let meeting = first + vec2<f32>(f32(i), f32(j));
            sum += textureSampleLevel(radiance, linear_sampler, meeting * scale, 0.0).rgb;
        }
    }
    return vec4<f32>(sum * (4.0 / f32(SAMPLES * SAMPLES)), 1.0);
}
