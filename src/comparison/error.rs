//! Why two things cannot be compared, or a dataset cannot be made again.

use std::path::PathBuf;

use crate::output::OutputError;
use crate::pipeline::PipelineError;

#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    #[error(transparent)]
    Pipeline(Box<PipelineError>),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{} is no manifest that this program understands: {why}", path.display())]
    Manifest { path: PathBuf, why: String },
    #[error("{} is no image that this program wrote: {why}", path.display())]
    Image { path: PathBuf, why: String },
    #[error("{} is no glTF scene that this program wrote: {why}", path.display())]
    Scene { path: PathBuf, why: String },
    #[error("{0}")]
    Operand(String),
    #[error("{command} failed: {why}")]
    Git { command: String, why: String },
    /// One line per input.
    #[error("the dataset cannot be made again from what was found:\n{}", .0.join("\n"))]
    Inputs(Vec<String>),
    #[error("the dataset cannot be made again: {0}")]
    Unverifiable(String),
}

impl From<PipelineError> for ComparisonError {
    fn from(error: PipelineError) -> Self {
        ComparisonError::Pipeline(Box::new(error))
    }
}

impl ComparisonError {
    /// For `map_err` on files that are read.
    pub fn read(path: &std::path::Path) -> impl FnOnce(std::io::Error) -> ComparisonError + '_ {
        move |source| ComparisonError::Read { path: path.to_owned(), source }
    }
}
