//! What is under the cursor. In: an object's label and a ray. Out: the feature, and the leaf whose face the ray meets
//! first with the rules and the line that made it. The lot is derived once more, watched; a build pays nothing for it.

use glam::DVec3;
use serde::Serialize;

/// From `origin` in `direction` (any length), world metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// One feature in one state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LotInfo {
    /// `way/123`; `None` for the terrain.
    pub feature: Option<String>,
    pub instance: u32,
    pub class: &'static str,
    /// Name of the change that touches it, and of its level.
    pub change: Option<String>,
    pub level: Option<String>,
    /// Rule file as the recipe writes it; `None` where no rule made it.
    pub rule_file: Option<String>,
    /// Values that the derivation began with, by name.
    pub attributes: Vec<(String, String)>,
    pub leaves: usize,
    pub triangles: usize,
    /// Of its derivation in the last build that derived it.
    pub derivation_ms: f64,
    /// Where a ray was given and meets something.
    pub leaf: Option<LeafInfo>,
}

/// One leaf.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeafInfo {
    /// Rules from the start rule to the leaf's own name.
    pub rules: Vec<String>,
    /// Child numbers from the root.
    pub path: Vec<u32>,
    pub faces: usize,
    pub material: String,
    /// Where the symbol that made it stands.
    pub file: String,
    pub line: usize,
    pub column: usize,
}
