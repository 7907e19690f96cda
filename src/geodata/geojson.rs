//! GeoJSON features (RFC 7946). In: parsed features. Out: shapes with tags in the builder.
//!
//! Properties become tags: texts as they are, numbers as text, `true`/`false` as `yes`/`no`, arrays joined by `;`,
//! nulls and other objects left out, a `tags` object unfolded. Points are left out, they make no feature.

use geojson::{Feature, Geometry, GeometryValue, JsonObject, JsonValue};
use serde_json::Value;

use super::osm::{OsmBuilder, Position, ShapeGeometry};

/// Object metadata that is not about the thing on the map (and names mappers).
const NOT_TAGS: [&str; 6] = ["@user", "@uid", "@version", "@changeset", "@timestamp", "@relations"];

/// Adds one feature of a collection.
pub(super) fn add(builder: &mut OsmBuilder, feature: Feature) -> Result<(), String> {
    let Some(geometry) = feature.geometry else { return Ok(()) };
    let (mut lines, mut polygons) = (Vec::new(), Vec::new());
    collect(geometry.value, &mut lines, &mut polygons)?;
    let tags = tags(builder, &feature.properties.unwrap_or_default());
    if !polygons.is_empty() {
        builder.shape(ShapeGeometry::Polygons(polygons), tags.iter().copied());
    }
    if !lines.is_empty() {
        builder.shape(ShapeGeometry::Lines(lines), tags);
    }
    Ok(())
}

/// A document that is one feature instead of a collection.
#[derive(Default)]
pub(super) struct Single {
    pub geometry: Option<Geometry>,
    pub properties: Option<JsonObject>,
}

impl Single {
    /// Whether there was one.
    pub fn add(self, builder: &mut OsmBuilder) -> Result<bool, String> {
        let found = self.geometry.is_some();
        add(builder, Feature { geometry: self.geometry, properties: self.properties, ..Feature::default() })?;
        Ok(found)
    }
}

/// Old files may name another coordinate system; only WGS 84 by longitude and latitude is GeoJSON today.
pub(super) fn check_crs(crs: &Value) -> Result<(), String> {
    let Some(name) = crs.pointer("/properties/name").and_then(Value::as_str) else { return Ok(()) };
    if ["CRS84", "EPSG::4326", "EPSG:4326", "EPSG:0:4326"].iter().any(|known| name.ends_with(known)) {
        Ok(())
    } else {
        Err(format!("coordinates in {name}; convert the file to WGS 84 (EPSG:4326)"))
    }
}

type Line = Vec<Position>;

fn collect(value: GeometryValue, lines: &mut Vec<Line>, polygons: &mut Vec<Vec<Line>>) -> Result<(), String> {
    match value {
        GeometryValue::Point { .. } | GeometryValue::MultiPoint { .. } => {}
        GeometryValue::LineString { coordinates } => lines.push(line(&coordinates)?),
        GeometryValue::MultiLineString { coordinates } => {
            for part in &coordinates {
                lines.push(line(part)?);
            }
        }
        GeometryValue::Polygon { coordinates } => polygons.push(rings(&coordinates)?),
        GeometryValue::MultiPolygon { coordinates } => {
            for part in &coordinates {
                polygons.push(rings(part)?);
            }
        }
        GeometryValue::GeometryCollection { geometries } => {
            for geometry in geometries {
                collect(geometry.value, lines, polygons)?;
            }
        }
    }
    Ok(())
}

fn rings(rings: &[Vec<geojson::Position>]) -> Result<Vec<Line>, String> {
    rings.iter().map(|ring| line(ring)).collect()
}

fn line(points: &[geojson::Position]) -> Result<Line, String> {
    points.iter().map(|point| position(point.as_slice())).collect()
}

fn position(point: &[f64]) -> Result<Position, String> {
    let (Some(&lon), Some(&lat)) = (point.first(), point.get(1)) else {
        return Err("a position with fewer than two numbers".to_owned());
    };
    Position::from_degrees(lon, lat)
        .ok_or_else(|| format!("position {lon}, {lat} is not a longitude and latitude in degrees"))
}

fn tags(builder: &mut OsmBuilder, properties: &JsonObject) -> Vec<(u32, u32)> {
    let mut out = Vec::new();
    for (key, value) in properties {
        if let ("tags", Value::Object(inner)) = (key.as_str(), value) {
            out.extend(tags(builder, inner));
        } else if let Some(text) = text(value).filter(|_| !NOT_TAGS.contains(&key.as_str())) {
            out.push((builder.string(key), builder.string(&text)));
        }
    }
    out
}

fn text(value: &JsonValue) -> Option<String> {
    match value {
        Value::Null | Value::Object(_) => None,
        Value::Bool(yes) => Some(if *yes { "yes" } else { "no" }.to_owned()),
        Value::Number(number) => Some(number.to_string()),
        Value::String(text) => Some(text.clone()),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().filter_map(text).collect();
            (!items.is_empty()).then(|| items.join(";"))
        }
    }
}
