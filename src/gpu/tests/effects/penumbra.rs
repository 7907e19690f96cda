//! Penumbras: the width of a soft shadow's edge on level ground from the sun's disc and the height of what throws it.

use glam::DVec3;

use super::{above, look};
use crate::gpu::Renderer;
use crate::gpu::tests::town::{self, sun};
use crate::plan::demand::{Camera, Shadows};
use crate::scene::Presence;

/// Share of a disc on one side of a line at `t` radii from its centre.
fn part_of_disc(t: f64) -> f64 {
    let t = t.clamp(-1.0, 1.0);
    0.5 + (t * (1.0 - t * t).sqrt() + libm::asin(t)) / std::f64::consts::PI
}

/// Lit shares along the middle row of an image across the shadow's end of a wall, the metres between them, and the
/// width of the penumbra.
fn edge(renderer: &mut Renderer, height: f64, elevation: f64, samples: u32) -> (Vec<f64>, f64, f64) {
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (448.0, 64.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-8.0, 0.0, -50.0), DVec3::new(0.0, height, 50.0));
    let sun = sun(elevation, 270.0);
    let end = |offset: f64| height / libm::tan((elevation + offset).to_radians());
    let width = end(-sun.disc_deg / 2.0) - end(sun.disc_deg / 2.0);
    let gsd = width / 40.0;
    let camera: Camera = above((end(0.0), 0.0), gsd, (80, 4));
    let mut view = look(&scene, camera, Some(sun));
    view.outputs[0].look.shadows = Shadows::Soft;
    view.quality.shadow_samples = samples;
    let frame = town::render(renderer, &scene, view);
    let lit = super::albedo()[1] * sun.irradiance[1] * sun.direction.y;
    let row = super::linear(&frame, 0)[80..160].iter().map(|pixel| pixel[1] / lit).collect();
    (row, gsd, width)
}

#[test]
fn penumbras_are_as_wide_as_the_disc_and_the_wall_make_them() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for (height, elevation) in
        [(4.0, 60.0), (12.0, 70.0), (12.0, 45.0), (40.0, 45.0), (12.0, 20.0), (40.0, 20.0), (12.0, 8.0)]
    {
        for samples in [4, 8] {
            let (row, gsd, width) = edge(&mut renderer, height, elevation, samples);
            let expected: Vec<f64> = (0..80).map(|i| part_of_disc((f64::from(i) - 39.5) / 20.0)).collect();
            // Both are as wide as the integral of share × (1 - share) says, in the same unit.
            let spread = |row: &[f64]| row.iter().map(|s| s * (1.0 - s)).sum::<f64>();
            let ratio = spread(&row) / spread(&expected);
            let squares = row.iter().zip(&expected).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            let rms = (squares / row.len() as f64).sqrt();
            println!(
                "{height} m under {elevation}°, {samples}² samples: {:.3} m for {width:.3} m, rms {rms:.4}",
                ratio * width
            );
            assert!((ratio - 1.0).abs() < 0.12, "{ratio} of the width; {row:.2?}");
            assert!(rms < 0.05, "{rms} ({} m a pixel): {row:.2?}", gsd);
        }
    }
}

#[test]
fn shadows_are_sharp_where_the_wall_stands_and_soft_at_its_top() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-64.0, -64.0), (128.0, 64.0), town::GROUND);
    // Thin: of a thick one the map knows only the side towards the sun.
    town::block(&mut scene, Presence::Both, DVec3::new(-0.1, 0.0, 0.0), DVec3::new(0.0, 40.0, 50.0));
    let sun = sun(45.0, 270.0);
    // The northern edge of the shadow runs east along z = 0.
    let blurred = |x: f64, renderer: &mut Renderer| {
        let mut view = look(&scene, above((x, 0.0), 0.02, (16, 80)), Some(sun));
        view.outputs[0].look.shadows = Shadows::Soft;
        (view.quality.shadow_map, view.quality.shadow_samples) = (2048, 8);
        let lit = super::albedo()[1] * sun.irradiance[1] * sun.direction.y;
        let frame = town::render(renderer, &scene, view);
        let column = super::linear(&frame, 0).iter().skip(8).step_by(16).map(|p| p[1] / lit).collect::<Vec<_>>();
        column.iter().map(|s| s * (1.0 - s)).sum::<f64>() * 0.02
    };
    let [near, middle, far] = [2.0, 15.0, 30.0].map(|x| blurred(x, &mut renderer));
    println!("{near} {middle} {far}");
    assert!(near < 0.15 * far && (middle / far - 0.5).abs() < 0.05, "{near} {middle} {far}");
}
