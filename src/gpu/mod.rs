//! Render: render plan + scene → frames. The only user of wgpu.
//!
//! Positions reach the GPU as f32 about the point where the camera's axis enters the scene, subtracted in f64
//! ([`crate::plan::demand::Camera::origin`]): however far the camera is, the scene keeps its digits. Depth is reversed
//! 32-bit float from the near plane to the scene's far end. Images are drawn in tiles; colour is linear 16-bit float,
//! averaged over k × k samples per pixel and encoded to sRGB last; object numbers are drawn at pixel centres into 32-bit
//! integers. A surface is drawn where its opacity (material times texel) is at least
//! one half, or the cut-off of its material where that is masked; opaque materials have no holes.

mod cutouts;
mod device;
mod draws;
mod execute;
mod junctions;
mod mipmaps;
mod passes;
mod pipelines;
mod pools;
mod readback;
mod source;
mod streams;
mod tiles;
mod timing;
mod upload;

use std::collections::BTreeSet;

use crate::frame::Frame;
use crate::plan::attribute::Attribute;
use crate::plan::{Counts, RenderPlan, ViewPlan};
use crate::scene::Scene;

pub use device::Adapter;
pub use pipelines::TextureFilter;
pub use tiles::Tile;
pub use upload::Positions;

/// What can go wrong between the plan and the frame; none of it is the recipe's mistake.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    #[error(
        "no Vulkan, Metal or DirectX 12 adapter was found; on Debian the package mesa-vulkan-drivers gives one that \
         runs on the CPU"
    )]
    NoAdapter(#[source] wgpu::RequestAdapterError),
    #[error("the adapter {adapter} gave no device: {reason}")]
    NoDevice { adapter: String, reason: String },
    #[error("the adapter {adapter} failed while {task}: {reason}")]
    Failed { adapter: String, task: String, reason: String },
    #[error("view {view}: {what} of {wanted} is more than the {limit} that adapter {adapter} allows")]
    TooLarge { adapter: String, view: String, what: &'static str, wanted: u64, limit: u64 },
    #[error("view {view}: a number of {what} is not finite")]
    NotFinite { view: String, what: &'static str },
    #[error("object {object} (instance {instance}): the {what} of vertex {vertex} is not a finite number")]
    NotFiniteMesh { object: usize, instance: u32, what: &'static str, vertex: usize },
    #[error("view {0} was planned for another scene, or no scene was uploaded")]
    WrongScene(String),
}

/// A device with one scene on it. Pipelines and render targets are made when a plan first needs them, and kept.
pub struct Renderer {
    gpu: device::Gpu,
    pipelines: pipelines::Pipelines,
    targets: pools::TargetPool,
    scene: Option<upload::GpuScene>,
    conformed: junctions::Conformed,
    readback: readback::Readback,
    max_tile: u32,
    positions: Positions,
    passes: usize,
    triangles: u64,
    drawn: u64,
    stopwatch: timing::Stopwatch,
}

impl Renderer {
    /// Opens the fastest adapter there is, a software one if there is no other.
    pub fn new() -> Result<Self, GpuError> {
        let gpu = device::Gpu::open()?;
        let pipelines = pipelines::Pipelines::new(&gpu);
        let (targets, readback) = (pools::TargetPool::default(), readback::Readback::default());
        let (max_tile, stopwatch) = (tiles::TILE_SAMPLES, timing::Stopwatch::default());
        let positions = Positions::default();
        Ok(Renderer {
            gpu,
            pipelines,
            targets,
            scene: None,
            conformed: junctions::Conformed::default(),
            readback,
            max_tile,
            positions,
            passes: 0,
            triangles: 0,
            drawn: 0,
            stopwatch,
        })
    }

    /// Name and driver, for the manifest.
    pub fn adapter(&self) -> &Adapter {
        &self.gpu.adapter
    }

    /// Whether the device is gone, after a driver's reset or because the adapter was taken out: open another renderer.
    pub fn is_lost(&self) -> bool {
        self.gpu.is_lost()
    }

    /// Takes the device away, as a driver's reset does.
    #[cfg(test)]
    pub(crate) fn lose(&self) {
        self.gpu.device.destroy();
    }

    /// Limits tiles to `samples` per side (1024 to 4096 are sensible): less memory, more passes over the geometry.
    pub fn set_tile(&mut self, samples: u32) {
        self.max_tile = samples.max(16);
        self.targets = pools::TargetPool::default();
    }

    /// Whether passes are timed from now on; that waits for the device more often. Off at first.
    pub fn set_timed(&mut self, timed: bool) {
        self.stopwatch.set(timed);
    }

    /// Word of each kind of pass in the view rendered last, in the order of their first runs, with the seconds that all
    /// runs took: by the clock of the device if it has one, by ours otherwise. Empty unless timed.
    pub fn timings(&self) -> &[(String, f64)] {
        &self.stopwatch.times
    }

    /// Puts a scene on the device, in place of any other, ready for any plan. Objects of both states are there once.
    pub fn upload(&mut self, scene: &Scene) -> Result<(), GpuError> {
        self.upload_attributes(scene, &Attribute::ALL.into_iter().collect())
    }

    /// The same with no more attributes than a plan reads.
    pub fn upload_for(&mut self, scene: &Scene, plan: &RenderPlan) -> Result<(), GpuError> {
        self.upload_attributes(scene, &plan.attributes())
    }

    fn upload_attributes(&mut self, scene: &Scene, wanted: &BTreeSet<Attribute>) -> Result<(), GpuError> {
        self.scene = None;
        upload::check(scene)?;
        let conformed = &mut self.conformed;
        let upload = || upload::GpuScene::new(&self.gpu, scene, wanted, conformed);
        let uploaded = self.gpu.checked("uploading the scene", upload)?;
        self.scene = Some(uploaded);
        Ok(())
    }

    /// How textures are looked up from now on.
    pub fn set_texture_filter(&mut self, filter: TextureFilter) {
        self.pipelines.set_texture_filter(&self.gpu, filter);
        if let Some(scene) = &mut self.scene {
            scene.forget_textures();
        }
    }

    /// How positions are rounded from now on.
    pub fn set_positions(&mut self, positions: Positions) {
        self.positions = positions;
    }

    /// Runs the plan of one view over the uploaded scene.
    pub fn render(&mut self, view: &ViewPlan) -> Result<Frame, GpuError> {
        execute::render(self, view, &[])
    }

    /// Draws these parts of a view's images, bit for bit as [`Renderer::render`] would; the rest stays blank. What is no
    /// image, such as a shadow map, is drawn as a whole.
    pub fn render_windows(&mut self, view: &ViewPlan, windows: &[Tile]) -> Result<Frame, GpuError> {
        execute::render(self, view, windows)
    }

    /// What has been made so far: passes run (tiles of a pass count once) and the triangles handed to them, render
    /// targets and pipelines created, and attributes of the present scene.
    pub fn created(&self) -> Counts {
        Counts {
            passes: self.passes,
            textures: self.targets.created(),
            pipelines: self.pipelines.created(),
            attributes: self.scene.as_ref().map_or(0, upload::GpuScene::attributes),
            triangles: self.triangles,
        }
    }

    /// Triangles drawn so far, without those of objects that no camera, tile or sun sees.
    pub fn drawn(&self) -> u64 {
        self.drawn
    }
}

#[cfg(test)]
pub(crate) mod tests;
