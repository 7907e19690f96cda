//! Parts of all features and the ground → the scene. In: [`FeatureParts`] in the order of their ids, the ground mesh
//! with a class per triangle. Out: a [`Scene`] whose objects carry integer labels.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};

use super::ground::{GroundLayer, GroundMesh};
use super::model::{Presence, Scene, SceneClass, SceneObject, TriMesh};
use super::palette::Palette;
use super::parts::{FlatFace, Parts, PlanUv};
use super::texture::builtin_size;
use super::triangles::Builder;
use crate::geodata::feature::FeatureId;
use crate::geometry::Polygon;
use crate::interpreter::material::Material;

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
    pub parts: Parts,
}

/// Who a class of ground triangles belongs to.
struct Owner<'a> {
    feature: FeatureId,
    class: SceneClass,
    instance: u32,
    state: &'a StateParts,
    face: &'a FlatFace,
    bounds: (DVec2, DVec2),
}

/// Key and identity of one scene object under construction.
type Key = (u32, Presence, u16);

struct Draft {
    feature: Option<FeatureId>,
    class: SceneClass,
    level: u8,
    builder: Builder,
    /// Owner and ground vertex → vertex of the run of the owner's material.
    shared: BTreeMap<(Option<usize>, u32), u32>,
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
pub fn assemble(features: Vec<FeatureParts>, ground: &GroundMesh) -> Scene {
    let mut palette = Palette::default();
    let mut objects = ground_objects(&features, ground, &mut palette);
    for (number, feature) in features.into_iter().enumerate() {
        for state in feature.states {
            let instance = TERRAIN_INSTANCE + 1 + number as u32;
            let mut mesh = state.parts.solid;
            if mesh.triangles.is_empty() {
                continue;
            }
            renumber(&mut mesh, &state.parts.materials, &mut palette);
            objects.push(SceneObject {
                feature: Some(feature.feature),
                instance,
                class: feature.class,
                presence: state.presence,
                change: state.change,
                level: state.level,
                mesh,
            });
        }
    }
    objects.sort_by_key(|o| (o.instance, o.presence, o.change));
    let objects = merged(objects);
    let bounds = bounds(&objects);
    Scene { objects, materials: palette.into_materials(), textures: Vec::new(), bounds }
}

/// Joins the ground part and the solid part of the same feature in the same state.
fn merged(objects: Vec<SceneObject>) -> Vec<SceneObject> {
    let mut out: Vec<SceneObject> = Vec::with_capacity(objects.len());
    for object in objects {
        let key = |o: &SceneObject| (o.instance, o.presence, o.change);
        match out.last_mut().filter(|last| key(last) == key(&object)) {
            Some(last) => last.mesh.append(&object.mesh),
            None => out.push(object),
        }
    }
    out
}

fn renumber(mesh: &mut TriMesh, materials: &[Arc<Material>], palette: &mut Palette) {
    for group in &mut mesh.groups {
        group.material = palette.number(&materials[group.material as usize]);
    }
}

fn bounds(objects: &[SceneObject]) -> (DVec3, DVec3) {
    let mut points = objects.iter().flat_map(|o| &o.mesh.positions);
    let Some(&first) = points.next() else { return (DVec3::ZERO, DVec3::ZERO) };
    points.fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

/// Triangles of the ground, each in the object that owns its class; where a change takes the ground over, one object
/// has it before and another after.
fn ground_objects(features: &[FeatureParts], ground: &GroundMesh, palette: &mut Palette) -> Vec<SceneObject> {
    let mut sorter = Sorter {
        owners: owners(features),
        ground,
        normals: ground.normals(),
        terrain: Arc::new(Material {
            name: "terrain".into(),
            colormap: Some(TERRAIN_TEXTURE.into()),
            ..Material::default()
        }),
        terrain_uv: PlanUv::tiles(builtin_size(TERRAIN_TEXTURE).expect("the terrain's texture is built in")),
        drafts: BTreeMap::new(),
    };
    for &(triangle, payload) in &ground.triangles {
        let owner = payload.map(|p| p as usize);
        match owner.map(|o| (sorter.owners[o].state.presence, sorter.owners[o].state.change)) {
            None | Some((Presence::Both, _)) => sorter.add(owner, Presence::Both, 0, triangle),
            Some((own, change)) => {
                let middle = triangle.iter().map(|&i| plan(ground.positions[i as usize])).sum::<DVec2>() / 3.0;
                let other = if own == Presence::AfterOnly { Presence::BeforeOnly } else { Presence::AfterOnly };
                let below = below(&sorter.owners, middle, own);
                sorter.add(owner, own, change, triangle);
                sorter.add(below, other, change, triangle);
            }
        }
    }
    sorter.drafts.into_iter().map(|(key, draft)| finish(key, draft, palette)).collect()
}

/// The highest class at a point among those that do not belong to the state `hidden`.
fn below(owners: &[Owner], point: DVec2, hidden: Presence) -> Option<usize> {
    let covers =
        |o: &Owner| o.bounds.0.cmple(point).all() && o.bounds.1.cmpge(point).all() && o.face.polygon.contains(point);
    (0..owners.len())
        .filter(|&i| owners[i].state.presence != hidden && covers(&owners[i]))
        .max_by_key(|&i| (owners[i].face.priority, i))
}

fn owners(features: &[FeatureParts]) -> Vec<Owner<'_>> {
    let mut owners = Vec::new();
    for (number, feature) in features.iter().enumerate() {
        for state in &feature.states {
            owners.extend(state.parts.flat.iter().map(|face| Owner {
                feature: feature.feature,
                class: feature.class,
                instance: TERRAIN_INSTANCE + 1 + number as u32,
                state,
                face,
                bounds: polygon_bounds(&face.polygon),
            }));
        }
    }
    owners
}

fn polygon_bounds(polygon: &Polygon) -> (DVec2, DVec2) {
    polygon.bounds().unwrap_or((DVec2::INFINITY, DVec2::NEG_INFINITY))
}

fn plan(p: DVec3) -> DVec2 {
    DVec2::new(p.x, -p.z)
}

/// Sorts ground triangles into objects.
struct Sorter<'a> {
    owners: Vec<Owner<'a>>,
    ground: &'a GroundMesh,
    normals: Vec<Vec3>,
    terrain: Arc<Material>,
    terrain_uv: PlanUv,
    drafts: BTreeMap<Key, Draft>,
}

