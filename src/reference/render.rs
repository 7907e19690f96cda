//! Render: the demanded images of a view, colour pass by pass, labels by pixel centres.

use rayon::prelude::*;

use super::camera;
use super::color::Rgb;
use super::light::Lighting;
use super::sampling::{self, Dimension, Strata};
use super::tracer::{Hit, Tracer};
use super::{Estimate, Options, Progress, ReferenceError};
use crate::frame::{Frame, Image, Pixels};
use crate::interpreter::seed::Seed;
use crate::plan::demand::{Output, OutputDemand, ViewDemand};
use crate::plan::effects::Sensor;
use crate::plan::finite::not_finite;
use crate::sensor;

/// The images of a view and, for each colour image, how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    pub frame: Frame,
    /// One per image; `None` for labels and depth, which are decisions.
    pub estimates: Vec<Option<Estimate>>,
}

impl Tracer {
    /// Renders what the view demands, on the threads of the current rayon pool. The demand's quality does not matter
    /// here.
    pub fn render(&self, view: &ViewDemand, options: &Options) -> Result<Rendered, ReferenceError> {
        check(self, view, options)?;
        let (mut images, mut estimates) = (Vec::new(), Vec::new());
        for output in &view.outputs {
            let (pixels, estimate) = match output.output {
                Output::Color => {
                    let estimate = self.color(view, output, options);
                    // The samples were spread already.
                    let sensor = Sensor { psf: 0.0, ..output.look.sensor.unwrap_or(sensor::PLAIN) };
                    let linear: Vec<[f32; 3]> = estimate.linear.iter().map(|light| light.map(|c| c as f32)).collect();
                    let size = (view.camera.width, view.camera.height);
                    (sensor::develop(&linear, size, &sensor), Some(estimate))
                }
                _ => (self.labels(view, output), None),
            };
            images.push(Image { pass: output.pass.clone(), pixels });
            estimates.push(estimate);
        }
        let frame = Frame { view: view.name.clone(), width: view.camera.width, height: view.camera.height, images };
        Ok(Rendered { frame, estimates })
    }

