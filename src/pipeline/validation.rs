//! Mesh checks of a scene. In: the leaves of every feature. Out: defects per feature and in total, as they go into
//! `validation.json`.
//!
//! Checked is what the rules made, before it is put on the ground: foundations and the ground itself are not in it.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::geodata::ledger::Outcome;
use crate::geometry::Mesh;
use crate::geometry::mesh_checks::{Bodies, Defect, bodies};
use crate::interpreter::tree::Leaf;

/// What the checks found on one feature, in all its states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FeatureChecks {
    /// `way/123`.
    pub feature: String,
    pub closed_bodies: usize,
    /// Surfaces that enclose nothing: streets, ruins, roofs whose rules drop the floor.
    pub open_surfaces: usize,
    /// Findings by the name of the defect.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub defects: BTreeMap<&'static str, usize>,
}

/// All features that have geometry, in the order of the map.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Validation {
    pub scene: String,
    pub features: Vec<FeatureChecks>,
}

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DefectTotal {
    pub defect: &'static str,
    /// Features that have it, in order.
    pub features: Vec<String>,
    pub findings: usize,
}

impl Validation {
    pub fn is_valid(&self) -> bool {
        self.features.iter().all(|f| f.defects.is_empty())
    }

    pub fn closed_bodies(&self) -> usize {
        self.features.iter().map(|f| f.closed_bodies).sum()
    }

    pub fn open_surfaces(&self) -> usize {
        self.features.iter().map(|f| f.open_surfaces).sum()
    }

    /// A line for every check, found or not.
    pub fn totals(&self) -> Vec<DefectTotal> {
        let total = |defect: Defect| {
            let with = || self.features.iter().filter_map(|f| Some((f, *f.defects.get(defect.name())?)));
            DefectTotal {
                defect: defect.name(),
                features: with().map(|(f, _)| f.feature.clone()).collect(),
                findings: with().map(|(_, n)| n).sum(),
            }
        };
        Defect::ALL.into_iter().map(total).collect()
    }
}

impl FeatureChecks {
    pub(super) fn new(feature: String, bodies: Bodies) -> FeatureChecks {
        let defects = bodies.defects.into_iter().map(|(d, n)| (d.name(), n)).collect();
        FeatureChecks { feature, closed_bodies: bodies.closed, open_surfaces: bodies.surfaces, defects }
    }

    /// What the ledger says of it.
    pub(super) fn outcome(&self) -> Outcome {
        let found: Vec<String> = self.defects.iter().map(|(name, count)| format!("{name} ({count})")).collect();
        if found.is_empty() { Outcome::Ok } else { Outcome::Invalid(found.join(", ")) }
    }
}

/// Checks all leaves of a feature together: walls and roofs are leaves of their own.
pub(super) fn check(leaves: &[Leaf]) -> Bodies {
    let mut mesh = Mesh::default();
    for leaf in leaves {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(&leaf.mesh.positions);
        mesh.faces.extend(leaf.mesh.faces.iter().map(|face| {
            let mut face = face.clone();
            face.loops_mut().flatten().for_each(|v| *v += first);
            face
        }));
    }
    bodies(&mesh)
}
