//! The scene's types: what export and renderer read.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::shared_mesh::SharedMesh;
use crate::geodata::feature::{FeatureClass, FeatureId};
use crate::interpreter::material::Material;

/// In which of the two states of the scene an object exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Presence {
    Both,
    BeforeOnly,
    AfterOnly,
}

/// Semantic class; the number is the label written to class images (0 is no object).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum SceneClass {
    Terrain = 1,
    Building = 2,
    Highway = 3,
    Landuse = 4,
    Natural = 5,
    Leisure = 6,
    Water = 7,
    /// Trees and bushes, where the recipe asks for them.
    Vegetation = 8,
}

impl From<FeatureClass> for SceneClass {
    fn from(class: FeatureClass) -> Self {
        match class {
            FeatureClass::Building | FeatureClass::BuildingPart => SceneClass::Building,
            FeatureClass::Highway => SceneClass::Highway,
            FeatureClass::Landuse => SceneClass::Landuse,
            FeatureClass::Natural => SceneClass::Natural,
            FeatureClass::Leisure => SceneClass::Leisure,
            FeatureClass::Water => SceneClass::Water,
        }
    }
}

impl SceneClass {
    pub const ALL: [SceneClass; 8] = [
        SceneClass::Terrain,
        SceneClass::Building,
        SceneClass::Highway,
        SceneClass::Landuse,
        SceneClass::Natural,
        SceneClass::Leisure,
        SceneClass::Water,
        SceneClass::Vegetation,
    ];

    /// The name in manifests and glTF extras.
    pub fn name(self) -> &'static str {
        match self {
            SceneClass::Terrain => "terrain",
            SceneClass::Building => "building",
            SceneClass::Highway => "highway",
            SceneClass::Landuse => "landuse",
            SceneClass::Natural => "natural",
            SceneClass::Leisure => "leisure",
            SceneClass::Water => "water",
            SceneClass::Vegetation => "vegetation",
        }
    }
}

/// Triangles `first..first + count` of a mesh share one material of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    pub material: u32,
    pub first: u32,
    pub count: u32,
}

/// Triangles with separate normals (one vertex per face corner): positions in f64 metres about the scene's origin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    pub positions: Vec<DVec3>,
    /// Unit normals, one per position.
    pub normals: Vec<Vec3>,
    /// Texture coordinates of uv set 0, one per position (zero where the face has none).
    pub uvs: Vec<Vec2>,
    /// Other uv sets that a material's texture layers use, sorted by set: one value per position, that of set 0 where the
    /// face has none of its own.
    pub uv_sets: Vec<(u8, Vec<Vec2>)>,
    pub triangles: Vec<[u32; 3]>,
    /// In order, covering all triangles.
    pub groups: Vec<Group>,
}

impl TriMesh {
    /// The texture coordinates of a set, or those of set 0 that stand for it.
    pub fn uv_set(&self, set: u8) -> &[Vec2] {
        self.uv_sets.iter().find(|(s, _)| *s == set).map_or(&self.uvs, |(_, uvs)| uvs)
    }

    /// Puts the sets of another mesh behind these; call it before the vertices are joined.
    pub fn join_uv_sets(&mut self, other: &TriMesh) {
        let mut sets: Vec<u8> = self.uv_sets.iter().chain(&other.uv_sets).map(|(set, _)| *set).collect();
        sets.sort_unstable();
        sets.dedup();
        let joined = |set: u8| (set, [self.uv_set(set), other.uv_set(set)].concat());
        self.uv_sets = sets.into_iter().map(joined).collect();
    }

    /// Adds the triangles of another mesh whose groups number the same materials.
    pub fn append(&mut self, other: &TriMesh) {
        let (vertices, triangles) = (self.positions.len() as u32, self.triangles.len() as u32);
        self.positions.extend_from_slice(&other.positions);
        self.normals.extend_from_slice(&other.normals);
        self.join_uv_sets(other);
        self.uvs.extend_from_slice(&other.uvs);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| vertices + i)));
        self.groups.extend(other.groups.iter().map(|g| Group { first: triangles + g.first, ..*g }));
    }
}

/// One feature of the scene in one state.
#[derive(Clone, Debug)]
pub struct SceneObject {
    /// `None` for the terrain.
    pub feature: Option<FeatureId>,
    /// Label in instance images, from 1; equal for the before and after states of one feature.
    pub instance: u32,
    pub class: SceneClass,
    pub presence: Presence,
    /// Number of the change block that the presence depends on, from 1; 0 for what no change touches. Ground that a
    /// change takes over carries the number too, as an object of its own.
    pub change: u16,
    /// Level (damage grade) within the change, from 1; 0 for unchanged features.
    pub level: u8,
    pub mesh: SharedMesh,
}

/// Everything that is drawn or exported.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Sorted by instance, then presence.
    pub objects: Vec<SceneObject>,
    pub materials: Vec<Arc<Material>>,
    /// Textures by name, decoded, as named by [`Material::colormap`], sorted by name.
    pub textures: Vec<(Arc<str>, Arc<image::RgbaImage>)>,
    /// Least and greatest corner of all objects, metres; both zero for an empty scene.
    pub bounds: (DVec3, DVec3),
}
