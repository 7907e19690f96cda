//! What one side of a comparison is, whether it was built just now or lies in files. In: recipes and built scenes. Out: a
//! [`Snapshot`] by names that mean the same on both sides.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde_json::Value;

use super::materials::material_text;
use super::meshes::{GROUND, MaterialGroup, Mesh};
use super::rules::RuleText;
use crate::pipeline::{Assignment, BuiltScene, Recipe};
use crate::scene::{Presence, Scene, SceneObject, TriMesh};
use crate::spec::render_spec::{LevelEffect, RenderSpec};

/// One side.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// What people call it.
    pub label: String,
    /// Name of the main recipe's file.
    pub recipe: Option<String>,
    pub inputs: Vec<InputSnapshot>,
    pub arguments: BTreeMap<String, String>,
    /// Absent where only a dataset's files are known.
    pub meaning: Option<Meaning>,
    pub scenes: BTreeMap<String, SceneSnapshot>,
    pub datasets: BTreeMap<String, DatasetSnapshot>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputSnapshot {
    pub role: String,
    pub name: String,
    /// Below the recipe's folder.
    pub path: Option<String>,
    pub sha256: String,
}

/// What the texts of a recipe say.
#[derive(Clone, Debug, Default)]
pub struct Meaning {
    /// Path of the property and its value, in the order of the recipe.
    pub properties: Vec<(String, String)>,
    pub rules: Vec<RuleText>,
}

#[derive(Clone, Debug, Default)]
pub struct SceneSnapshot {
    pub geometry_sha256: String,
    /// By name; of files only those that have geometry or something to tell.
    pub features: BTreeMap<String, FeatureSnapshot>,
    pub objects: Vec<ObjectSnapshot>,
    /// Change → share of its candidates that was drawn.
    pub shares: BTreeMap<String, f64>,
    /// Number in instance images → feature.
    pub instances: BTreeMap<u32, String>,
}

/// What was made of a feature.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FeatureSnapshot {
    pub class: String,
    /// Rule file and start rule; `None` where files do not tell.
    pub rule: Option<String>,
    /// The change and its level; empty where nothing changes.
    pub change: String,
    /// `ok`, or what the ledger says.
    pub outcome: String,
}

/// One mesh of a feature.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectSnapshot {
    pub feature: String,
    pub class: String,
    /// In which states it is there.
    pub before: bool,
    pub after: bool,
    pub mesh: Mesh,
}

#[derive(Clone, Debug, Default)]
pub struct DatasetSnapshot {
    /// Where the images lie, if there are any.
    pub folder: Option<PathBuf>,
    /// What drew them.
    pub renderer: Option<String>,
    pub views: BTreeMap<String, ViewSnapshot>,
    /// Number in class images → name.
    pub classes: BTreeMap<u8, String>,
}

#[derive(Clone, Debug, Default)]
pub struct ViewSnapshot {
    pub scene: String,
    /// Path of the property → value drawn.
    pub draws: BTreeMap<String, Value>,
    /// As [`crate::dataset::manifest::AcquisitionRecord`].
    pub acquisitions: Vec<Value>,
    pub images: BTreeMap<String, ImageSnapshot>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageSnapshot {
    /// Below the dataset's folder.
    pub path: String,
    pub sha256: String,
    /// As recipes name it; `None` in old manifests.
    pub output: Option<String>,
}

/// A built scene; its meshes are taken out of it.
pub fn scene_snapshot(recipe: &Recipe, index: usize, built: BuiltScene) -> SceneSnapshot {
    let spec = &recipe.spec;
    let mut features: BTreeMap<String, FeatureSnapshot> = BTreeMap::new();
    for assignment in &built.assignments {
        features.insert(assignment.feature.to_string(), feature_snapshot(spec, index, assignment));
    }
    for entry in &built.record.ledger.entries {
        if let Some(feature) = features.get_mut(&entry.feature) {
            feature.outcome = outcome_text(&serde_json::json!(entry));
        }
    }
    let shares = built.record.changes.iter().map(|change| (change.name.clone(), change.share)).collect();
    let name = |o: &SceneObject| o.feature.map_or_else(|| GROUND.to_owned(), |f| f.to_string());
    let instances = built.scene.objects.iter().map(|object| (object.instance, name(object))).collect();
    let geometry_sha256 = built.record.geometry_sha256.clone();
    SceneSnapshot { geometry_sha256, features, objects: objects(built.scene), shares, instances }
}

fn feature_snapshot(spec: &RenderSpec, scene: usize, assignment: &Assignment) -> FeatureSnapshot {
    let rule = assignment.rule.map(|rule| {
        let rule = &spec.scenes[scene].rules[rule];
        let start = rule.start.as_ref().map_or(String::new(), |start| format!(" start {start}"));
        format!("{}{start}", super::properties::file_text(&rule.file))
    });
    let change = assignment.change.map(|changed| {
        let change = &spec.changes[changed.change];
        change_text(&change.name, (change.levels.len() > 1).then_some(changed.level + 1))
    });
    let gone = assignment.change.is_some_and(|changed| {
        matches!(spec.changes[changed.change].levels[changed.level].effect, LevelEffect::Demolished)
    });
    let change = change.map_or(String::new(), |text| if gone { format!("{text}, demolished") } else { text });
    let class = crate::scene::SceneClass::from(assignment.class).name().to_owned();
    FeatureSnapshot { class, rule: Some(rule.unwrap_or_else(|| "none".to_owned())), change, outcome: "ok".to_owned() }
}

/// A change and, where it has several, its level.
pub fn change_text(name: &str, level: Option<usize>) -> String {
    level.map_or_else(|| name.to_owned(), |level| format!("{name} level {level}"))
}

/// An entry of a ledger as JSON → `skipped: it covers no area`.
pub fn outcome_text(entry: &Value) -> String {
    let word = entry["outcome"].as_str().unwrap_or_default().replace('_', " ");
    entry["detail"].as_str().map_or_else(|| word.clone(), |detail| format!("{word}: {detail}"))
}

fn objects(scene: Scene) -> Vec<ObjectSnapshot> {
    let materials: Vec<_> = scene.materials.iter().map(|material| material_text(material)).collect();
    let one = |object: SceneObject| ObjectSnapshot {
        feature: object.feature.map_or_else(|| GROUND.to_owned(), |f| f.to_string()),
        class: object.class.name().to_owned(),
        before: object.presence != Presence::AfterOnly,
        after: object.presence != Presence::BeforeOnly,
        mesh: mesh(TriMesh::clone(&object.mesh), &materials),
    };
    scene.objects.into_iter().map(one).collect()
}

fn mesh(mesh: TriMesh, materials: &[std::sync::Arc<str>]) -> Mesh {
    let group = |g: crate::scene::Group| MaterialGroup {
        material: materials[g.material as usize].clone(),
        first: g.first,
        count: g.count,
    };
    let TriMesh { positions, normals, uvs, uv_sets, triangles, groups } = mesh;
    let uvs = std::iter::once((0, uvs)).chain(uv_sets).collect();
    Mesh { positions, normals, uvs, triangles, groups: groups.into_iter().map(group).collect() }
}
