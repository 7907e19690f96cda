//! Streets along the edges of start shapes. In: a scene's features and the outline of a lot. Out: per edge the street it
//! faces: its width, distance, name and class (reference 3.7, 3.12).
//!
//! An edge faces the nearest road that runs about parallel to it, on its outer side and near its middle, with no building
//! in between.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::geodata::feature::{Feature, FeatureClass, Outline};
use crate::geodata::tags::road_width;
use crate::geometry::Mesh;
use crate::geometry::box_tree::{Bounds, BoxTree};
use crate::interpreter::HostData;
use crate::interpreter::host::{EdgeAttribute, EdgeValues};

/// Farthest edge of a roadway from the edge of a lot, metres.
const FARTHEST: f64 = 30.0;
/// Sine of the greatest angle between an edge and its street: 30 degrees.
const SKEW: f64 = 0.5;
/// Cosine of the greatest angle between the way to the street and straight ahead: 45 degrees.
const AHEAD: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Ways that no house has as its address side.
const NO_STREETS: &[&str] = &[
    "footway",
    "path",
    "steps",
    "cycleway",
    "bridleway",
    "corridor",
    "platform",
    "elevator",
    "construction",
    "proposed",
    "raceway",
    "bus_guideway",
];

/// A stretch of road.
struct Stretch {
    from: DVec2,
    to: DVec2,
    road: usize,
}

struct Road {
    width: f64,
    name: Arc<str>,
    class: Arc<str>,
}

/// The roads and the buildings of a scene, ready for questions.
pub struct Streets {
    roads: Vec<Road>,
    stretches: Vec<Stretch>,
    near: BoxTree,
    /// Edges of building outlines.
    walls: Vec<(DVec2, DVec2)>,
    near_walls: BoxTree,
}

/// The street an edge faces.
struct Found {
    /// From the middle of the edge to the edge of the roadway, metres; not negative.
    distance: f64,
    road: usize,
}

impl Streets {
    pub fn new(features: &[Feature]) -> Streets {
        let (mut roads, mut stretches, mut walls) = (Vec::new(), Vec::new(), Vec::new());
        for feature in features {
            match (feature.class, &feature.outline) {
                (FeatureClass::Highway, Outline::Line(line)) if is_street(feature) => {
                    let tag = |key: &str| feature.tags.get(key).cloned().unwrap_or_else(|| "".into());
                    let width = road_width(&feature.tags).metres;
                    stretches.extend(line.windows(2).map(|w| Stretch { from: w[0], to: w[1], road: roads.len() }));
                    roads.push(Road { width, name: tag("name"), class: tag("highway") });
                }
                (FeatureClass::Building, Outline::Area(polygon)) => {
                    for ring in polygon.rings() {
                        walls.extend((0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
                    }
                }
                _ => {}
            }
        }
        let near = BoxTree::new(stretches.iter().map(|s| bounds(s.from, s.to)).collect());
        let near_walls = BoxTree::new(walls.iter().map(|w| bounds(w.0, w.1)).collect());
        Streets { roads, stretches, near, walls, near_walls }
    }

    /// Street widths and the edge attributes `streetWidth`, `streetDistance` (metres, infinite without a street),
    /// `streetName` and `streetClass` (the value of `highway`) of a mesh, in face-edge order.
    pub fn of_edges(&self, mesh: &Mesh) -> HostData {
        let plan = |v: u32| DVec2::new(mesh.positions[v as usize].x, -mesh.positions[v as usize].z);
        let edges = mesh.faces.iter().flat_map(|face| face.edges());
        let found: Vec<Option<Found>> = edges.map(|(a, b)| self.faced(plan(a), plan(b))).collect();
        let road = |f: &Option<Found>| f.as_ref().map(|f| &self.roads[f.road]);
        let width = |f: &Option<Found>| road(f).map_or(0.0, |r| r.width);
        let text = |of: fn(&Road) -> &Arc<str>| {
            EdgeValues::Strings(found.iter().map(|f| road(f).map_or_else(|| "".into(), |r| of(r).clone())).collect())
        };
        let distance = |f: &Option<Found>| f.as_ref().map_or(f64::INFINITY, |f| f.distance);
        let street_widths: Vec<f64> = found.iter().map(width).collect();
        let attributes = [
            ("streetWidth", EdgeValues::Floats(street_widths.clone())),
            ("streetDistance", EdgeValues::Floats(found.iter().map(distance).collect())),
            ("streetName", text(|road| &road.name)),
            ("streetClass", text(|road| &road.class)),
        ];
        let edge_attributes = attributes.map(|(name, values)| EdgeAttribute { name: name.into(), values }).into();
        HostData { edge_attributes, street_widths, place: None }
    }

    /// The street that an edge of a counter-clockwise outline (or a clockwise hole) faces.
    fn faced(&self, a: DVec2, b: DVec2) -> Option<Found> {
        let along = (b - a).try_normalize()?;
        let outward = -along.perp();
        let middle = a.midpoint(b);
        // No believed road is wider than twice this.
        const HALF_OF_WIDEST: f64 = 40.0;
        let around = bounds(middle, middle).grown(FARTHEST + HALF_OF_WIDEST);
        let mut found: Vec<Found> = Vec::new();
        let mut places: Vec<DVec2> = Vec::new();
        for i in self.near.touching(&around) {
            let stretch = &self.stretches[i];
            let Some(direction) = (stretch.to - stretch.from).try_normalize() else { continue };
            let length = stretch.from.distance(stretch.to);
            let foot = stretch.from + direction * (middle - stretch.from).dot(direction).clamp(0.0, length);
            let way = foot - middle;
            let distance = (way.length() - self.roads[stretch.road].width / 2.0).max(0.0);
            let parallel = along.perp_dot(direction).abs() <= SKEW;
            if parallel && distance <= FARTHEST && way.dot(outward) > AHEAD * way.length() {
                found.push(Found { distance, road: stretch.road });
                places.push(foot);
            }
        }
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|&i, &j| found[i].distance.total_cmp(&found[j].distance).then(i.cmp(&j)));
        let free = order.into_iter().find(|&i| !self.is_hidden(middle + outward * CLEAR, places[i]))?;
        Some(found.swap_remove(free))
    }

    /// Whether a wall stands between two points.
    fn is_hidden(&self, from: DVec2, to: DVec2) -> bool {
        self.near_walls.touching(&bounds(from, to)).into_iter().any(|i| {
            let (a, b) = self.walls[i];
            let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) > 0.0;
            side(from, to, a) != side(from, to, b) && side(a, b, from) != side(a, b, to)
        })
    }
}

