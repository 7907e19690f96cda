//! Drawing what is shown. In: a built scene and what a view asks for. Out: its images. The renderer is kept; a scene is
//! uploaded once; a lost adapter is opened again.

use std::sync::Arc;
use std::time::Instant;

use super::update::Phase;
use crate::frame::Frame;
use crate::gpu::{Adapter, GpuError, Renderer};
use crate::pipeline::BuiltScene;
use crate::plan::demand::ViewDemand;
use crate::plan::{schedule, summarize};

/// A renderer with the scene shown.
#[derive(Default)]
pub struct Canvas {
    renderer: Option<Renderer>,
    uploaded: Option<Arc<BuiltScene>>,
}

/// Images of a demand.
#[derive(Debug)]
pub struct Drawing {
    pub frame: Frame,
    /// `upload` where the scene was put on the device, then each kind of pass.
    pub phases: Vec<Phase>,
    /// What went on besides, such as that the adapter was lost and opened again.
    pub notes: Vec<String>,
}

impl Canvas {
    /// Opens no adapter yet.
    pub fn new() -> Canvas {
        Canvas::default()
    }

    /// The adapter, once something was drawn.
    pub fn adapter(&self) -> Option<&Adapter> {
        self.renderer.as_ref().map(Renderer::adapter)
    }

    /// Draws the images of one acquisition. Selections of the demand have a flag per object of the scene.
    pub fn draw(&mut self, scene: &Arc<BuiltScene>, demand: &ViewDemand) -> Result<Drawing, GpuError> {
        let mut phases = Vec::new();
        if self.renderer.is_none() {
            let start = Instant::now();
            let mut renderer = Renderer::new()?;
            renderer.set_timed(true);
            self.renderer = Some(renderer);
            phases.push(Phase::new("open adapter", start.elapsed().as_secs_f64()));
        }
        let renderer = self.renderer.as_mut().expect("it was opened");
        if !self.uploaded.as_ref().is_some_and(|uploaded| Arc::ptr_eq(uploaded, scene)) {
            let start = Instant::now();
            self.uploaded = None;
            renderer.upload(&scene.scene)?;
            self.uploaded = Some(scene.clone());
            phases.push(Phase::new("upload", start.elapsed().as_secs_f64()));
        }
        let plan = schedule(std::slice::from_ref(demand), &summarize(&scene.scene));
        let frame = renderer.render(&plan.views[0])?;
        phases.extend(renderer.timings().iter().map(|(pass, seconds)| Phase::new(pass.clone(), *seconds)));
        Ok(Drawing { frame, phases, notes: Vec::new() })
    }
}
