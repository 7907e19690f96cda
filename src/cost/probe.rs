//! Probe: what a view asks for → what is drawn besides to measure errors in it, and what both renderers make of that.
//!
//! Beside the view's first colour image (in linear light, before any sensor) that is: the scene without shadows, in
//! which edges are measured; the sun's light with and without shadows, whose ratio is the mask of shadow; and numbers of
//! objects at pixel centres.

use super::metrics::{Rgb, luminance, shadow};
use super::window::{camera_of, crop};
use crate::frame::{Frame, Pixels};
use crate::gpu::Tile;
use crate::plan::demand::{Ambient, Look, Output, OutputDemand, Shadows, ViewDemand};
use crate::plan::effects::{Bands, BitDepth, Sensor};
use crate::reference::{Options, ReferenceError, Rendered, Tracer};

/// A view with the images that errors are measured in.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    pub demand: ViewDemand,
    /// Whether there are images of the sun's light.
    pub shadows: bool,
}

/// Takes light as it is, in steps of 1/65,535 of white.
const PLAIN_SENSOR: Sensor = Sensor {
    key: 0,
    psf: 0.0,
    exposure: 1.0,
    read_noise: 0.0,
    full_well: 0.0,
    depth: BitDepth::Sixteen,
    bands: Bands::Rgb,
};

const IMAGE: &str = "cost image";
const PLAIN: &str = "cost without shadows";
const SUN: &str = "cost sun";
const ALL_SUN: &str = "cost sun without shadows";
const LABELS: &str = "cost labels";

impl Probe {
    /// `None` for a view without a colour image: its labels are decisions at pixel centres, which no knob changes.
    pub fn new(view: &ViewDemand) -> Option<Probe> {
        let image = view.outputs.iter().find(|output| output.output == Output::Color)?;
        let look = &image.look;
        let shadows = look.shadows != Shadows::Off && view.sun.is_some_and(|sun| sun.direction.y > 0.0);
        let open_sky = match look.ambient {
            Ambient::Sky { zenith, ground, .. } => Ambient::Sky { zenith, ground, occluded: false },
            other => other,
        };
        let output = |pass: &str, output: Output, look: Look| OutputDemand {
            pass: pass.to_owned(),
            output,
            selection: image.selection.clone(),
            marked: None,
            look,
        };
        let color = |pass: &str, look: Look| output(pass, Output::Color, Look { sensor: Some(PLAIN_SENSOR), ..look });
        let mut outputs = vec![
            color(IMAGE, look.clone()),
            color(PLAIN, Look::plain(Shadows::Off, open_sky)),
            output(LABELS, Output::Instance, Look::none()),
        ];
        if shadows {
            outputs.push(color(SUN, Look::plain(look.shadows, Ambient::Off)));
            outputs.push(color(ALL_SUN, Look::plain(Shadows::Off, Ambient::Off)));
        }
        Some(Probe { demand: ViewDemand { outputs, ..view.clone() }, shadows })
    }
}

/// The images of a probe in one window.
#[derive(Clone, Debug, PartialEq)]
pub struct Images {
    pub window: Tile,
    pub light: Vec<Rgb>,
    /// Luminance without shadows.
    pub plain: Vec<f32>,
    pub labels: Vec<u32>,
    /// Mask of shadow, where the view has shadows.
    pub shadow: Option<Vec<Option<bool>>>,
}

/// The true images of a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    pub images: Images,
    /// Of `images.light`.
    pub standard_error: Vec<Rgb>,
    /// Samples per pixel that were taken.
    pub samples: u32,
}

/// Traces a window until the mean standard error is not above `enough`, or 16 passes of 4 × 4 samples are done.
pub fn trace(tracer: &Tracer, probe: &Probe, window: Tile, enough: f64) -> Result<Truth, ReferenceError> {
    let demand = ViewDemand { camera: camera_of(&probe.demand.camera, window), ..probe.demand.clone() };
    let options = Options { side: 4, passes: 16, enough: Some(enough), ..Options::default() };
    let rendered = tracer.render(&demand, &options)?;
    let first = rendered.estimates[0].as_ref().expect("the first image is colour");
    let single = |light: &[[f64; 3]]| light.iter().map(|c| c.map(|v| v as f32)).collect::<Vec<Rgb>>();
    let (standard_error, samples) = (single(&first.standard_error), first.samples);
    let light = |name: &str| {
        let image = rendered.frame.images.iter().position(|image| image.pass == name);
        single(&rendered.estimates[image.expect("the probe asked for it")].as_ref().expect("it is colour").linear)
    };
    let images = images(probe, window, &light, labels(&rendered));
    Ok(Truth { images, standard_error, samples })
}

fn labels(rendered: &Rendered) -> Vec<u32> {
    numbers(&rendered.frame).clone()
}

fn numbers(frame: &Frame) -> &Vec<u32> {
    match &frame.images.iter().find(|image| image.pass == LABELS).expect("the probe asked for labels").pixels {
        Pixels::Id32(numbers) => numbers,
        _ => unreachable!("instances are numbers"),
    }
}

fn images(probe: &Probe, window: Tile, light: &dyn Fn(&str) -> Vec<Rgb>, labels: Vec<u32>) -> Images {
    Images {
        window,
        light: light(IMAGE),
        plain: light(PLAIN).into_iter().map(luminance).collect(),
        labels,
        shadow: probe.shadows.then(|| shadow::mask(&light(SUN), &light(ALL_SUN))),
    }
}

/// What the wgpu renderer made of a probe, in one window.
pub fn drawn(probe: &Probe, frame: &Frame, window: Tile) -> Images {
    let light = |name: &str| {
        let image = frame.images.iter().find(|image| image.pass == name).expect("the probe asked for it");
        linear(&image.pixels, frame.width, window)
    };
    images(probe, window, &light, crop(numbers(frame), frame.width, window))
}

/// The light of the pixels of a window.
fn linear(pixels: &Pixels, width: u32, window: Tile) -> Vec<Rgb> {
    match pixels {
        Pixels::Rgb16(words) => {
            let pixels: Vec<[u16; 3]> = words.as_chunks().0.to_vec();
            let light = |word: u16| f32::from(word) / f32::from(u16::MAX);
            crop(&pixels, width, window).into_iter().map(|p| p.map(light)).collect()
        }
        _ => unreachable!("the probe's sensor has 16 bits"),
    }
}
