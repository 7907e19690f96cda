//! Scene: shape trees + terrain → meshes with materials and integer labels, ready for export and rendering.
//!
//! World axes: x east, y up, z south, metres about the site's one origin.

pub mod assemble;
pub mod export;
pub mod ground;
pub mod model;
mod palette;
pub mod parts;
pub mod reflectance;
mod shared_mesh;
pub mod texture;
mod triangles;
pub mod vegetation;

pub use model::{Group, Presence, Scene, SceneClass, SceneObject, TriMesh};
pub use shared_mesh::SharedMesh;
