//! Geometry files: what is read of them, and that what is wrong with them is said.

use super::*;
use crate::cga::builtins::{MapLayer, MapPart, MaterialAttr};
use crate::interpreter::value::Value;

/// A reader's way to other files: `red.mtl` is there, nothing else.
fn with_files<T>(read: impl FnOnce(&Files) -> T) -> T {
    let bytes = |name: &str| match name {
        "red.mtl" => Ok(b"newmtl red\nKd 1 0 0\nd 0.5\nmap_Kd wall.png\n".to_vec()),
        "positions.bin" => Ok(positions_bytes()),
        other => Err(format!("{other} was not found")),
    };
    let place = |file: &str| format!("place/{file}");
    let embedded = |number: usize| format!("inside#{number}");
    read(&Files { read: &bytes, place: &place, embedded: &embedded })
}

fn obj(text: &str) -> Result<Asset, obj::Wrong> {
    with_files(|files| obj::read(text.as_bytes(), files).map(Asset::from))
}

fn gltf(json: &serde_json::Value) -> Result<Asset, String> {
    with_files(|files| gltf_file::read(json.to_string().as_bytes(), files).map(Asset::from))
}

fn outer(asset: &Asset, face: usize) -> Vec<[f64; 3]> {
    let mesh = &asset.form.mesh;
    mesh.faces[face].outer.iter().map(|&v| mesh.positions[v as usize].to_array()).collect()
}

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 2 0\n";

#[test]
fn obj_faces_have_materials_uvs_normals_and_groups() {
    let asset = obj(&format!(
        "# comment\r\nmtllib red.mtl\r\n{CORNERS}g first part\nusemtl red\nf 1/1/1 2/2/1 3/3/1\n\
         usemtl unknown\nf -4/-3/-1 -2/-1/-1 \\\n-1/-2/-1 # the same corners from the end\ng second\nf 1 2 3 4\n"
    ))
    .expect("the file is sound");
    let form = &asset.form;
    assert_eq!(outer(&asset, 1), [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    assert_eq!(form.face_materials, [1, 2, 2]);
    assert_eq!(form.materials[0].get(MaterialAttr::Opacity), Some(Value::Float(0.5)));
    assert_eq!(form.materials[0].colormap.as_deref(), Some("place/wall.png"));
    assert_eq!(form.mesh.faces[0].uv(0).map(|uv| uv[2].to_array()), Some([1.0, 1.0]));
    assert_eq!(form.mesh.faces[0].normals, [DVec3::Y; 3]);
    assert!(form.mesh.faces[2].uv(0).is_none() && form.mesh.faces[2].normals.is_empty());
    let names = |names: Vec<Arc<str>>| names.join(" | ");
    assert_eq!(names(asset.groups()), "first | second");
    assert_eq!(names(asset.materials()), "red | unknown");
    assert_eq!((form.group(1), form.group(2)), (1, 2));
}

#[test]
fn channels_that_only_some_faces_of_a_group_have_go() {
    let asset = obj(&format!("{CORNERS}g a\nf 1/1 2/2 3/3\nf 1 2 4\ng b\nf 1/1 2/2 3/3\n")).expect("the file is sound");
    let has: Vec<bool> = asset.form.mesh.faces.iter().map(|f| f.uv(0).is_some()).collect();
    assert_eq!(has, [false, false, true]);
}

#[test]
fn a_missing_library_is_noted_and_its_materials_keep_their_names() {
    let asset = obj(&format!("mtllib gone.mtl red.mtl\n{CORNERS}usemtl red\nf 1 2 3\n")).expect("the file is sound");
    assert_eq!(asset.notes, ["gone.mtl was not found"]);
    assert_eq!(asset.form.materials[0].color[0], Some(1.0));
    let asset = obj(&format!("mtllib gone.mtl\n{CORNERS}usemtl red\nf 1 2 3\n")).expect("the file is sound");
    assert_eq!((asset.materials().join(" "), asset.form.materials[0].color[0]), ("red".to_owned(), None));
}

#[test]
fn wrong_lines_of_an_obj_are_named() {
    let cases = [
        ("v 0 0\n", 1),
        ("v 0 0 0\nf 1 2 3\n", 2),
        ("v 0 0 x\n", 1),
        ("v 0 0 0\n\nf 1 1\n", 3),
        ("v 0 0 nan", 1),
        ("v 0 0 0\nf 1 1 -2\n", 2),
        ("v 0 0 0\nf 0 1 1\n", 2),
        ("v 0 0 0\nf 1/9 1/9 1/9\n", 2),
        ("v 0 0 0\nf 1//9 1//9 1//9\n", 2),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", 2),
        ("v 0 0 0\nf 1 1 -9223372036854775808\n", 2),
    ];
    for (text, line) in cases {
        match obj(text) {
            Err((found, _)) => assert_eq!(found, line, "{text}"),
            Ok(_) => panic!("{text} was read"),
        }
    }
    assert!(obj("").is_ok_and(|asset| asset.form.is_empty()));
}

/// Four corners of a unit square in the xy-plane.
fn positions_bytes() -> Vec<u8> {
    let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
}

/// A file of one square: 48 bytes of positions, 32 of texture coordinates, 6 of indices.
fn square() -> serde_json::Value {
    let mut bytes = positions_bytes();
    let uvs: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    bytes.extend(uvs.iter().flatten().flat_map(|x| x.to_le_bytes()));
    bytes.extend([0u8, 1, 2, 0, 2, 3]);
    serde_json::json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "name": "square" }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2 }] }],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes)) }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 6 }
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ]
    })
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize] as char;
            out.push(if i <= chunk.len() { digit } else { '=' });
        }
    }
    out
}

