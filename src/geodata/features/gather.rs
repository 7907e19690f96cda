//! Objects that make features. In: [`OsmData`]. Out: candidates with their rings or lines, and what was passed over.
//!
//! Relations come first, then ways, then GeoJSON shapes, each by id; of equal footprints the first stays.

use std::collections::{BTreeMap, BTreeSet};

use super::classify::{Verdict, classify};
use super::duplicate::canonical;
use super::multipolygon::{Combine, Group, assemble, from_ring};
use super::scene::Scene;
use crate::geodata::feature::{FeatureClass, FeatureId, ObjectKind, Tags};
use crate::geodata::osm::{Position, Relation, Shape, ShapeGeometry, TagsView, Way};

/// An object that makes features.
pub struct Candidate {
    pub kind: ObjectKind,
    pub id: i64,
    pub class: FeatureClass,
    pub tags: Tags,
    pub body: Body,
    /// What was mended so far.
    pub notes: Vec<String>,
}

pub enum Body {
    Area { groups: Vec<Group>, combine: Combine },
    Lines(Vec<Vec<Position>>),
}

/// What [`gather`] found.
#[derive(Default)]
pub struct Gathered {
    pub candidates: Vec<Candidate>,
    /// Coastline ways.
    pub coast: Vec<(i64, Vec<Position>)>,
    pub skipped: Vec<(ObjectKind, i64, String)>,
    /// Objects passed over of which no node is known, so that they may or may not lie in the area.
    pub unplaced: usize,
}

/// Sorts all objects of the map that may lie in the window.
pub fn gather(scene: &Scene) -> Gathered {
    let mut gatherer = Gatherer { scene, found: Gathered::default(), drawn_by: BTreeMap::new(), seen: BTreeMap::new() };
    for relation in scene.data.relations() {
        gatherer.relation(&relation);
    }
    for way in scene.data.ways() {
        gatherer.way(&way);
    }
    for shape in scene.data.shapes() {
        gatherer.shape(&shape);
    }
    gatherer.found
}

/// A map object as messages name it.
#[derive(Clone, Copy)]
struct Object<'a> {
    kind: ObjectKind,
    id: i64,
    tags: TagsView<'a>,
}

/// What makes two footprints the same: class, rings, and for parts their vertical extent (parts may be stacked).
type Footprint = (FeatureClass, Vec<Vec<Position>>, Vec<String>);

struct Gatherer<'a> {
    scene: &'a Scene<'a>,
    found: Gathered,
    /// Ways that a relation draws.
    drawn_by: BTreeMap<i64, i64>,
    seen: BTreeMap<Footprint, (ObjectKind, i64)>,
}

impl<'a> Gatherer<'a> {
    fn relation(&mut self, relation: &Relation<'a>) {
        if relation.tags.get("type") != Some("multipolygon") {
            return;
        }
        let mut object = Object { kind: ObjectKind::Relation, id: relation.id, tags: relation.tags };
        let class = match classify(relation.tags, true) {
            Verdict::Area(class) => class,
            Verdict::Skip(why) => return self.skip(object, why, self.points(relation)),
            Verdict::Nothing => match self.outer_tags(relation) {
                Some((class, tags)) => {
                    object.tags = tags;
                    class
                }
                None => return,
            },
            Verdict::Road | Verdict::Waterway | Verdict::Coastline => return,
        };
        if !self.scene.may_meet(self.points(relation), class == FeatureClass::BuildingPart) {
            self.claim(relation, class, object.tags);
            return;
        }
        match assemble(self.scene.data, relation) {
            Ok(made) => {
                self.claim(relation, class, object.tags);
                let body = Body::Area { groups: made.groups, combine: made.combine };
                self.add(object, class, body, made.notes);
            }
            Err(why) => self.skip(object, why, self.points(relation)),
        }
    }

    fn points(&self, relation: &Relation) -> Vec<Position> {
        let data = self.scene.data;
        let ways = relation.members().filter(|m| m.kind == ObjectKind::Way).filter_map(|m| data.way(m.id));
        ways.flat_map(|way| way.refs).filter_map(|id| data.node(*id)).collect()
    }

