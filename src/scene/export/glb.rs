//! A scene as binary glTF 2.0. In: a [`Scene`]. Out: one `.glb` with two glTF scenes, `before` and `after`, that share
//! the nodes of everything that does not change.
//!
//! One node per feature and state, named by its OSM id, with `osm`, `class`, `instance`, `change` and `level` in its
//! extras; separate normals; positions in metres (x east, y up, z south) as f32 about the node's translation, so
//! that precision does not depend on where the feature lies.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::Arc;

use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Stride, Target, View};
use gltf::json::extras::RawValue;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::texture::{MagFilter, MinFilter, Sampler, WrappingMode};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{self, Index, Root};
use image::RgbaImage;

use super::material::{TRANSFORM_EXTENSION, Textures, uv_slots};
use crate::scene::{Group, Presence, Scene, SceneObject, TriMesh};

/// Why a scene could not be written as glTF.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    #[error("texture `{name}` cannot be encoded: {source}")]
    Texture { name: Arc<str>, source: image::ImageError },
    #[error("a binary glTF file holds at most 4 GiB; this scene needs {0} bytes")]
    TooLarge(usize),
    #[error("glTF cannot be written: {0}")]
    Gltf(#[from] gltf::Error),
    #[error("glTF cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// Bytes of the binary chunk, one run per kind of data.
#[derive(Default)]
struct Data {
    positions: Vec<u8>,
    normals: Vec<u8>,
    uvs: Vec<u8>,
    indices: Vec<u8>,
    images: Vec<Vec<u8>>,
}

/// Index of the buffer views, in the order of [`views`].
const POSITIONS: u32 = 0;
const NORMALS: u32 = 1;
const UVS: u32 = 2;
const INDICES: u32 = 3;
const FIRST_IMAGE: u32 = 4;

/// Encodes a scene. `copyright` goes into the asset block (map attribution).
pub fn to_glb(scene: &Scene, copyright: &str) -> Result<Vec<u8>, ExportError> {
    let mut root = Root {
        asset: json::Asset {
            copyright: (!copyright.is_empty()).then(|| copyright.to_owned()),
            generator: Some(format!("mansard {}", env!("CARGO_PKG_VERSION"))),
            ..json::Asset::default()
        },
        ..Root::default()
    };
    let mut data = Data::default();
    let slots = uv_slots(scene);
    let mut made = Textures::new(scene);
    root.materials = scene.materials.iter().zip(&slots).map(|(m, slots)| made.material(m, slots)).collect();
    if made.transformed {
        root.extensions_used.push(TRANSFORM_EXTENSION.to_owned());
    }
    textures(scene, &made.made, &mut root, &mut data)?;
    let mut states = [("before", Vec::new()), ("after", Vec::new())];
    for object in scene.objects.iter().filter(|o| !o.mesh.triangles.is_empty()) {
        let node = node(object, &slots, &mut root, &mut data);
        for (list, absent) in states.iter_mut().zip([Presence::AfterOnly, Presence::BeforeOnly]) {
            if object.presence != absent {
                list.1.push(node);
            }
        }
    }
    root.scenes = states.into_iter().map(|(name, nodes)| gltf_scene(name, nodes)).collect();
    root.scene = Some(Index::new(0));
    assemble(root, data)
}

fn gltf_scene(name: &str, nodes: Vec<Index<json::Node>>) -> json::Scene {
    json::Scene { extensions: None, extras: None, name: Some(name.to_owned()), nodes }
}

fn textures(
    scene: &Scene,
    made: &[(Arc<str>, RgbaImage)],
    root: &mut Root,
    data: &mut Data,
) -> Result<(), ExportError> {
    let own = scene.textures.iter().map(|(name, pixels)| (name, &**pixels));
    let all: Vec<(&Arc<str>, &RgbaImage)> = own.chain(made.iter().map(|(name, pixels)| (name, pixels))).collect();
    if all.is_empty() {
        return Ok(());
    }
    root.samplers.push(Sampler {
        mag_filter: Some(Checked::Valid(MagFilter::Linear)),
        min_filter: Some(Checked::Valid(MinFilter::LinearMipmapLinear)),
        name: None,
        wrap_s: Checked::Valid(WrappingMode::Repeat),
        wrap_t: Checked::Valid(WrappingMode::Repeat),
        extensions: None,
        extras: None,
    });
    for (number, (name, pixels)) in all.into_iter().enumerate() {
        data.images.push(png(name, pixels)?);
        root.images.push(json::Image {
            buffer_view: Some(Index::new(FIRST_IMAGE + number as u32)),
            mime_type: Some(json::image::MimeType("image/png".to_owned())),
            name: Some(name.to_string()),
            uri: None,
            extensions: None,
            extras: None,
        });
        root.textures.push(json::Texture {
            name: None,
            sampler: Some(Index::new(0)),
            source: Index::new(number as u32),
            extensions: None,
            extras: None,
        });
    }
    Ok(())
}

fn png(name: &Arc<str>, pixels: &RgbaImage) -> Result<Vec<u8>, ExportError> {
    let mut out = Cursor::new(Vec::new());
    pixels
        .write_to(&mut out, image::ImageFormat::Png)
        .map_err(|source| ExportError::Texture { name: name.clone(), source })?;
    Ok(out.into_inner())
}

fn node(object: &SceneObject, slots: &[Vec<u8>], root: &mut Root, data: &mut Data) -> Index<json::Node> {
    let mesh = &object.mesh;
    let origin = mesh.positions[0].as_vec3();
    let (positions, count) = (data.positions.len(), mesh.positions.len());
    let (mut least, mut greatest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in &mesh.positions {
        let local = (*p - origin.as_dvec3()).as_vec3().to_array();
        for axis in 0..3 {
            least[axis] = least[axis].min(local[axis]);
            greatest[axis] = greatest[axis].max(local[axis]);
        }
        data.positions.extend(local.iter().flat_map(|v| v.to_le_bytes()));
    }
    let normals = data.normals.len();
    data.normals.extend(mesh.normals.iter().flat_map(|n| n.to_array()).flat_map(f32::to_le_bytes));
    let coordinates = coordinates(mesh, root, data);

    let mut positions = accessor(POSITIONS, positions, count, Type::Vec3, ComponentType::F32);
    positions.min = Some(serde_json::json!(least));
    positions.max = Some(serde_json::json!(greatest));
    let attributes = [
        (Semantic::Positions, root.push(positions)),
        (Semantic::Normals, root.push(accessor(NORMALS, normals, count, Type::Vec3, ComponentType::F32))),
    ];
    let of = |set: u8| coordinates.get(&set).unwrap_or(&coordinates[&0]);
    let primitives = mesh.groups.iter().filter(|g| g.count > 0).map(|group| Primitive {
        attributes: (attributes.iter().cloned())
            .chain((0..).zip(std::iter::once(&0).chain(&slots[group.material as usize])).map(|(slot, set)| {
                // Two names of one set would be one accessor named twice, which is allowed.
                (Semantic::TexCoords(slot), *of(*set))
            }))
            .map(|(semantic, accessor)| (Checked::Valid(semantic), accessor))
            .collect(),
        indices: Some(indices(mesh, group, root, data)),
        material: Some(Index::new(group.material)),
        mode: Checked::Valid(Mode::Triangles),
        extensions: None,
        extras: None,
        targets: None,
    });
    let primitives = primitives.collect();
    let name = object.feature.map_or_else(|| "terrain".to_owned(), |f| f.to_string());
    let gltf_mesh = root.push(json::Mesh { primitives, name: None, weights: None, extensions: None, extras: None });
    root.push(json::Node {
        mesh: Some(gltf_mesh),
        translation: Some(origin.to_array()),
        extras: Some(extras(object, &name)),
        name: Some(name),
        ..json::Node::default()
    })
}

/// Accessors of the texture coordinates by uv set; v runs down.
fn coordinates(mesh: &TriMesh, root: &mut Root, data: &mut Data) -> BTreeMap<u8, Index<json::Accessor>> {
    let others = mesh.uv_sets.iter().map(|(set, uvs)| (*set, uvs));
    let sets: Vec<(u8, &Vec<glam::Vec2>)> = std::iter::once((0, &mesh.uvs)).chain(others).collect();
    let mut out = BTreeMap::new();
    for (set, uvs) in sets {
        let start = data.uvs.len();
        data.uvs.extend(uvs.iter().flat_map(|uv| [uv.x, 1.0 - uv.y]).flat_map(f32::to_le_bytes));
        out.insert(set, root.push(accessor(UVS, start, uvs.len(), Type::Vec2, ComponentType::F32)));
    }
    out
}

fn indices(mesh: &TriMesh, group: &Group, root: &mut Root, data: &mut Data) -> Index<json::Accessor> {
    let start = data.indices.len();
    let triangles = &mesh.triangles[group.first as usize..(group.first + group.count) as usize];
    data.indices.extend(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()));
    root.push(accessor(INDICES, start, triangles.len() * 3, Type::Scalar, ComponentType::U32))
}

fn accessor(view: u32, offset: usize, count: usize, kind: Type, component: ComponentType) -> json::Accessor {
    json::Accessor {
        buffer_view: Some(Index::new(view)),
        byte_offset: Some(USize64::from(offset)),
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component)),
        type_: Checked::Valid(kind),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
        extensions: None,
        extras: None,
    }
}

