//! Meshes. In: the triangles of a feature in one state, from both sides. Out: whether they are the same surface, and if
//! not, by how much they differ. Exact: two coordinates are equal if all their bits are.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use serde::Serialize;

use super::snapshot::{ObjectSnapshot, SceneSnapshot};

/// Triangles with everything that is drawn of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// World metres.
    pub positions: Vec<DVec3>,
    /// One per position.
    pub normals: Vec<Vec3>,
    /// By uv set, one per position each.
    pub uvs: Vec<(u8, Vec<Vec2>)>,
    pub triangles: Vec<[u32; 3]>,
    /// In order, covering all triangles.
    pub groups: Vec<MaterialGroup>,
}

/// Triangles `first..first + count` have the material with this text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaterialGroup {
    pub material: Arc<str>,
    pub first: u32,
    pub count: u32,
}

/// How two surfaces relate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Surface {
    Same,
    /// The same triangles in another order.
    Reordered,
    /// The same triangles in space; materials, normals or texture coordinates differ.
    Look {
        triangles: usize,
    },
    Shape {
        triangles_a: usize,
        triangles_b: usize,
        /// Triangles of A that B does not have, and the other way round.
        gone: usize,
        new: usize,
        /// Greatest distance of a vertex from where it was, metres, where nothing but vertices moved.
        moved_m: Option<f64>,
    },
}

impl Surface {
    /// Whether what is to be seen is the same.
    pub fn is_same(self) -> bool {
        matches!(self, Surface::Same | Surface::Reordered)
    }
}

/// Compares the surfaces that two lists of meshes make together.
pub fn compare_surfaces(a: &[&Mesh], b: &[&Mesh]) -> Surface {
    if a.len() == b.len() && a.iter().zip(b).all(|(a, b)| identical(a, b)) {
        return Surface::Same;
    }
    let [bare_a, bare_b] = [a, b].map(|meshes| sorted(meshes.iter().flat_map(|mesh| bare(mesh))));
    if bare_a != bare_b {
        let (gone, new) = unmatched(&bare_a, &bare_b);
        let (triangles_a, triangles_b) = (bare_a.len(), bare_b.len());
        return Surface::Shape { triangles_a, triangles_b, gone, new, moved_m: displacement(a, b) };
    }
    let [full_a, full_b] = [a, b].map(|meshes| sorted(meshes.iter().flat_map(|mesh| dressed(mesh))));
    match unmatched(&full_a, &full_b) {
        (0, 0) => Surface::Reordered,
        (gone, _) => Surface::Look { triangles: gone },
    }
}

fn identical(a: &Mesh, b: &Mesh) -> bool {
    a.triangles == b.triangles
        && a.groups == b.groups
        && same_bits(&a.positions, &b.positions)
        && same_bits(&a.normals, &b.normals)
        && a.uvs.len() == b.uvs.len()
        && a.uvs.iter().zip(&b.uvs).all(|(a, b)| a.0 == b.0 && same_bits(&a.1, &b.1))
}

fn same_bits<T: bytemuck::NoUninit>(a: &[T], b: &[T]) -> bool {
    bytemuck::cast_slice::<T, u8>(a) == bytemuck::cast_slice::<T, u8>(b)
}

fn sorted<T: Ord>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut items: Vec<T> = items.collect();
    items.sort_unstable();
    items
}

/// How many items of each sorted list the other does not have.
fn unmatched<T: Ord>(a: &[T], b: &[T]) -> (usize, usize) {
    let (mut i, mut j, mut both) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => (i, j, both) = (i + 1, j + 1, both + 1),
        }
    }
    (a.len() - both, b.len() - both)
}

/// The bits of three corners, the least one first; which way round they run stays.
type Bare = [[u64; 3]; 3];

fn corners(mesh: &Mesh, triangle: [u32; 3]) -> (Bare, [u32; 3]) {
    let bits = |i: u32| mesh.positions[i as usize].to_array().map(f64::to_bits);
    let turns = [triangle, [triangle[1], triangle[2], triangle[0]], [triangle[2], triangle[0], triangle[1]]];
    let turned = turns.map(|turn| (turn.map(bits), turn));
    turned.into_iter().min_by_key(|(bits, _)| *bits).expect("there are three")
}

fn bare(mesh: &Mesh) -> impl Iterator<Item = Bare> {
    mesh.triangles.iter().map(|&triangle| corners(mesh, triangle).0)
}

/// Corners, the bits of normals and texture coordinates at them, material.
type Dressed = (Bare, Vec<u32>, Arc<str>);

