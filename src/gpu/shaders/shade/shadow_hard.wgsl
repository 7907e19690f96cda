// Hard shadow: of the middle of the sun's disc.

fn lit_share(corner: Corner) -> f32 {
    return open_share(corner.shadow.xy, corner.shadow, corner.slope, shadow.texel, shadow.fade);
}
