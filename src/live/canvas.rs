//! Drawing what is shown. In: a built scene and what a view asks for. Out: its images. The renderer is kept; a scene is
//! uploaded once; a lost adapter is opened again.

use std::sync::Arc;
use std::time::Instant;

use super::update::Phase;
use crate::frame::Frame;
use crate::gpu::{Adapter, GpuError, Renderer};
use crate::pipeline::BuiltScene;
use crate::plan::demand::{Output, State, ViewDemand};
use crate::plan::view::DrawnView;
use crate::plan::{ViewPlan, schedule, summarize};

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
    /// `upload` where the scene was put on the device; `draw`, and each kind of pass in it.
    pub phases: Vec<Phase>,
    /// What went on besides, such as that the adapter was lost and opened again.
    pub notes: Vec<String>,
}

/// Which image of a view is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    Before,
    After,
    Mask,
}

/// What a view asks for, without any image but the first of this kind; the first colour image where a view has none of
/// the state. `None` for a view without.
pub fn demand_of(view: &DrawnView, shown: Shown) -> Option<ViewDemand> {
    let wanted = if shown == Shown::Mask { Output::Mask } else { Output::Color };
    let of_kind = || {
        let outputs = view.demands.iter().flat_map(|demand| demand.outputs.iter().map(move |output| (demand, output)));
        outputs.filter(move |(_, output)| output.output == wanted)
    };
    let state = match shown {
        Shown::Before => Some(State::Before),
        Shown::After => Some(State::After),
        Shown::Mask => None,
    };
    let (demand, output) =
        of_kind().find(|(_, output)| Some(output.selection.state) == state).or_else(|| of_kind().next())?;
    Some(ViewDemand { outputs: vec![output.clone()], ..demand.clone() })
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

    /// Draws the images of one acquisition. Selections of the demand have a flag per object of the scene. An adapter that
    /// was lost is opened again, once.
    pub fn draw(&mut self, scene: &Arc<BuiltScene>, demand: &ViewDemand) -> Result<Drawing, GpuError> {
        let (mut phases, mut notes) = (Vec::new(), Vec::new());
        let plan = timed("plan", &mut phases, || schedule(std::slice::from_ref(demand), &summarize(&scene.scene)));
        let mut frame = self.attempt(scene, &plan.views[0], &mut phases);
        if frame.is_err() && self.renderer.as_ref().is_some_and(Renderer::is_lost) {
            notes.push("the adapter was lost; it was opened again and the scene uploaded anew".to_owned());
            (self.renderer, self.uploaded) = (None, None);
            frame = self.attempt(scene, &plan.views[0], &mut phases);
        }
        Ok(Drawing { frame: frame?, phases, notes })
    }

    fn attempt(
        &mut self,
        scene: &Arc<BuiltScene>,
        plan: &ViewPlan,
        phases: &mut Vec<Phase>,
    ) -> Result<Frame, GpuError> {
        if self.renderer.is_none() {
            let mut renderer = timed("open adapter", phases, Renderer::new)?;
            renderer.set_timed(true);
            self.renderer = Some(renderer);
        }
        let renderer = self.renderer.as_mut().expect("it was opened");
        if !self.uploaded.as_ref().is_some_and(|uploaded| Arc::ptr_eq(uploaded, scene)) {
            self.uploaded = None;
            timed("upload", phases, || renderer.upload(&scene.scene))?;
            self.uploaded = Some(scene.clone());
        }
        let frame = timed("draw", phases, || renderer.render(plan))?;
        phases.extend(renderer.timings().iter().map(|(pass, seconds)| Phase::new(format!("pass {pass}"), *seconds)));
        Ok(frame)
    }

    /// Loses the adapter, as a driver that is reset does.
    #[cfg(test)]
    pub(crate) fn lose_adapter(&self) {
        self.renderer.as_ref().expect("something was drawn").lose();
    }
}

fn timed<T>(name: &str, phases: &mut Vec<Phase>, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    phases.push(Phase::new(name, start.elapsed().as_secs_f64()));
    result
}
