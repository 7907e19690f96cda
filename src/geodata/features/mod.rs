//! Map objects → features. In: [`OsmData`]. Out: [`Feature`]s in the local frame, and the ledger's lines.
//!
//! - Buildings and building parts belong to the scene as a whole if the centre of gravity of their footprint lies in the
//!   area; parts follow their outline. Everything else is cut to the area.
//! - Roads stay centre lines ([`Outline::Line`]); [`ribbon`] makes surfaces of them. Running water becomes surfaces here.
//! - Coastlines become one or more polygons of sea (`natural=coastline`, `water=sea`).
//! - Every feature of the area gets one record in the ledger, and so does every object that should have been one.

pub mod area;
mod build;
mod classify;
mod coastline;
mod duplicate;
mod gather;
mod inner_parts;
mod multipolygon;
#[cfg(test)]
mod multipolygon_tests;
mod parts;
pub mod ribbon;
mod rings;
mod scene;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::feature::{Feature, FeatureClass, FeatureId, ObjectKind, Outline};
use super::ledger::{Ledger, Outcome};
use super::osm::{LonLatBox, OsmData, Position, TagsView};
use crate::geometry::Ring;
use crate::geometry::repair::{Options, Verdict, repair};
use area::Area;
use build::{Built, build};
use parts::Footprint;
use scene::{Scene, centroid};

/// Where an area is asked for, broken objects without any node are counted under this, not listed.
const UNPLACED: &str = "outside the area: object without known nodes";

/// See [`super::map::extract`].
pub fn extract(
    data: &OsmData,
    area: Option<&Area>,
    project: &(dyn Fn(f64, f64) -> DVec2 + Sync),
    ledger: &mut Ledger,
) -> Vec<Feature> {
    let scene = Scene::new(data, area, project);
    let found = gather::gather(&scene);
    if found.unplaced > 0 {
        *ledger.assumptions.entry(UNPLACED.to_owned()).or_default() += found.unplaced;
    }
    let built: Vec<Built> = found.candidates.par_iter().map(|candidate| build(&scene, candidate)).collect();

    let mut features = Vec::new();
    let mut footprints = Vec::new();
    let mut records: Vec<(FeatureId, Outcome)> = found
        .skipped
        .into_iter()
        .map(|(kind, id, why)| (FeatureId { kind, id, part: 0 }, Outcome::Skipped(why)))
        .collect();
    for Built { id, features: made, outcome } in built {
        if matches!(outcome, Outcome::Skipped(_)) {
            records.push((id, outcome.clone()));
        }
        for feature in made {
            match (feature.class, &feature.outline) {
                (FeatureClass::Building | FeatureClass::BuildingPart, Outline::Area(polygon)) => {
                    let home = centroid(polygon);
                    footprints.push(Footprint { feature, outcome: outcome.clone(), home, dropped: None });
                }
                _ => {
                    records.push((feature.id, outcome.clone()));
                    features.push(feature);
                }
            }
        }
    }
    parts::resolve(&mut footprints);
    renumber(&mut footprints);
    for footprint in footprints.into_iter().filter(|f| scene.holds(f.home)) {
        match footprint.dropped {
            Some(why) => records.push((footprint.feature.id, Outcome::Skipped(why))),
            None => {
                records.push((footprint.feature.id, footprint.outcome));
                features.push(footprint.feature);
            }
        }
    }
    features.extend(sea(&scene, &found.coast, &mut records));

    features.sort_by_key(|feature| feature.id);
    records.sort_by_key(|record| record.0);
    for (id, outcome) in records {
        ledger.record(id, outcome);
    }
    features
}

/// Numbers the polygons of each object anew, because outlines may have been cut to pieces.
fn renumber(footprints: &mut [Footprint]) {
    footprints.sort_by_key(|f| f.feature.id);
    let mut last = None;
    let mut next = 0;
    for footprint in footprints {
        let id = &mut footprint.feature.id;
        next = if last == Some((id.kind, id.id)) { next + 1 } else { 0 };
        last = Some((id.kind, id.id));
        id.part = next;
    }
}

/// Water on the seaward side of the coastline, up to the border of the area (or of the map's extent).
fn sea(scene: &Scene, coast: &[(i64, Vec<Position>)], records: &mut Vec<(FeatureId, Outcome)>) -> Vec<Feature> {
    let Some(first) = coast.iter().map(|(id, _)| *id).min() else { return Vec::new() };
    let id = FeatureId { kind: ObjectKind::Way, id: first, part: 0 };
    let border: Option<Ring> =
        scene.area_ring().cloned().or_else(|| Some(scene.ring_of(&Area::Box(extent(scene.data)?))));
    let Some(border) = border else { return Vec::new() };
    let lines: Vec<Vec<DVec2>> = coast.iter().map(|(_, line)| scene.local_line(line)).collect();
    let water = match coastline::sea(&lines, &border) {
        Ok(water) => water,
        Err(why) => {
            records.push((id, Outcome::Skipped(why)));
            return Vec::new();
        }
    };
    let tags = [("natural", "coastline"), ("water", "sea")].map(|(k, v)| (Arc::from(k), Arc::from(v)));
    let mut features = Vec::new();
    let outcome = match water.bridged {
        0.0 => Outcome::Ok,
        gap => Outcome::Repaired(format!("the coastline was continued straight over {gap:.0} m to the border")),
    };
    for polygon in water.polygons {
        let rings: Vec<Ring> = polygon.rings().cloned().collect();
        let repaired = repair(&rings, &Options::default());
        if let Verdict::Rejected(why) = repaired.verdict {
            records.push((id, Outcome::Skipped(format!("sea: {why}"))));
        }
        for polygon in repaired.polygons {
            let id = FeatureId { part: features.len() as u32, ..id };
            records.push((id, outcome.clone()));
            let outline = Outline::Area(polygon);
            features.push(Feature { id, class: FeatureClass::Water, outline, tags: tags.iter().cloned().collect() });
        }
    }
    features
}

/// See [`super::map::extent`].
pub fn extent(data: &OsmData) -> Option<LonLatBox> {
    let around = |wanted: &dyn Fn(TagsView) -> bool| {
        let ways = data.ways().filter(|way| way.refs.len() > 2 && wanted(way.tags));
        let nodes = ways.flat_map(|way| way.refs.iter().filter_map(|id| data.node(*id))).map(Position::degrees);
        let shapes = data.shapes().filter(|shape| wanted(shape.tags));
        let shapes = shapes.flat_map(|shape| shape.geometry.positions()).map(Position::degrees);
        LonLatBox::around(nodes.chain(shapes))
    };
    let of = |key: &'static str| around(&move |tags| tags.get(key).is_some());
    data.bounds.or_else(|| of("building")).or_else(|| of("highway")).or_else(|| around(&|_| true))
}
