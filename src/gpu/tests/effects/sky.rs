//! Occluded sky: nothing is lost in the open; a wall takes what its form factor says.

use glam::DVec3;

use super::{above, difference, linear, look};
use crate::gpu::Renderer;
use crate::gpu::tests::town::{self, demand, nadir, tilted, view};
use crate::plan::demand::{Ambient, Camera, Output, State, ViewDemand};
use crate::reference::{Options, Tracer};
use crate::scene::{Presence, Scene, SceneClass};

const ZENITH: [f64; 3] = [0.5, 0.6, 0.7];
const GROUND: [f64; 3] = [0.2, 0.15, 0.1];

fn under_sky(scene: &Scene, camera: Camera, occluded: bool, samples: u32) -> ViewDemand {
    let mut view = look(scene, camera, None);
    view.outputs[0].look.ambient = Ambient::Sky { zenith: ZENITH, ground: GROUND, occluded };
    view.quality.sky_samples = samples;
    view
}

fn render(renderer: &mut Renderer, scene: &Scene, view: ViewDemand) -> Vec<[f64; 3]> {
    linear(&town::render(renderer, scene, view), 0)
}

#[test]
fn an_open_surface_of_any_slope_has_the_whole_sky() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    for slope in [0.0, 0.4, 1.0, 3.0] {
        let mut scene = town::empty();
        let p = |x: f64, z: f64| DVec3::new(x, 120.0 + x * slope, z);
        let face = vec![p(-32.0, -33.0), p(-32.0, 34.0), p(31.0, 34.0), p(31.0, -33.0)];
        town::add(&mut scene, SceneClass::Building, Presence::Both, &[(face, town::GROUND)]);
        for samples in [4, 8, 24] {
            let camera = above((0.0, 0.0), 1.0, (40, 32));
            let [open, occluded] = [false, true]
                .map(|occluded| render(&mut renderer, &scene, under_sky(&scene, camera, occluded, samples)));
            let (worst, _) = difference(&open, &occluded);
            assert!(worst < 4e-4, "slope {slope}, {samples} directions: {worst}");
        }
    }
}

#[test]
fn a_long_wall_hides_its_form_factor_of_the_sky() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let mut scene = town::empty();
    town::plane(&mut scene, (-40.0, -900.0), (60.0, 900.0), town::GROUND);
    town::block(&mut scene, Presence::Both, DVec3::new(-8.0, 0.0, -800.0), DVec3::new(0.0, 10.0, 800.0));
    for (samples, bound) in [(24, 0.05), (64, 0.025), (256, 0.012)] {
        let camera = above((20.0, 0.0), 0.5, (72, 4));
        let mut view = under_sky(&scene, camera, true, samples);
        view.quality.shadow_map = 4096;
        let row = render(&mut renderer, &scene, view);
        let errors = (0..72).map(|i| {
            let distance = 2.0 + (i as f64 + 0.5) * 0.5;
            // Of the sky over level ground a wall of infinite length hides (1 - cos γ) / 2, γ the height of its top.
            let share = (1.0 + distance / (distance * distance + 100.0).sqrt()) / 2.0;
            row[72 + i][1] / (super::albedo()[1] * ZENITH[1]) - share
        });
        let errors: Vec<f64> = errors.collect();
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        println!("{samples} directions: rms {rms:.4} of the sky");
        assert!(rms < bound, "{samples} directions: {rms}; {errors:.3?}");
    }
}

#[test]
fn a_town_has_the_sky_that_rays_find() {
    let Some(mut renderer) = crate::gpu::tests::renderer() else { return };
    let scene = town::town(4);
    let mut output = demand(&scene, Output::Color, State::Before);
    output.look.ambient = Ambient::Sky { zenith: ZENITH, ground: GROUND, occluded: true };
    output.look.shadows = crate::plan::demand::Shadows::Off;
    let mut view = view(tilted(nadir(0.0, 0.0, 0.5, 128, 120), 20.0), town::sun(40.0, 120.0), vec![output]);
    view.sun = None;
    let tracer = Tracer::new(&scene).expect("finite");
    let options = Options { side: 6, passes: 3, ..Options::default() };
    let traced = tracer.render(&view, &options).expect("it renders").estimates.swap_remove(0).expect("colour");
    view.outputs[0].look.sensor = Some(super::ideal(crate::plan::effects::Bands::Rgb));
    (view.quality.supersample, view.quality.shadow_map) = (4, 4096);
    let mut last = f64::INFINITY;
    // Textures, edges and the rays' noise alone are 0.009 off.
    for (samples, bound) in [(8, 0.02), (24, 0.012), (96, 0.0105)] {
        view.quality.sky_samples = samples;
        let drawn = render(&mut renderer, &scene, view.clone());
        let squares = drawn.iter().flatten().zip(traced.linear.iter().flatten()).map(|(a, b)| (a - b).powi(2));
        let rms = (squares.sum::<f64>() / (3 * drawn.len()) as f64).sqrt();
        println!("{samples} directions: rms {rms:.5}, noise {:.5}", traced.mean_standard_error);
        assert!(rms < bound && rms < last + 0.001, "{samples} directions: {rms}");
        last = rms;
    }
}
