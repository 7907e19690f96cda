//! What a map object is. In: its tags. Out: the feature class and form, or why it is not drawn.
//!
//! The first key that decides wins: building, building:part, highway, water, leisure, natural, landuse.

use super::super::feature::FeatureClass;
use super::super::osm::TagsView;
use super::super::tags::{first, number};

/// What becomes of an object.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    Area(FeatureClass),
    /// Centre line of a road.
    Road,
    /// Centre line of running water.
    Waterway,
    Coastline,
    /// A feature that is not drawn, and why.
    Skip(String),
    /// Not a feature of any class.
    Nothing,
}

/// Values of `building` and `highway` that stand for things that are not there.
const NOT_THERE: [&str; 8] =
    ["proposed", "planned", "abandoned", "razed", "demolished", "destroyed", "removed", "disused"];

/// Values of `natural` that name a line, a point or a region instead of a cover.
const NOT_COVER: [&str; 22] = [
    "arch",
    "arete",
    "bay",
    "cape",
    "cave_entrance",
    "cliff",
    "coastline",
    "earth_bank",
    "gorge",
    "gully",
    "hill",
    "isthmus",
    "mountain_range",
    "peak",
    "peninsula",
    "plateau",
    "ridge",
    "saddle",
    "strait",
    "tree",
    "tree_row",
    "valley",
];

/// `closed`: whether the object has an outline (closed way, multipolygon, polygon).
pub fn classify(tags: TagsView, closed: bool) -> Verdict {
    if tags.is_empty() {
        return Verdict::Nothing;
    }
    let deciders = [building, building_part, highway, water, leisure, natural, landuse];
    deciders.iter().map(|decide| decide(tags, closed)).find(|v| *v != Verdict::Nothing).unwrap_or(Verdict::Nothing)
}

/// The value of a key that is there and not `no`.
fn value<'a>(tags: TagsView<'a>, key: &str) -> Option<&'a str> {
    tags.get(key).map(first).filter(|v| !v.is_empty() && *v != "no")
}

fn area(class: FeatureClass, closed: bool) -> Verdict {
    if closed { Verdict::Area(class) } else { Verdict::Skip("the outline is not closed".to_owned()) }
}

fn building(tags: TagsView, _: bool) -> Verdict {
    body(tags, "building", FeatureClass::Building)
}

fn building_part(tags: TagsView, _: bool) -> Verdict {
    body(tags, "building:part", FeatureClass::BuildingPart)
}

/// Buildings that the border of an extract left open are closed later, so `closed` does not matter.
fn body(tags: TagsView, key: &str, class: FeatureClass) -> Verdict {
    let Some(kind) = value(tags, key) else { return Verdict::Nothing };
    if NOT_THERE.contains(&kind) || kind == "entrance" {
        return Verdict::Skip(format!("not a standing building: {key}={kind}"));
    }
    let below = tags.get("layer").and_then(number).filter(|layer| *layer < 0.0);
    match (below, value(tags, "location"), value(tags, "tunnel")) {
        (Some(layer), ..) => Verdict::Skip(format!("underground: layer={layer}")),
        (_, Some("underground"), _) => Verdict::Skip("underground: location=underground".to_owned()),
        (.., Some(kind)) => Verdict::Skip(format!("underground: tunnel={kind}")),
        _ => Verdict::Area(class),
    }
}

fn highway(tags: TagsView, closed: bool) -> Verdict {
    let square = closed && value(tags, "place") == Some("square");
    let Some(kind) = value(tags, "highway").or(value(tags, "area:highway")).or(square.then_some("square")) else {
        return Verdict::Nothing;
    };
    if NOT_THERE.contains(&kind) {
        return Verdict::Skip(format!("not built: highway={kind}"));
    }
    if let Some(tunnel) = value(tags, "tunnel") {
        return Verdict::Skip(format!("underground: tunnel={tunnel}"));
    }
    if value(tags, "location") == Some("underground") {
        return Verdict::Skip("underground: location=underground".to_owned());
    }
    if kind == "corridor" || value(tags, "indoor").is_some() {
        return Verdict::Skip("inside a building".to_owned());
    }
    if ["elevator", "rest_area", "services", "bus_stop", "street_lamp"].contains(&kind) {
        return Verdict::Nothing;
    }
    let as_area = square || value(tags, "area").is_some() || tags.get("type") == Some("multipolygon");
    if closed && (as_area || value(tags, "area:highway").is_some() || kind == "platform") {
        Verdict::Area(FeatureClass::Highway)
    } else if value(tags, "highway").is_some() {
        Verdict::Road
    } else {
        Verdict::Skip("the outline is not closed".to_owned())
    }
}

fn water(tags: TagsView, closed: bool) -> Verdict {
    match value(tags, "natural") {
        Some("coastline") => return Verdict::Coastline,
        Some("water") => return area(FeatureClass::Water, closed),
        _ => {}
    }
    if matches!(value(tags, "landuse"), Some("reservoir" | "basin")) {
        return area(FeatureClass::Water, closed);
    }
    match value(tags, "waterway") {
        Some("riverbank" | "dock") => area(FeatureClass::Water, closed),
        Some("river" | "stream" | "canal" | "drain" | "ditch" | "tidal_channel") => match value(tags, "tunnel") {
            Some(tunnel) => Verdict::Skip(format!("underground: tunnel={tunnel}")),
            None if closed && value(tags, "area").is_some() => Verdict::Area(FeatureClass::Water),
            None => Verdict::Waterway,
        },
        _ => Verdict::Nothing,
    }
}

fn leisure(tags: TagsView, closed: bool) -> Verdict {
    match value(tags, "leisure") {
        None | Some("nature_reserve" | "slipway") => Verdict::Nothing,
        // A closed running track is usually drawn as its line.
        Some("track") if value(tags, "area").is_none() => Verdict::Nothing,
        Some(_) if value(tags, "indoor").is_some() || value(tags, "location") == Some("indoor") => {
            Verdict::Skip("inside a building".to_owned())
        }
        Some(_) => area(FeatureClass::Leisure, closed),
    }
}

fn natural(tags: TagsView, closed: bool) -> Verdict {
    match value(tags, "natural") {
        Some(kind) if !NOT_COVER.contains(&kind) => area(FeatureClass::Natural, closed),
        _ => Verdict::Nothing,
    }
}

fn landuse(tags: TagsView, closed: bool) -> Verdict {
    if value(tags, "landuse").is_some() { area(FeatureClass::Landuse, closed) } else { Verdict::Nothing }
}