    /// Old-style multipolygons carry their tags on the outer ways, which then have to agree.
    fn outer_tags(&self, relation: &Relation) -> Option<(FeatureClass, TagsView<'a>)> {
        let data = self.scene.data;
        let with_holes = relation.members().any(|m| m.role == "inner");
        let mut found: Option<(FeatureClass, TagsView)> = None;
        for member in relation.members().filter(|m| m.kind == ObjectKind::Way && m.role != "inner") {
            let Some(way) = data.way(member.id) else { continue };
            let Verdict::Area(class) = classify(way.tags, true) else { continue };
            match &found {
                Some((known, tags)) if *known != class || key_value(class, *tags) != key_value(class, way.tags) => {
                    return None;
                }
                Some(_) => {}
                None if with_holes || way.refs.first() != way.refs.last() => found = Some((class, way.tags)),
                None => return None,
            }
        }
        found
    }

    /// Notes the outer ways that say the same as the relation, so that they are not drawn again.
    fn claim(&mut self, relation: &Relation, class: FeatureClass, tags: TagsView) {
        for member in relation.members().filter(|m| m.kind == ObjectKind::Way && m.role != "inner") {
            let Some(way) = self.scene.data.way(member.id) else { continue };
            let same = classify(way.tags, true) == Verdict::Area(class);
            if same && (class == FeatureClass::Building || key_value(class, tags) == key_value(class, way.tags)) {
                self.drawn_by.entry(way.id).or_insert(relation.id);
            }
        }
    }

    fn way(&mut self, way: &Way) {
        if way.tags.is_empty() {
            return;
        }
        let closed = way.refs.len() > 2 && way.refs.first() == way.refs.last();
        let verdict = classify(way.tags, closed);
        if verdict == Verdict::Nothing {
            return;
        }
        let data = self.scene.data;
        let nodes: Vec<Option<Position>> = way.refs.iter().map(|id| data.node(*id)).collect();
        let points: Vec<Position> = nodes.iter().copied().flatten().collect();
        let missing = nodes.len() - points.len();
        let is_part = verdict == Verdict::Area(FeatureClass::BuildingPart);
        if !self.scene.may_meet(points.iter().copied(), is_part) {
            return;
        }
        let mut notes = Vec::new();
        if missing > 0 {
            notes.push(format!("{missing} of {} nodes are missing", nodes.len()));
        }
        let object = Object { kind: ObjectKind::Way, id: way.id, tags: way.tags };
        match verdict {
            Verdict::Skip(why) => self.skip(object, why, points),
            Verdict::Area(class) => match self.drawn_by.get(&way.id) {
                Some(relation) => self.skip(object, format!("drawn as relation/{relation}"), points),
                None => self.outline(object, class, points, closed, notes),
            },
            Verdict::Coastline => self.found.coast.push((way.id, points)),
            Verdict::Road | Verdict::Waterway => {
                let class = if verdict == Verdict::Road { FeatureClass::Highway } else { FeatureClass::Water };
                let runs = nodes.split(Option::is_none).filter(|run| run.len() > 1);
                let runs: Vec<Vec<Position>> = runs.map(|run| run.iter().copied().flatten().collect()).collect();
                if runs.is_empty() {
                    self.skip(object, too_few(points.len(), nodes.len()), points);
                } else {
                    self.add(object, class, Body::Lines(runs), notes);
                }
            }
            Verdict::Nothing => {}
        }
    }

