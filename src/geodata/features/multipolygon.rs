//! Multipolygon relations. In: a relation's member ways. Out: groups of one outline and its holes.
//!
//! Which ring is a hole follows from geometry (a ring in an odd number of others); roles are hints where rings cross
//! and where members are missing (<https://wiki.openstreetmap.org/wiki/Relation:multipolygon>).

use super::rings::{Relation as Lie, Role, Strand, join, meet_off_nodes, relate, twice_area};
use crate::geodata::feature::ObjectKind;
use crate::geodata::osm::{OsmData, Position, Relation};

/// One outline and its holes.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    pub outer: Vec<Position>,
    pub holes: Vec<Vec<Position>>,
}

/// How the groups make the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Combine {
    /// They lie apart.
    #[default]
    Side,
    /// Outlines cross each other: the groups have to be united.
    Union,
    /// Rings cross in common points only: what lies in an odd number of groups.
    EvenOdd,
}

/// What a relation's members make.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembled {
    pub groups: Vec<Group>,
    pub combine: Combine,
    /// What was mended.
    pub notes: Vec<String>,
}

/// An open ring whose gap is at most this share of its length is closed.
const CLOSABLE_GAP: f64 = 0.25;

/// Builds the polygons of a relation, or says why that cannot be done.
pub fn assemble(data: &OsmData, relation: &Relation) -> Result<Assembled, String> {
    let mut notes = Vec::new();
    let (strands, missing, total) = member_strands(data, relation, &mut notes);
    if total == 0 {
        return Err("the relation has no member ways".to_owned());
    }
    let mut joined = join(strands);
    if missing == 0 {
        close_gaps(&mut joined, &mut notes);
    }
    let incomplete = || format!("{missing} of {total} member ways are missing");
    let mut rings = joined.rings;
    drop_repeats(&mut rings, &mut notes);
    if missing > 0 {
        notes.push(incomplete());
    } else if !joined.open.is_empty() {
        notes.push(format!("{} open line{} left out", joined.open.len(), plural(joined.open.len())));
    }
    if rings.is_empty() {
        return Err(if missing > 0 { incomplete() } else { "the member ways do not form a ring".to_owned() });
    }
    if rings.iter().all(|ring| ring.role == Role::Inner) {
        return Err(if missing > 0 { incomplete() } else { "the relation has no outer ring".to_owned() });
    }
    let nested = nest(rings, missing > 0, &mut notes);
    if nested.groups.is_empty() { Err(incomplete()) } else { Ok(Assembled { notes, ..nested }) }
}

