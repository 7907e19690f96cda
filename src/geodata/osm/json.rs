//! JSON maps, streamed. In: Overpass JSON (`elements`) or GeoJSON (`features`). Out: their objects in the builder.
//!
//! Overpass: <https://wiki.openstreetmap.org/wiki/Overpass_API/Overpass_QL#out>, with `nodes`, inline `geometry`, or
//! both; a way of which only the `center` was asked for has no nodes and is skipped later with that reason.

use std::fmt;

use serde::Deserialize;
use serde::de::{DeserializeSeed, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::container::CountedReader;
use super::data::{OsmBuilder, Position};
use super::error::{Fault, MapPlace};
use crate::geodata::feature::ObjectKind;
use crate::geodata::geojson;

/// Reads a whole document.
pub(super) fn read(input: CountedReader, builder: &mut OsmBuilder) -> Result<(), Fault> {
    let mut json = serde_json::Deserializer::from_reader(input);
    let done = Document(builder).deserialize(&mut json).and_then(|()| json.end());
    done.map_err(|error| {
        let place = MapPlace::LineColumn(error.line() as u64, error.column() as u64);
        if error.is_io() {
            Fault::from_io(error.into(), place)
        } else if error.is_eof() {
            Fault::Truncated(place)
        } else {
            let text = error.to_string();
            let message = text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message);
            Fault::Malformed(place, message.to_owned())
        }
    })
}

/// The document's outermost object.
struct Document<'a>(&'a mut OsmBuilder);

impl<'de> DeserializeSeed<'de> for Document<'_> {
    type Value = ();

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Document<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an Overpass answer or a GeoJSON object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let mut found = false;
        let mut single = geojson::Single::default();
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "elements" => {
                    map.next_value_seed(List { builder: &mut *self.0, add })?;
                    found = true;
                }
                "features" => {
                    map.next_value_seed(List { builder: &mut *self.0, add: geojson::add })?;
                    found = true;
                }
                "remark" => {
                    let remark: String = map.next_value()?;
                    return Err(A::Error::custom(format!("the server's answer is not complete: {remark}")));
                }
                "crs" => geojson::check_crs(&map.next_value()?).map_err(A::Error::custom)?,
                "geometry" => single.geometry = map.next_value()?,
                "properties" => single.properties = map.next_value()?,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        let found = single.add(self.0).map_err(A::Error::custom)? || found;
        if found { Ok(()) } else { Err(A::Error::custom("neither `elements` (Overpass) nor `features` (GeoJSON)")) }
    }
}

/// A JSON array whose items are handed on one by one.
struct List<'a, T> {
    builder: &'a mut OsmBuilder,
    add: fn(&mut OsmBuilder, T) -> Result<(), String>,
}

impl<'de, T: Deserialize<'de>> DeserializeSeed<'de> for List<'_, T> {
    type Value = ();

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de, T: Deserialize<'de>> Visitor<'de> for List<'_, T> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an array")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        while let Some(item) = items.next_element()? {
            (self.add)(self.builder, item).map_err(A::Error::custom)?;
        }
        Ok(())
    }
}

/// An element of an Overpass answer.
#[derive(Deserialize)]
struct Element {
    #[serde(rename = "type")]
    kind: String,
    id: i64,
    lat: Option<f64>,
    lon: Option<f64>,
    #[serde(default)]
    tags: std::collections::BTreeMap<String, String>,
    nodes: Option<Vec<i64>>,
    /// Null where the node lies outside the box that was asked for.
    geometry: Option<Vec<Option<Point>>>,
    #[serde(default)]
    members: Vec<MemberElement>,
}

#[derive(Deserialize)]
struct MemberElement {
    #[serde(rename = "type")]
    kind: String,
    #[serde(rename = "ref")]
    id: i64,
    #[serde(default)]
    role: String,
    lat: Option<f64>,
    lon: Option<f64>,
    geometry: Option<Vec<Option<Point>>>,
}

#[derive(Clone, Copy, Deserialize)]
struct Point {
    lat: f64,
    lon: f64,
}

fn add(builder: &mut OsmBuilder, element: Element) -> Result<(), String> {
    let id = element.id;
    match element.kind.as_str() {
        "node" => {
            builder.node(id, position(element.lon, element.lat).ok_or_else(|| format!("node {id} has no position"))?);
            if element.tags.iter().any(|(key, value)| OsmBuilder::is_plant(key, value)) {
                let tags = tags(builder, &element);
                builder.plant(id, tags);
            }
        }
        "way" => {
            let refs = way_refs(builder, &element)?;
            let tags = tags(builder, &element);
            builder.way(id, refs, tags);
        }
        "relation" => {
            let members = element.members.iter().map(|m| member(builder, id, m)).collect::<Result<Vec<_>, _>>()?;
            let tags = tags(builder, &element);
            builder.relation(id, members, tags);
        }
        // Areas, counts and timelines of other queries.
        _ => {}
    }
    Ok(())
}

fn position(lon: Option<f64>, lat: Option<f64>) -> Option<Position> {
    Position::from_degrees(lon?, lat?)
}

fn tags(builder: &mut OsmBuilder, element: &Element) -> Vec<(u32, u32)> {
    element.tags.iter().map(|(key, value)| (builder.string(key), builder.string(value))).collect()
}

fn way_refs(builder: &mut OsmBuilder, way: &Element) -> Result<Vec<i64>, String> {
    match (&way.nodes, &way.geometry) {
        (Some(nodes), Some(geometry)) if nodes.len() != geometry.len() => {
            Err(format!("way {} has {} nodes but {} points", way.id, nodes.len(), geometry.len()))
        }
        (Some(nodes), Some(geometry)) => {
            for (&node, point) in nodes.iter().zip(geometry).filter_map(|(n, p)| Some((n, p.as_ref()?))) {
                builder.node(node, place(way.id, point)?);
            }
            Ok(nodes.clone())
        }
        (Some(nodes), None) => Ok(nodes.clone()),
        (None, Some(geometry)) => points(builder, way.id, geometry),
        (None, None) => Ok(Vec::new()),
    }
}

/// Nodes without ids; a point outside the box becomes a reference to no node.
fn points(builder: &mut OsmBuilder, way: i64, geometry: &[Option<Point>]) -> Result<Vec<i64>, String> {
    geometry
        .iter()
        .map(|point| match point {
            Some(point) => place(way, point).map(|position| builder.anonymous_node(position)),
            None => Ok(OsmBuilder::NO_NODE),
        })
        .collect()
}

fn place(way: i64, point: &Point) -> Result<Position, String> {
    position(Some(point.lon), Some(point.lat)).ok_or_else(|| format!("way {way} leaves the earth's coordinates"))
}

fn member(builder: &mut OsmBuilder, relation: i64, m: &MemberElement) -> Result<(ObjectKind, i64, u32), String> {
    let kind = match m.kind.as_str() {
        "node" => ObjectKind::Node,
        "way" => ObjectKind::Way,
        "relation" => ObjectKind::Relation,
        other => return Err(format!("relation {relation} has a member of type `{other}`")),
    };
    if let Some(position) = position(m.lon, m.lat) {
        builder.node(m.id, position);
    }
    if let Some(geometry) = &m.geometry {
        let refs = points(builder, m.id, geometry)?;
        builder.stub_way(m.id, refs);
    }
    Ok((kind, m.id, builder.string(&m.role)))
}
