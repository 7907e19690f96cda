// Shadow bounds: greatest and least height of the points in each block of a shadow map; then of blocks of 1, 2, 4,
// 8 ... blocks per side, side by side from the left in one map twice as wide.

struct Blocks {
    // Height of a point of the map: texel column, texel row, depth (1 nearest to the sun), constant.
    height: vec4<f32>,
};

@group(0) @binding(0) var<storage, read> blocks: Blocks;
@group(0) @binding(1) var shadow_map: texture_depth_2d;
@group(0) @binding(2) var gather_sampler: sampler;
@group(0) @binding(3) var finer: texture_2d<f32>;

const BLOCK: i32 = 8;
// Above the blocks themselves.
const LEVELS: u32 = 6u;
// Of what is not there.
const NOWHERE: f32 = -1e9;

@vertex
fn vs_bounds(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    return vec4<f32>(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fs_first(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let first = vec2<i32>(position.xy) * BLOCK;
    let size = vec2<i32>(textureDimensions(shadow_map));
    let row = blocks.height;
    var bounds = vec2<f32>(NOWHERE, -NOWHERE);
    for (var j = 0; j < BLOCK; j += 2) {
        for (var i = 0; i < BLOCK; i += 2) {
            // Beyond the last texel it is met again, at a place that is not its own: a wider bound.
            let middle = vec2<f32>(first + vec2<i32>(i, j) + 1);
            let depth = textureGather(shadow_map, gather_sampler, middle / vec2<f32>(size));
            // Gather order: (0, 1), (1, 1), (1, 0), (0, 0).
            let corner = dot(row, vec4<f32>(middle - 0.5, 0.0, 1.0));
            let height = corner + vec4<f32>(row.y, row.x + row.y, row.x, 0.0) + row.z * depth;
            let found = select(vec4<f32>(NOWHERE), height, depth > vec4<f32>(0.0));
            bounds.x = max(bounds.x, max(max(found.x, found.y), max(found.z, found.w)));
            bounds.y = min(bounds.y, min(min(found.x, found.y), min(found.z, found.w)));
        }
    }
    return select(bounds, vec2<f32>(NOWHERE), any(first >= size));
}

@fragment
fn fs_coarse(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let at = vec2<i32>(position.xy);
    let side = i32(textureDimensions(finer).x);
    var level = 0u;
    while level < LEVELS && at.x >= 2 * side - (side >> level) {
        level++;
    }
    let count = 1 << level;
    let first = vec2<i32>(at.x - 2 * (side - (side >> level)), at.y) * count;
    var bounds = vec2<f32>(NOWHERE, -NOWHERE);
    if first.x >= side || first.y >= side {
        return bounds;
    }
    for (var j = 0; j < count; j++) {
        for (var i = 0; i < count; i++) {
            let found = textureLoad(finer, first + vec2<i32>(i, j), 0).xy;
            bounds = vec2<f32>(max(bounds.x, found.x), min(bounds.y, found.y));
        }
    }
    return bounds;
}
