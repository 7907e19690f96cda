//! Scenes as files of other people's formats.

pub mod glb;

pub use glb::{ExportError, to_glb};
