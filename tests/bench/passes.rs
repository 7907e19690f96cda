//! How long the passes of one frame take. In: a recipe. Out: per kind of pass the milliseconds of the fastest and of the
//! median of nine runs, for object numbers alone and for a colour frame with soft shadows and an ambient sky.
//!
//! `cargo bench --bench passes -- [RECIPE [NAME=VALUE ...]] [--side PIXELS]`: the recipe's first scene (the town of
//! examples/riverside otherwise), 3072 pixels and 0.6 m a pixel, 15° off nadir. Times are the device's where it has a clock.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use mansard::gpu::Renderer;
use mansard::pipeline::{Checks, RecipeOptions, Silent, build_scene, load_recipe};
use mansard::plan::demand::{
    Ambient, Camera, Look, Output, OutputDemand, Projection, Quality, Selection, Shadows, State, Sun, ViewDemand,
};
use mansard::plan::{schedule, summarize};
use mansard::scene::Scene;
use mansard::source::SourceMap;
use mansard::spec::PRESETS;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const RUNS: usize = 9;

fn main() {
    let (path, options, side) = arguments();
    let recipe = load_recipe(&path, &options, &mut SourceMap::default()).expect("the recipe is sound");
    let scene = build_scene(&recipe, 0, Checks::Off, &Silent).expect("the scene can be built").scene;
    let mut renderer = Renderer::new().expect("there is an adapter");
    println!("{} triangles, {side} x {side} pixels, {}", triangles(&scene), renderer.adapter().name);
    renderer.upload(&scene).expect("the scene is finite");
    renderer.set_timed(true);
    let sky = Ambient::Sky { zenith: [0.3; 3], ground: [0.1; 3], occluded: false };
    measure(&mut renderer, &scene, &view(&scene, side, Output::Instance, Look::none()));
    for (preset, spec) in &PRESETS {
        let mut demand = view(&scene, side, Output::Color, Look::plain(Shadows::Soft, sky));
        (demand.quality, demand.name) = (Quality::from(spec), format!("frame, {preset}"));
        measure(&mut renderer, &scene, &demand);
    }
}

fn arguments() -> (PathBuf, RecipeOptions, u32) {
    let (mut words, mut side, mut options) = (Vec::new(), 3072, RecipeOptions::default());
    let mut given = std::env::args().skip(1).filter(|word| word != "--bench");
    while let Some(word) = given.next() {
        match word.split_once('=') {
            _ if word == "--side" => side = given.next().and_then(|n| n.parse().ok()).expect("--side takes a number"),
            Some((name, value)) => options.arguments.push((name.to_owned(), value.to_owned())),
            None => words.push(PathBuf::from(word)),
        }
    }
    let riverside = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("examples/riverside/riverside.render");
    (words.pop().unwrap_or(riverside), options, side)
}

fn triangles(scene: &Scene) -> usize {
    scene.objects.iter().map(|o| o.mesh.triangles.len()).sum()
}

/// The scene's middle from 15° off nadir, 1,800 m away.
fn view(scene: &Scene, side: u32, output: Output, look: Look) -> ViewDemand {
    let (sin, cos) = libm::sincos(15f64.to_radians());
    let forward = DVec3::new(0.0, -cos, -sin);
    let middle = (scene.bounds.0 + scene.bounds.1) / 2.0;
    let tan = 0.3 * f64::from(side) / 1800.0;
    let objects: Arc<[bool]> = scene.objects.iter().map(|_| true).collect();
    let selection = Selection { state: State::After, objects };
    ViewDemand {
        name: "object numbers".into(),
        camera: Camera {
            position: middle - forward * 1800.0,
            right: DVec3::X,
            up: DVec3::new(0.0, sin, -cos),
            forward,
            projection: Projection::Perspective { tan_x: tan, tan_y: tan },
            width: side,
            height: side,
            near: 1.0,
        },
        sun: Some(Sun { direction: DVec3::new(0.5, 0.64, 0.58).normalize(), disc_deg: 0.53, irradiance: [1.0; 3] }),
        quality: Quality::from(&PRESETS[1].1),
        outputs: vec![OutputDemand { pass: "bench".into(), output, selection, marked: None, look }],
    }
}

/// Prints the time of every kind of pass, and of all by the wall with the image read back.
fn measure(renderer: &mut Renderer, scene: &Scene, demand: &ViewDemand) {
    let plan = schedule(std::slice::from_ref(demand), &summarize(scene));
    let (mut passes, mut walls): (BTreeMap<String, Vec<f64>>, Vec<f64>) = Default::default();
    for run in 0..=RUNS {
        let start = Instant::now();
        renderer.render(&plan.views[0]).expect("the view can be drawn");
        if run == 0 {
            continue; // It compiles.
        }
        walls.push(start.elapsed().as_secs_f64());
        for (pass, seconds) in renderer.timings() {
            passes.entry(pass.clone()).or_default().push(*seconds);
        }
    }
    println!("\n{}", demand.name);
    passes.into_iter().for_each(|(pass, times)| print(&pass, times));
    print("all, by the wall, with the image read back", walls);
}

fn print(what: &str, mut seconds: Vec<f64>) {
    seconds.sort_by(f64::total_cmp);
    println!("{:>10.1} ms  {:>10.1} ms  {what}", 1e3 * seconds[0], 1e3 * seconds[seconds.len() / 2]);
}
