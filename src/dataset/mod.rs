//! Dataset: frames + labels → files.
//!
//! In: [`crate::frame::Frame`]s and what is known about them. Out: image files in a layout that loaders read, and
//! `manifest.json`, from which everything can be made again.

pub mod layout;
pub mod manifest;
pub mod reports;
pub mod writer;

pub use layout::{image_path, is_levir_label};
pub use manifest::Manifest;
pub use writer::{DatasetError, encode_png, write_image};
