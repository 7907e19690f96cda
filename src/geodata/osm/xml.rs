//! OSM XML, version 0.6, streamed. In: the text. Out: its objects in the builder.
//!
//! Objects that an editor marked as deleted (`action="delete"`, `visible="false"`) are left out. Elements that
//! this reader does not know are passed over with all they hold; entity declarations are refused.

use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::container::CountedReader;
use super::data::{LonLatBox, OsmBuilder, Position};
use super::error::{Fault, MapPlace};
use crate::geodata::feature::ObjectKind;

/// Reads a whole document.
pub(super) fn read(input: CountedReader, builder: &mut OsmBuilder) -> Result<(), Fault> {
    let mut reader = Reader::from_reader(input);
    let mut document = Document { builder, open: 0, object: None, rooted: false };
    let mut buffer = Vec::new();
    loop {
        buffer.clear();
        let event = match reader.read_event_into(&mut buffer) {
            Ok(event) => event,
            Err(error) => return Err(xml_fault(error, reader.get_ref().place())),
        };
        let step = match event {
            Event::Start(start) => document.start(&start),
            Event::Empty(start) => document.start(&start).and_then(|()| document.end()),
            Event::End(_) => document.end(),
            Event::DocType(_) => Err("document type and entity declarations are not allowed".to_owned()),
            Event::Eof if document.open > 0 => return Err(Fault::Truncated(reader.get_ref().place())),
            Event::Eof if !document.rooted => Err("no <osm> element".to_owned()),
            Event::Eof => return Ok(()),
            _ => Ok(()),
        };
        step.map_err(|message| Fault::Malformed(reader.get_ref().place(), message))?;
    }
}

fn xml_fault(error: quick_xml::Error, place: MapPlace) -> Fault {
    match error {
        quick_xml::Error::Io(error) => Fault::from_io(std::io::Error::new(error.kind(), error.to_string()), place),
        // Every syntax error of the parser is a construct that the end of the input left open.
        quick_xml::Error::Syntax(_) => Fault::Truncated(place),
        error => Fault::Malformed(place, error.to_string()),
    }
}

/// The object whose children are being read.
enum Object {
    Node { id: i64, tags: Vec<(u32, u32)>, is_plant: bool },
    Way { id: i64, refs: Vec<i64>, tags: Vec<(u32, u32)> },
    Relation { id: i64, members: Vec<(ObjectKind, i64, u32)>, tags: Vec<(u32, u32)> },
}

struct Document<'a> {
    builder: &'a mut OsmBuilder,
    /// Open elements.
    open: usize,
    object: Option<Object>,
    rooted: bool,
}

type Step = Result<(), String>;

