//! Why a run stopped. The user's mistakes come as diagnostics, the world's as typed errors that name the file.

use std::path::PathBuf;

use crate::cost::bench::CostError;
use crate::dataset::DatasetError;
use crate::diagnostics::Diagnostics;
use crate::geodata::elevation::ElevationError;
use crate::geodata::map::MapError;
use crate::geodata::projection::ProjectionError;
use crate::geodata::terrain::TerrainError;
use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::reference::ReferenceError;
use crate::scene::export::ExportError;
use crate::scene::ground::GroundError;
use crate::source::AccessError;

#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// Mistakes in recipes or rules; the texts are in the run's [`crate::source::SourceMap`].
    #[error("the recipe or its rules have errors")]
    Diagnostics(Diagnostics),
    /// Rules that met a limit on so many features that a build for the next one was given up.
    #[error("rules do not end")]
    Endless(Diagnostics),
    #[error("it is no longer wanted")]
    Stopped,
    #[error(transparent)]
    Access(#[from] AccessError),
    #[error(transparent)]
    Map(#[from] MapError),
    #[error(transparent)]
    Elevation(#[from] ElevationError),
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    #[error(transparent)]
    Projection(#[from] ProjectionError),
    #[error("{0}: the map has no building, road or bounds to take the scene's area from; name an area in the recipe")]
    NoExtent(String),
    #[error("the ground of scene `{scene}` cannot be meshed: {source}")]
    Ground { scene: String, source: GroundError },
    #[error("texture {}: {source}", path.display())]
    Texture { path: PathBuf, source: image::ImageError },
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Dataset(#[from] DatasetError),
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    #[error(
        "no settings keep {promised} in scene `{scene}` of dataset `{dataset}`: the best there is has {best} ({settings})"
    )]
    Budget { promised: String, dataset: String, scene: String, best: String, settings: String },
    #[error("the ground of scene `{scene}` cannot keep height {promised_m} m: the best there is has {best_m:.3} m")]
    HeightBudget { scene: String, promised_m: f64, best_m: f64 },
    #[error("no view of the recipe has a colour image, whose accuracy could cost something")]
    NoColor,
    #[error("the recipe has no dataset; `mansard build` writes the geometry alone")]
    NoDataset,
    #[error("no object of the map lies in the area of scene `{0}`")]
    NothingInArea(String),
    #[error("no view of the recipe is called {0}; `mansard plan` lists them")]
    NoSuchView(String),
}

impl From<CostError> for PipelineError {
    fn from(error: CostError) -> Self {
        match error {
            CostError::Gpu(error) => error.into(),
            CostError::Reference(error) => error.into(),
        }
    }
}

impl PipelineError {
    /// 1 where the input is wrong, 2 where the machine or the surroundings are.
    pub fn exit_code(&self) -> u8 {
        match self {
            PipelineError::Output(_)
            | PipelineError::Dataset(_)
            | PipelineError::Gpu(_)
            | PipelineError::NoSuchView(_) => 2,
            _ => 1,
        }
    }
}
