//! Tags → attributes of start shapes. In: a feature's tags. Out: named values, and the ledger's assumptions.
//!
//! Buildings and building parts:
//!
//! | attribute | unit | from | where the tag is missing |
//! | --- | --- | --- | --- |
//! | `osmId` | | `way/123` (`@id` of GeoJSON exports) | always there |
//! | `buildingType` | | `building`, else `building:part`, as tagged | always there |
//! | `height` | m | `height`, `building:height`: ground to ridge | levels × storey height, else [`Defaults`] |
//! | `minHeight` | m | `min_height`, `building:min_level` × storey height | 0 |
//! | `levels` | storeys | `building:levels`: without those in the roof | (height − roof height) / storey height, at least 1 |
//! | `roofShape` | | `roof:shape`, `building:roof:shape` | left to the rule |
//! | `roofHeight` | m | `roof:height`, `roof:levels` × storey height, 0 for flat roofs | left to the rule |
//! | `roofLevels` | storeys | `roof:levels` | left to the rule |
//! | `eaveHeight` | m | `height` − `roofHeight` | left to the rule, as `roofHeight` is |
//! | `roofAngle` | degrees | `roof:angle` | left to the rule |
//! | `roofDirection` | degrees clockwise from north, downhill | `roof:direction` (number or N, NNE, …) | left to the rule |
//! | `roofOrientation` | | `roof:orientation`: `along`, `across` | left to the rule |
//! | `wallColor`, `roofColor` | `#rrggbb` | `building:colour`, `roof:colour`, names and hex | left to the rule |
//! | `wallMaterial`, `roofMaterial` | | `building:material`, `building:facade:material`, `roof:material` | left to the rule |
//! | `name` | | `name` | left to the rule |
//! | `outlineId` | | building that a part belongs to | only parts with an outline |
//!
//! Highways: `osmId`, `highwayClass`, `width` (m, see [`road_width`]), `lanes`, `surface`, `name`, `layer`, `oneway`,
//! `bridge`. Land cover and water: `osmId`, `kind` (value of the key that made the class), `surface`, `name`.
//!
//! "Left to the rule" means that the attribute is not given, so the rule file's own default holds.
//! Tag meanings: <https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings>.

mod colour;
mod length;
#[cfg(test)]
mod tests;
mod width;

use std::sync::Arc;

use super::feature::{Feature, FeatureClass, Tags};
use super::ledger::Ledger;

pub use colour::colour;
pub use length::{compass, length, number};
pub use width::{lanes, road_width};

/// Key under which [`super::features`] notes the outline that a building part belongs to.
pub const OUTLINE_KEY: &str = "mansard:outline";

/// An attribute's value.
#[derive(Clone, Debug, PartialEq)]
pub enum TagValue {
    Number(f64),
    Text(Arc<str>),
    Bool(bool),
}

/// What is assumed where tags are missing.
#[derive(Clone, Debug, PartialEq)]
pub struct Defaults {
    /// Metres from floor to floor.
    pub storey_height: f64,
    /// Height of a building without height and levels, metres.
    pub height: f64,
    /// The same for certain values of `building`, which come before [`Self::height`].
    pub heights: Vec<(String, f64)>,
}

impl Default for Defaults {
    /// 3 m storeys; 6 m buildings; lower outbuildings, higher blocks of flats and halls.
    fn default() -> Self {
        let low = ["garage", "garages", "carport", "shed", "hut", "kiosk", "greenhouse", "static_caravan", "roof"];
        let heights = low.iter().map(|kind| (*kind, 3.0)).chain([
            ("bungalow", 4.5),
            ("apartments", 12.0),
            ("office", 12.0),
            ("hotel", 12.0),
            ("hospital", 12.0),
            ("industrial", 8.0),
            ("warehouse", 8.0),
            ("hangar", 10.0),
            ("church", 12.0),
            ("cathedral", 20.0),
        ]);
        let heights = heights.map(|(kind, height)| (kind.to_owned(), height)).collect();
        Defaults { storey_height: 3.0, height: 6.0, heights }
    }
}

impl Defaults {
    fn height_of(&self, kind: &str) -> f64 {
        self.heights.iter().find(|(k, _)| k == kind).map_or(self.height, |(_, height)| *height)
    }
}