fn dressed(mesh: &Mesh) -> impl Iterator<Item = Dressed> {
    mesh.groups.iter().flat_map(move |group| {
        let triangles = &mesh.triangles[group.first as usize..(group.first + group.count) as usize];
        triangles.iter().map(move |&triangle| {
            let (bare, turned) = corners(mesh, triangle);
            let normals = turned.into_iter().flat_map(|i| mesh.normals[i as usize].to_array());
            let mut bits: Vec<u32> = normals.map(f32::to_bits).collect();
            for (set, uvs) in &mesh.uvs {
                bits.push(u32::from(*set));
                bits.extend(turned.into_iter().flat_map(|i| uvs[i as usize].to_array()).map(f32::to_bits));
            }
            (bare, bits, group.material.clone())
        })
    })
}

/// The greatest way that a vertex moved, where the triangles join the same vertices.
fn displacement(a: &[&Mesh], b: &[&Mesh]) -> Option<f64> {
    let alike = |(a, b): (&&Mesh, &&Mesh)| a.triangles == b.triangles && a.positions.len() == b.positions.len();
    if a.len() != b.len() || !a.iter().zip(b).all(alike) {
        return None;
    }
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.positions.iter().zip(&b.positions));
    Some(pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max))
}

/// A feature's meshes in both states of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FeatureMeshes {
    pub feature: String,
    pub class: String,
    pub before: Surface,
    pub after: Surface,
}

/// What differs between the meshes of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MeshDifference {
    /// Features with geometry on either side, the ground left out.
    pub compared: usize,
    /// Of those: the same triangles in another order, which is no difference.
    pub reordered: usize,
    pub triangles_a: usize,
    pub triangles_b: usize,
    /// Ground that no feature covers.
    pub ground: Option<FeatureMeshes>,
    /// Those that differ; what differs most comes first.
    pub features: Vec<FeatureMeshes>,
}

impl MeshDifference {
    pub fn is_none(&self) -> bool {
        self.ground.is_none() && self.features.is_empty()
    }
}

/// The name of the ground among features.
pub const GROUND: &str = "terrain";

/// Compares the meshes of a scene feature by feature.
pub fn compare_meshes(a: &SceneSnapshot, b: &SceneSnapshot) -> MeshDifference {
    let [of_a, of_b] = [a, b].map(|scene| by_feature(&scene.objects));
    let mut names: Vec<&str> = of_a.keys().chain(of_b.keys()).copied().collect();
    names.sort_unstable();
    names.dedup();
    let one = |name: &&str| {
        let [a, b] = [&of_a, &of_b].map(|side| side.get(name).map(Vec::as_slice).unwrap_or_default());
        let class = b.first().or(a.first()).map_or_else(String::new, |object| object.class.clone());
        let state = |is_in: fn(&ObjectSnapshot) -> bool| {
            let [a, b] = [a, b].map(|side| -> Vec<&Mesh> {
                side.iter().filter(|object| is_in(object)).map(|object| &object.mesh).collect()
            });
            compare_surfaces(&a, &b)
        };
        FeatureMeshes { feature: (*name).to_owned(), class, before: state(|o| o.before), after: state(|o| o.after) }
    };
    let compared: Vec<FeatureMeshes> = names.par_iter().map(one).collect();
    let triangles = |scene: &SceneSnapshot| scene.objects.iter().map(|o| o.mesh.triangles.len()).sum();
    let mut out = MeshDifference { triangles_a: triangles(a), triangles_b: triangles(b), ..MeshDifference::default() };
    for meshes in compared {
        let is_ground = meshes.feature == GROUND;
        out.compared += usize::from(!is_ground);
        if !meshes.before.is_same() || !meshes.after.is_same() {
            if is_ground { out.ground = Some(meshes) } else { out.features.push(meshes) }
        } else if (meshes.before, meshes.after) != (Surface::Same, Surface::Same) {
            out.reordered += 1;
        }
    }
    out.features.sort_by(|x, y| weight(y).total_cmp(&weight(x)).then_with(|| x.feature.cmp(&y.feature)));
    out
}

fn by_feature(objects: &[ObjectSnapshot]) -> BTreeMap<&str, Vec<&ObjectSnapshot>> {
    let mut out: BTreeMap<&str, Vec<&ObjectSnapshot>> = BTreeMap::new();
    for object in objects {
        out.entry(&object.feature).or_default().push(object);
    }
    out
}

/// How much a difference matters: triangles that came and went, then looks.
fn weight(meshes: &FeatureMeshes) -> f64 {
    let one = |surface: Surface| match surface {
        Surface::Same | Surface::Reordered => 0.0,
        Surface::Look { triangles } => 1e-6 * triangles as f64,
        Surface::Shape { gone, new, .. } => (gone + new) as f64,
    };
    one(meshes.before).max(one(meshes.after))
}

#[cfg(test)]
mod tests;
