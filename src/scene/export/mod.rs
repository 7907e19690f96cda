//! Scenes as files of other people's formats.

pub mod glb;
mod material;

pub use glb::{ExportError, to_glb};