/// The polygons of one closed way that visits a point more than once: loops inside loops are holes.
pub fn from_ring(points: Vec<Position>) -> Assembled {
    let mut closed = points;
    closed.extend(closed.first().copied());
    let mut notes = Vec::new();
    let mut rings = join(vec![Strand { points: closed, role: Role::None }]).rings;
    drop_repeats(&mut rings, &mut notes);
    let nested = nest(rings, false, &mut notes);
    Assembled { notes, ..nested }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

/// The member ways as strands, how many are not in the data, and how many there are.
fn member_strands(data: &OsmData, relation: &Relation, notes: &mut Vec<String>) -> (Vec<Strand>, usize, usize) {
    let mut seen = std::collections::BTreeSet::new();
    let (mut strands, mut missing, mut lost_nodes) = (Vec::new(), 0, 0);
    for member in relation.members().filter(|m| m.kind == ObjectKind::Way) {
        if !seen.insert(member.id) {
            continue;
        }
        let role = match member.role {
            "outer" | "exclave" | "outline" => Role::Outer,
            "inner" | "enclave" => Role::Inner,
            _ => Role::None,
        };
        let Some(way) = data.way(member.id) else {
            missing += 1;
            continue;
        };
        let points: Vec<Position> = way.refs.iter().filter_map(|id| data.node(*id)).collect();
        lost_nodes += way.refs.len() - points.len();
        if points.len() < 2 {
            missing += 1;
        } else {
            strands.push(Strand { points, role });
        }
    }
    if lost_nodes > 0 {
        notes.push(format!("{lost_nodes} node{} of member ways missing", plural(lost_nodes)));
    }
    (strands, missing, seen.len())
}

/// Closes a ring that is all there but for a small gap.
fn close_gaps(joined: &mut super::rings::Joined, notes: &mut Vec<String>) {
    let length = |a: Position, b: Position| {
        libm::hypot(f64::from(a.lon) - f64::from(b.lon), f64::from(a.lat) - f64::from(b.lat))
    };
    let open = std::mem::take(&mut joined.open);
    for strand in open {
        let run: f64 = strand.points.windows(2).map(|w| length(w[0], w[1])).sum();
        let gap = length(strand.points[0], strand.points[strand.points.len() - 1]);
        if strand.points.len() > 2 && gap <= CLOSABLE_GAP * run {
            notes.push("a ring was closed over a gap".to_owned());
            joined.rings.push(strand);
        } else {
            joined.open.push(strand);
        }
    }
}

/// Keeps one of several equal rings.
fn drop_repeats(rings: &mut Vec<Strand>, notes: &mut Vec<String>) {
    let before = rings.len();
    let mut seen = std::collections::BTreeSet::new();
    rings.retain(|ring| seen.insert(super::duplicate::canonical(&ring.points)));
    if rings.len() < before {
        notes.push(format!("{} repeated ring{} left out", before - rings.len(), plural(before - rings.len())));
    }
}

/// Sorts rings into outlines and holes.
fn nest(mut rings: Vec<Strand>, members_missing: bool, notes: &mut Vec<String>) -> Assembled {
    // Largest first, so that a ring can only lie in those before it.
    rings.sort_by_key(|ring| std::cmp::Reverse(twice_area(&ring.points).abs()));
    if cross_at_nodes(&rings) {
        let groups = rings.into_iter().map(|ring| Group { outer: ring.points, holes: Vec::new() }).collect();
        return Assembled { groups, combine: Combine::EvenOdd, notes: Vec::new() };
    }
    let mut assembled = Assembled::default();
    // Per ring: how many rings it lies in, and its group where it is an outline.
    let mut placed: Vec<(usize, Option<usize>)> = Vec::new();
    let mut against_roles = false;
    for (i, ring) in rings.iter().enumerate() {
        let lies: Vec<Lie> = rings[..i].iter().map(|larger| relate(&ring.points, &larger.points)).collect();
        let holders = || (0..i).filter(|&j| matches!(lies[j], Lie::Within | Lie::Equal));
        let crossed = (0..i).filter(|&j| lies[j] == Lie::Crossing).find_map(|j| placed[j].1);
        let depth = holders().count();
        let host = holders().filter(|&j| placed[j].0 + 1 == depth).find_map(|j| placed[j].1);
        let cut_hole = ring.role == Role::Inner && host.is_none() && depth == 0;
        match (host, crossed) {
            (Some(group), _) if depth % 2 == 1 => {
                against_roles |= ring.role == Role::Outer;
                assembled.groups[group].holes.push(ring.points.clone());
                placed.push((depth, None));
            }
            (_, Some(group)) if ring.role == Role::Inner => {
                assembled.groups[group].holes.push(ring.points.clone());
                placed.push((depth, None));
            }
            _ if cut_hole && members_missing => placed.push((depth, None)),
            _ => {
                against_roles |= ring.role == Role::Inner;
                if crossed.is_some() {
                    assembled.combine = Combine::Union;
                }
                placed.push((depth, Some(assembled.groups.len())));
                assembled.groups.push(Group { outer: ring.points.clone(), holes: Vec::new() });
            }
        }
    }
    if against_roles {
        notes.push("roles contradict the geometry, which was followed".to_owned());
    }
    if assembled.combine == Combine::Union {
        notes.push("outer rings overlap and were united".to_owned());
    }
    assembled
}

/// Whether rings (larger ones first) cross, but only in points that they share.
fn cross_at_nodes(rings: &[Strand]) -> bool {
    let mut found = false;
    for (i, ring) in rings.iter().enumerate() {
        for larger in &rings[..i] {
            if relate(&ring.points, &larger.points) == Lie::Crossing {
                if meet_off_nodes(&ring.points, &larger.points) {
                    return false;
                }
                found = true;
            }
        }
    }
    found
}
