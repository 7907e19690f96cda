// Shadow bounds: greatest and least height of the points in each block of a shadow map; then of 2 × 2 blocks.

struct Blocks {
    // Height of a point of the map: texel column, texel row, depth (1 nearest to the sun), constant.
    height: vec4<f32>,
};

@group(0) @binding(0) var<uniform> blocks: Blocks;
@group(0) @binding(1) var shadow_map: texture_depth_2d;
@group(0) @binding(2) var finer: texture_2d<f32>;

const BLOCK: i32 = 8;
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
fn fs_halve(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let first = vec2<i32>(position.xy) * 2;
    let a = textureLoad(finer, first, 0).xy;
    let b = textureLoad(finer, first + vec2<i32>(1, 0), 0).xy;
    let c = textureLoad(finer, first + vec2<i32>(0, 1), 0).xy;
    let d = textureLoad(finer, first + vec2<i32>(1, 1), 0).xy;
    return vec2<f32>(max(max(a.x, b.x), max(c.x, d.x)), min(min(a.y, b.y), min(c.y, d.y)));
}
