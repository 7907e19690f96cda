//! Plants that the map names. In: [`OsmData`], the extracted features, the area. Out: single trees, lines of them and
//! areas in which they grow, in the local frame. What grows where is drawn later (`scene::vegetation`).

use glam::DVec2;

use super::feature::{Feature, FeatureClass, FeatureId, ObjectKind, Outline, Tags};
use super::features::area::{Area, clip_line};
use super::osm::OsmData;
use super::tags::first;
use crate::geometry::Polygon;
use crate::geometry::polygon::ring_contains;

/// Where plants stand, each list sorted by id.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Greenery {
    /// `natural=tree`, `natural=shrub`.
    pub single: Vec<SinglePlant>,
    pub rows: Vec<Row>,
    pub stands: Vec<Stand>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct SinglePlant {
    pub id: FeatureId,
    pub at: DVec2,
    pub tags: Tags,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowKind {
    Trees,
    Hedge,
}

/// Plants along a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub id: FeatureId,
    pub kind: RowKind,
    pub line: Vec<DVec2>,
    pub tags: Tags,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandKind {
    /// `natural=wood`, `landuse=forest`.
    Wood,
    /// `landuse=orchard`: in rows.
    Orchard,
    /// Parks, gardens and cemeteries: trees here and there, bushes between.
    Park,
    /// `natural=scrub`, `natural=heath`.
    Scrub,
    /// Grassland and meadows: a few bushes.
    Grass,
}

/// Plants in an area.
#[derive(Clone, Debug, PartialEq)]
pub struct Stand {
    pub id: FeatureId,
    pub kind: StandKind,
    pub outline: Polygon,
    pub tags: Tags,
}

/// Finds all plants in the area.
pub fn greenery(
    data: &OsmData,
    features: &[Feature],
    area: &Area,
    project: &(dyn Fn(f64, f64) -> DVec2 + Sync),
) -> Greenery {
    let ring = area.ring(project);
    let local = |position: super::osm::Position| {
        let (lon, lat) = position.degrees();
        project(lon, lat)
    };
    let single = data.plants().map(|(id, position, tags)| SinglePlant {
        id: FeatureId { kind: ObjectKind::Node, id, part: 0 },
        at: local(position),
        tags: tags.to_tags(),
    });
    let rows = data.ways().filter_map(|way| Some((way, row_kind(way.tags.get("natural"), way.tags.get("barrier"))?)));
    let rows = rows.flat_map(|(way, kind)| {
        let line: Vec<DVec2> = way.refs.iter().filter_map(|&id| data.node(id)).map(local).collect();
        let pieces = if line.len() > 1 { clip_line(&line, &ring) } else { Vec::new() };
        let tags = way.tags.to_tags();
        pieces.into_iter().enumerate().map(move |(part, line)| {
            let id = FeatureId { kind: ObjectKind::Way, id: way.id, part: part as u32 };
            Row { id, kind, line, tags: tags.clone() }
        })
    });
    let stands = features.iter().filter_map(|feature| {
        let Outline::Area(outline) = &feature.outline else { return None };
        let kind = stand_kind(feature.class, &feature.tags)?;
        Some(Stand { id: feature.id, kind, outline: outline.clone(), tags: feature.tags.clone() })
    });
    Greenery {
        single: single.filter(|plant| ring_contains(&ring, plant.at)).collect(),
        rows: rows.collect(),
        stands: stands.collect(),
    }
}

fn row_kind(natural: Option<&str>, barrier: Option<&str>) -> Option<RowKind> {
    match (natural.map(first), barrier.map(first)) {
        (Some("tree_row"), _) => Some(RowKind::Trees),
        (_, Some("hedge")) => Some(RowKind::Hedge),
        _ => None,
    }
}

fn stand_kind(class: FeatureClass, tags: &Tags) -> Option<StandKind> {
    let value = |key: &str| tags.get(key).map(|value| first(value));
    match class {
        FeatureClass::Natural => match value("natural")? {
            "wood" => Some(StandKind::Wood),
            "scrub" | "heath" => Some(StandKind::Scrub),
            "grassland" => Some(StandKind::Grass),
            _ => None,
        },
        FeatureClass::Landuse => match value("landuse")? {
            "forest" => Some(StandKind::Wood),
            "orchard" => Some(StandKind::Orchard),
            "cemetery" | "recreation_ground" | "village_green" => Some(StandKind::Park),
            "meadow" => Some(StandKind::Grass),
            _ => None,
        },
        FeatureClass::Leisure => matches!(value("leisure")?, "park" | "garden").then_some(StandKind::Park),
        FeatureClass::Building | FeatureClass::BuildingPart | FeatureClass::Highway | FeatureClass::Water => None,
    }
}
