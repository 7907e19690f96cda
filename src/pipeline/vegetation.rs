//! Plants of the map in the scene. In: features, their derived parts, the map's greenery. Out: objects in the scene, lines
//! in the ledger.

use crate::geodata::feature::{Feature, FeatureClass, Outline};
use crate::geodata::greenery::Greenery;
use crate::geodata::ledger::{Ledger, Outcome};
use crate::geodata::terrain::Terrain;
use crate::interpreter::seed::Seed;
use crate::scene::assemble::FeatureParts;
use crate::scene::vegetation::{self, Obstacles, Sites};
use crate::scene::{Scene, SceneClass};

/// What plants keep clear of: buildings as they are mapped, roads and water as they were derived.
pub fn sites(features: &[Feature], derived: &[FeatureParts]) -> Sites {
    let buildings = features.iter().filter_map(|feature| match (&feature.outline, feature.class) {
        (Outline::Area(outline), FeatureClass::Building | FeatureClass::BuildingPart) => Some(outline.clone()),
        _ => None,
    });
    let faces = |class: SceneClass| {
        let of_class = derived.iter().filter(move |feature| feature.class == class);
        let faces = of_class.flat_map(|f| &f.states).flat_map(|state| &state.parts.flat);
        faces.map(|face| face.polygon.clone())
    };
    Sites {
        taken: Obstacles::new(buildings.chain(faces(SceneClass::Water)).collect()),
        paved: Obstacles::new(faces(SceneClass::Highway).collect()),
    }
}

/// Adds the plants. Every tree, row and stand of the map is told in the ledger, by its id and the word `plants`: woods
/// have a line as land cover too.
pub fn plant(scene: &mut Scene, greenery: &Greenery, sites: &Sites, terrain: &Terrain, seed: u64, ledger: &mut Ledger) {
    let planted = vegetation::plant(scene, greenery, sites, &|at| terrain.height(at), Seed::root(seed));
    for (id, _) in &planted.grown {
        ledger.record(format!("plants of {id}"), Outcome::Ok);
    }
    for (id, why) in planted.bare {
        ledger.record(format!("plants of {id}"), Outcome::Skipped(why));
    }
    *ledger.assumptions.entry("vegetation: plants grown".to_owned()).or_default() +=
        planted.grown.iter().map(|(_, count)| count).sum::<usize>();
}
