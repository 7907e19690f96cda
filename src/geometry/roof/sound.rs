//! Roofs that pass their checks. In: a roof or why there is none. Out: it, or the nearest roof that passes: the hip of
//! the outline, the hip of the bounding rectangle, flat; with every step and its reason.

use std::fmt::Write;

use glam::DVec2;

use super::hip::hip;
use super::{Roof, RoofError, Slope};
use crate::geometry::mesh_checks::{Defect, defects, faces_not_triangulated};
use crate::geometry::polygon::Polygon;
use crate::geometry::rectangle::least_around;

/// One step down: what was given up, why, and what was tried next.
#[derive(Clone, Debug, PartialEq)]
pub struct FellBack {
    pub from: &'static str,
    pub why: String,
    pub to: &'static str,
}

/// `roof` is `None` for a flat one.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundRoof {
    pub roof: Option<Roof>,
    pub steps: Vec<FellBack>,
}

/// Makes a roof that stands in for another; `None` is a flat one.
type Simpler = fn(&Polygon, Slope) -> Result<Option<Roof>, RoofError>;

/// The roof if it has no defect but those `by_design`, else the first of the simpler ones that has none.
///
/// # Errors
/// What was asked for is outside its domain: no other roof would be nearer to it.
pub fn sound(
    polygon: &Polygon,
    slope: Slope,
    by_design: &[Defect],
    (name, first): (&'static str, Result<Option<Roof>, RoofError>),
) -> Result<SoundRoof, RoofError> {
    let mut steps: Vec<FellBack> = Vec::new();
    let (mut from, mut roof) = (name, first);
    let simpler: [(&str, Simpler); 3] = [
        ("a hip roof", |p, s| hip(p, s, 0.0, false).map(Some)),
        ("a hip roof over the bounding rectangle", |p, s| hip(&around(p), s, 0.0, false).map(Some)),
        ("a flat roof", |_, _| Ok(None)),
    ];
    for (number, (to, make)) in simpler.into_iter().enumerate() {
        let why = match &roof {
            Ok(None) => break,
            Ok(Some(roof)) => match faults(roof, if number == 0 { by_design } else { &[] }) {
                None => break,
                Some(why) => why,
            },
            Err(error @ (RoofError::HiddenEdge | RoofError::Skeleton(_))) => error.to_string(),
            Err(error) => return Err(*error),
        };
        steps.push(FellBack { from, why, to });
        (from, roof) = (to, make(polygon, slope));
    }
    Ok(SoundRoof { roof: roof?, steps })
}

/// The defects of a roof in words; `None` without any, and for a level one: it has no inside. Triangles without area
/// between the corners of a face are none as long as the face is covered: they show nowhere.
fn faults(roof: &Roof, by_design: &[Defect]) -> Option<String> {
    if roof.mesh.bounds().is_some_and(|(low, high)| low.y == high.y) {
        return None;
    }
    let ignored: Vec<Defect> = by_design.iter().copied().chain([Defect::DegenerateTriangle]).collect();
    let mut found: Vec<(&str, usize)> = defects(&roof.mesh, &ignored).iter().map(|(d, n)| (d.name(), *n)).collect();
    let uncovered = faces_not_triangulated(&roof.mesh).len();
    if uncovered > 0 && !by_design.contains(&Defect::DegenerateTriangle) {
        found.push(("face not covered by its triangles", uncovered));
    }
    let mut text = String::new();
    for (name, count) in &found {
        let separator = if text.is_empty() { "" } else { ", " };
        write!(text, "{separator}{name} ({count})").expect("a string takes everything");
    }
    (!found.is_empty()).then_some(text)
}

/// The least rectangle around an outline.
fn around(polygon: &Polygon) -> Polygon {
    let along = least_around(&polygon.outer).unwrap_or(DVec2::X);
    let across = along.perp();
    let origin = polygon.outer.first().copied().unwrap_or_default();
    let (low, high) = (polygon.outer.iter())
        .map(|&p| DVec2::new(along.dot(p - origin), across.dot(p - origin)))
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let at = |x: f64, y: f64| origin + along * x + across * y;
    let outer = vec![at(low.x, low.y), at(high.x, low.y), at(high.x, high.y), at(low.x, high.y)];
    Polygon { outer, holes: Vec::new() }
}
