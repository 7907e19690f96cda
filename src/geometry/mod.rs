//! Polygons and meshes, nothing else; imports nothing of ours.
//!
//! In: rings and face lists in f64 metres. Out: checked polygons, skeletons, roofs, cuts, meshes.
//! Plan coordinates are (x, y) with y up the page (north), counter-clockwise outlines; space is (x, y, z) with y up.

pub mod body;
pub mod boolean;
pub mod box_tree;
pub mod canonical;
pub mod convex_parts;
pub mod cut;
pub mod envelope;
pub mod extrude;
pub mod grid;
#[cfg(test)]
pub(crate) mod hard_cases;
#[cfg(test)]
mod invariance;
pub mod largest_rectangle;
pub mod mesh;
pub mod mesh_checks;
pub mod normals;
pub mod offset;
pub mod orientation;
pub mod plane;
pub mod polygon;
pub mod polygon_checks;
pub mod predicates;
pub mod proximity;
pub mod rectangle;
pub mod repair;
pub mod roof;
pub mod simplify;
pub mod skeleton;
pub mod solid;
pub mod transform;
pub mod triangulate;

pub use mesh::{Face, Mesh};
pub use plane::{Plane, PlaneFrame};
pub use polygon::{Polygon, Ring};
