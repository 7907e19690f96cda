//! Times of whole frames, pass by pass: `cargo test --release --lib frame_times -- --ignored --nocapture`.

use super::look;
use crate::gpu::tests::town::{self, nadir, sun};
use crate::plan::demand::{Ambient, Look, Quality, Shadows};
use crate::plan::effects::Haze;

/// A change of a look.
type Change = fn(&mut Look);

#[test]
#[ignore = "prints times; a minute on two cores"]
fn frame_times() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(70);
    renderer.set_timed(true);
    let looks: [(&str, Change); 5] = [
        ("unshadowed", |_| {}),
        ("hard", |look| look.shadows = Shadows::Hard),
        ("soft", |look| look.shadows = Shadows::Soft),
        ("occluded sky", |look| {
            look.ambient = Ambient::Sky { zenith: [0.3; 3], ground: [0.1; 3], occluded: true };
        }),
        ("haze", |look| {
            look.haze = Some(Haze { extinction: [1e-4; 3], scale_height: 900.0, base: 0.0, airlight: [0.3; 3] });
        }),
    ];
    for (name, change) in looks {
        let mut view = look(&scene, nadir(0.0, 0.0, 0.35, 3072, 3072), Some(sun(40.0, 130.0)));
        view.outputs[0].look.sensor = None;
        view.quality =
            Quality { supersample: 2, shadow_map: 4096, shadow_samples: 4, sky_samples: 24, field_map: 1024 };
        change(&mut view.outputs[0].look);
        for _ in 0..2 {
            let start = std::time::Instant::now();
            town::render(&mut renderer, &scene, view.clone());
            println!("{name}: {:.2} s; {:.3?}", start.elapsed().as_secs_f64(), renderer.timings());
        }
    }
}
