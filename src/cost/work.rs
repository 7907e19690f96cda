//! Work: a view and its quality → what drawing it costs, counted. Choices go by it, never by the clock, so that a recipe
//! gets the same settings on every machine.

use crate::plan::demand::{Ambient, Look, Output, Quality, Shadows, ViewDemand};
use crate::plan::sky;

/// Weights in units of one shaded sample without shadows, from times on a software adapter (two cores, llvmpipe).
const TEXEL: f64 = 0.1;
const TAP: f64 = 0.12;
const SKY_TAP: f64 = 0.12;
const FIELD_TEXEL: f64 = 4.0;
const TRIANGLE: f64 = 10.0;

/// What the images of a view take with this quality, if its scene has so many triangles.
pub fn work(view: &ViewDemand, quality: &Quality, triangles: u64) -> f64 {
    let colors = view.outputs.iter().filter(|output| output.output == Output::Color);
    let mut looks: Vec<&Look> = Vec::new();
    for output in colors {
        if !looks.contains(&&output.look) {
            looks.push(&output.look);
        }
    }
    looks.into_iter().map(|look| one_look(view, look, quality, triangles as f64)).sum()
}

fn one_look(view: &ViewDemand, look: &Look, quality: &Quality, triangles: f64) -> f64 {
    let square = |side: u32| f64::from(side) * f64::from(side);
    let samples = f64::from(view.camera.width) * f64::from(view.camera.height) * square(quality.supersample);
    let (mut sample, mut maps) = (1.0, 0.0);
    if look.shadows != Shadows::Off {
        sample += TAP * if look.shadows == Shadows::Soft { square(quality.shadow_samples) } else { 1.0 };
        maps += TEXEL * square(quality.shadow_map) + TRIANGLE * triangles;
    }
    if matches!(look.ambient, Ambient::Sky { occluded: true, .. }) {
        let count = quality.sky_samples;
        sample += SKY_TAP * f64::from(count / sky::subsets(count, quality.supersample));
        maps += f64::from(count) * (TEXEL * square(sky::map_size(quality.shadow_map, count)) + TRIANGLE * triangles);
    }
    if look.clouds.is_some() || look.ground.is_some() {
        maps += FIELD_TEXEL * square(quality.field_map);
    }
    samples * sample + maps + TRIANGLE * triangles
}
