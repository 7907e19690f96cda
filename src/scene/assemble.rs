//! Parts of all features and the ground → the scene. In: [`FeatureParts`] in the order of their ids, the ground mesh
//! with a class per triangle. Out: a [`Scene`] whose objects carry integer labels. Meshes of the scene before are taken
//! over where nothing of them changed.

mod ground_objects;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::ground::{GroundLayer, GroundMesh};
use super::model::{Presence, Scene, SceneClass, SceneObject, TriMesh};
use super::palette::Palette;
use super::parts::{FlatFace, Parts};
use super::shared_mesh::SharedMesh;
use crate::geodata::feature::FeatureId;
use ground_objects::{KeptGround, ground_objects};

/// Label of the terrain in instance images; features follow from 2.
pub const TERRAIN_INSTANCE: u32 = 1;
/// Built-in texture of ground that nothing covers.
pub const TERRAIN_TEXTURE: &str = "builtin:ground";

/// One feature in all its states.
#[derive(Clone, Debug)]
pub struct FeatureParts {
    pub feature: FeatureId,
    pub class: SceneClass,
    /// One state for features that no change touches; else up to two.
    pub states: Vec<StateParts>,
}

#[derive(Clone, Debug)]
pub struct StateParts {
    pub presence: Presence,
    /// Number of the change block, 0 for none.
    pub change: u16,
    /// Level of the change, 0 for none.
    pub level: u8,
    pub parts: Arc<Parts>,
}

/// Meshes of the scene before.
#[derive(Default)]
pub struct Kept {
    keeps: bool,
    ground: Option<KeptGround>,
    solids: BTreeMap<StateKey, KeptSolid>,
    merged: BTreeMap<StateKey, KeptMerged>,
}

type StateKey = (FeatureId, Presence);

struct KeptSolid {
    parts: Arc<Parts>,
    numbers: Vec<u32>,
    mesh: SharedMesh,
}

struct KeptMerged {
    parts: [SharedMesh; 2],
    mesh: SharedMesh,
}

impl Kept {
    /// Keeps the meshes of every scene for the next one; by default none are kept.
    pub fn keeping() -> Kept {
        Kept { keeps: true, ..Kept::default() }
    }
}

/// The layers that the ground mesh has to honour, one per flat face, numbered in the order of `features`.
pub fn ground_layers(features: &[FeatureParts]) -> Vec<GroundLayer> {
    let faces = features.iter().flat_map(|f| &f.states).flat_map(|s| &s.parts.flat);
    let layer = |(number, face): (usize, &FlatFace)| GroundLayer {
        polygons: vec![face.polygon.clone()],
        priority: face.priority,
        payload: number as u32,
        surface: face.surface,
    };
    faces.enumerate().map(layer).collect()
}

/// Builds the scene. `ground` was made from [`ground_layers`] of the same features; instance numbers follow the order
/// of `features`.
pub fn assemble(features: Vec<FeatureParts>, ground: &Arc<GroundMesh>, kept: &mut Kept) -> Scene {
    let mut palette = Palette::default();
    let mut objects = ground_objects(&features, ground, &mut palette, kept);
    let mut known = std::mem::take(&mut kept.solids);
    for (number, feature) in features.into_iter().enumerate() {
        for StateParts { presence, change, level, parts } in feature.states {
            if parts.solid.triangles.is_empty() {
                continue;
            }
            let key = (feature.feature, presence);
            let numbers: Vec<u32> = parts.materials.iter().map(|material| palette.number(material)).collect();
            let same = |known: &KeptSolid| Arc::ptr_eq(&known.parts, &parts) && known.numbers == numbers;
            let mesh = match known.remove(&key).filter(same) {
                Some(known) => {
                    let mesh = known.mesh.clone();
                    kept.solids.insert(key, known);
                    mesh
                }
                None => solid(parts, numbers, key, kept),
            };
            let (feature, class) = (feature.feature, feature.class);
            let instance = TERRAIN_INSTANCE + 1 + number as u32;
            objects.push(SceneObject { feature: Some(feature), instance, class, presence, change, level, mesh });
        }
    }
    objects.sort_by_key(|o| (o.instance, o.presence, o.change));
    let objects = merged(objects, kept);
    let bounds = bounds(&objects);
    Scene { objects, materials: palette.into_materials(), textures: Vec::new(), bounds }
}

/// The solid part of a state with the scene's materials.
fn solid(parts: Arc<Parts>, numbers: Vec<u32>, key: StateKey, kept: &mut Kept) -> SharedMesh {
    if !kept.keeps {
        let own = Arc::try_unwrap(parts).map_or_else(|shared| shared.solid.clone(), |parts| parts.solid);
        return renumbered(own, &numbers).into();
    }
    let mesh = SharedMesh::from(renumbered(parts.solid.clone(), &numbers));
    kept.solids.insert(key, KeptSolid { parts, numbers, mesh: mesh.clone() });
    mesh
}

/// Joins the ground part and the solid part of the same feature in the same state.
fn merged(objects: Vec<SceneObject>, kept: &mut Kept) -> Vec<SceneObject> {
    let mut known = std::mem::take(&mut kept.merged);
    let mut out: Vec<SceneObject> = Vec::with_capacity(objects.len());
    for object in objects {
        let key = |o: &SceneObject| (o.instance, o.presence, o.change);
        let Some(last) = out.last_mut().filter(|last| key(last) == key(&object)) else {
            out.push(object);
            continue;
        };
        let state = object.feature.map(|feature| (feature, object.presence));
        let same = |known: &KeptMerged| known.parts[0].is(&last.mesh) && known.parts[1].is(&object.mesh);
        let join = state.and_then(|state| known.remove(&state)).filter(same).unwrap_or_else(|| {
            let mut mesh = last.mesh.clone();
            mesh.append(&object.mesh);
            KeptMerged { parts: [last.mesh.clone(), object.mesh.clone()], mesh }
        });
        last.mesh = join.mesh.clone();
        if let (true, Some(state)) = (kept.keeps, state) {
            kept.merged.insert(state, join);
        }
    }
    out
}

/// The mesh with its materials' numbers in the scene.
fn renumbered(mut mesh: TriMesh, numbers: &[u32]) -> TriMesh {
    for group in &mut mesh.groups {
        group.material = numbers[group.material as usize];
    }
    mesh
}

fn bounds(objects: &[SceneObject]) -> (DVec3, DVec3) {
    let boxes = objects.iter().filter_map(|object| object.mesh.bounds());
    boxes.reduce(|(lo, hi), (low, high)| (lo.min(low), hi.max(high))).unwrap_or_default()
}
