//! The start shape of a feature. In: its outline and the terrain. Out: a mesh in its plane, and how what grows on it
//! meets the ground.

use glam::{DVec2, DVec3};

use crate::geodata::feature::{Feature, FeatureClass, Outline};
use crate::geodata::features::ribbon::{Cap, ribbon};
use crate::geodata::tags::road_width;
use crate::geodata::terrain::Terrain;
use crate::geometry::canonical::canonical_order;
use crate::geometry::mesh::Loop;
use crate::geometry::{Face, Mesh, Polygon};
use crate::interpreter::tree::Leaf;
use crate::scene::ground::Surface;
use crate::scene::parts::{Parts, Stand, has_flat_face, parts};

/// How far walls go on below the lowest ground, metres: more than the ground mesh's usual tolerance.
const SKIRT_M: f64 = 1.0;
/// On a slope a building stands on its lowest ground, but the ground covers at most this much of a wall, metres: on
/// steeper ground the base rises, and a foundation fills the gap below.
const MOST_BURIED_M: f64 = 1.5;
/// Ground classes from below to above; larger numbers cover smaller ones. Within a class small areas cover large ones.
const LANDUSE: i32 = 1000;
const LEISURE: i32 = 2000;
const NATURAL: i32 = 3000;
const WATER: i32 = 4000;
const ROAD: i32 = 5000;
const FOOTPRINT: i32 = 9000;

/// Where a feature's derivation begins.
pub struct Lot {
    /// World coordinates in the plane y = `base`.
    pub mesh: Mesh,
    pub base: f64,
    /// For every edge of the mesh, in face-edge order, its number in the map's outline; empty where the outline is made,
    /// as a road's is.
    pub map_edges: Vec<usize>,
    polygons: Vec<Polygon>,
    stand: Stand,
}

/// Least and greatest height of the ground under a feature, metres.
pub type Relief = (f64, f64);

