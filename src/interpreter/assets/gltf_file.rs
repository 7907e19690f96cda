//! glTF 2.0. In: the bytes of a `.gltf` or `.glb` file. Out: its triangles in scene coordinates with texture
//! coordinates, normals, material colours, and a group per named node (or mesh). Points, lines, skins and animations are left out.

use std::path::Path;

use glam::{DMat3, DMat4, DVec2, DVec3};
use gltf::mesh::Mode;

use super::AssetError;
use crate::geometry::Face;
use crate::geometry::transform::normals_under;
use crate::interpreter::appearance::Appearance;
use crate::interpreter::form::Form;
use crate::interpreter::labels::GroupList;
use crate::source::Access;

pub fn read(name: &str, bytes: &[u8], folder: &Path, access: &Access) -> Result<Form, AssetError> {
    let wrong = |message: String| AssetError::Gltf(name.to_owned(), message);
    let gltf = gltf::Gltf::from_slice(bytes).map_err(|e| wrong(e.to_string()))?;
    for buffer in gltf.document.buffers() {
        if let gltf::buffer::Source::Uri(uri) = buffer.source()
            && !uri.starts_with("data:")
        {
            access.resolve(folder, uri).map_err(|e| wrong(e.to_string()))?;
        }
    }
    let buffers = gltf::import_buffers(&gltf.document, Some(folder), gltf.blob).map_err(|e| wrong(e.to_string()))?;
    let mut reader = Reader {
        buffers: &buffers,
        form: Form::default(),
        groups: GroupList::default(),
        has_uvs: true,
        has_normals: true,
    };
    let document = &gltf.document;
    match document.default_scene().or_else(|| document.scenes().next()) {
        Some(scene) => scene.nodes().try_for_each(|node| reader.node(&node, DMat4::IDENTITY, 0)),
        None => document.nodes().try_for_each(|node| reader.node(&node, DMat4::IDENTITY, 0)),
    }
    .map_err(wrong)?;
    let mut form = reader.form;
    if !reader.has_uvs {
        form.mesh.faces.iter_mut().for_each(|f| f.uvs.clear());
    }
    if !reader.has_normals {
        form.mesh.faces.iter_mut().for_each(|f| f.normals.clear());
    }
    form.labels = reader.groups.into_labels();
    form.materials = document.materials().map(|m| appearance(&m, folder)).collect();
    form.instanced = true;
    Ok(form)
}

struct Reader<'a> {
    buffers: &'a [gltf::buffer::Data],
    form: Form,
    groups: GroupList,
    has_uvs: bool,
    has_normals: bool,
}

/// Nodes within nodes; deeper files are refused.
const DEEPEST: usize = 64;

impl Reader<'_> {
    fn node(&mut self, node: &gltf::Node, above: DMat4, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!("nodes go deeper than {DEEPEST}"));
        }
        let own = glam::Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let world = above * own;
        self.groups.begin(node.name().or(node.mesh().and_then(|mesh| mesh.name())).unwrap_or(""));
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            self.primitive(&primitive, &world)?;
        }
        node.children().try_for_each(|child| self.node(&child, world, depth + 1))
    }

    fn primitive(&mut self, primitive: &gltf::Primitive, world: &DMat4) -> Result<(), String> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(|data| &data.0[..]));
        let start = self.form.mesh.positions.len() as u32;
        let positions: Vec<DVec3> = reader
            .read_positions()
            .ok_or("a primitive has no positions")?
            .map(|p| world.transform_point3(glam::Vec3::from_array(p).as_dvec3()))
            .collect();
        if !positions.iter().all(|p| p.is_finite()) {
            return Err("a position is not a finite number".into());
        }
        let count = positions.len() as u32;
        // glTF counts v downwards.
        let uvs: Option<Vec<DVec2>> = reader
            .read_tex_coords(0)
            .map(|set| set.into_f32().map(|[u, v]| DVec2::new(f64::from(u), 1.0 - f64::from(v))).collect());
        let mirrored = world.determinant() < 0.0;
        let turn = normals_under(DMat3::from_mat4(*world));
        let normals: Option<Vec<DVec3>> = reader
            .read_normals()
            .map(|list| list.map(|n| (turn * glam::Vec3::from_array(n).as_dvec3()).normalize_or_zero()).collect());
        let indices: Vec<u32> = match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..count).collect(),
        };
        if indices.iter().any(|&i| i >= count) {
            return Err("an index points past the vertices".into());
        }
        self.form.mesh.positions.extend(positions);
        let material = primitive.material().index().map_or(0, |i| i as u16 + 1);
        let uvs = uvs.filter(|uv| uv.len() == count as usize);
        self.has_uvs &= uvs.is_some();
        let sound = |list: &Vec<DVec3>| list.len() == count as usize && list.iter().all(|n| n.is_normalized());
        let normals = normals.filter(sound);
        self.has_normals &= normals.is_some();
        for mut corners in triangles(primitive.mode(), &indices) {
            if mirrored {
                corners.swap(1, 2);
            }
            let outer = corners.map(|i| i + start);
            let set = uvs.as_ref().map(|uv| (0, corners.map(|i| uv[i as usize]).as_slice().into()));
            let normals = normals.iter().flat_map(|list| corners.map(|i| list[i as usize])).collect();
            let uvs = set.into_iter().collect();
            self.form.mesh.faces.push(Face { uvs, normals, ..Face::new(outer.as_slice()) });
            self.groups.add_face();
            self.form.face_materials.push(material);
        }
        Ok(())
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

fn appearance(material: &gltf::Material, folder: &Path) -> Appearance {
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, a] = pbr.base_color_factor().map(f64::from);
    let texture = pbr.base_color_texture().map(|info| info.texture().source().source());
    let colormap = match texture {
        Some(gltf::image::Source::Uri { uri, .. }) if !uri.starts_with("data:") => {
            Some(folder.join(uri).to_string_lossy().into())
        }
        _ => None,
    };
    Appearance {
        name: material.name().map(Into::into),
        color: [r, g, b].map(|linear| Some(srgb_encoded(linear))),
        opacity: Some(a),
        roughness: Some(f64::from(pbr.roughness_factor())),
        metallic: Some(f64::from(pbr.metallic_factor())),
        colormap,
        other: Vec::new(),
    }
}

/// IEC 61966-2-1.
fn srgb_encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}
