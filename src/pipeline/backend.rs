//! Backend: which of the two renderers draws. In: the command line's choice, and what the machine has. Out: the frames
//! of views, and what the manifest says of who drew them.

use super::error::PipelineError;
use super::progress::Progress;
use super::views::SceneViews;
use crate::dataset::manifest::RendererInfo;
use crate::frame::Frame;
use crate::gpu::{GpuError, Renderer};
use crate::plan::ViewPlan;
use crate::plan::demand::{Output, ViewDemand};
use crate::reference::{Options, Tracer};
use crate::scene::Scene;

/// What the command line asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// The GPU's renderer; the reference where there is no adapter.
    #[default]
    Any,
    Gpu,
    Reference,
}

/// Samples per pixel of the reference where it was asked for.
const SAMPLES: u32 = 32;
/// Samples per pixel where it stands in.
const SAMPLES_INSTEAD: u32 = 8;

/// A renderer with a scene.
pub(super) enum Backend {
    Gpu(Box<Renderer>),
    /// `samples` as asked for, at least.
    Reference {
        tracer: Option<Box<Tracer>>,
        samples: u32,
    },
}

/// Images of a demand, and how sure those in colour are.
pub(super) struct Drawn {
    pub frame: Frame,
    /// Name of the image and its mean standard error, linear light.
    pub errors: Vec<(String, f64)>,
}

impl Backend {
    /// `samples` per pixel are for the reference. Warns through `progress` where the reference stands in.
    pub fn open(
        choice: BackendChoice,
        samples: Option<u32>,
        progress: &dyn Progress,
    ) -> Result<Backend, PipelineError> {
        let reference = |samples| Backend::Reference { tracer: None, samples };
        if choice == BackendChoice::Reference {
            return Ok(reference(samples.unwrap_or(SAMPLES)));
        }
        match Renderer::new() {
            Ok(renderer) => Ok(Backend::Gpu(Box::new(renderer))),
            Err(error @ (GpuError::NoAdapter(_) | GpuError::NoDevice { .. })) if choice == BackendChoice::Any => {
                let samples = samples.unwrap_or(SAMPLES_INSTEAD);
                progress.warn(&format!(
                    "{error}. The reference renderer draws instead, slowly, with {} samples per pixel; the manifest says \
                     how noisy its images are",
                    Options::of_samples(samples).samples()
                ));
                Ok(reference(samples))
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Puts a scene in place of any other.
    pub fn upload(&mut self, scene: &Scene) -> Result<(), PipelineError> {
        match self {
            Backend::Gpu(renderer) => renderer.upload(scene)?,
            Backend::Reference { tracer, .. } => *tracer = Some(Box::new(Tracer::new(scene)?)),
        }
        Ok(())
    }

    /// Begins the phase in which these views are drawn: the reference tells of rows of pixels, the GPU of views.
    pub fn begin(&self, views: &SceneViews, progress: &dyn Progress) {
        match self {
            Backend::Gpu(_) => progress.begin("render", Some(views.drawn.len() as u64)),
            Backend::Reference { samples, .. } => {
                let passes = u64::from(Options::of_samples(*samples).passes);
                let rows = |demand: &ViewDemand| {
                    let images = demand.outputs.iter().filter(|o| o.output == Output::Color).count() as u64;
                    images * passes * u64::from(demand.camera.height)
                };
                let rows = views.drawn.iter().flat_map(|view| &view.demands).map(rows).sum();
                progress.begin("trace rows", (rows > 0).then_some(rows));
            }
        }
    }

    /// Whether a finished view is a step of the phase.
    pub fn counts_views(&self) -> bool {
        matches!(self, Backend::Gpu(_))
    }

    /// Draws a view of the uploaded scene; `plan` is the GPU's plan of `demand`.
    pub fn render(
        &mut self,
        demand: &ViewDemand,
        plan: &ViewPlan,
        progress: &dyn Progress,
    ) -> Result<Drawn, PipelineError> {
        match self {
            Backend::Gpu(renderer) => Ok(Drawn { frame: renderer.render(plan)?, errors: Vec::new() }),
            Backend::Reference { tracer, samples } => {
                let tracer = tracer.as_ref().expect("a scene is uploaded before its views are drawn");
                let options = Options { row: &|| progress.step(1), ..Options::of_samples(*samples) };
                let rendered = tracer.render(demand, &options)?;
                let named = rendered.frame.images.iter().zip(&rendered.estimates);
                let error = |(image, estimate): (&crate::frame::Image, &Option<_>)| {
                    let estimate: &crate::reference::Estimate = estimate.as_ref()?;
                    Some((image.pass.clone(), estimate.mean_standard_error))
                };
                let errors = named.filter_map(error).collect();
                Ok(Drawn { frame: rendered.frame, errors })
            }
        }
    }

    /// For the manifest.
    pub fn info(&self) -> RendererInfo {
        match self {
            Backend::Gpu(renderer) => {
                let adapter = renderer.adapter();
                RendererInfo {
                    backend: adapter.backend.clone(),
                    adapter: Some(adapter.name.clone()),
                    driver: Some(adapter.driver.clone()),
                    samples_per_pixel: None,
                }
            }
            Backend::Reference { samples, .. } => RendererInfo {
                backend: "reference".to_owned(),
                adapter: None,
                driver: None,
                samples_per_pixel: Some(Options::of_samples(*samples).samples()),
            },
        }
    }
}