    fn color(&self, view: &ViewDemand, output: &OutputDemand, options: &Options) -> Estimate {
        let lighting = Lighting::new(view, output);
        let spread = output.look.sensor.map_or(0.0, |sensor| sensor.psf);
        let [sun, sky] = lighting.needs();
        let used = [true, sun, sky, spread > 0.0];
        let seed = Seed::root(options.seed).named(&view.name);
        let (width, height) = (view.camera.width as usize, view.camera.height as usize);
        let mut sums = vec![Sum::default(); width * height];
        let side = options.side;
        for pass in 0..options.passes {
            sums.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
                for (x, sum) in row.iter_mut().enumerate() {
                    let key = seed.part((y as u64) << 32 | x as u64).part(u64::from(pass));
                    let strata = Strata::new(key, side, used);
                    sum.add(self.mean(view, &lighting, (x, y), &strata, (side * side, spread)));
                }
                (options.row)();
            });
            let error = (pass > 0).then(|| mean_error(&sums));
            let (passes, of) = (pass + 1, options.passes);
            (options.told)(Progress { image: &output.pass, passes, of, standard_error: error });
            if error.zip(options.enough).is_some_and(|(error, enough)| error <= enough) {
                break;
            }
        }
        Estimate {
            samples: sums.first().map_or(0, |sum| sum.passes * side * side),
            linear: sums.iter().map(|sum| sum.mean).collect(),
            standard_error: sums.iter().map(Sum::standard_error).collect(),
            mean_standard_error: mean_error(&sums),
        }
    }

    /// Mean of one pass's samples of a pixel: their number, and the deviation of the point-spread function.
    fn mean(
        &self,
        view: &ViewDemand,
        light: &Lighting,
        pixel: (usize, usize),
        strata: &Strata,
        (count, spread): (u32, f64),
    ) -> Rgb {
        let mut sum = [0.0; 3];
        for sample in 0..count {
            let [mut dx, mut dy] = strata.point(sample, Dimension::Pixel);
            if spread > 0.0 {
                let [aside, down] = sampling::normal(strata.point(sample, Dimension::Spread));
                (dx, dy) = (dx + spread * aside, dy + spread * down);
            }
            let (eye, direction) = camera::ray(&view.camera, pixel.0 as f64 + dx, pixel.1 as f64 + dy);
            let ray = self.ray((eye, direction));
            let point = self.nearest(&ray, view.camera.near, light.shown).map(|hit| self.point(&hit, &ray));
            let radiance = light.seen(self, eye, point.as_ref(), strata, sample);
            (0..3).for_each(|k| sum[k] += radiance[k]);
        }
        sum.map(|s| s / f64::from(count))
    }

    /// Labels or depth of what the rays through the pixel centres meet.
    fn labels(&self, view: &ViewDemand, output: &OutputDemand) -> Pixels {
        let object = |hit: &Hit| &self.objects[self.object(hit)];
        let marked = |hit: &Hit| output.marked.as_ref().is_some_and(|marked| marked[self.object(hit)]);
        let byte = |label: &(dyn Fn(&Hit) -> u8 + Sync)| {
            Pixels::Gray8(self.at_centers(view, output, |hit| hit.map_or(0, |hit| label(&hit))))
        };
        match output.output {
            Output::Class => byte(&|hit| object(hit).class),
            Output::Level => byte(&|hit| object(hit).level),
            Output::Mask => byte(&|hit| if marked(hit) { 255 } else { 0 }),
            Output::Depth => {
                let metres = |hit: Option<Hit>| hit.map_or(f32::INFINITY, |hit| hit.crossing.t as f32);
                Pixels::Float32(self.at_centers(view, output, metres))
            }
            Output::Instance | Output::Color => {
                let number = |hit: Option<Hit>| hit.map_or(0, |hit| object(&hit).instance);
                Pixels::Id32(self.at_centers(view, output, number))
            }
        }
    }

    fn at_centers<T: Send>(
        &self,
        view: &ViewDemand,
        output: &OutputDemand,
        of: impl Fn(Option<Hit>) -> T + Sync,
    ) -> Vec<T> {
        let (width, height) = (view.camera.width, view.camera.height);
        let pixel = |y: u32, x: u32| {
            let ray = self.ray(camera::ray(&view.camera, f64::from(x) + 0.5, f64::from(y) + 0.5));
            of(self.nearest(&ray, view.camera.near, &output.selection.objects))
        };
        let pixel = &pixel;
        (0..height).into_par_iter().flat_map_iter(|y| (0..width).map(move |x| pixel(y, x))).collect()
    }
}

fn check(tracer: &Tracer, view: &ViewDemand, options: &Options) -> Result<(), ReferenceError> {
    let (passes, side) = (options.passes, options.side);
    if passes < 2 || !(1..=256).contains(&side) {
        return Err(ReferenceError::BadSampling { passes, side });
    }
    if let Some(what) = not_finite(view) {
        return Err(ReferenceError::NotFiniteView { view: view.name.clone(), what });
    }
    let flags = view.outputs.iter().flat_map(|o| [Some(&o.selection.objects), o.marked.as_ref()]).flatten();
    if flags.into_iter().any(|flags| flags.len() != tracer.objects.len()) {
        return Err(ReferenceError::WrongScene(view.name.clone()));
    }
    Ok(())
}

/// Mean and spread of the passes of one pixel (Welford 1962).
#[derive(Clone, Copy, Default)]
struct Sum {
    passes: u32,
    mean: Rgb,
    squares: Rgb,
}

impl Sum {
    fn add(&mut self, value: Rgb) {
        self.passes += 1;
        for (k, value) in value.into_iter().enumerate() {
            let off = value - self.mean[k];
            self.mean[k] += off / f64::from(self.passes);
            self.squares[k] += off * (value - self.mean[k]);
        }
    }

    /// Of the mean; passes are independent.
    fn standard_error(&self) -> Rgb {
        let n = f64::from(self.passes);
        self.squares.map(|s| (s / (n - 1.0) / n).sqrt())
    }
}

fn mean_error(sums: &[Sum]) -> f64 {
    let total: f64 = sums.iter().map(|sum| sum.standard_error().iter().sum::<f64>()).sum();
    if sums.is_empty() { 0.0 } else { total / (3.0 * sums.len() as f64) }
}
