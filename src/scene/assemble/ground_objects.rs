//! Ground triangles → objects. In: the ground mesh with a class per triangle, the flat faces that the classes are. Out:
//! one object per owner and state, with materials of its own numbering.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};

use super::{FeatureParts, Kept, StateParts, TERRAIN_INSTANCE, TERRAIN_TEXTURE, renumbered};
use crate::geodata::feature::FeatureId;
use crate::geometry::Polygon;
use crate::interpreter::material::Material;
use crate::scene::ground::GroundMesh;
use crate::scene::model::{Presence, SceneClass, SceneObject};
use crate::scene::palette::Palette;
use crate::scene::parts::{FlatFace, Parts, PlanUv};
use crate::scene::shared_mesh::SharedMesh;
use crate::scene::texture::builtin_size;
use crate::scene::triangles::Builder;

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

/// The objects of a ground mesh, and what they were made from.
pub struct KeptGround {
    ground: Arc<GroundMesh>,
    faces: Vec<KeptFaces>,
    pieces: Vec<Piece>,
}

/// What of a state with flat faces the objects depend on.
struct KeptFaces {
    identity: (FeatureId, SceneClass, u32, Presence, u16, u8),
    parts: Arc<Parts>,
}

/// One object of the ground.
pub struct Piece {
    feature: Option<FeatureId>,
    class: SceneClass,
    key: Key,
    level: u8,
    mesh: SharedMesh,
    materials: Vec<Arc<Material>>,
    /// The mesh as the last scene had it, with the numbers of its materials there.
    numbered: Option<(Vec<u32>, SharedMesh)>,
}

fn faces(features: &[FeatureParts]) -> Vec<KeptFaces> {
    let mut faces = Vec::new();
    for (number, feature) in features.iter().enumerate() {
        let instance = TERRAIN_INSTANCE + 1 + number as u32;
        for state in feature.states.iter().filter(|state| !state.parts.flat.is_empty()) {
            let StateParts { presence, change, level, parts } = state;
            let identity = (feature.feature, feature.class, instance, *presence, *change, *level);
            faces.push(KeptFaces { identity, parts: parts.clone() });
        }
    }
    faces
}

impl KeptFaces {
    fn is(&self, other: &KeptFaces) -> bool {
        let KeptFaces { identity, parts } = self;
        let same = || Arc::ptr_eq(parts, &other.parts) || parts.flat == other.parts.flat;
        *identity == other.identity && same()
    }
}

/// Triangles of the ground, each in the object that owns its class; where a change takes the ground over, one object
/// has it before and another after.
pub fn ground_objects(
    features: &[FeatureParts],
    ground: &Arc<GroundMesh>,
    palette: &mut Palette,
    kept: &mut Kept,
) -> Vec<SceneObject> {
    let faces = faces(features);
    let is_same = |kept: &KeptGround| {
        let same_faces = || kept.faces.iter().zip(&faces).all(|(a, b)| a.is(b));
        Arc::ptr_eq(&kept.ground, ground) && kept.faces.len() == faces.len() && same_faces()
    };
    let mut pieces = match kept.ground.take() {
        Some(kept) if is_same(&kept) => kept.pieces,
        _ => sorted(features, ground),
    };
    let objects = pieces.iter_mut().map(|piece| piece.object(palette)).collect();
    if kept.keeps {
        kept.ground = Some(KeptGround { ground: ground.clone(), faces, pieces });
    }
    objects
}

impl Piece {
    fn new(key: Key, draft: Draft) -> Piece {
        let (mesh, materials) = draft.builder.finish();
        let (feature, class, level) = (draft.feature, draft.class, draft.level);
        Piece { feature, class, key, level, mesh: mesh.into(), materials, numbered: None }
    }

    fn object(&mut self, palette: &mut Palette) -> SceneObject {
        let numbers: Vec<u32> = self.materials.iter().map(|material| palette.number(material)).collect();
        let mesh = match self.numbered.take() {
            Some((known, mesh)) if known == numbers => mesh,
            _ => renumbered((*self.mesh).clone(), &numbers).into(),
        };
        self.numbered = Some((numbers, mesh.clone()));
        let (instance, presence, change) = self.key;
        SceneObject { feature: self.feature, instance, class: self.class, presence, change, level: self.level, mesh }
    }
}

fn sorted(features: &[FeatureParts], ground: &GroundMesh) -> Vec<Piece> {
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
    sorter.drafts.into_iter().map(|(key, draft)| Piece::new(key, draft)).collect()
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