/// The attributes of a feature, in the order of the tables above. What had to be assumed is counted in the ledger.
pub fn attributes(feature: &Feature, defaults: &Defaults, ledger: &mut Ledger) -> Vec<(Arc<str>, TagValue)> {
    let mut out = Attributes { tags: &feature.tags, ledger, list: Vec::new() };
    let id = feature.tags.get("@id").map_or_else(|| feature.id.to_string(), |id| id.to_string());
    out.text("osmId", Some(&id));
    match feature.class {
        FeatureClass::Building | FeatureClass::BuildingPart => building(&mut out, defaults),
        FeatureClass::Highway => highway(&mut out),
        FeatureClass::Landuse => land(&mut out, &["landuse"]),
        FeatureClass::Natural => land(&mut out, &["natural"]),
        FeatureClass::Leisure => land(&mut out, &["leisure"]),
        FeatureClass::Water => land(&mut out, &["water", "waterway", "natural", "landuse"]),
    }
    out.list
}

/// Attributes under construction.
struct Attributes<'a> {
    tags: &'a Tags,
    ledger: &'a mut Ledger,
    list: Vec<(Arc<str>, TagValue)>,
}

impl Attributes<'_> {
    /// The first of these tags that is there.
    fn tag(&self, keys: &[&str]) -> Option<&str> {
        keys.iter().find_map(|key| self.tags.get(*key)).map(|value| value.trim()).filter(|value| !value.is_empty())
    }

    /// The first of these tags, read by `read`; a value that cannot be read counts as missing, and is counted.
    fn read<T>(&mut self, keys: &[&str], read: impl Fn(&str) -> Option<T>) -> Option<T> {
        let value = self.tag(keys)?;
        let found = read(value);
        if found.is_none() {
            self.ledger.assume(format!("{}: unreadable value ignored", keys[0]));
        }
        found
    }

    fn number(&mut self, name: &str, value: Option<f64>) {
        self.list.extend(value.map(|value| (name.into(), TagValue::Number(value))));
    }

    fn text(&mut self, name: &str, value: Option<&str>) {
        self.list.extend(value.map(|value| (name.into(), TagValue::Text(value.into()))));
    }

    fn text_tag(&mut self, name: &str, keys: &[&str]) {
        let value = self.tag(keys).map(str::to_owned);
        self.text(name, value.as_deref());
    }

    fn flag(&mut self, name: &str, key: &str) {
        let value = self.tag(&[key]).is_some_and(|value| value != "no");
        self.list.push((name.into(), TagValue::Bool(value)));
    }
}

/// Greatest height, in metres, that a building tag is believed (the tallest building is 828 m high).
const MAX_HEIGHT: f64 = 1000.0;

fn building(out: &mut Attributes, defaults: &Defaults) {
    let storey = defaults.storey_height;
    let kind = out.tag(&["building", "building:part"]).unwrap_or("yes").to_owned();
    let positive = |text: &str| length(text).filter(|m| (0.0..MAX_HEIGHT).contains(m));
    let storeys = |text: &str| number(text).filter(|n| (0.0..MAX_HEIGHT / storey).contains(n));
    let levels = out.read(&["building:levels", "levels"], storeys);
    let roof_levels = out.read(&["roof:levels", "building:roof:levels"], storeys);
    let shape = out.tag(&["roof:shape", "building:roof:shape"]).map(str::to_lowercase);
    let min_height = min_height(out, storey, positive, storeys);
    let mut roof = out.read(&["roof:height", "building:roof:height"], positive);
    if roof.is_none() && shape.as_deref() == Some("flat") {
        roof = Some(0.0);
    } else if roof.is_none() {
        roof = roof_levels.filter(|n| *n > 0.0).map(|n| n * storey);
        if roof.is_some() {
            out.ledger.assume("roofHeight: from roof:levels");
        }
    }
    let tagged = out.read(&["height", "building:height"], positive).filter(|h| *h > 0.0);
    let height = tagged.unwrap_or_else(|| assumed_height(out, defaults, &kind, levels, roof, min_height));
    let height = if height > min_height {
        height
    } else {
        out.ledger.assume("height: not above minHeight, one storey added");
        min_height + storey
    };
    let roof = roof.map(|roof| roof.min(height - min_height));
    let body = height - min_height - roof.unwrap_or(0.0);
    let levels = levels.filter(|n| *n > 0.0).unwrap_or_else(|| {
        out.ledger.assume("levels: from height");
        (body / storey).round().max(1.0)
    });

    out.text("buildingType", Some(&kind));
    out.number("height", Some(height));
    out.number("minHeight", Some(min_height));
    out.number("levels", Some(levels));
    out.text("roofShape", shape.as_deref());
    out.number("roofHeight", roof);
    out.number("roofLevels", roof_levels);
    out.number("eaveHeight", roof.map(|roof| height - roof));
    building_looks(out);
}

