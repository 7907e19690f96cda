//! glTF 2.0. In: the bytes of a `.gltf` or `.glb` file and a way to the files it names. Out: its triangles in scene
//! coordinates with texture coordinates, materials, groups (one per node) and metadata. Points, lines, skins and
//! animations are left out.

mod accessor;
mod material;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec2, DVec3};
use gltf::mesh::Mode;
use percent_encoding::percent_decode_str;

use super::{Contents, Files};
use crate::geometry::Face;
use crate::geometry::transform::normals_under;
use crate::interpreter::tree::Scalar;
use accessor::{Buffers, MOST_ELEMENTS};

/// Nodes within nodes; deeper files are refused.
const DEEPEST: usize = 64;
/// Visits of nodes: a node with two parents is visited twice.
const MOST_VISITS: usize = 100_000;
const MOST_MATERIALS: usize = 10_000;
/// uv sets of the rule language.
const UV_SETS: u32 = 10;

/// Reads a file; the message says what is wrong with it.
pub fn read(bytes: &[u8], files: &Files) -> Result<Contents, String> {
    let (document, buffers) = open(bytes, files)?;
    if document.materials().len() > MOST_MATERIALS {
        return Err(format!("it has more than {MOST_MATERIALS} materials"));
    }
    let name_image = |image: &gltf::Image| image_name(image, files);
    let materials: Vec<_> = document.materials().map(|m| material::read(&m, &name_image)).collect();
    let mut reader =
        Reader { buffers: &buffers, materials: &materials, out: Contents::default(), elements: 0, visits: 0 };
    match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().try_for_each(|node| reader.node(&node, DMat4::IDENTITY, 0))?,
        None => document.nodes().try_for_each(|node| reader.node(&node, DMat4::IDENTITY, 0))?,
    }
    let mut out = reader.out;
    out.form.materials = materials.into_iter().map(|m| m.appearance).collect();
    out.metadata = metadata(&document);
    Ok(out)
}

/// The bytes of an image that lies inside the file, by its number.
pub fn embedded_image(bytes: &[u8], number: usize, files: &Files) -> Result<Vec<u8>, String> {
    let (document, buffers) = open(bytes, files)?;
    match document.images().nth(number).map(|image| image.source()) {
        Some(gltf::image::Source::View { view, .. }) => Ok(buffers.image(&view)?.to_vec()),
        Some(gltf::image::Source::Uri { uri, .. }) if uri.starts_with("data:") => data_uri(uri),
        _ => Err(format!("it holds no image {number}")),
    }
}

fn open(bytes: &[u8], files: &Files) -> Result<(gltf::Document, Buffers), String> {
    let gltf = gltf::Gltf::from_slice_without_validation(bytes).map_err(|e| e.to_string())?;
    let mut blob = gltf.blob;
    let document = checked(gltf.document.into_json())?;
    let mut buffers = Vec::new();
    for buffer in document.buffers() {
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => blob.take().ok_or("the binary chunk is missing")?,
            gltf::buffer::Source::Uri(uri) if uri.starts_with("data:") => data_uri(uri)?,
            gltf::buffer::Source::Uri(uri) => (files.read)(&file_name(uri)?)?,
        };
        if bytes.len() < buffer.length() {
            return Err(format!("buffer {} has {} bytes instead of {}", buffer.index(), bytes.len(), buffer.length()));
        }
        buffers.push(bytes);
    }
    Ok((document, Buffers(buffers)))
}

/// The document if every index in it leads somewhere. The validation of the `gltf` crate trusts the accessors of
/// positions and asks for bounds that many files do not have, so these are looked after first.
fn checked(mut json: gltf::json::Root) -> Result<gltf::Document, String> {
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    if primitives.flat_map(|p| p.attributes.values()).any(|accessor| accessor.value() >= json.accessors.len()) {
        return Err("a primitive names an accessor that is not there".into());
    }
    for accessor in &mut json.accessors {
        for bound in [&mut accessor.min, &mut accessor.max] {
            bound.get_or_insert_with(|| serde_json::json!([0.0, 0.0, 0.0]));
        }
    }
    gltf::Document::from_json(json).map_err(|e| e.to_string())
}

