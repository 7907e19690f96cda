// Cutout: texels of alpha under one half are holes.

@group(1) @binding(0) var color_texture: texture_2d<f32>;
@group(1) @binding(1) var color_sampler: sampler;

fn is_hole(alpha: f32) -> bool {
    return alpha < 0.5;
}