/// Height from levels, or the default for the kind; counted.
fn assumed_height(
    out: &mut Attributes,
    defaults: &Defaults,
    kind: &str,
    levels: Option<f64>,
    roof: Option<f64>,
    min_height: f64,
) -> f64 {
    match levels {
        // Levels count from the ground, also those below a part's min_height.
        Some(levels) if levels > 0.0 || roof.is_some_and(|r| r > 0.0) => {
            out.ledger.assume("height: from levels");
            levels * defaults.storey_height + roof.unwrap_or(0.0)
        }
        _ => {
            let height = defaults.height_of(kind);
            out.ledger.assume(format!("height: default {height} m"));
            if min_height < height { height } else { min_height + height }
        }
    }
}

fn min_height(
    out: &mut Attributes,
    storey: f64,
    positive: impl Fn(&str) -> Option<f64>,
    storeys: impl Fn(&str) -> Option<f64>,
) -> f64 {
    if let Some(height) = out.read(&["min_height", "building:min_height"], positive) {
        return height;
    }
    let level = out.read(&["building:min_level", "min_level"], storeys).filter(|n| *n > 0.0);
    if level.is_some() {
        out.ledger.assume("minHeight: from building:min_level");
    }
    level.unwrap_or(0.0) * storey
}

fn building_looks(out: &mut Attributes) {
    let angle = out.read(&["roof:angle", "building:roof:angle"], |text| {
        number(text.trim_end_matches(['°', ' '])).filter(|a| (0.0..90.0).contains(a))
    });
    let direction = out.read(&["roof:direction", "building:roof:direction"], compass);
    let wall = out.read(&["building:colour", "building:color", "building:facade:colour"], colour);
    let roof = out.read(&["roof:colour", "roof:color", "building:roof:colour"], colour);
    out.number("roofAngle", angle);
    out.number("roofDirection", direction);
    out.text_tag("roofOrientation", &["roof:orientation", "building:roof:orientation"]);
    out.text("wallColor", wall.as_deref());
    out.text("roofColor", roof.as_deref());
    out.text_tag("wallMaterial", &["building:material", "building:facade:material"]);
    out.text_tag("roofMaterial", &["roof:material", "building:roof:material"]);
    out.text_tag("name", &["name"]);
    out.text_tag("outlineId", &[OUTLINE_KEY]);
}

fn highway(out: &mut Attributes) {
    let class = out.tag(&["highway", "area:highway", "place"]).map(|v| first(v).to_owned());
    let width = road_width(out.tags);
    if let Some(assumption) = width.assumption {
        out.ledger.assume(assumption);
    }
    let layer = out.read(&["layer"], number);
    out.text("highwayClass", class.as_deref());
    out.number("width", Some(width.metres));
    out.number("lanes", lanes(out.tags));
    out.text_tag("surface", &["surface"]);
    out.text_tag("name", &["name"]);
    out.number("layer", Some(layer.unwrap_or(0.0)));
    out.flag("oneway", "oneway");
    out.flag("bridge", "bridge");
}

fn land(out: &mut Attributes, keys: &[&str]) {
    let kind = out.tag(keys).map(|v| first(v).to_owned());
    out.text("kind", kind.as_deref());
    out.text_tag("surface", &["surface"]);
    out.text_tag("name", &["name"]);
}

/// The first of several values (`residential;service`).
pub fn first(value: &str) -> &str {
    value.split(';').next().unwrap_or(value).trim()
}
