//! Bench: a scene on the device, views with windows in it, and the truth of each window. In: settings. Out: their
//! errors, and the time that the views' images take with them.

use std::time::Instant;

use super::errors::{Errors, Gathered};
use super::probe::{Images, Probe, Truth, drawn, trace};
use super::window::windows;
use crate::gpu::{GpuError, Positions, Renderer, TextureFilter, Tile};
use crate::plan::demand::{Quality, Shadows, ViewDemand};
use crate::plan::{ObjectSummary, schedule, summarize};
use crate::reference::{ReferenceError, Tracer};
use crate::scene::Scene;

/// Why nothing can be measured.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Reference(#[from] ReferenceError),
}

/// Samples per side of the renderer's usual tiles.
pub const USUAL_TILE: u32 = 2048;

/// Which windows count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    All,
    /// Every other one, from the first.
    Calibration,
    /// The rest.
    Check,
}

impl Part {
    fn has(self, window: usize) -> bool {
        match self {
            Part::All => true,
            Part::Calibration => window.is_multiple_of(2),
            Part::Check => !window.is_multiple_of(2),
        }
    }
}

/// Everything that can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    pub quality: Quality,
    /// Another way to make shadows than the recipe's.
    pub shadows: Option<Shadows>,
    pub texture: TextureFilter,
    pub positions: Positions,
    /// Samples per side of a tile.
    pub tile: u32,
}

impl Setting {
    /// The quality alone, everything else as images are made.
    pub fn of(quality: Quality) -> Setting {
        let (texture, positions) = (TextureFilter::default(), Positions::default());
        Setting { quality, shadows: None, texture, positions, tile: USUAL_TILE }
    }
}

/// How windows are chosen and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windows {
    /// Pixels per side.
    pub side: u32,
    /// Of each view: its busiest ones.
    pub count: usize,
    /// Mean standard error, of white, at which tracing stops.
    pub enough: f64,
}

/// Milliseconds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times {
    pub median: f64,
    pub least: f64,
    pub most: f64,
    pub repeats: usize,
    /// Milliseconds of each kind of pass, in one more run, by the device's clock if it has one.
    pub passes: Vec<(String, f64)>,
}

/// A view and the truth of its windows.
struct Spot {
    demand: ViewDemand,
    probe: Probe,
    truths: Vec<Truth>,
}

impl Spot {
    fn of(&self, part: Part) -> impl Iterator<Item = &Truth> {
        self.truths.iter().enumerate().filter(move |(number, _)| part.has(*number)).map(|(_, truth)| truth)
    }
}

pub struct Bench<'a> {
    renderer: &'a mut Renderer,
    objects: Vec<ObjectSummary>,
    spots: Vec<Spot>,
    height: Option<f64>,
}

