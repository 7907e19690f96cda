//! Street selectors (reference 3.7, choice A38). In: the initial shape and a street width per edge. Out: on which side
//! of the lot, seen from the street, a component lies.

use glam::{DVec2, DVec3};

use super::environment::{Facet, Place};
use super::outline::{Outline, nearest_on_segment};
use super::shape::Shape;
use super::{derivation::Derivation, orientation};
use crate::cga::builtins::Word;
use crate::geometry::{Face, Mesh};

/// Seen by somebody standing on the street and looking at the lot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Front,
    Back,
    Left,
    Right,
}

/// The initial shape's edges with their streets.
#[derive(Clone, Debug)]
pub struct Streets {
    outline: Outline,
    /// By the outline's edges.
    is_street: Vec<bool>,
    /// Mean outward direction of the street edges by length; of the longest one where they cancel.
    toward: DVec2,
}

/// Cosine of the greatest angle between a component and the edge it is taken to lie on.
const FACES_EDGE: f64 = 0.5;
/// Cosine of 45 degrees, less a tie.
const BACK: f64 = std::f64::consts::FRAC_1_SQRT_2 - 1e-6;

impl Streets {
    /// `widths` by the host's edge numbers; `None` where no edge has a street.
    pub fn new(outline: Outline, widths: &[f64]) -> Option<Streets> {
        let width = |number: usize| widths.get(number).copied().unwrap_or(0.0);
        let is_street: Vec<bool> = outline.edges.iter().map(|e| width(e.number) > 0.0).collect();
        let streets = || outline.edges.iter().zip(&is_street).filter(|(_, street)| **street).map(|(e, _)| e);
        let longest = streets().max_by(|a, b| a.from.distance(a.to).total_cmp(&b.from.distance(b.to)))?.outward;
        let sum: DVec2 = streets().map(|e| e.outward * e.from.distance(e.to)).sum();
        let total: f64 = streets().map(|e| e.from.distance(e.to)).sum();
        let toward = if sum.length() > 1e-6 * total { sum.normalize() } else { longest };
        Some(Streets { outline, is_street, toward })
    }

    /// The side of a component at `point` that faces `direction`; `None` for one that faces up or down.
    fn side(&self, point: DVec3, direction: DVec3) -> Option<Side> {
        let frame = &self.outline.frame;
        let facing = DVec2::new(direction.dot(frame.u), direction.dot(frame.v));
        let rise = direction.dot(frame.normal).abs();
        if facing == DVec2::ZERO || rise > facing.length() * (1.0 + 1e-6) {
            return None;
        }
        let facing = facing.normalize();
        if self.nearest(frame.to_plan(point), facing).is_some_and(|i| self.is_street[i]) {
            return Some(Side::Front);
        }
        if facing.dot(-self.toward) > BACK {
            return Some(Side::Back);
        }
        // Left of somebody who looks along -toward.
        Some(if self.toward.perp_dot(facing) < 0.0 { Side::Left } else { Side::Right })
    }

    /// The nearest edge that faces the same way.
    fn nearest(&self, point: DVec2, facing: DVec2) -> Option<usize> {
        let edges = self.outline.edges.iter().enumerate().filter(|(_, e)| e.outward.dot(facing) >= FACES_EDGE);
        let distance = |e: &super::outline::OutlineEdge| point.distance(nearest_on_segment(point, e.from, e.to));
        edges.min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b))).map(|(i, _)| i)
    }
}

/// The `object.*` selector that stands in where nothing is known of streets (reference 3.7).
fn stand_in(word: Word) -> Option<Word> {
    Some(match word {
        Word::StreetFront | Word::LegacyStreetSide => Word::ObjectFront,
        Word::StreetBack => Word::ObjectBack,
        Word::StreetLeft => Word::ObjectLeft,
        Word::StreetRight => Word::ObjectRight,
        Word::StreetSide => Word::ObjectSide,
        _ => return None,
    })
}

/// Whether a component at `point` that faces `direction` matches a street or orientation word; `None` for other words.
pub fn agrees(run: &Derivation, word: Word, point: DVec3, direction: DVec3, outer: &Shape) -> Option<bool> {
    if word == Word::LegacyNoStreetSide {
        let level = orientation::agrees(Word::ObjectSide, direction, &outer.scope, &run.object)?;
        return Some(level && !agrees(run, Word::LegacyStreetSide, point, direction, outer)?);
    }
    let Some(other) = stand_in(word) else {
        return orientation::agrees(word, direction, &outer.scope, &run.object);
    };
    let Some(streets) = &run.streets else {
        return orientation::agrees(other, direction, &outer.scope, &run.object);
    };
    let side = streets.side(point, direction);
    Some(match word {
        Word::StreetFront | Word::LegacyStreetSide => side == Some(Side::Front),
        Word::StreetBack => side == Some(Side::Back),
        Word::StreetLeft => side == Some(Side::Left),
        Word::StreetRight => side == Some(Side::Right),
        _ => matches!(side, Some(Side::Left | Side::Right)),
    })
}

/// As [`agrees`], for a component of a baked shape.
pub fn facet_agrees(run: &Derivation, word: Word, facet: &Facet, outer: &Shape) -> Option<bool> {
    let mesh = &outer.form.mesh;
    let vertex = |v: u32| mesh.positions[v as usize];
    let at = match facet.place {
        // Without streets nobody asks where it is.
        _ if run.streets.is_none() => DVec3::ZERO,
        Place::Face(face) => middle(mesh, &mesh.faces[face as usize]),
        Place::Edge([a, b]) => vertex(a).midpoint(vertex(b)),
        Place::Vertex(v) => vertex(v),
    };
    agrees(run, word, at, facet.direction, outer)
}

/// As [`agrees`], for a face of a mesh.
pub fn face_agrees(run: &Derivation, word: Word, mesh: &Mesh, face: &Face, outer: &Shape) -> Option<bool> {
    agrees(run, word, middle(mesh, face), mesh.normal(face), outer)
}

/// Mean of the corners of the outer loop.
pub fn middle(mesh: &Mesh, face: &Face) -> DVec3 {
    let sum: DVec3 = face.outer.iter().map(|&v| mesh.positions[v as usize]).sum();
    sum / face.outer.len().max(1) as f64
}
