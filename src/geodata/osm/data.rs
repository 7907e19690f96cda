//! The map in memory, whatever file it came from. In: objects in any order. Out: sorted, deduplicated [`OsmData`].
//!
//! Node tags are kept for plants alone: no feature class is made of single nodes.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::geodata::feature::{ObjectKind, Tags};

/// WGS 84 in units of 1e-7 degrees (1.1 cm), as OSM stores it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    pub lon: i32,
    pub lat: i32,
}

impl Position {
    /// `None` if not finite or outside ±180°, ±90°.
    pub fn from_degrees(lon: f64, lat: f64) -> Option<Position> {
        let inside = lon.abs() <= 180.0 && lat.abs() <= 90.0;
        inside.then(|| Position { lon: (lon * 1e7).round() as i32, lat: (lat * 1e7).round() as i32 })
    }

    /// Longitude and latitude in degrees.
    pub fn degrees(self) -> (f64, f64) {
        (f64::from(self.lon) / 1e7, f64::from(self.lat) / 1e7)
    }
}

/// Least and greatest longitude and latitude, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LonLatBox {
    pub west: f64,
    pub south: f64,
    pub east: f64,
    pub north: f64,
}

impl LonLatBox {
    /// The smallest box around points; `None` without points.
    pub fn around(points: impl IntoIterator<Item = (f64, f64)>) -> Option<LonLatBox> {
        points.into_iter().fold(None, |found, (lon, lat)| {
            let here = LonLatBox { west: lon, south: lat, east: lon, north: lat };
            Some(found.map_or(here, |b: LonLatBox| b.join(here)))
        })
    }

    pub fn join(self, other: LonLatBox) -> LonLatBox {
        LonLatBox {
            west: self.west.min(other.west),
            south: self.south.min(other.south),
            east: self.east.max(other.east),
            north: self.north.max(other.north),
        }
    }

    pub fn meets(&self, other: &LonLatBox) -> bool {
        self.west <= other.east && other.west <= self.east && self.south <= other.north && other.south <= self.north
    }

    pub fn center(&self) -> (f64, f64) {
        ((self.west + self.east) / 2.0, (self.south + self.north) / 2.0)
    }
}

type Span = std::ops::Range<usize>;

/// Tags of one object.
#[derive(Clone, Copy, Debug)]
pub struct TagsView<'a> {
    strings: &'a [Arc<str>],
    pairs: &'a [(u32, u32)],
}

impl<'a> TagsView<'a> {
    pub fn get(&self, key: &str) -> Option<&'a str> {
        self.iter().find(|(k, _)| *k == key).map(|(_, v)| v)
    }

    pub fn iter(&self) -> impl Iterator<Item = (&'a str, &'a str)> + use<'a> {
        let strings = self.strings;
        self.pairs.iter().map(move |&(k, v)| (&*strings[k as usize], &*strings[v as usize]))
    }

    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    pub fn to_tags(&self) -> Tags {
        let string = |i: u32| Arc::clone(&self.strings[i as usize]);
        self.pairs.iter().map(|&(k, v)| (string(k), string(v))).collect()
    }
}

#[derive(Clone, Debug)]
struct WayRecord {
    id: i64,
    /// Known only through a relation's inline geometry: gives way to the same way from elsewhere.
    stub: bool,
    refs: Span,
    tags: Span,
}

/// A way: its node ids in order.
#[derive(Clone, Copy, Debug)]
pub struct Way<'a> {
    pub id: i64,
    pub refs: &'a [i64],
    pub tags: TagsView<'a>,
}

#[derive(Clone, Debug)]
struct MemberRecord {
    kind: ObjectKind,
    id: i64,
    role: u32,
}

#[derive(Clone, Debug)]
struct RelationRecord {
    id: i64,
    members: Span,
    tags: Span,
}

/// One member of a relation.
#[derive(Clone, Copy, Debug)]
pub struct Member<'a> {
    pub kind: ObjectKind,
    pub id: i64,
    pub role: &'a str,
}

#[derive(Clone, Copy, Debug)]
pub struct Relation<'a> {
    pub id: i64,
    members: &'a [MemberRecord],
    pub tags: TagsView<'a>,
    strings: &'a [Arc<str>],
}

