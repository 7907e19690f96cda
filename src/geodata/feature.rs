//! A thing on the map in the local frame, with its tags and its identity.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;

use crate::geometry::Polygon;

/// The OSM object a feature came from, or the GeoJSON feature with its running number over all inputs, from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FeatureId {
    pub kind: ObjectKind,
    pub id: i64,
    /// Number of the polygon or line within the object (multipolygons fall into several).
    pub part: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ObjectKind {
    Node,
    Way,
    Relation,
    /// A GeoJSON feature: numbers of its own, so that they never meet OSM ids.
    Feature,
}

impl std::fmt::Display for FeatureId {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let kind = match self.kind {
            ObjectKind::Node => "node",
            ObjectKind::Way => "way",
            ObjectKind::Relation => "relation",
            ObjectKind::Feature => "feature",
        };
        write!(f, "{kind}/{}", self.id)?;
        if self.part > 0 { write!(f, "#{}", self.part) } else { Ok(()) }
    }
}

/// OSM tags, sorted by key.
pub type Tags = BTreeMap<Arc<str>, Arc<str>>;

/// The kinds of thing that rules are assigned to. The OSM key that decided it is the recipe's class name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FeatureClass {
    Building,
    BuildingPart,
    Highway,
    Landuse,
    Natural,
    Leisure,
    Water,
}

/// Shape in the plan: local metres, x east, y north, about the site's origin.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// Repaired polygon (counter-clockwise outer ring, clockwise holes).
    Area(Polygon),
    /// Centre line of a road.
    Line(Vec<DVec2>),
}

/// One feature ready for derivation.
#[derive(Clone, Debug)]
pub struct Feature {
    pub id: FeatureId,
    pub class: FeatureClass,
    pub outline: Outline,
    pub tags: Tags,
}