/// How far in front of its wall an edge looks from, metres: party walls look into the neighbour.
const CLEAR: f64 = 0.05;

fn is_street(feature: &Feature) -> bool {
    let tag = |key: &str| feature.tags.get(key).map_or("", |v| v);
    !NO_STREETS.contains(&tag("highway")) && matches!(tag("tunnel"), "" | "no")
}

fn bounds(a: DVec2, b: DVec2) -> Bounds {
    let (lo, hi) = (a.min(b), a.max(b));
    Bounds { lo: DVec3::new(lo.x, lo.y, 0.0), hi: DVec3::new(hi.x, hi.y, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geodata::feature::{FeatureId, ObjectKind};
    use crate::geometry::{PlaneFrame, Polygon};

    fn feature(class: FeatureClass, outline: Outline, tags: &[(&str, &str)]) -> Feature {
        let id = FeatureId { kind: ObjectKind::Way, id: 1, part: 0 };
        Feature { id, class, outline, tags: tags.iter().map(|(k, v)| ((*k).into(), (*v).into())).collect() }
    }

    fn road(points: [(f64, f64); 2], tags: &[(&str, &str)]) -> Feature {
        feature(FeatureClass::Highway, Outline::Line(points.map(Into::into).into()), tags)
    }

    fn house(x: f64, y: f64) -> (Polygon, Mesh) {
        let outer = [(x, y), (x + 10.0, y), (x + 10.0, y + 8.0), (x, y + 8.0)].map(Into::into).into();
        let polygon = Polygon { outer, holes: Vec::new() };
        let mut mesh = Mesh::default();
        PlaneFrame::PLAN.push_face(&mut mesh, &polygon, 3.0);
        (polygon, mesh)
    }

    #[test]
    fn edges_face_the_nearest_parallel_street_in_sight() {
        let (front, front_mesh) = house(0.0, 0.0);
        let (back, back_mesh) = house(0.0, 12.0);
        let features = [
            road([(-50.0, -10.0), (60.0, -10.0)], &[("highway", "residential"), ("name", "South"), ("width", "6")]),
            road([(-50.0, -20.0), (60.0, -20.0)], &[("highway", "primary"), ("name", "Far"), ("width", "9")]),
            road([(25.0, -50.0), (30.0, 60.0)], &[("highway", "service"), ("width", "4")]),
            road([(-1.0, -50.0), (-1.0, 60.0)], &[("highway", "footway")]),
            road([(-50.0, 23.0), (60.0, 23.0)], &[("highway", "primary"), ("tunnel", "yes")]),
            feature(FeatureClass::Building, Outline::Area(front), &[]),
            feature(FeatureClass::Building, Outline::Area(back), &[]),
        ];
        let streets = Streets::new(&features);
        let host = streets.of_edges(&front_mesh);
        assert_eq!(host.street_widths, [6.0, 4.0, 0.0, 0.0]);
        let values = |name: &str| host.edge_attributes.iter().find(|a| &*a.name == name).map(|a| a.values.clone());
        assert_eq!(values("streetName"), Some(EdgeValues::Strings(["South", "", "", ""].map(Into::into).into())));
        assert_eq!(
            values("streetClass"),
            Some(EdgeValues::Strings(["residential", "service", "", ""].map(Into::into).into()))
        );
        let Some(EdgeValues::Floats(distances)) = values("streetDistance") else { panic!("numbers") };
        assert_eq!((distances[0], distances[2]), (7.0, f64::INFINITY));
        assert!((distances[1] - (25.0 + 54.0 * 5.0 / 110.0 - 10.0 - 2.0)).abs() < 0.1, "{distances:?}");
        // The house behind sees no street past the one in front.
        assert_eq!(streets.of_edges(&back_mesh).street_widths, [0.0, 4.0, 0.0, 0.0]);
    }
}
