//! Reference: view demand + scene → frame and its error, by rays in f64 on the CPU. It shares no shading and no
//! shadows with `gpu`: agreement of the two is evidence.
//!
//! Colour is the mean over the pixel's area and the sun's disc, by stratified samples in independent passes, from whose
//! spread the standard error comes. Labels and depth are those of one ray through the pixel's centre. Every sample is
//! keyed by view, pixel, pass and number: threads change no byte, and images of one view share their noise.

mod air;
mod camera;
mod color;
mod hierarchy;
mod light;
mod ray;
mod render;
mod sampling;
mod surface;
mod tracer;

pub use render::Rendered;
pub use tracer::Tracer;

/// What the reference renderer refuses.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    #[error("object {object} (instance {instance}): the {what} of vertex {vertex} is not a finite number")]
    NotFinite { object: usize, instance: u32, what: &'static str, vertex: usize },
    #[error("view {view}: a number of {what} is not finite")]
    NotFiniteView { view: String, what: &'static str },
    #[error("view {0} was planned for another scene")]
    WrongScene(String),
    #[error("{passes} passes of {side} × {side} samples: at least 2 passes of 1 × 1 to 256 × 256 are needed")]
    BadSampling { passes: u32, side: u32 },
}

/// How far a picture has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// Name of the recipe's pass.
    pub image: &'a str,
    pub passes: u32,
    pub of: u32,
    /// Mean over pixels and channels, after the second pass.
    pub standard_error: Option<f64>,
}

/// How finely colour is sampled.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    pub seed: u64,
    /// Each pass takes `side × side` stratified samples per pixel.
    pub side: u32,
    /// Independent passes, at least 2.
    pub passes: u32,
    /// Stops as soon as the mean standard error is not above this, linear light.
    pub enough: Option<f64>,
    /// Hears of every pass, on the calling thread.
    pub told: &'a dyn Fn(Progress),
    /// Hears of every row of every pass, on any thread.
    pub row: &'a (dyn Fn() + Sync),
}

impl Default for Options<'_> {
    fn default() -> Self {
        Options { seed: 0, side: 3, passes: 4, enough: None, told: &|_| {}, row: &|| {} }
    }
}

impl Options<'_> {
    /// At least `samples` per pixel, in passes of at most 8 × 8.
    pub fn of_samples(samples: u32) -> Self {
        let side = (samples / 2).isqrt().clamp(1, 8);
        Options { side, passes: samples.div_ceil(side * side).max(2), ..Options::default() }
    }

    /// Per pixel, if it does not stop earlier.
    pub fn samples(&self) -> u32 {
        self.side * self.side * self.passes
    }
}

/// How sure a colour image is.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Samples per pixel.
    pub samples: u32,
    /// Linear light of the image's channels per pixel, spread by the sensor's optics, before its exposure.
    pub linear: Vec<[f64; 3]>,
    /// Of `linear`, per pixel.
    pub standard_error: Vec<[f64; 3]>,
    /// Over all pixels and channels; 0 for an image without pixels.
    pub mean_standard_error: f64,
}

#[cfg(test)]
mod tests;
