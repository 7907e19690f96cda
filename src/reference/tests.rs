//! The reference against closed forms, against itself, and against the wgpu renderer.

mod agreement;
mod agreement_effects;
mod coverage;
mod effects;
mod estimates;
mod intersection;
mod shadow;

use super::{Estimate, Options, Rendered, Tracer};
use crate::frame::Pixels;
use crate::plan::demand::ViewDemand;
use crate::scene::Scene;

fn render(scene: &Scene, view: &ViewDemand, options: &Options) -> Rendered {
    let tracer = Tracer::new(scene).expect("the scene is finite");
    tracer.render(view, options).expect("the view is of this scene")
}

fn estimate(rendered: &Rendered) -> &Estimate {
    rendered.estimates[0].as_ref().expect("the first image is in colour")
}

fn depth(rendered: &Rendered, image: usize) -> &[f32] {
    match &rendered.frame.images[image].pixels {
        Pixels::Float32(pixels) => pixels,
        other => panic!("a depth image, not {other:?}"),
    }
}

fn numbers(rendered: &Rendered, image: usize) -> &[u32] {
    match &rendered.frame.images[image].pixels {
        Pixels::Id32(pixels) => pixels,
        other => panic!("an image of numbers, not {other:?}"),
    }
}
