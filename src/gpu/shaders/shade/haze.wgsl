// Haze: what a path through an exponential atmosphere takes away and adds (Koschmieder 1924), in closed form.

struct Haze {
    // Per metre at the base.
    extinction: vec4<f32>,
    airlight: vec4<f32>,
    // Height of the origin above the base, metres.
    base: f32,
    // 1 / metres over which haze falls to 1/e.
    thinning: f32,
    unused: vec2<f32>,
};

@group(1) @binding(10) var<storage, read> haze: Haze;

fn through_haze(radiance: Light, place: vec3<f32>) -> Light {
    let path = path_to(place);
    let density = exp(-(haze.base + place.y) * haze.thinning);
    // Mean density along the path over that at the point; x is the path's rise in scale heights.
    let x = -path.y * haze.thinning;
    let near = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
    let mean = select((1.0 - exp(-x)) / x, near, abs(x) < 0.02);
    let kept = exp(-to_light(haze.extinction) * (length(path) * density * mean));
    return radiance * kept + to_light(haze.airlight) * (1.0 - kept);
}
