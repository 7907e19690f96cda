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
};

@group(1) @binding(5) var<storage, read> disc: Disc;
// Greatest and least height of the points in each block of the map, and in blocks of 2, 4, 8 ... blocks per side.
@group(1) @binding(6) var bounds_map: texture_2d<f32>;

const BLOCK: f32 = 8.0;
// Above the blocks themselves.
const LEVELS: f32 = 6.0;
// Casters nearer than this share of the fade's depth leave all light.
const CONTACT: f32 = 0.5;
// Texels: the disc's image is no wider than the blending between texels.
const NARROW: f32 = 0.585;
// Cosine and sine of the golden angle.
const TURN = vec2<f32>(-0.73736888, 0.67549029);

// What every look needs.
struct Look {
    at: vec3<f32>,
    slope: vec2<f32>,
    spread: vec2<f32>,
    // Distance at which casters begin to count, metres.
    contact: f32,
    range: f32,
    fade: f32,
    texel: f32,
};

// Bounds of all within `radius` texels of `center`: 2 × 2 blocks of the size that covers them; `top` and nothing low
// where no size does.
fn height_bounds(center: vec2<f32>, radius: vec2<f32>, top: f32) -> vec2<f32> {
    let reach = radius + 1.5;
    let side = f32(textureDimensions(bounds_map).y);
    let level = max(0.0, ceil(log2(2.0 * max(reach.x, reach.y) / BLOCK)));
    let size = side * exp2(-level);
    if level > LEVELS || size < 2.0 {
        return vec2<f32>(top, -1e9);
    }
    let middle = clamp(floor((center - reach) / (BLOCK * exp2(level))) + 1.0, vec2<f32>(1.0), vec2<f32>(size - 1.0));
    let at = vec2<f32>(middle.x + 2.0 * (side - size), middle.y) / (side * vec2<f32>(2.0, 1.0));
    let high = textureGather(0, bounds_map, gather_sampler, at);
    let low = textureGather(1, bounds_map, gather_sampler, at);
    return vec2<f32>(max(max(high.x, high.y), max(high.z, high.w)), min(min(low.x, low.y), min(low.z, low.w)));
}

// The next direction of a sunflower spiral.
fn turned(direction: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(direction.x * TURN.x - direction.y * TURN.y, direction.x * TURN.y + direction.y * TURN.x);
}

// Sum of the distances of the four texels around `center` that stand in the disc's cone, and their number.
fn blockers(center: vec2<f32>, look: Look) -> vec2<f32> {
    let first = floor(center - 0.5);
    let aside = first + 0.5 - look.at.xy;
    let slope = look.slope;
    let plane = look.at.z + dot(slope, aside);
    let stored = textureGather(shadow_map, gather_sampler, (first + 1.0) * look.texel);
    let expected = vec4<f32>(plane + slope.y, plane + slope.x + slope.y, plane + slope.x, plane);
    let distance = (stored - expected) * look.range;
    // Of the texel's nearest part, as a distance at which the cone is as wide.
    let x = max(abs(vec4<f32>(aside.x, aside.x + 1.0, aside.x + 1.0, aside.x)) - 0.5, vec4<f32>(0.0)) / look.spread.x;
    let y = max(abs(vec4<f32>(aside.y + 1.0, aside.y + 1.0, aside.y, aside.y)) - 0.5, vec4<f32>(0.0)) / look.spread.y;
    let near = distance > vec4<f32>(look.contact);
    let within = distance * distance >= x * x + y * y;
    let found = select(vec4<f32>(0.0), vec4<f32>(1.0), near & within);
    return vec2<f32>(dot(found, distance), dot(found, vec4<f32>(1.0)));
}

// Software adapters run both sides of every branch: the map is read in one place for each purpose, in loops that end.
fn lit_share(corner: Corner) -> f32 {
    let fade = shadow.fade;
    let range = shadow.range;
    let look = Look(corner.shadow, corner.slope, disc.spread, CONTACT * range / fade, range, fade, shadow.texel);
    let climb = disc.climb;
    let top = disc.top;
    let samples = disc.samples;
    let at = look.at;
    // The share where it is known without a filter, -1 where it is not.
    var known = -1.0;
    var reach = (top - corner.height) / climb;
    var bounds = vec2<f32>(top, -1e9);
    for (var round = 0; round < 2; round++) {
        let radius = look.spread * reach;
        if max(radius.x, radius.y) < NARROW {
            break;
        }
        bounds = height_bounds(at.xy, radius, top);
        reach = min(reach, (bounds.x - corner.height) / climb);
        if reach <= look.contact {
            known = 1.0;
            break;
        }
    }
    let radius = look.spread * max(reach, 0.0);
    let wide = known < 0.0 && max(radius.x, radius.y) >= NARROW;
    // How much the receiver's own plane rises within the radius.
    let rise = abs(disc.rise + look.slope * (range * climb));
    if wide && bounds.y - corner.height > dot(rise, radius + 1.5) + look.contact * climb {
        known = 0.0;
    }
    var found = vec2<f32>(0.0);
    let looks = select(0u, min(samples, u32(4.0 + 4.0 * radius.x * radius.y)), wide && known < 0.0);
    var direction = vec2<f32>(1.0, 0.0);
    for (var k = 0u; k < looks; k++) {
        found += blockers(at.xy + direction * (sqrt((f32(k) + 0.5) / f32(looks)) * radius), look);
        direction = turned(direction);
    }
    let image = look.spread * (found.x / max(found.y, 1.0));
    var width = vec2<f32>(0.0);
    var taps = select(1u, 0u, known >= 0.0);
    if max(image.x, image.y) >= NARROW {
        // Blending between texels is itself as wide as a disc of radius 1/√3.
        width = sqrt(max(image * image - 1.0 / 3.0, vec2<f32>(0.0)));
        taps = min(samples, u32(4.0 + 3.0 * width.x * width.y));
    }
    var sum = 0.0;
    direction = vec2<f32>(1.0, 0.0);
    for (var k = 0u; k < taps; k++) {
        let aside = direction * (sqrt((f32(k) + 0.5) / f32(taps)) * width);
        sum += open_share(at.xy + aside, at, look.slope, look.texel, fade);
        direction = turned(direction);
    }
    return select(sum / f32(max(taps, 1u)), known, known >= 0.0);
}
