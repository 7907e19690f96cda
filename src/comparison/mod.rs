//! Comparison: what differs between two recipes, two revisions or two datasets, and whether a dataset can be made again.
//!
//! In: two [`Operand`]s, or a dataset's folder. Out: a [`Difference`] with every detail, its text, pictures and page; a
//! [`Verification`], file by file.
//!
//! Each side becomes a [`snapshot::Snapshot`], the same whether it was built just now or read from files, and snapshots
//! are compared part by part: [`rules`], [`properties`], [`features`], [`meshes`], [`views`], [`pixels`].

mod collect;
mod difference;
mod error;
mod features;
mod glb;
mod glyphs;
mod inputs;
mod materials;
mod meshes;
mod operand;
mod page;
mod picture;
mod pixels;
mod properties;
mod revision;
mod rules;
mod snapshot;
mod stored;
mod text;
mod verify;
mod views;

pub use collect::{Collected, Pixels, collect};
pub use difference::{Difference, compare};
pub use error::ComparisonError;
pub use operand::Operand;
pub use page::write_pages;
pub use text::difference_text;
pub use verify::{Colours, Verification, VerifyOptions, verification_text, verify};
