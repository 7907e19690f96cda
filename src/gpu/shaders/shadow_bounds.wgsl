// Shadow bounds: greatest and least height of the points in each block of a shadow map; then of blocks of 2, 4, 8 ...
// blocks per side, side by side from the left in one map.

struct Blocks {
    // Height of a point of the map: texel column, texel row, depth (1 nearest to the sun), constant.
    height: vec4<f32>,
};

@group(0) @binding(0) var<uniform> blocks: Blocks;
@group(0) @binding(1) var shadow_map: texture_depth_2d;
@group(0) @binding(2) var finer: texture_2d<f32>;

const BLOCK: i32 = 8;
// Of blocks of blocks.
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
    var bounds = vec2<f32>(NOWHERE, -NOWHERE);
    for (var j = 0; j < BLOCK; j++) {
        for (var i = 0; i < BLOCK; i++) {
            let texel = min(first + vec2<i32>(i, j), size - 1);
            let depth = textureLoad(shadow_map, texel, 0);
            let height = dot(blocks.height, vec4<f32>(vec2<f32>(texel) + 0.5, depth, 1.0));
            let found = select(NOWHERE, height, depth > 0.0);
            bounds = vec2<f32>(max(bounds.x, found), min(bounds.y, found));
        }
    }
    return select(bounds, vec2<f32>(NOWHERE), any(first >= size));
}

@fragment
fn fs_coarse(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let at = vec2<i32>(position.xy);
    let side = i32(textureDimensions(finer).x);
    var level = 1u;
    while level < LEVELS && at.x >= side - (side >> level) {
        level++;
    }
    let count = 1 << level;
    let first = vec2<i32>(at.x - (side - 2 * (side >> level)), at.y) * count;
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
