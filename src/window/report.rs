//! What the threads tell the window.

use std::path::PathBuf;
use std::sync::Arc;

use super::drawer::Drawn;
use super::shown::Shown;
use crate::live::{LotInfo, Update};

/// Something happened on another thread.
pub enum Report {
    /// An update began.
    Building,
    /// There is another good scene, or other views of it.
    Built(Arc<Shown>),
    Updated(Box<Update>),
    /// What a click met; `None` for nothing that is known.
    Picked(Option<Box<LotInfo>>),
    Drawn(Box<Drawn>),
    /// The adapter could not draw.
    NotDrawn(String),
    Saved(PathBuf),
    NotSaved(String),
}

/// How a thread tells it.
pub type Tell = Arc<dyn Fn(Report) + Send + Sync>;
