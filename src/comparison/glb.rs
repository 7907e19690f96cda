//! A scene read back from its glTF file, as `scene::export` wrote it. In: bytes of a `.glb`. Out: its objects with their
//! labels, in the file's precision, and the features by their numbers.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use serde::Deserialize;

use super::materials::gltf_material_texts;
use super::meshes::{MaterialGroup, Mesh};
use super::snapshot::ObjectSnapshot;

/// What a file tells of a scene.
#[derive(Clone, Debug, Default)]
pub struct StoredObjects {
    pub objects: Vec<ObjectSnapshot>,
    /// Number in instance images → feature.
    pub instances: BTreeMap<u32, String>,
    /// Feature → number of its change, from 1, and level.
    pub changed: BTreeMap<String, (usize, usize)>,
}

/// The extras of a node.
#[derive(Deserialize)]
struct Labels {
    osm: String,
    class: String,
    instance: u32,
    state: String,
    change: usize,
    level: usize,
}

/// Reads a scene; says why not.
pub fn read(bytes: &[u8]) -> Result<StoredObjects, String> {
    let gltf = gltf::Gltf::from_slice(bytes).map_err(|error| error.to_string())?;
    let materials = gltf_material_texts(&gltf.document);
    let blob = gltf.blob.as_deref().unwrap_or_default();
    let mut out = StoredObjects::default();
    for node in gltf.document.nodes() {
        let nameless = || format!("node {} has no labels", node.index());
        let extras = node.extras().as_ref().ok_or_else(nameless)?;
        let labels: Labels = serde_json::from_str(extras.get()).map_err(|error| error.to_string())?;
        out.instances.insert(labels.instance, labels.osm.clone());
        if labels.change > 0 && labels.level > 0 {
            out.changed.insert(labels.osm.clone(), (labels.change, labels.level));
        }
        out.objects.push(ObjectSnapshot {
            before: labels.state != "after",
            after: labels.state != "before",
            mesh: mesh(&node, blob, &materials).ok_or_else(|| format!("the mesh of {} cannot be read", labels.osm))?,
            feature: labels.osm,
            class: labels.class,
        });
    }
    Ok(out)
}

/// The primitives of a node share their vertices.
fn mesh(node: &gltf::Node, blob: &[u8], materials: &[Arc<str>]) -> Option<Mesh> {
    let (translation, _, _) = node.transform().decomposed();
    let origin = Vec3::from_array(translation).as_dvec3();
    let mut out = Mesh::default();
    for (number, primitive) in node.mesh()?.primitives().enumerate() {
        let reader = primitive.reader(|buffer| (buffer.index() == 0).then_some(blob));
        if number == 0 {
            let place = |p: [f32; 3]| origin + Vec3::from_array(p).as_dvec3();
            out.positions = reader.read_positions()?.map(place).collect::<Vec<DVec3>>();
            out.normals = reader.read_normals()?.map(Vec3::from_array).collect();
        }
        // Materials differ in the sets they use.
        for set in 0.. {
            let Some(uvs) = reader.read_tex_coords(set) else { break };
            if !out.uvs.iter().any(|(known, _)| u32::from(*known) == set) {
                out.uvs.push((set as u8, uvs.into_f32().map(Vec2::from_array).collect()));
            }
        }
        let indices: Vec<u32> = reader.read_indices()?.into_u32().collect();
        let first = out.triangles.len() as u32;
        out.triangles.extend(indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]));
        let material = primitive.material().index().and_then(|index| materials.get(index).cloned());
        let count = out.triangles.len() as u32 - first;
        out.groups.push(MaterialGroup { material: material.unwrap_or_else(|| "none".into()), first, count });
    }
    let count = out.positions.len();
    let whole = out.normals.len() == count
        && out.uvs.iter().all(|(_, uvs)| uvs.len() == count)
        && out.triangles.iter().flatten().all(|&i| (i as usize) < count);
    whole.then_some(out)
}
