//! Road widths. In: the tags of a road. Out: its paved width in metres and how it was found.

use super::{first, length, number};
use crate::geodata::feature::Tags;

/// Width of a road and, where no tag says it, what was assumed.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadWidth {
    pub metres: f64,
    pub assumption: Option<String>,
}

/// Believed widths, metres.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 0.3..=80.0;

/// Per class: lanes where not tagged (both directions), metres per lane, metres of shoulders in all.
/// Footways and the like are one lane of their whole width. Lane widths after the usual design values
/// (AASHTO Green Book 2018: 3.6 m freeways, 3.0-3.3 m streets; RASt 06 for paths).
const CLASSES: [(&str, f64, f64, f64); 29] = [
    ("motorway", 2.0, 3.6, 4.0),
    ("motorway_link", 1.0, 3.6, 2.0),
    ("trunk", 2.0, 3.6, 2.0),
    ("trunk_link", 1.0, 3.6, 1.5),
    ("primary", 2.0, 3.5, 1.5),
    ("primary_link", 1.0, 3.5, 1.0),
    ("secondary", 2.0, 3.5, 1.0),
    ("secondary_link", 1.0, 3.5, 1.0),
    ("tertiary", 2.0, 3.25, 0.5),
    ("tertiary_link", 1.0, 3.25, 0.5),
    ("unclassified", 2.0, 2.75, 0.0),
    ("residential", 2.0, 3.0, 0.0),
    ("living_street", 2.0, 2.5, 0.0),
    ("road", 2.0, 2.75, 0.0),
    ("busway", 2.0, 3.25, 0.0),
    ("bus_guideway", 1.0, 3.0, 0.0),
    ("raceway", 1.0, 10.0, 0.0),
    ("escape", 1.0, 4.0, 0.0),
    ("service", 1.0, 3.5, 0.0),
    ("track", 1.0, 2.5, 0.0),
    ("pedestrian", 1.0, 5.0, 0.0),
    ("footway", 1.0, 2.0, 0.0),
    ("cycleway", 1.0, 2.0, 0.0),
    ("bridleway", 1.0, 2.0, 0.0),
    ("path", 1.0, 1.5, 0.0),
    ("steps", 1.0, 2.0, 0.0),
    ("construction", 2.0, 3.0, 0.0),
    ("platform", 1.0, 3.0, 0.0),
    ("services", 1.0, 6.0, 0.0),
];

/// One-way streets keep room to stop beside their lane.
const ONE_WAY_LANES: f64 = 1.5;

/// Class of a road that the table does not know.
const OTHER: (f64, f64, f64) = (1.0, 3.0, 0.0);

/// Width from `width`, else from lanes and class, else from the class alone.
pub fn road_width(tags: &Tags) -> RoadWidth {
    let tagged = ["width", "width:carriageway", "est_width"].iter().find_map(|key| length(tags.get(*key)?));
    if let Some(metres) = tagged.filter(|w| PLAUSIBLE.contains(w)) {
        return RoadWidth { metres, assumption: None };
    }
    let class = tags.get("highway").map_or("", |value| first(value));
    let (mut usual, lane, shoulders) = CLASSES
        .iter()
        .find(|(name, ..)| *name == class)
        .map_or(OTHER, |&(_, lanes, lane, shoulders)| (lanes, lane, shoulders));
    if usual == 2.0 && !class.starts_with("motorway") && tags.get("oneway").is_some_and(|v| &**v != "no") {
        usual = ONE_WAY_LANES;
    }
    match lanes(tags) {
        Some(lanes) => RoadWidth { metres: lanes * lane + shoulders, assumption: Some("width: from lanes".to_owned()) },
        None => RoadWidth {
            metres: usual * lane + shoulders,
            assumption: Some(format!("width: default of highway={class}")),
        },
    }
}

/// Tagged number of lanes, if between 1 and 16.
pub fn lanes(tags: &Tags) -> Option<f64> {
    number(tags.get("lanes")?).filter(|n| (1.0..=16.0).contains(n))
}
