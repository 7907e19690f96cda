//! Vegetation: plants that the map names → meshes. In: [`Greenery`], what is in their way, the terrain, a seed. Out: scene
//! objects of class [`SceneClass::Vegetation`], the same in every state, and what was left out.
//!
//! Which plant stands where is keyed by the seed, the map object and a cell of the plan: cutting the area elsewhere or
//! mapping another park moves no tree.

mod obstacles;
mod placing;
mod shape;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::model::{Presence, Scene, SceneClass, SceneObject, TriMesh};
use super::triangles::Builder;
use crate::geodata::feature::FeatureId;
use crate::geodata::greenery::Greenery;
use crate::interpreter::material::Material;
use crate::interpreter::seed::Seed;

pub use obstacles::{Obstacles, Sites};

/// One plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    pub at: DVec2,
    pub form: Form,
    /// Metres.
    pub height: f64,
    /// Radius of the crown, metres.
    pub crown: f64,
    /// Key of its looks.
    pub seed: Seed,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    Broadleaved,
    Conifer,
    Bush,
}

/// What became of the map's plants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planted {
    /// Map objects with the number of their plants.
    pub grown: Vec<(FeatureId, usize)>,
    /// Map objects without any, and why.
    pub bare: Vec<(FeatureId, String)>,
}

/// Adds the plants to a scene; `height` is the ground's at a place of the plan.
pub fn plant(
    scene: &mut Scene,
    greenery: &Greenery,
    sites: &Sites,
    height: &(dyn Fn(DVec2) -> Option<f64> + Sync),
    seed: Seed,
) -> Planted {
    let groups = placing::groups(greenery, sites, seed.named("vegetation"));
    let meshes: Vec<_> = groups.par_iter().map(|group| mesh(&group.plants, height)).collect();
    let mut planted = Planted::default();
    let mut instance = scene.objects.last().map_or(1, |object| object.instance);
    for (group, (mut mesh, materials, count)) in groups.into_iter().zip(meshes) {
        if count == 0 {
            let why = group.why_bare.unwrap_or_else(|| "no place is free of buildings, roads and water".to_owned());
            planted.bare.push((group.id, why));
            continue;
        }
        instance += 1;
        let numbers: Vec<u32> = materials.iter().map(|material| material_number(scene, material)).collect();
        mesh.groups.iter_mut().for_each(|group| group.material = numbers[group.material as usize]);
        let (low, high) = scene.bounds;
        scene.bounds = mesh.positions.iter().fold((low, high), |(low, high), &p| (low.min(p), high.max(p)));
        scene.objects.push(SceneObject {
            feature: Some(group.id),
            instance,
            class: SceneClass::Vegetation,
            presence: Presence::Both,
            change: 0,
            level: 0,
            mesh: mesh.into(),
        });
        planted.grown.push((group.id, count));
    }
    planted
}

fn material_number(scene: &mut Scene, material: &Arc<Material>) -> u32 {
    let known = scene.materials.iter().position(|other| other == material);
    known.unwrap_or_else(|| {
        scene.materials.push(material.clone());
        scene.materials.len() - 1
    }) as u32
}

/// The plants that stand on ground of known height.
fn mesh(plants: &[Plant], height: &dyn Fn(DVec2) -> Option<f64>) -> (TriMesh, Vec<Arc<Material>>, usize) {
    let mut builder = Builder::default();
    let mut count = 0;
    for plant in plants {
        if let Some(ground) = height(plant.at) {
            shape::add(&mut builder, plant, ground);
            count += 1;
        }
    }
    let (mesh, materials) = builder.finish();
    (mesh, materials, count)
}

#[cfg(test)]
mod tests;