impl<'a> Bench<'a> {
    /// Puts the scene on the device and traces the windows of all views that have a colour image. `height` is the
    /// greatest error of the scene's ground, metres. `told` hears of every window.
    pub fn new(
        renderer: &'a mut Renderer,
        scene: &Scene,
        demands: &[ViewDemand],
        height: Option<f64>,
        wanted: Windows,
        told: &dyn Fn(&Truth),
    ) -> Result<Bench<'a>, CostError> {
        renderer.upload(scene)?;
        let tracer = Tracer::new(scene)?;
        let objects = summarize(scene);
        let mut spots = Vec::new();
        for demand in demands {
            let Some(probe) = Probe::new(demand) else { continue };
            let mut truths = Vec::new();
            for window in chosen(&probe, &objects, wanted) {
                let truth = trace(&tracer, &probe, window, wanted.enough)?;
                told(&truth);
                truths.push(truth);
            }
            spots.push(Spot { demand: demand.clone(), probe, truths });
        }
        Ok(Bench { renderer, objects, spots, height })
    }

    /// Puts another version of the scene in its place; the truth stays.
    pub fn replace(&mut self, scene: &Scene, demands: &[ViewDemand], height: Option<f64>) -> Result<(), CostError> {
        self.renderer.upload(scene)?;
        self.objects = summarize(scene);
        let probes = demands.iter().filter_map(|demand| Some((demand, Probe::new(demand)?)));
        for (spot, (demand, probe)) in self.spots.iter_mut().zip(probes) {
            (spot.demand, spot.probe) = (demand.clone(), probe);
        }
        self.height = height;
        Ok(())
    }

    pub fn is_empty(&self) -> bool {
        self.spots.iter().all(|spot| spot.truths.is_empty())
    }

    /// Windows and their truth, view by view.
    pub fn truths(&self) -> impl Iterator<Item = (&str, &Truth)> {
        self.spots.iter().flat_map(|spot| spot.truths.iter().map(|truth| (spot.demand.name.as_str(), truth)))
    }

    /// What the renderer makes of all windows, in the order of [`Bench::truths`].
    pub fn pictures(&mut self, setting: &Setting) -> Result<Vec<Images>, CostError> {
        self.pictures_in(Part::All, setting)
    }

    fn pictures_in(&mut self, part: Part, setting: &Setting) -> Result<Vec<Images>, CostError> {
        self.set(setting);
        let mut all = Vec::new();
        for spot in &self.spots {
            let tiles: Vec<Tile> = spot.of(part).map(|truth| truth.images.window).collect();
            if tiles.is_empty() {
                continue;
            }
            let demand = with(&spot.probe.demand, setting);
            let plan = schedule(&[demand], &self.objects);
            let frame = self.renderer.render_windows(&plan.views[0], &tiles)?;
            all.extend(tiles.iter().map(|&tile| drawn(&spot.probe, &frame, tile)));
        }
        Ok(all)
    }

    /// Errors of a setting over all windows.
    pub fn errors(&mut self, setting: &Setting) -> Result<Errors, CostError> {
        self.errors_in(Part::All, setting)
    }

    /// Errors of a setting over some windows.
    pub fn errors_in(&mut self, part: Part, setting: &Setting) -> Result<Errors, CostError> {
        let images = self.pictures_in(part, setting)?;
        let mut gathered = Gathered::default();
        for (images, truth) in images.iter().zip(self.spots.iter().flat_map(|spot| spot.of(part))) {
            gathered.add(images, truth);
        }
        Ok(gathered.errors(self.height))
    }

    /// Time of all images of the first view, by the wall, after one run that compiles and allocates.
    pub fn time(&mut self, setting: &Setting, repeats: usize) -> Result<Times, CostError> {
        self.set(setting);
        let Some(spot) = self.spots.first() else { return Ok(Times::default()) };
        let plan = schedule(&[with(&spot.demand, setting)], &self.objects);
        self.renderer.render(&plan.views[0])?;
        let mut times = Vec::new();
        for _ in 0..repeats.max(1) {
            let start = Instant::now();
            self.renderer.render(&plan.views[0])?;
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        times.sort_by(f64::total_cmp);
        let middle = times.len() / 2;
        let median = if times.len() % 2 == 1 { times[middle] } else { (times[middle - 1] + times[middle]) / 2.0 };
        self.renderer.set_timed(true);
        let timed = self.renderer.render(&plan.views[0]);
        let passes = self.renderer.timings().iter().map(|(pass, seconds)| (pass.clone(), seconds * 1e3)).collect();
        self.renderer.set_timed(false);
        timed?;
        Ok(Times { median, least: times[0], most: times[times.len() - 1], repeats: times.len(), passes })
    }

    fn set(&mut self, setting: &Setting) {
        self.renderer.set_texture_filter(setting.texture);
        self.renderer.set_positions(setting.positions);
        self.renderer.set_tile(setting.tile);
    }
}

impl Drop for Bench<'_> {
    /// Images are made the usual way again.
    fn drop(&mut self) {
        self.renderer.set_texture_filter(TextureFilter::default());
        self.renderer.set_positions(Positions::default());
        self.renderer.set_tile(USUAL_TILE);
    }
}

fn chosen(probe: &Probe, objects: &[ObjectSummary], wanted: Windows) -> Vec<Tile> {
    let shown = &probe.demand.outputs[0].selection.objects;
    windows(&probe.demand.camera, objects, shown, wanted.side, wanted.count)
}

/// A view with the setting's quality and shadows; looks without shadows keep none.
fn with(demand: &ViewDemand, setting: &Setting) -> ViewDemand {
    let mut demand = ViewDemand { quality: setting.quality, ..demand.clone() };
    if let Some(shadows) = setting.shadows {
        for output in demand.outputs.iter_mut().filter(|output| output.look.shadows != Shadows::Off) {
            output.look.shadows = shadows;
        }
    }
    demand
}