impl<'a> Relation<'a> {
    pub fn members(&self) -> impl Iterator<Item = Member<'a>> + use<'a> {
        let strings = self.strings;
        self.members.iter().map(move |m| Member { kind: m.kind, id: m.id, role: &strings[m.role as usize] })
    }
}

/// Geometry of a GeoJSON feature.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeGeometry {
    Lines(Vec<Vec<Position>>),
    /// Per polygon its rings, the outer one first, last points as in the file.
    Polygons(Vec<Vec<Vec<Position>>>),
}

impl ShapeGeometry {
    /// All positions, ring by ring.
    pub fn positions(&self) -> impl Iterator<Item = Position> + '_ {
        let (lines, polygons): (&[_], &[_]) = match self {
            ShapeGeometry::Lines(lines) => (lines, &[]),
            ShapeGeometry::Polygons(polygons) => (&[], polygons),
        };
        lines.iter().chain(polygons.iter().flatten()).flatten().copied()
    }
}

#[derive(Clone, Debug)]
struct ShapeRecord {
    id: i64,
    tags: Span,
    geometry: ShapeGeometry,
}

/// A GeoJSON feature.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// Running number over all inputs, from 1.
    pub id: i64,
    pub tags: TagsView<'a>,
    pub geometry: &'a ShapeGeometry,
}

/// Everything read from the inputs: sorted by id, each id once.
#[derive(Clone, Debug, Default)]
pub struct OsmData {
    nodes: Vec<(i64, Position)>,
    /// Nodes that stand for a plant.
    plants: Vec<(i64, Span)>,
    ways: Vec<WayRecord>,
    relations: Vec<RelationRecord>,
    shapes: Vec<ShapeRecord>,
    refs: Vec<i64>,
    tags: Vec<(u32, u32)>,
    members: Vec<MemberRecord>,
    strings: Vec<Arc<str>>,
    /// Union of the bounds that the inputs declare.
    pub bounds: Option<LonLatBox>,
}

impl OsmData {
    pub fn node(&self, id: i64) -> Option<Position> {
        self.nodes.binary_search_by_key(&id, |n| n.0).ok().map(|i| self.nodes[i].1)
    }

    /// Nodes with `natural=tree` or `natural=shrub`, by id.
    pub fn plants(&self) -> impl Iterator<Item = (i64, Position, TagsView<'_>)> {
        self.plants.iter().filter_map(|(id, tags)| Some((*id, self.node(*id)?, self.tags_view(tags))))
    }

    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    pub fn ways(&self) -> impl ExactSizeIterator<Item = Way<'_>> {
        self.ways.iter().map(|w| self.way_view(w))
    }

    pub fn way(&self, id: i64) -> Option<Way<'_>> {
        self.ways.binary_search_by_key(&id, |w| w.id).ok().map(|i| self.way_view(&self.ways[i]))
    }

    pub fn relations(&self) -> impl ExactSizeIterator<Item = Relation<'_>> {
        self.relations.iter().map(|r| Relation {
            id: r.id,
            members: &self.members[r.members.clone()],
            tags: self.tags_view(&r.tags),
            strings: &self.strings,
        })
    }

    pub fn shapes(&self) -> impl ExactSizeIterator<Item = Shape<'_>> {
        self.shapes.iter().map(|s| Shape { id: s.id, tags: self.tags_view(&s.tags), geometry: &s.geometry })
    }

    fn way_view(&self, way: &WayRecord) -> Way<'_> {
        Way { id: way.id, refs: &self.refs[way.refs.clone()], tags: self.tags_view(&way.tags) }
    }

    fn tags_view(&self, span: &Span) -> TagsView<'_> {
        TagsView { strings: &self.strings, pairs: &self.tags[span.clone()] }
    }
}

/// Collects objects of one or several files.
#[derive(Debug, Default)]
pub struct OsmBuilder {
    data: OsmData,
    string_ids: BTreeMap<Arc<str>, u32>,
    anonymous: i64,
}

impl OsmBuilder {
    /// A reference to a node that no file has.
    pub const NO_NODE: i64 = i64::MAX;

