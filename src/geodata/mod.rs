//! Map and elevation: files → [`feature::Feature`]s in a [`projection::LocalFrame`], and [`terrain::Terrain`].

pub mod elevation;
pub mod feature;
pub mod features;
mod geojson;
pub mod greenery;
pub mod ledger;
pub mod map;
pub mod osm;
pub mod projection;
pub mod tags;
pub mod terrain;
#[cfg(test)]
mod testdata;
