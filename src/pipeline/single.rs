//! One derivation as a scene of its own, for `mansard derive --format glb`.

use super::error::PipelineError;
use super::textures;
use crate::geodata::feature::{FeatureId, ObjectKind};
use crate::geometry::Polygon;
use crate::interpreter::FileAssets;
use crate::interpreter::tree::ShapeTree;
use crate::scene::assemble::{FeatureParts, Kept, StateParts, assemble};
use crate::scene::ground::GroundMesh;
use crate::scene::parts::{Stand, parts};
use crate::scene::{Presence, Scene, SceneClass};
use crate::source::Access;

/// The leaves of a tree as the scene's only object.
pub fn single_scene(tree: &ShapeTree, access: &Access) -> Result<Scene, PipelineError> {
    let parts = parts(&tree.leaves, 0.0, &Stand::Level { skirt: 0.0 }, &Polygon::default());
    let feature = FeatureParts {
        feature: FeatureId { kind: ObjectKind::Way, id: 1, part: 0 },
        class: SceneClass::Building,
        states: vec![StateParts { presence: Presence::Both, change: 0, level: 0, parts: parts.into() }],
    };
    let mut scene = assemble(vec![feature], &GroundMesh::default().into(), &mut Kept::default());
    textures::load(&mut scene, &FileAssets::new(access.clone()), &mut textures::Kept::default())?;
    Ok(scene)
}