/// The relief under some polygons; `None` where the ground is not known.
pub fn relief(polygons: &[Polygon], terrain: &Terrain) -> Option<Relief> {
    polygons.iter().filter_map(|p| terrain.extremes_under(p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

impl Lot {
    /// `caps` are the ends of a road's ribbon; `whole` is the relief under the whole building that a part belongs to.
    /// Says why where there is no lot.
    pub fn new(feature: &Feature, caps: [Cap; 2], whole: Option<Relief>, terrain: &Terrain) -> Result<Lot, String> {
        let (polygons, map_edges) = match &feature.outline {
            Outline::Area(polygon) => {
                let mut polygon = polygon.clone();
                let edges = canonical_order(&mut polygon);
                (vec![polygon], edges)
            }
            Outline::Line(line) => {
                let width = road_width(&feature.tags).metres;
                (ribbon(line, width, caps).map_err(|e| format!("no surface: {e}"))?, Vec::new())
            }
        };
        if polygons.iter().all(|p| p.outer.len() < 3) {
            return Err("it covers no area".to_owned());
        }
        let (least, greatest) = whole.or_else(|| relief(&polygons, terrain)).unwrap_or((0.0, 0.0));
        let mean = (least + greatest) / 2.0;
        let building = matches!(feature.class, FeatureClass::Building | FeatureClass::BuildingPart);
        let (base, stand) = if building {
            let base = least.max(greatest - MOST_BURIED_M);
            (base, Stand::Level { skirt: if terrain.is_flat() { 0.0 } else { base - least + SKIRT_M } })
        } else if let Some(deck) = deck(feature, terrain, mean) {
            (mean, deck)
        } else {
            (mean, Stand::Draped { priority: priority(feature, &polygons), surface: surface(feature), lift: 0.0 })
        };
        Ok(Lot { mesh: mesh(&polygons, base), base, map_edges, polygons, stand })
    }

    /// Sorts the leaves of a derivation. Leaves with flat faces on a building's footprint, such as ash, drape it, and
    /// what stands among them, such as rubble, follows the ground corner by corner.
    pub fn parts(&self, leaves: &[Leaf], terrain: &Terrain) -> Parts {
        let draped = Stand::Draped { priority: FOOTPRINT, surface: Surface::Drape, lift: 0.0 };
        let level = matches!(self.stand, Stand::Level { .. });
        let stand = if level && has_flat_face(leaves, self.base) { &draped } else { &self.stand };
        let nothing = Polygon::default();
        let mut parts = parts(leaves, self.base, stand, self.polygons.first().unwrap_or(&nothing));
        self.settle(&mut parts, stand, terrain);
        parts
    }
}

impl Lot {
    /// The same leaf by leaf, without a foundation.
    pub fn parts_by_leaf(&self, leaves: &[Leaf], terrain: &Terrain) -> Vec<Parts> {
        let draped = Stand::Draped { priority: FOOTPRINT, surface: Surface::Drape, lift: 0.0 };
        let level = matches!(self.stand, Stand::Level { .. });
        let stand = match &self.stand {
            _ if level && has_flat_face(leaves, self.base) => draped,
            Stand::Level { .. } => Stand::Level { skirt: 0.0 },
            other => other.clone(),
        };
        let one = |leaf| {
            let mut parts = parts(std::slice::from_ref(leaf), self.base, &stand, &Polygon::default());
            self.settle(&mut parts, &stand, terrain);
            parts
        };
        leaves.iter().map(one).collect()
    }

    /// Lets what stands among draped faces follow the ground corner by corner.
    fn settle(&self, parts: &mut Parts, stand: &Stand, terrain: &Terrain) {
        if matches!(stand, Stand::Draped { .. }) {
            for p in &mut parts.solid.positions {
                p.y += terrain.height(DVec2::new(p.x, -p.z)).unwrap_or(self.base) - self.base;
            }
        }
    }
}

fn mesh(polygons: &[Polygon], base: f64) -> Mesh {
    let mut mesh = Mesh::default();
    for polygon in polygons {
        let mut rings = polygon.rings().map(|ring| {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(ring.iter().map(|p| DVec3::new(p.x, base, -p.y)));
            (first..first + ring.len() as u32).collect::<Loop>()
        });
        let outer = rings.next().expect("a polygon has an outer ring");
        let holes = rings.collect();
        mesh.faces.push(Face { outer, holes, ..Face::default() });
    }
    mesh
}

/// A bridge spans its ends; over a valley the ground in between does not matter.
fn deck(feature: &Feature, terrain: &Terrain, base: f64) -> Option<Stand> {
    let bridge = feature.tags.get("bridge").is_some_and(|v| &**v != "no");
    let Outline::Line(line) = &feature.outline else { return None };
    let (from, to) = (*line.first()?, *line.last()?);
    let layer = feature.tags.get("layer").and_then(|l| l.parse::<f64>().ok()).unwrap_or(1.0).clamp(1.0, 5.0);
    // A deck lies a little above the street it carries on, so that it covers what passes under it.
    let lift = 0.15 * layer;
    let height = |p: DVec2| terrain.height(p).unwrap_or(base) - base + lift;
    bridge.then(|| Stand::Deck { from, to, heights: [height(from), height(to)] })
}

/// Standing water is level; rivers and streams, and everything else, follow the ground.
fn surface(feature: &Feature) -> Surface {
    let running = ["river", "stream", "canal", "ditch", "drain", "riverbank", "waterfall"];
    let kind = feature.tags.get("water").or_else(|| feature.tags.get("waterway"));
    if feature.class == FeatureClass::Water && !kind.is_some_and(|k| running.contains(&&**k)) {
        Surface::Level
    } else {
        Surface::Drape
    }
}

fn priority(feature: &Feature, polygons: &[Polygon]) -> i32 {
    let area: f64 = polygons.iter().map(Polygon::area).sum();
    // 0..=990, growing as the area shrinks.
    let small = (990.0 - 45.0 * libm::log2(area.max(1.0))).clamp(0.0, 990.0) as i32;
    match feature.class {
        FeatureClass::Landuse => LANDUSE + small,
        FeatureClass::Leisure => LEISURE + small,
        FeatureClass::Natural => NATURAL + small,
        FeatureClass::Water => WATER + small,
        FeatureClass::Building | FeatureClass::BuildingPart => FOOTPRINT,
        FeatureClass::Highway => {
            let layer = feature.tags.get("layer").and_then(|l| l.parse::<i32>().ok()).unwrap_or(0).clamp(-5, 5);
            ROAD + 100 * layer + rank(feature.tags.get("highway").map_or("", |v| v))
        }
    }
}

/// Larger roads cover smaller ones where they meet.
fn rank(class: &str) -> i32 {
    const ORDER: &[&str] = &[
        "steps",
        "path",
        "footway",
        "cycleway",
        "bridleway",
        "pedestrian",
        "track",
        "service",
        "living_street",
        "residential",
        "unclassified",
        "tertiary_link",
        "tertiary",
        "secondary_link",
        "secondary",
        "primary_link",
        "primary",
        "trunk_link",
        "trunk",
        "motorway_link",
        "motorway",
    ];
    ORDER.iter().position(|c| *c == class).unwrap_or(9) as i32
}
