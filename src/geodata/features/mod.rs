//! Map objects → features. In: [`OsmData`]. Out: [`Feature`]s in the local frame, and the ledger's lines.

pub mod area;

use glam::DVec2;

use super::feature::Feature;
use super::ledger::Ledger;
use super::osm::{LonLatBox, OsmData};
use area::Area;

pub fn extract(
    data: &OsmData,
    area: Option<&Area>,
    project: &(dyn Fn(f64, f64) -> DVec2 + Sync),
    ledger: &mut Ledger,
) -> Vec<Feature> {
    todo!()
}

pub fn extent(data: &OsmData) -> Option<LonLatBox> {
    todo!()
}
