// View: where points land in the panel (a part of the image) that is drawn. Positions are metres from the origin, the point
// where the camera's axis enters the scene.

struct View {
    // Rows of clip_from_origin.
    clip_x: vec4<f32>,
    clip_y: vec4<f32>,
    clip_z: vec4<f32>,
    clip_w: vec4<f32>,
    // Viewing direction; w is 1 for parallel projection.
    forward: vec4<f32>,
    // From the camera to the origin of positions, metres.
    to_origin: vec4<f32>,
    // Half size of the whole image, in samples.
    image_half: vec2<f32>,
    // Centre and half size of the panel from the image's centre, in samples, y up.
    panel_center: vec2<f32>,
    panel_half: vec2<f32>,
    // Least clip w at which a vertex is surely in front of the camera.
    front: f32,
    unused: f32,
};

@group(0) @binding(0) var<storage, read> view: View;

// Clip position in the panel. Positions are first rounded to 1/256 sample in the whole image, which is the grid that
// rasterisers use: the same triangle then covers the same samples whichever part it is drawn in.
fn to_panel(position: vec3<f32>) -> vec4<f32> {
    let p = vec4<f32>(position, 1.0);
    let clip = vec4<f32>(dot(view.clip_x, p), dot(view.clip_y, p), dot(view.clip_z, p), dot(view.clip_w, p));
    if clip.w < view.front {
        let xy = (clip.xy * view.image_half - view.panel_center * clip.w) / view.panel_half;
        return vec4<f32>(xy, clip.zw);
    }
    let sample = round(clip.xy / clip.w * view.image_half * 256.0) / 256.0;
    return vec4<f32>((sample - view.panel_center) / view.panel_half * clip.w, clip.zw);
}
