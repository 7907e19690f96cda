//! Materials with textures on several uv sets, written and read by someone else's parser.

use glam::{DVec2, DVec3};

use super::*;
use crate::geometry::{Face, Mesh};
use crate::scene::export::to_glb;
use crate::scene::triangles::Builder;
use crate::scene::{Presence, SceneClass, SceneObject};

const SQUARE: [DVec3; 4] =
    [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];

/// A face whose coordinates in each set are those of its corners plus the set's number.
fn face(sets: &[u8]) -> Face {
    let uvs = |set: u8| SQUARE.iter().map(|p| DVec2::new(p.x, p.y) + f64::from(set)).collect();
    Face { uvs: sets.iter().map(|&set| (set, uvs(set))).collect(), ..Face::new(vec![0, 1, 2, 3]) }
}

fn map(layer: MapLayer, path: &str, scale: [f64; 2]) -> TextureMap {
    TextureMap { layer, path: path.into(), transform: MapTransform { scale, ..MapTransform::IDENTITY } }
}

fn scene(faces: &[Face], material: Material) -> Scene {
    let mut builder = Builder::default();
    let mesh = Mesh { positions: SQUARE.to_vec(), faces: Vec::new() };
    let material = Arc::new(material);
    faces.iter().for_each(|face| builder.face(&mesh, face, &material, DVec3::ZERO));
    let (mesh, materials) = builder.finish();
    let class = SceneClass::Building;
    let object = SceneObject {
        feature: None,
        instance: 1,
        class,
        presence: Presence::Both,
        change: 0,
        level: 0,
        mesh: mesh.into(),
    };
    let image = |side: u32, pixel: [u8; 4]| Arc::new(RgbaImage::from_pixel(side, side, Rgba(pixel)));
    let textures = vec![
        ("metal".into(), image(1, [1, 2, 30, 255])),
        ("normal".into(), image(1, [128, 128, 255, 255])),
        ("rough".into(), image(2, [4, 50, 6, 255])),
        ("wall".into(), image(1, [9; 4])),
    ];
    Scene { objects: vec![object], materials, textures, ..Scene::default() }
}

fn written(scene: &Scene) -> (gltf::Document, Vec<gltf::buffer::Data>, Vec<gltf::image::Data>) {
    let glb = to_glb(scene, "").expect("it can be written");
    gltf::import_slice(glb).expect("someone else's parser reads it")
}

#[test]
fn layers_use_their_own_uv_set_where_there_is_one() {
    let maps = vec![map(MapLayer::Normal, "normal", [1.0, 1.0]), map(MapLayer::Occlusion, "rough", [1.0, 1.0])];
    let scene =
        scene(&[face(&[0, 5]), face(&[0])], Material { colormap: Some("wall".into()), maps, ..Material::default() });
    let (document, buffers, _) = written(&scene);
    let material = document.materials().next().expect("there is one");
    assert_eq!(material.normal_texture().map(|t| t.tex_coord()), Some(1));
    assert_eq!(material.occlusion_texture().map(|t| t.tex_coord()), Some(0), "it has no set 7");
    let primitive = document.meshes().next().and_then(|m| m.primitives().next()).expect("there is one");
    let reader = primitive.reader(|b| Some(&buffers[b.index()]));
    let set = |number| reader.read_tex_coords(number).map(|set| set.into_f32().collect::<Vec<_>>());
    // v runs down; the second face has the coordinates of set 0 in set 5's place.
    let (zero, five) = (set(0).expect("set 0"), set(1).expect("set 5"));
    assert_eq!((zero[0], five[0], zero[4], five[4]), ([0.0, 1.0], [5.0, -4.0], [0.0, 1.0], [0.0, 1.0]));
    assert!(set(2).is_none());
}