impl Sorter<'_> {
    /// Adds a triangle to the object of its owner (`None`: the terrain) in one state.
    fn add(&mut self, number: Option<usize>, presence: Presence, change: u16, triangle: [u32; 3]) {
        let owner = number.map(|o| &self.owners[o]);
        let instance = owner.map_or(TERRAIN_INSTANCE, |o| o.instance);
        let draft = self.drafts.entry((instance, presence, change)).or_insert_with(|| Draft {
            feature: owner.map(|o| o.feature),
            class: owner.map_or(SceneClass::Terrain, |o| o.class),
            level: owner.map_or(0, |o| o.state.level),
            builder: Builder::default(),
            shared: BTreeMap::new(),
        });
        let uv = owner.map_or(self.terrain_uv, |o| o.face.uv);
        let run = draft.builder.run(owner.map_or(&self.terrain, |o| &o.face.material));
        let local = triangle.map(|i| {
            *draft.shared.entry((number, i)).or_insert_with(|| {
                let p = self.ground.positions[i as usize];
                run.positions.push(p);
                run.normals.push(self.normals[i as usize]);
                run.uvs.push(uv.at(plan(p)).as_vec2());
                (run.positions.len() - 1) as u32
            })
        });
        run.triangles.push(local);
    }
}

fn finish((instance, presence, change): Key, draft: Draft, palette: &mut Palette) -> SceneObject {
    let (mut mesh, materials) = draft.builder.finish();
    renumber(&mut mesh, &materials, palette);
    SceneObject { feature: draft.feature, instance, class: draft.class, presence, change, level: draft.level, mesh }
}
