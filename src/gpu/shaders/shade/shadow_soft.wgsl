// Soft shadow: the share of the sun's disc that is seen past what stands in the way (after Fernando 2005,
// "Percentage-Closer Soft Shadows"). The bounds of the map tell how high anything near can stand and so how far aside
// it may be; a search finds how far away it is; the filter is the disc's image at that distance.

struct Disc {
    // Texels per metre of distance of the disc's radius along the map's axes.
    spread: vec2<f32>,
    // From positions to the bounds' heights, and the scene's top in these.
    lift: f32,
    top: f32,
    // Change of height per texel across the light, and of height per metre towards the sun.
    rise: vec2<f32>,
    climb: f32,
    samples: u32,
    // Two unit vectors each: the directions of a sunflower spiral.
    turns: array<vec4<f32>, 128>,
};

@group(1) @binding(5) var<uniform> disc: Disc;
// Greatest and least height of the points in each block of the map, and in blocks of blocks.
@group(1) @binding(6) var bounds_map: texture_2d<f32>;
@group(1) @binding(18) var coarse_map: texture_2d<f32>;

const BLOCK: f32 = 8.0;
// Of blocks of blocks in the coarse map.
const LEVELS: u32 = 6u;
// Casters nearer than this share of the fade's depth leave all light.
const CONTACT: f32 = 0.5;

fn block(at: vec2<i32>, level: u32, side: i32) -> vec2<f32> {
    let size = side >> level;
    let within = clamp(at, vec2<i32>(0), vec2<i32>(size - 1));
    if level == 0u {
        return textureLoad(bounds_map, within, 0).xy;
    }
    return textureLoad(coarse_map, within + vec2<i32>(side - 2 * size, 0), 0).xy;
}

// Bounds of all within `radius` texels of `center`: 2 × 2 blocks of the size that covers them.
fn height_bounds(center: vec2<f32>, radius: vec2<f32>) -> vec2<f32> {
    let reach = radius + 1.5;
    let side = i32(textureDimensions(bounds_map).x);
    let wanted = max(0.0, ceil(log2(2.0 * max(reach.x, reach.y) / BLOCK)));
    if wanted > f32(LEVELS) || side >> u32(wanted) == 0 {
        return vec2<f32>(disc.top, -1e9);
    }
    let level = u32(wanted);
    let first = vec2<i32>(floor((center - reach) / (BLOCK * exp2(wanted))));
    let a = block(first, level, side);
    let b = block(first + vec2<i32>(1, 0), level, side);
    let c = block(first + vec2<i32>(0, 1), level, side);
    let d = block(first + 1, level, side);
    return vec2<f32>(max(max(a.x, b.x), max(c.x, d.x)), min(min(a.y, b.y), min(c.y, d.y)));
}

// Point k of n in the unit disc.
fn disc_point(k: u32, n: u32) -> vec2<f32> {
    let pair = disc.turns[k / 2u];
    return select(pair.xy, pair.zw, k % 2u == 1u) * sqrt((f32(k) + 0.5) / f32(n));
}

// Sum of the distances of the four texels around `center` that stand in the disc's cone, and their number.
fn blockers(center: vec2<f32>, at: vec3<f32>, slope: vec2<f32>) -> vec2<f32> {
    let first = floor(center - 0.5);
    let aside = first + 0.5 - at.xy;
    let plane = at.z + dot(slope, aside);
    let stored = textureGather(shadow_map, gather_sampler, (first + 1.0) * shadow.texel);
    let expected = vec4<f32>(plane + slope.y, plane + slope.x + slope.y, plane + slope.x, plane);
    let distance = (stored - expected) * shadow.range;
    // Of the texel's nearest part, as a distance at which the cone is as wide.
    let x = max(abs(vec4<f32>(aside.x, aside.x + 1.0, aside.x + 1.0, aside.x)) - 0.5, vec4<f32>(0.0)) / disc.spread.x;
    let y = max(abs(vec4<f32>(aside.y + 1.0, aside.y + 1.0, aside.y, aside.y)) - 0.5, vec4<f32>(0.0)) / disc.spread.y;
    let near = distance * shadow.fade > vec4<f32>(CONTACT * shadow.range);
    let within = distance * distance >= x * x + y * y;
    let found = select(vec4<f32>(0.0), vec4<f32>(1.0), near & within);
    return vec2<f32>(dot(found, distance), dot(found, vec4<f32>(1.0)));
}

fn lit_share(corner: Corner) -> f32 {
    let at = corner.shadow;
    let slope = corner.slope;
    let contact = CONTACT * shadow.range / shadow.fade;
    var reach = (disc.top - corner.height) / disc.climb;
    var bounds = vec2<f32>(0.0);
    for (var round = 0; round < 2; round++) {
        bounds = height_bounds(at.xy, disc.spread * reach);
        reach = min(reach, (bounds.x - corner.height) / disc.climb);
        if reach <= contact {
            return 1.0;
        }
    }
    let radius = disc.spread * reach;
    // How much the receiver's own plane rises within the radius.
    let rise = abs(disc.rise + slope * (shadow.range * disc.climb));
    if bounds.y - corner.height > dot(rise, radius + 1.5) + contact * disc.climb {
        return 0.0;
    }
    if max(radius.x, radius.y) < 0.1 {
        return open_share(at.xy, at, slope);
    }
    var found = vec2<f32>(0.0);
    let looks = min(disc.samples, u32(4.0 + 4.0 * radius.x * radius.y));
    for (var k = 0u; k < looks; k++) {
        found += blockers(at.xy + disc_point(k, looks) * radius, at, slope);
    }
    if found.y < 0.5 {
        return open_share(at.xy, at, slope);
    }
    // Blending between texels is itself as wide as a disc of radius 1/√3.
    let image = disc.spread * (found.x / found.y);
    let width = sqrt(max(image * image - 1.0 / 3.0, vec2<f32>(0.0)));
    if max(width.x, width.y) < 0.1 {
        return open_share(at.xy, at, slope);
    }
    let taps = min(disc.samples, u32(4.0 + 3.0 * width.x * width.y));
    var sum = 0.0;
    for (var k = 0u; k < taps; k++) {
        sum += open_share(at.xy + disc_point(k, taps) * width, at, slope);
    }
    return sum / f32(taps);
}