/// The bytes in a `data:` URI.
fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let source = gltf::buffer::Source::Uri(uri);
    gltf::buffer::Data::from_source(source, None).map(|data| data.0).map_err(|e| format!("a data URI: {e}"))
}

fn file_name(uri: &str) -> Result<String, String> {
    let decoded = percent_decode_str(uri).decode_utf8().map_err(|_| format!("`{uri:.80}` is no UTF-8 name"))?;
    if decoded.contains("://") {
        return Err(format!("`{decoded:.80}` lies in no folder"));
    }
    Ok(decoded.into_owned())
}

fn image_name(image: &gltf::Image, files: &Files) -> Option<String> {
    match image.source() {
        gltf::image::Source::Uri { uri, .. } if !uri.starts_with("data:") => Some((files.place)(&file_name(uri).ok()?)),
        _ => Some((files.embedded)(image.index())),
    }
}

struct Reader<'a> {
    buffers: &'a Buffers,
    materials: &'a [material::Read],
    out: Contents,
    elements: usize,
    visits: usize,
}

impl Reader<'_> {
    fn node(&mut self, node: &gltf::Node, above: DMat4, depth: usize) -> Result<(), String> {
        self.visits += 1;
        if depth > DEEPEST || self.visits > MOST_VISITS {
            return Err(format!("nodes go deeper than {DEEPEST} or are more than {MOST_VISITS}"));
        }
        let world = above * glam::Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        if let Some(mesh) = node.mesh() {
            let name =
                node.name().or_else(|| mesh.name()).map_or_else(|| format!("node{}", node.index()), str::to_owned);
            self.out.begin_group(&name)?;
            mesh.primitives().try_for_each(|primitive| self.primitive(&primitive, &world))?;
        }
        node.children().try_for_each(|child| self.node(&child, world, depth + 1))
    }

    fn primitive(&mut self, primitive: &gltf::Primitive, world: &DMat4) -> Result<(), String> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let positions = primitive.get(&gltf::Semantic::Positions).ok_or("a primitive has no positions")?;
        self.count(positions.count())?;
        let positions: Vec<DVec3> = (self.buffers.vectors::<3>(&positions)?.into_iter())
            .map(|p| world.transform_point3(DVec3::from_array(p)))
            .collect();
        if !positions.iter().all(|p| p.is_finite()) {
            return Err("a position is not a finite number".into());
        }
        let count = positions.len() as u32;
        let indices: Vec<u32> = match primitive.indices() {
            Some(indices) => {
                self.count(indices.count())?;
                self.buffers.indices(&indices)?
            }
            None => (0..count).collect(),
        };
        if indices.iter().any(|&i| i >= count) {
            return Err("an index points past the vertices".into());
        }
        let uvs = self.uv_sets(primitive, positions.len())?;
        let normals = self.normals(primitive, positions.len(), world)?;
        let first = self.out.form.mesh.positions.len() as u32;
        self.out.form.mesh.positions.extend(positions);
        // A mirrored node turns its triangles round.
        let mirrored = world.determinant() < 0.0;
        let material = primitive.material().index().map_or(0, |i| i as u16 + 1);
        for [a, b, c] in triangles(primitive.mode(), &indices) {
            let corners = if mirrored { [a, c, b] } else { [a, b, c] };
            let of = |uv: &Vec<DVec2>| corners.iter().map(|&i| uv[i as usize]).collect();
            let face = Face {
                uvs: uvs.iter().map(|(set, uv)| (*set, of(uv))).collect(),
                normals: normals.iter().flat_map(|n| corners.map(|i| n[i as usize])).collect(),
                ..Face::new(corners.map(|i| first + i).as_slice())
            };
            self.out.face(face, material);
        }
        Ok(())
    }

    /// Normals in the scene, if there are any and all have a direction.
    fn normals(&self, primitive: &gltf::Primitive, count: usize, world: &DMat4) -> Result<Option<Vec<DVec3>>, String> {
        let Some(accessor) = primitive.get(&gltf::Semantic::Normals).filter(|a| a.count() == count) else {
            return Ok(None);
        };
        let turn = normals_under(DMat3::from_mat4(*world));
        let read = self.buffers.vectors::<3>(&accessor)?;
        let turned: Vec<_> = read.into_iter().map(|n| (turn * DVec3::from_array(n)).try_normalize()).collect();
        Ok(turned.into_iter().collect())
    }

    fn count(&mut self, more: usize) -> Result<(), String> {
        self.elements = self.elements.saturating_add(more);
        if self.elements > MOST_ELEMENTS {
            return Err(format!("it has more than {MOST_ELEMENTS} vertices and indices"));
        }
        Ok(())
    }

    /// Texture coordinates by uv set: set n holds the file's coordinates n, but where the material's layer n uses
    /// others, it holds those. v runs up.
    fn uv_sets(&mut self, primitive: &gltf::Primitive, count: usize) -> Result<Vec<(u8, Vec<DVec2>)>, String> {
        let mut read = BTreeMap::new();
        for number in 0..UV_SETS {
            let Some(accessor) = primitive.get(&gltf::Semantic::TexCoords(number)) else { continue };
            if accessor.count() != count {
                return Err("texture coordinates and positions differ in number".into());
            }
            self.count(count)?;
            let uv = self.buffers.vectors::<2>(&accessor)?;
            if !uv.iter().flatten().all(|x| x.is_finite()) {
                return Err("a texture coordinate is not a finite number".into());
            }
            read.insert(number, uv.into_iter().map(|[u, v]| DVec2::new(u, 1.0 - v)).collect::<Vec<_>>());
        }
        let mut sets: BTreeMap<u8, u32> = read.keys().map(|&number| (number as u8, number)).collect();
        let material = primitive.material().index().and_then(|i| self.materials.get(i));
        for (layer, number) in material.iter().flat_map(|m| &m.coordinates).filter(|(_, n)| read.contains_key(n)) {
            // Layers without a set of their own use set 0.
            let set = *layer as u8;
            if set == 0 || sets.contains_key(&set) || sets.get(&0) != Some(number) {
                sets.insert(set, *number);
            }
        }
        Ok(sets.into_iter().map(|(set, number)| (set, read[&number].clone())).collect())
    }
}

fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
            .collect(),
        Mode::TriangleFan => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

/// Single values in the `extras` of the file, its asset block, its scene and its nodes; of equal keys the first counts.
fn metadata(document: &gltf::Document) -> BTreeMap<Arc<str>, Scalar> {
    let json = document.as_json();
    let scene = document.default_scene().and_then(|s| s.extras().as_deref().map(|e| e.get()));
    let blocks = [json.extras.as_deref(), json.asset.extras.as_deref()].into_iter().flatten().map(|e| e.get());
    let nodes = document.nodes().filter_map(|node| node.extras().as_deref().map(|e| e.get()));
    let mut out = BTreeMap::new();
    for text in blocks.chain(scene).chain(nodes) {
        let Ok(serde_json::Value::Object(fields)) = serde_json::from_str(text) else { continue };
        for (key, value) in fields {
            let value = match value {
                serde_json::Value::Number(x) => Scalar::Float(x.as_f64().unwrap_or(f64::NAN)),
                serde_json::Value::Bool(b) => Scalar::Bool(b),
                serde_json::Value::String(s) => Scalar::String(s.into()),
                _ => continue,
            };
            out.entry(key.into()).or_insert(value);
        }
    }
    out
}
