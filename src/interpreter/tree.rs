//! What a derivation gives: the leaves with their meshes, the reports and the prints.

use std::sync::Arc;

use super::material::Material;
use super::reports::Report;
use super::steps::Path;
use super::used::Used;
use crate::diagnostics::Diagnostics;
use crate::geometry::Mesh;

/// A value of the rule language as it leaves the interpreter.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalar {
    Float(f64),
    Bool(bool),
    String(Arc<str>),
}

/// One terminal shape, in world coordinates of the start shape (metres, y up, z south).
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The symbol that was not rewritten, such as `Wall` or `roof.Tile`.
    pub rule: Arc<str>,
    /// Index of the leaf's creation path, for stable identity.
    pub path: Path,
    /// Generic attributes as the start shape had them, sorted by name and shared by all leaves: a later `set` does not
    /// show, as in CityEngine.
    pub attributes: Arc<[(Arc<str>, Scalar)]>,
    pub material: Arc<Material>,
    pub mesh: Mesh,
}

/// The result of deriving one start shape.
#[derive(Clone, Debug, Default)]
pub struct ShapeTree {
    /// Depth first, in creation order.
    pub leaves: Vec<Leaf>,
    /// Sorted by name, then by type.
    pub reports: Vec<Report>,
    pub prints: Vec<String>,
    /// Warnings and errors met while deriving; with an error the leaves are those made before it.
    pub diagnostics: Diagnostics,
    /// Rules and functions that ran.
    pub used: Used,
}