fn extras(object: &SceneObject, name: &str) -> Box<RawValue> {
    let presence = match object.presence {
        Presence::Both => "both",
        Presence::BeforeOnly => "before",
        Presence::AfterOnly => "after",
    };
    let values = serde_json::json!({
        "osm": name,
        "class": object.class.name(),
        "instance": object.instance,
        "state": presence,
        "change": object.change,
        "level": object.level,
    });
    RawValue::from_string(values.to_string()).expect("serde_json writes valid JSON")
}

/// Lays the runs one after another on four-byte borders and packs the file.
fn assemble(mut root: Root, data: Data) -> Result<Vec<u8>, ExportError> {
    let mut bin = Vec::new();
    let runs = [(data.positions, 12), (data.normals, 12), (data.uvs, 8)];
    for (bytes, stride) in runs {
        let view = view(&mut bin, &bytes, Some(Stride(stride)), Some(Target::ArrayBuffer));
        root.buffer_views.push(view);
    }
    let indices = view(&mut bin, &data.indices, None, Some(Target::ElementArrayBuffer));
    root.buffer_views.push(indices);
    for image in data.images {
        let image = view(&mut bin, &image, None, None);
        root.buffer_views.push(image);
    }
    if root.meshes.is_empty() && root.images.is_empty() {
        root.buffer_views.clear();
    } else {
        root.buffers.push(json::Buffer {
            byte_length: USize64::from(bin.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        });
    }
    let json = serde_json::to_vec(&root)?;
    let length = 12 + 8 + json.len().next_multiple_of(4) + 8 + bin.len();
    let Ok(length) = u32::try_from(length) else { return Err(ExportError::TooLarge(length)) };
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length };
    let bin = (!root.buffers.is_empty()).then_some(bin.into());
    Ok(gltf::binary::Glb { header, json: json.into(), bin }.to_vec()?)
}

fn view(bin: &mut Vec<u8>, bytes: &[u8], stride: Option<Stride>, target: Option<Target>) -> View {
    let offset = bin.len();
    bin.extend_from_slice(bytes);
    bin.resize(bin.len().next_multiple_of(4), 0);
    View {
        buffer: Index::new(0),
        byte_length: USize64::from(bytes.len()),
        byte_offset: Some(USize64::from(offset)),
        byte_stride: stride,
        target: target.map(Checked::Valid),
        name: None,
        extensions: None,
        extras: None,
    }
}