    /// A closed outline, or one that the border of the extract has opened.
    fn outline(
        &mut self,
        object: Object,
        class: FeatureClass,
        mut points: Vec<Position>,
        closed: bool,
        mut notes: Vec<String>,
    ) {
        let total = points.len();
        points.dedup();
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        } else if !closed {
            notes.push("the open outline was closed".to_owned());
        }
        let distinct = points.iter().copied().collect::<BTreeSet<_>>().len();
        if distinct < 3 {
            let missing = notes.first().filter(|note| note.contains("missing")).cloned();
            return self.skip(object, missing.unwrap_or_else(|| too_few(distinct, total)), points);
        }
        if distinct < points.len() {
            let made = from_ring(points);
            notes.extend(made.notes);
            let body = Body::Area { groups: made.groups, combine: made.combine };
            return self.add(object, class, body, notes);
        }
        let groups = vec![Group { outer: points, holes: Vec::new() }];
        self.add(object, class, Body::Area { groups, combine: Combine::Side }, notes);
    }

    fn shape(&mut self, shape: &Shape) {
        let object = Object { kind: ObjectKind::Feature, id: shape.id, tags: shape.tags };
        let points: Vec<Position> = shape.geometry.positions().collect();
        if !self.scene.may_meet(points.iter().copied(), false) {
            return;
        }
        let polygons = match shape.geometry {
            ShapeGeometry::Lines(lines) => return self.shape_lines(object, lines, points),
            ShapeGeometry::Polygons(polygons) => polygons,
        };
        let class = match classify(shape.tags, true) {
            Verdict::Area(class) => class,
            // A polygon of a road is its surface.
            Verdict::Road => FeatureClass::Highway,
            Verdict::Waterway => FeatureClass::Water,
            Verdict::Skip(why) => return self.skip(object, why, points),
            Verdict::Coastline | Verdict::Nothing => return,
        };
        let group = |rings: &Vec<Vec<Position>>| {
            let (outer, holes) = rings.split_first()?;
            Some(Group { outer: outer.clone(), holes: holes.to_vec() })
        };
        let groups = polygons.iter().filter_map(group).collect();
        self.add(object, class, Body::Area { groups, combine: Combine::Side }, Vec::new());
    }

    fn shape_lines(&mut self, object: Object, lines: &[Vec<Position>], points: Vec<Position>) {
        let closed = lines.len() == 1 && points.len() > 3 && points.first() == points.last();
        let lines = || Body::Lines(lines.iter().filter(|line| line.len() > 1).cloned().collect());
        match classify(object.tags, closed) {
            Verdict::Area(class) => self.outline(object, class, points, closed, Vec::new()),
            Verdict::Road => self.add(object, FeatureClass::Highway, lines(), Vec::new()),
            Verdict::Waterway => self.add(object, FeatureClass::Water, lines(), Vec::new()),
            Verdict::Coastline => self.found.coast.push((object.id, points)),
            Verdict::Skip(why) => self.skip(object, why, points),
            Verdict::Nothing => {}
        }
    }

    fn add(&mut self, object: Object, class: FeatureClass, body: Body, notes: Vec<String>) {
        let Object { kind, id, tags } = object;
        if let (FeatureClass::Building | FeatureClass::BuildingPart, Body::Area { groups, .. }) = (class, &body) {
            let rings = groups.iter().flat_map(|group| std::iter::once(&group.outer).chain(&group.holes));
            let footprint = (class, rings.map(|ring| canonical(ring)).collect(), vertical(class, tags));
            if let Some(&(kind, id)) = self.seen.get(&footprint) {
                let first = FeatureId { kind, id, part: 0 };
                self.found.skipped.push((object.kind, object.id, format!("the same footprint as {first}")));
                return;
            }
            self.seen.insert(footprint, (kind, id));
        }
        self.found.candidates.push(Candidate { kind, id, class, tags: tags.to_tags(), body, notes });
    }

    fn skip(&mut self, object: Object, why: String, points: Vec<Position>) {
        if points.is_empty() && self.scene.area_ring().is_some() {
            self.found.unplaced += 1;
        } else if self.scene.may_meet(points, false) {
            self.found.skipped.push((object.kind, object.id, why));
        }
    }
}

fn too_few(there: usize, total: usize) -> String {
    if there < total {
        format!("only {there} of {total} nodes are there")
    } else {
        format!("only {there} different nodes")
    }
}

/// The vertical tags of a part, so that stacked parts are not taken for repeats.
fn vertical(class: FeatureClass, tags: TagsView) -> Vec<String> {
    if class != FeatureClass::BuildingPart {
        return Vec::new();
    }
    let keys = ["min_height", "height", "building:min_level", "building:levels"];
    keys.iter().map(|key| tags.get(key).unwrap_or_default().to_owned()).collect()
}

/// Value of the key that stands for the class.
fn key_value<'a>(class: FeatureClass, tags: TagsView<'a>) -> Option<&'a str> {
    let keys: &[&str] = match class {
        FeatureClass::Building => &["building"],
        FeatureClass::BuildingPart => &["building:part"],
        FeatureClass::Highway => &["highway", "area:highway", "place"],
        FeatureClass::Landuse => &["landuse"],
        FeatureClass::Natural => &["natural"],
        FeatureClass::Leisure => &["leisure"],
        FeatureClass::Water => &["natural", "waterway", "landuse"],
    };
    keys.iter().find_map(|key| tags.get(key))
}
