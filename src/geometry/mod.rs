//! Polygons and meshes, nothing else; imports nothing of ours.
//!
//! In: rings and face lists in f64 metres. Out: checked polygons, skeletons, roofs, cuts, meshes.
//! Plan coordinates are (x, y) with y up the page (north), counter-clockwise outlines; space is (x, y, z) with y up.

pub mod mesh;
pub mod polygon;

pub use mesh::{Face, Mesh};
pub use polygon::{Polygon, Ring};