#[test]
fn every_property_has_its_place() {
    let material = Material {
        color: [1.0, 0.0, 0.5],
        opacity: 0.75,
        opacity_mode: OpacityMode::Mask,
        opacity_cutoff: 0.25,
        metallic: 0.5,
        roughness: 0.125,
        emissive: [0.0, 1.0, 0.0],
        double_sided: false,
        colormap: Some("wall".into()),
        colormap_transform: MapTransform { scale: [2.0, 4.0], offset: [0.5, -3.0], rotation: 0.0 },
        maps: vec![
            map(MapLayer::Dirt, "rough", [1.0, 1.0]),
            map(MapLayer::Normal, "normal", [3.0, 1.0]),
            map(MapLayer::Roughness, "rough", [1.0, 1.0]),
        ],
        other: vec![("shininess".into(), "5".into())],
        ..Material::default()
    };
    let (document, _, images) = written(&scene(&[face(&[0])], material));
    assert!(document.extensions_used().eq([TRANSFORM_EXTENSION]));
    let material = document.materials().next().expect("there is one");
    let pbr = material.pbr_metallic_roughness();
    assert_eq!((material.alpha_mode(), material.alpha_cutoff()), (gltf::material::AlphaMode::Mask, Some(0.25)));
    assert!(!material.double_sided());
    assert_eq!(material.emissive_factor(), [0.0, 1.0, 0.0]);
    assert_eq!(pbr.base_color_factor()[3], 0.75);
    // The map stands for the roughness; there is no metallic map, so its channel is 1 and the factor counts.
    assert_eq!((pbr.roughness_factor(), pbr.metallic_factor()), (1.0, 0.5));
    let packed = pbr.metallic_roughness_texture().expect("there is one").texture().source().index();
    assert_eq!(images[packed].pixels[..4], [255, 50, 255, 255]);
    let transform = pbr.base_color_texture().expect("there is one").texture_transform().expect("it is moved");
    // v' = 4 v - 3 upwards is v' = 4 v counted downwards.
    assert_eq!((transform.scale(), transform.offset()), ([2.0, 4.0], [0.5, 0.0]));
    let extras: Value = serde_json::from_str(material.extras().as_ref().expect("there are some").get()).expect("JSON");
    assert_eq!(extras["shininess"], "5");
    assert_eq!((&extras["dirtmap"]["name"], &extras["dirtmap"]["index"]), (&json!("rough"), &json!(2)));
}

#[test]
fn roughness_and_metallic_maps_share_an_image() {
    let maps = vec![map(MapLayer::Roughness, "rough", [1.0; 2]), map(MapLayer::Metallic, "metal", [1.0; 2])];
    let (document, _, images) = written(&scene(&[face(&[0])], Material { maps, ..Material::default() }));
    let pbr = document.materials().next().expect("there is one").pbr_metallic_roughness();
    assert_eq!((pbr.roughness_factor(), pbr.metallic_factor()), (1.0, 1.0));
    let image = &images[pbr.metallic_roughness_texture().expect("there is one").texture().source().index()];
    assert_eq!((image.width, &image.pixels[..4]), (2, &[255, 50, 30, 255][..]));
}

#[test]
fn layers_without_texture_coordinates_are_ignored() {
    let material = Material { colormap: Some("wall".into()), ..Material::default() };
    let scene = scene(&[face(&[])], material);
    assert_eq!(scene.materials[0].colormap, None);
}

#[test]
fn transforms_are_the_same_counted_up_and_down() {
    let t = MapTransform { scale: [2.0, 3.0], offset: [0.25, 0.5], rotation: 30.0 };
    let down = downwards(&t, 0);
    let ([su, sv], [ou, ov]) = (down.scale.0.map(f64::from), down.offset.0.map(f64::from));
    let (sin, cos) = (libm::sin(f64::from(down.rotation.0)), libm::cos(f64::from(down.rotation.0)));
    for [u, v] in [[0.0, 0.0], [1.0, 0.5], [-2.0, 3.0]] {
        let [expected_u, expected_v] = t.apply([u, v]);
        // The matrix of KHR_texture_transform on a v that runs down.
        let (x, y) = (su * u, sv * (1.0 - v));
        let found = [cos * x + sin * y + ou, 1.0 - (cos * y - sin * x + ov)];
        assert!((found[0] - expected_u).abs() < 1e-5 && (found[1] - expected_v).abs() < 1e-5, "{found:?}");
    }
}