    pub fn string(&mut self, text: &str) -> u32 {
        if let Some(&id) = self.string_ids.get(text) {
            return id;
        }
        let (text, id) = (Arc::<str>::from(text), self.data.strings.len() as u32);
        self.data.strings.push(Arc::clone(&text));
        self.string_ids.insert(text, id);
        id
    }

    pub fn node(&mut self, id: i64, position: Position) {
        self.data.nodes.push((id, position));
    }

    /// Whether tags of a node are worth keeping.
    pub fn is_plant(key: &str, value: &str) -> bool {
        key == "natural" && matches!(value, "tree" | "shrub")
    }

    /// Keeps the tags of a node that [`Self::is_plant`].
    pub fn plant(&mut self, id: i64, tags: impl IntoIterator<Item = (u32, u32)>) {
        let tags = extend(&mut self.data.tags, tags);
        self.data.plants.push((id, tags));
    }

    /// Adds a node that has no id in the file; ids from the far end of the range, which OSM never uses.
    pub fn anonymous_node(&mut self, position: Position) -> i64 {
        let id = i64::MIN + self.anonymous;
        self.anonymous += 1;
        self.node(id, position);
        id
    }

    pub fn way(&mut self, id: i64, refs: impl IntoIterator<Item = i64>, tags: impl IntoIterator<Item = (u32, u32)>) {
        self.push_way(id, false, refs, tags);
    }

    /// Adds a way that is known only as member of a relation.
    pub fn stub_way(&mut self, id: i64, refs: impl IntoIterator<Item = i64>) {
        self.push_way(id, true, refs, []);
    }

    fn push_way(
        &mut self,
        id: i64,
        stub: bool,
        refs: impl IntoIterator<Item = i64>,
        tags: impl IntoIterator<Item = (u32, u32)>,
    ) {
        let refs = extend(&mut self.data.refs, refs);
        let tags = extend(&mut self.data.tags, tags);
        self.data.ways.push(WayRecord { id, stub, refs, tags });
    }

    /// Members are (kind, id, role), the role as a [`Self::string`].
    pub fn relation(
        &mut self,
        id: i64,
        members: impl IntoIterator<Item = (ObjectKind, i64, u32)>,
        tags: impl IntoIterator<Item = (u32, u32)>,
    ) {
        let members = members.into_iter().map(|(kind, id, role)| MemberRecord { kind, id, role });
        let members = extend(&mut self.data.members, members);
        let tags = extend(&mut self.data.tags, tags);
        self.data.relations.push(RelationRecord { id, members, tags });
    }

    pub fn shape(&mut self, geometry: ShapeGeometry, tags: impl IntoIterator<Item = (u32, u32)>) {
        let tags = extend(&mut self.data.tags, tags);
        let id = self.data.shapes.len() as i64 + 1;
        self.data.shapes.push(ShapeRecord { id, tags, geometry });
    }

    pub fn bounds(&mut self, bounds: LonLatBox) {
        self.data.bounds = Some(self.data.bounds.map_or(bounds, |b| b.join(bounds)));
    }

    /// How many nodes, ways, relations and GeoJSON features were added so far.
    pub fn counts(&self) -> [usize; 4] {
        let d = &self.data;
        [d.nodes.len(), d.ways.len(), d.relations.len(), d.shapes.len()]
    }

    /// Sorts by id; of objects with the same id the one added first stays.
    pub fn finish(mut self) -> OsmData {
        let d = &mut self.data;
        if !d.nodes.is_sorted_by(|a, b| a.0 < b.0) {
            d.nodes.sort_by_key(|n| n.0);
            d.nodes.dedup_by_key(|n| n.0);
        }
        d.plants.sort_by_key(|p| p.0);
        d.plants.dedup_by_key(|p| p.0);
        d.ways.sort_by_key(|w| (w.id, w.stub));
        d.ways.dedup_by_key(|w| w.id);
        d.relations.sort_by_key(|r| r.id);
        d.relations.dedup_by_key(|r| r.id);
        d.nodes.shrink_to_fit();
        self.data
    }
}

fn extend<T>(pool: &mut Vec<T>, items: impl IntoIterator<Item = T>) -> Span {
    let start = pool.len();
    pool.extend(items);
    start..pool.len()
}