impl Document<'_> {
    fn start(&mut self, start: &BytesStart) -> Step {
        self.open += 1;
        let attributes = Attributes::of(start)?;
        match (self.open, start.name().as_ref()) {
            (1, name) => self.root(name, &attributes),
            (2, "node") => self.node(&attributes),
            (2, "way") if !attributes.deleted() => {
                self.object = Some(Object::Way { id: attributes.id("way")?, refs: Vec::new(), tags: Vec::new() });
                Ok(())
            }
            (2, "relation") if !attributes.deleted() => {
                let id = attributes.id("relation")?;
                self.object = Some(Object::Relation { id, members: Vec::new(), tags: Vec::new() });
                Ok(())
            }
            (2, "bounds") => self.bounds(&attributes),
            (2, "remark") => Err("the server added a remark: its answer is not complete".to_owned()),
            (3, "nd") => self.node_reference(&attributes),
            (3, "member") => self.member(&attributes),
            (3, "tag") => self.tag(&attributes),
            _ => Ok(()),
        }
    }

    fn end(&mut self) -> Step {
        self.open = self.open.checked_sub(1).ok_or("an element is closed that was not opened")?;
        if self.open == 1 {
            match self.object.take() {
                Some(Object::Way { id, refs, tags }) => self.builder.way(id, refs, tags),
                Some(Object::Relation { id, members, tags }) => self.builder.relation(id, members, tags),
                Some(Object::Node { id, tags, is_plant: true }) => self.builder.plant(id, tags),
                Some(Object::Node { is_plant: false, .. }) | None => {}
            }
        }
        Ok(())
    }

    fn root(&mut self, name: &str, attributes: &Attributes) -> Step {
        if self.rooted {
            return Err(format!("<{name}> after the end of <osm>"));
        }
        self.rooted = true;
        match (name, attributes.get("version")) {
            ("osm", Some("0.6")) => Ok(()),
            ("osm", Some(version)) => Err(format!("OSM version {version}; only 0.6 can be read")),
            ("osm", None) => Err("<osm> without version=\"0.6\"".to_owned()),
            ("osmChange", _) => Err("an OSM change file; apply it to a map first".to_owned()),
            _ => Err(format!("<{name}> instead of <osm>")),
        }
    }

    fn node(&mut self, attributes: &Attributes) -> Step {
        if attributes.deleted() {
            return Ok(());
        }
        let id = attributes.id("node")?;
        let position = attributes.position().ok_or_else(|| format!("node {id} has no valid lat and lon"))?;
        self.builder.node(id, position);
        self.object = Some(Object::Node { id, tags: Vec::new(), is_plant: false });
        Ok(())
    }

    fn bounds(&mut self, attributes: &Attributes) -> Step {
        let side = |name: &str| attributes.number(name).ok_or_else(|| format!("<bounds> without a number `{name}`"));
        let bounds =
            LonLatBox { west: side("minlon")?, south: side("minlat")?, east: side("maxlon")?, north: side("maxlat")? };
        self.builder.bounds(bounds);
        Ok(())
    }

    fn node_reference(&mut self, attributes: &Attributes) -> Step {
        let Some(Object::Way { id, refs, .. }) = &mut self.object else { return Ok(()) };
        let reference = match (attributes.get("ref"), attributes.position()) {
            (Some(text), position) => {
                let node = text.parse().map_err(|_| format!("way {id} refers to a node `{text}`"))?;
                if let Some(position) = position {
                    self.builder.node(node, position);
                }
                node
            }
            (None, Some(position)) => self.builder.anonymous_node(position),
            (None, None) => return Err(format!("way {id} has an <nd> without ref")),
        };
        refs.push(reference);
        Ok(())
    }

    fn member(&mut self, attributes: &Attributes) -> Step {
        let Some(Object::Relation { id, members, .. }) = &mut self.object else { return Ok(()) };
        let kind = match attributes.get("type") {
            Some("node") => ObjectKind::Node,
            Some("way") => ObjectKind::Way,
            Some("relation") => ObjectKind::Relation,
            other => return Err(format!("relation {id} has a member of type `{}`", other.unwrap_or_default())),
        };
        let text = attributes.get("ref").ok_or_else(|| format!("relation {id} has a member without ref"))?;
        let member = text.parse().map_err(|_| format!("relation {id} has a member `{text}`"))?;
        let role = self.builder.string(attributes.get("role").unwrap_or_default());
        members.push((kind, member, role));
        Ok(())
    }

    fn tag(&mut self, attributes: &Attributes) -> Step {
        let Some(object) = &mut self.object else { return Ok(()) };
        let (Some(key), Some(value)) = (attributes.get("k"), attributes.get("v")) else {
            return Err("a <tag> without k and v".to_owned());
        };
        let tags = match object {
            Object::Way { tags, .. } | Object::Relation { tags, .. } => tags,
            Object::Node { tags, is_plant, .. } => {
                *is_plant |= OsmBuilder::is_plant(key, value);
                tags
            }
        };
        tags.push((self.builder.string(key), self.builder.string(value)));
        Ok(())
    }
}

/// The attributes of one element, unescaped.
struct Attributes<'a>(Vec<(&'a str, std::borrow::Cow<'a, str>)>);

impl<'a> Attributes<'a> {
    fn of(start: &'a BytesStart) -> Result<Self, String> {
        let unescape = |attribute: Attribute<'a>| {
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|e| e.to_string())?;
            Ok((attribute.key.into_inner(), value))
        };
        let all = start.attributes().map(|a| a.map_err(|e| e.to_string()).and_then(unescape));
        Ok(Attributes(all.collect::<Result<_, String>>()?))
    }

    fn get(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(key, _)| *key == name).map(|(_, value)| &**value)
    }

    fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.trim().parse().ok().filter(|n: &f64| n.is_finite())
    }

    fn id(&self, what: &str) -> Result<i64, String> {
        let text = self.get("id").ok_or_else(|| format!("a {what} without id"))?;
        text.trim().parse().map_err(|_| format!("a {what} with id `{text}`"))
    }

    fn position(&self) -> Option<Position> {
        Position::from_degrees(self.number("lon")?, self.number("lat")?)
    }

    fn deleted(&self) -> bool {
        self.get("action") == Some("delete") || self.get("visible") == Some("false")
    }
}
