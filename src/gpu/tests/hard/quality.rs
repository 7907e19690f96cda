//! Quality: a higher setting is never worse than a lower one by more than the noise of the measure.

use super::{sunlit, trace};
use crate::gpu::Renderer;
use crate::gpu::mipmaps::linear_from_srgb;
use crate::gpu::tests::town::{self, nadir, rgb, sun, tilted};
use crate::plan::demand::{Quality, Shadows, ViewDemand};
use crate::reference::{Options, Tracer};
use crate::scene::Scene;

fn picture(scene: &Scene, shadows: Shadows) -> ViewDemand {
    let mut view = sunlit(scene, tilted(nadir(0.0, 0.0, 0.5, 128, 120), 20.0), sun(40.0, 120.0), shadows);
    view.quality = Quality { supersample: 4, shadow_map: 4096, ..view.quality };
    view
}

/// Linear RMS error of one picture against the rays' light.
fn error(renderer: &mut Renderer, scene: &Scene, view: ViewDemand, truth: &[[f64; 3]]) -> f64 {
    let frame = town::render(renderer, scene, view);
    let square = |(byte, light): (&u8, &f64)| (linear_from_srgb(f64::from(*byte) / 255.0) - light.min(1.0)).powi(2);
    let light = truth.iter().flatten();
    (rgb(&frame, 0).iter().zip(light).map(square).sum::<f64>() / rgb(&frame, 0).len() as f64).sqrt()
}

/// Errors must not rise from one setting to the next by more than twice the noise.
#[track_caller]
fn falls(axis: &str, errors: &[f64], noise: f64) {
    println!("{axis}: {errors:.5?}, noise {noise:.6}");
    for pair in errors.windows(2) {
        assert!(pair[1] <= pair[0] + 2.0 * noise, "{axis}: {errors:?}, noise {noise}");
    }
    assert!(errors[errors.len() - 1] < errors[0], "{axis}: {errors:?}");
}

/// What the axes of the geometry do is in `dem_bowl`; curves have no setting of their own yet.
#[test]
fn monotone_quality() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(4);
    let truth = |shadows| {
        let estimate = trace(&scene, &picture(&scene, shadows), 8).estimates.swap_remove(0).expect("colour");
        (estimate.linear, estimate.mean_standard_error)
    };
    let with = |shadows, change: &dyn Fn(&mut Quality)| {
        let mut view = picture(&scene, shadows);
        change(&mut view.quality);
        view
    };

    let (light, noise) = truth(Shadows::Off);
    let samples = [1, 2, 4, 8].map(|k| with(Shadows::Off, &|q| q.supersample = k));
    falls("samples per pixel", &samples.map(|view| error(&mut renderer, &scene, view, &light)), noise);

    let (light, noise) = truth(Shadows::Hard);
    let maps = [256, 512, 1024, 2048, 4096].map(|size| with(Shadows::Hard, &|q| q.shadow_map = size));
    falls("shadow map", &maps.map(|view| error(&mut renderer, &scene, view, &light)), noise);

    let (light, noise) = truth(Shadows::Soft);
    let taps = [3, 7, 15].map(|taps| with(Shadows::Soft, &|q| q.shadow_samples = taps));
    let errors = taps.map(|view| error(&mut renderer, &scene, view, &light));
    println!("shadow samples: {errors:.5?}, noise {noise:.6}");
    assert!(errors.windows(2).all(|pair| pair[1] <= pair[0] + 2.0 * noise), "{errors:?}");

    // Samples of the sun's disc, by the reference against itself.
    let tracer = Tracer::new(&scene).expect("finite");
    let of = |side: u32| {
        let options = Options { seed: 99, side, passes: 2, ..Options::default() };
        let rendered = tracer.render(&picture(&scene, Shadows::Soft), &options).expect("it renders");
        let own = rendered.estimates.into_iter().next().flatten().expect("colour").linear;
        let squares = own.iter().flatten().zip(light.iter().flatten()).map(|(a, b)| (a - b).powi(2));
        (squares.sum::<f64>() / (3.0 * own.len() as f64)).sqrt()
    };
    falls("sun samples", &[1, 2, 4].map(of), noise);
}