#[test]
fn gltf_nodes_place_their_meshes() {
    let mut file = square();
    file["scenes"][0]["nodes"] = serde_json::json!([1]);
    file["nodes"] = serde_json::json!([
        { "mesh": 0, "name": "low", "scale": [2, 2, 2] },
        { "name": "above", "translation": [10, 0, 0], "children": [0, 2] },
        { "mesh": 0, "name": "mirrored", "scale": [1, -1, 1] },
        { "mesh": 0, "name": "in no scene" }
    ]);
    let asset = gltf(&file).expect("the file is sound");
    assert_eq!((asset.low.to_array(), asset.size.to_array()), ([10.0, -1.0, 0.0], [2.0, 3.0, 0.0]));
    assert_eq!(asset.groups().join(" "), "low mirrored");
    assert_eq!(outer(&asset, 0), [[10.0, 0.0, 0.0], [12.0, 0.0, 0.0], [12.0, 2.0, 0.0]]);
    // A mirrored face still looks the same way.
    let mesh = &asset.form.mesh;
    assert!(mesh.faces.iter().all(|face| mesh.normal(face) == DVec3::Z));
    assert_eq!(
        mesh.faces[0].uv(0).map(|uv| uv.iter().map(|p| p.to_array()).collect::<Vec<_>>()),
        Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    );
}

#[test]
fn gltf_buffers_may_be_files() {
    let mut file = square();
    file["buffers"] = serde_json::json!([{ "byteLength": 48, "uri": "positions%2Ebin" }]);
    file["meshes"][0]["primitives"][0] = serde_json::json!({ "attributes": { "POSITION": 0 }, "mode": 5 });
    file["bufferViews"] = serde_json::json!([{ "buffer": 0, "byteLength": 48 }]);
    file["accessors"] = serde_json::json!([file["accessors"][0]]);
    let asset = gltf(&file).expect("the file is sound");
    assert_eq!(asset.form.mesh.faces.len(), 2, "a strip of four");
    for (uri, why) in [
        ("gone.bin", "gone.bin was not found"),
        ("file:///etc/passwd", "in no folder"),
        ("%ff.bin", "no UTF-8"),
        ("data:x;base64,%%", "data URI"),
    ] {
        file["buffers"][0]["uri"] = uri.into();
        assert!(gltf(&file).is_err_and(|e| e.contains(why)), "{uri}: {:?}", gltf(&file));
    }
}

