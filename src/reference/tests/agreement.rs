//! The reference and the wgpu renderer draw the same town. Without an adapter this says so and passes.

use super::{depth, estimate, numbers, render};
use crate::frame::Pixels;
use crate::gpu::tests::town::{self, demand, nadir, rgb, sun, tilted, view};
use crate::plan::demand::{Output, Projection, Shadows, State};
use crate::reference::Options;

const OUTPUTS: [Output; 3] = [Output::Color, Output::Instance, Output::Depth];

#[test]
fn the_town_is_the_same_town() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(6);
    let slanted = tilted(nadir(0.0, 0.0, 0.8, 160, 120), 30.0);
    let mut parallel = nadir(3.05, -5.13, 0.8, 160, 120);
    parallel.projection = Projection::Orthographic { half_x: 64.0, half_y: 48.0 };
    let cameras = [("slanted", slanted), ("nadir", nadir(0.3, -0.2, 0.74, 160, 120)), ("parallel", parallel)];
    for (name, camera) in cameras {
        for (shadows, elevation) in
            [(Shadows::Off, 50.0), (Shadows::Hard, 50.0), (Shadows::Hard, 12.0), (Shadows::Soft, 35.0)]
        {
            let mut outputs = OUTPUTS.map(|o| demand(&scene, o, State::After)).to_vec();
            outputs[0].look.shadows = shadows;
            let mut demand = view(camera, sun(elevation, 120.0), outputs);
            (demand.quality.supersample, demand.quality.shadow_map) = (4, 4096);
            let drawn = town::render(&mut renderer, &scene, demand.clone());
            let traced = render(&scene, &demand, &Options { side: 3, passes: 2, ..Options::default() });
            let case = format!("{name}, {shadows:?} shadows at {elevation}°");
            if shadows == Shadows::Off {
                compare_labels(&case, &drawn, &traced);
            }
            let errors: Vec<f64> = rgb(&drawn, 0)
                .iter()
                .zip(estimate(&traced).linear.iter().flatten())
                .map(|(&byte, light)| crate::reference::color::linear(f64::from(byte) / 255.0) - light)
                .collect();
            let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
            let bias = errors.iter().sum::<f64>() / errors.len() as f64;
            println!("{case}: rms {rms:.5}, bias {bias:.6}, noise {:.5}", estimate(&traced).mean_standard_error);
            assert!(rms < 0.01 && bias.abs() < 0.001, "{case}: rms {rms}, bias {bias}");
        }
    }
}

fn compare_labels(case: &str, drawn: &crate::frame::Frame, traced: &crate::reference::Rendered) {
    let (Pixels::Id32(ids), Pixels::Float32(metres)) = (&drawn.images[1].pixels, &drawn.images[2].pixels) else {
        panic!("numbers and depth")
    };
    let other = ids.iter().zip(numbers(traced, 1)).filter(|(a, b)| a != b).count();
    let (truth, width) = (depth(traced, 2), drawn.width as usize);
    // Rasterisers round places on the image to 1/256 pixel, which walls seen along their length turn into much depth.
    let steep = |i: usize| {
        let near = [i.wrapping_sub(width), i.wrapping_sub(1), i + 1, i + width];
        let steps = near.iter().filter_map(|&j| Some((truth.get(j)? - truth[i]).abs()));
        steps.filter(|step| step.is_finite()).fold(0.0, f32::max)
    };
    let far = |i: &usize| metres[*i] != truth[*i] && (metres[*i] - truth[*i]).abs() > 0.02 + steep(*i) / 100.0;
    let far = (0..metres.len()).filter(far).count();
    println!("{case}: {other} labels, {far} depths of {} differ", ids.len());
    assert!(other * 1000 <= ids.len() && far * 500 <= ids.len(), "{case}: {other} labels, {far} depths");
}
