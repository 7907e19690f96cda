//! Derivation: `Program` + start shape + seed → `ShapeTree`.

pub mod material;
pub mod seed;
pub mod tree;