#[test]
fn gltf_accessors_may_be_sparse_normalised_or_absent() {
    let mut file = square();
    // Without bytes all positions are 0; one is put elsewhere.
    file["accessors"][0] = serde_json::json!({
        "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 0],
        "sparse": { "count": 1, "indices": { "bufferView": 2, "byteOffset": 1, "componentType": 5121 },
                    "values": { "bufferView": 0, "byteOffset": 12 } }
    });
    let asset = gltf(&file).expect("the file is sound");
    assert_eq!(outer(&asset, 0), [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]]);
    let mut file = square();
    file["accessors"][1] =
        serde_json::json!({ "bufferView": 1, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2" });
    let asset = gltf(&file).expect("the file is sound");
    let uv = asset.form.mesh.faces[0].uv(0).expect("it has some");
    // The bytes of 0.0f32 and 1.0f32.
    assert!((uv[2].x - 0.0).abs() < 1e-12 && (uv[3 - 1].y - 1.0).abs() < 1e-12, "{uv:?}");
}

#[test]
fn gltf_files_that_cannot_be_true_are_refused() {
    type Edit = fn(&mut serde_json::Value);
    let cases: &[(Edit, &str)] = &[
        (|f| f["accessors"][0]["count"] = 5.into(), "passes the end"),
        (|f| f["accessors"][0]["count"] = 4_000_000_000u32.into(), "more than"),
        (|f| f["accessors"][0]["byteOffset"] = u64::MAX.into(), "passes the end"),
        (|f| f["bufferViews"][0]["byteLength"] = 4000.into(), "passes the end of its buffer"),
        (|f| f["bufferViews"][0]["byteStride"] = 4.into(), "overlap"),
        (|f| f["buffers"][0]["byteLength"] = 4000.into(), "instead of 4000"),
        (|f| f["accessors"][2]["componentType"] = 5126.into(), "whole numbers"),
        (|f| f["accessors"][0]["type"] = "VEC2".into(), "vectors of 3"),
        (|f| f["accessors"][1]["count"] = 3.into(), "differ in number"),
        (|f| f["accessors"][2]["count"] = 0.into(), ""),
        (|f| f["meshes"][0]["primitives"][0]["attributes"] = serde_json::json!({ "TEXCOORD_0": 1 }), ""),
        (
            |f| f["accessors"][2] = serde_json::json!({ "bufferView": 1, "byteOffset": 4, "componentType": 5121, "count": 6, "type": "SCALAR" }),
            "past the vertices",
        ),
        (|f| f["nodes"][0]["children"] = serde_json::json!([0]), "deeper"),
        (|f| f["extensionsRequired"] = serde_json::json!(["KHR_draco_mesh_compression"]), ""),
        (|f| f["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 77.into(), "not there"),
        (|f| f["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 77.into(), "not there"),
    ];
    for (number, (edit, why)) in cases.iter().enumerate() {
        let mut file = square();
        edit(&mut file);
        match gltf(&file) {
            Err(message) => assert!(message.contains(why), "case {number}: {message}"),
            Ok(asset) => assert!(why.is_empty() && asset.form.mesh.faces.is_empty(), "case {number} was read"),
        }
    }
    assert!(with_files(|files| gltf_file::read(b"glTF\x02\0\0\0\xff\xff\xff\xff", files)).is_err());
    assert!(with_files(|files| gltf_file::read(b"", files)).is_err());
}

#[test]
fn a_web_of_nodes_ends() {
    let mut file = square();
    // Each node has the next one twice: 2^60 ways through.
    let node = |i: usize| match i {
        59 => serde_json::json!({ "mesh": 0 }),
        i => serde_json::json!({ "children": [i + 1, i + 1] }),
    };
    file["nodes"] = (0..60).map(node).collect();
    assert!(gltf(&file).is_err_and(|e| e.contains("more than 100000")));
}

#[test]
fn gltf_materials_become_attributes() {
    let mut file = square();
    file["materials"] = serde_json::json!([{
        "name": "brass", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [0.0, 1.0, 0.0],
        "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 0.0, 0.0, 0.5], "metallicFactor": 0.75, "roughnessFactor": 0.125,
            "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0], "scale": [2, 4] } } },
            "metallicRoughnessTexture": { "index": 1, "texCoord": 1 }
        },
        "normalTexture": { "index": 1 }
    }]);
    file["images"] = serde_json::json!([{ "uri": "wall%20one.png" }, { "bufferView": 1, "mimeType": "image/png" }]);
    file["textures"] = serde_json::json!([{ "source": 0 }, { "source": 1 }]);
    let primitive = &mut file["meshes"][0]["primitives"][0];
    primitive["material"] = 0.into();
    primitive["attributes"]["TEXCOORD_1"] = 1.into();
    let asset = gltf(&file).expect("the file is sound");
    let look = &asset.form.materials[0];
    let get = |attr| look.get(attr);
    let map = |layer, part| get(MaterialAttr::Map(layer, part));
    assert_eq!(
        (look.name.as_deref(), look.opacity, look.metallic, look.roughness),
        (Some("brass"), Some(0.5), Some(0.75), Some(0.125))
    );
    assert_eq!(get(MaterialAttr::Emissive(1)), Some(Value::Float(1.0)));
    assert_eq!(get(MaterialAttr::OpacityMode), Some(Value::text("mask")));
    assert_eq!(get(MaterialAttr::OpacityCutoff), Some(Value::Float(0.25)));
    assert_eq!(get(MaterialAttr::DoubleSided), Some(Value::Bool(true)));
    assert_eq!(map(MapLayer::Color, MapPart::Path), Some(Value::text("place/wall one.png")));
    assert_eq!(map(MapLayer::Opacity, MapPart::Path), Some(Value::text("place/wall one.png")));
    assert_eq!(map(MapLayer::Normal, MapPart::Path), Some(Value::text("inside#1")));
    assert_eq!(map(MapLayer::Metallic, MapPart::Path), Some(Value::text("inside#1")));
    // v' = 1 - 4 (1 - v) in the file's sense is 4 v - 3 upwards.
    assert_eq!(map(MapLayer::Color, MapPart::ScaleV), Some(Value::Float(4.0)));
    assert_eq!(map(MapLayer::Color, MapPart::OffsetV), Some(Value::Float(-3.0)));
    assert_eq!(map(MapLayer::Color, MapPart::OffsetU), Some(Value::Float(0.5)));
    let sets: Vec<u8> = asset.form.mesh.faces[0].uvs.iter().map(|(set, _)| *set).collect();
    assert_eq!(sets, [0, 1, 8, 9], "layers 8 and 9 use the file's coordinates 1, layer 5 uses set 0");
    let image = with_files(|files| gltf_file::embedded_image(file.to_string().as_bytes(), 1, files));
    assert_eq!(image.map(|bytes| bytes.len()), Ok(32));
}

proptest::proptest! {
    /// Files that were damaged are read or refused, never a panic.
    #[test]
    fn damaged_files_end_in_words(at in 0usize..4000, byte in 0u8..=255) {
        let mut bytes = square().to_string().into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        let _ = with_files(|files| gltf_file::read(&bytes, files).map(Asset::from));
        let mut text = format!("mtllib red.mtl\n{CORNERS}g a\nusemtl red\nf 1/1/1 2/2/1 3/3/1\nf -1 -2 -3\n").into_bytes();
        let at = at % text.len();
        text[at] = byte;
        let _ = with_files(|files| obj::read(&text, files).map(Asset::from));
    }
}
