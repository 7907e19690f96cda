//! How fast the reference renderer is. In: the town of examples/riverside. Out: a table of times and of rays per second,
//! by kind of light.
//!
//! `cargo bench --bench reference`. Rays are counted as asked for: one per sample, and one more to the sun or the sky
//! where it is looked for (faces that turn away from it ask for none).

use std::path::Path;
use std::sync::{Arc, LazyLock};

use divan::Bencher;
use divan::counter::ItemsCount;
use glam::DVec3;
use mansard::pipeline::{Checks, RecipeOptions, Silent, build_scene, load_recipe};
use mansard::plan::demand::{
    Ambient, Camera, Look, Output, OutputDemand, Projection, Quality, Selection, Shadows, State, Sun, ViewDemand,
};
use mansard::reference::{Options, Tracer};
use mansard::scene::Scene;
use mansard::source::SourceMap;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    println!("{} triangles", TOWN.1.triangles());
    divan::main();
}

static TOWN: LazyLock<(Scene, Tracer)> = LazyLock::new(|| {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/riverside/riverside.render");
    let recipe =
        load_recipe(&path, &RecipeOptions::default(), &mut SourceMap::default()).expect("the example is sound");
    let scene = build_scene(&recipe, 0, Checks::Off, &Silent).expect("the example is sound").scene;
    let tracer = Tracer::new(&scene).expect("the example is finite");
    (scene, tracer)
});

/// Pixels per side.
const SIDE: u32 = 256;

/// All objects from the scene's middle above, 15° off nadir, 0.6 m per pixel.
fn view(shadows: Shadows, ambient: Ambient) -> ViewDemand {
    let scene = &TOWN.0;
    let (sin, cos) = libm::sincos(15f64.to_radians());
    let forward = DVec3::new(0.0, -cos, -sin);
    let middle = (scene.bounds.0 + scene.bounds.1) / 2.0;
    let tan = 0.3 * f64::from(SIDE) / 1200.0;
    let camera = Camera {
        position: middle - forward * 1200.0,
        right: DVec3::X,
        up: DVec3::new(0.0, sin, -cos),
        forward,
        projection: Projection::Perspective { tan_x: tan, tan_y: tan },
        width: SIDE,
        height: SIDE,
        near: 1.0,
    };
    let objects: Arc<[bool]> = scene.objects.iter().map(|_| true).collect();
    let output = OutputDemand {
        pass: "bench".into(),
        output: Output::Color,
        selection: Selection { state: State::After, objects },
        marked: None,
        look: Look::plain(shadows, ambient),
    };
    let direction = DVec3::new(0.5, 0.64, 0.58).normalize();
    ViewDemand {
        name: "bench".into(),
        camera,
        sun: Some(Sun { direction, disc_deg: 0.53, irradiance: [1.0; 3] }),
        quality: Quality { supersample: 1, shadow_map: 1, shadow_samples: 1, sky_samples: 1, field_map: 1 },
        outputs: vec![output],
    }
}

const SKY: Ambient = Ambient::Sky { zenith: [0.3; 3], ground: [0.1; 3], occluded: true };

#[divan::bench(args = ["camera", "camera and sun", "camera and sky"], sample_count = 5, sample_size = 1)]
fn rays(bencher: Bencher, light: &str) {
    let (shadows, ambient, per_sample) = match light {
        "camera" => (Shadows::Off, Ambient::Off, 1),
        "camera and sun" => (Shadows::Soft, Ambient::Off, 2),
        _ => (Shadows::Off, SKY, 2),
    };
    let demand = view(shadows, ambient);
    let options = Options { side: 2, passes: 2, ..Options::default() };
    let rays = u64::from(SIDE * SIDE * options.samples()) * per_sample;
    bencher.counter(ItemsCount::new(rays)).bench(|| TOWN.1.render(&demand, &options).expect("the view is sound"));
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn building_the_tree(bencher: Bencher) {
    let triangles = TOWN.1.triangles();
    bencher.counter(ItemsCount::new(triangles)).bench(|| Tracer::new(&TOWN.0).expect("finite").triangles());
}
