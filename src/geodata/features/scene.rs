//! The window on the map. In: area and projection. Out: local coordinates, and what lies inside.

use geo::Centroid;
use glam::DVec2;

use super::area::{Area, clip_line};
use crate::geodata::osm::{LonLatBox, OsmData, Position};
use crate::geometry::boolean::{BooleanError, intersection};
use crate::geometry::polygon::ring_contains;
use crate::geometry::{Polygon, Ring};

/// Everything that the steps of extraction share.
pub struct Scene<'a> {
    pub data: &'a OsmData,
    project: &'a (dyn Fn(f64, f64) -> DVec2 + Sync),
    window: Option<Window>,
}

struct Window {
    bounds: LonLatBox,
    polygon: Polygon,
    /// A box: a polygon with all corners inside lies inside.
    convex: bool,
}

/// Building parts reach at most this far (degrees) out of the window if their outline's centre lies in it.
const PART_REACH: f64 = 0.01;

impl<'a> Scene<'a> {
    pub fn new(data: &'a OsmData, area: Option<&Area>, project: &'a (dyn Fn(f64, f64) -> DVec2 + Sync)) -> Self {
        let window = area.and_then(|area| {
            let polygon = Polygon { outer: area.ring(&|lon, lat| project(lon, lat)), holes: Vec::new() };
            Some(Window { bounds: area.bounds()?, polygon, convex: matches!(area, Area::Box(_)) })
        });
        Scene { data, project, window }
    }

    pub fn local(&self, position: Position) -> DVec2 {
        let (lon, lat) = position.degrees();
        (self.project)(lon, lat)
    }

    pub fn local_line(&self, line: &[Position]) -> Vec<DVec2> {
        line.iter().map(|p| self.local(*p)).collect()
    }

    /// Corners of any area, counter-clockwise.
    pub fn ring_of(&self, area: &Area) -> Ring {
        area.ring(&|lon, lat| (self.project)(lon, lat))
    }

    /// Corners of the scene's area, counter-clockwise, where one was asked for.
    pub fn area_ring(&self) -> Option<&Ring> {
        self.window.as_ref().map(|w| &w.polygon.outer)
    }

    /// Whether the box of these points meets the window's; true without points, whose place is unknown.
    pub fn may_meet(&self, points: impl IntoIterator<Item = Position>, is_part: bool) -> bool {
        let Some(window) = &self.window else { return true };
        let mut bounds = window.bounds;
        if is_part {
            bounds.west -= PART_REACH;
            bounds.east += PART_REACH;
            bounds.south -= PART_REACH;
            bounds.north += PART_REACH;
        }
        LonLatBox::around(points.into_iter().map(Position::degrees)).is_none_or(|b| b.meets(&bounds))
    }

    pub fn holds(&self, point: DVec2) -> bool {
        self.window.as_ref().is_none_or(|w| ring_contains(&w.polygon.outer, point))
    }

    /// The parts of polygons inside the window; polygons that lie wholly inside stay as they are.
    pub fn clip_polygons(&self, polygons: Vec<Polygon>) -> Result<Vec<Polygon>, BooleanError> {
        let Some(window) = &self.window else { return Ok(polygons) };
        let mut out = Vec::new();
        for polygon in polygons {
            if window.convex && polygon.outer.iter().all(|p| ring_contains(&window.polygon.outer, *p)) {
                out.push(polygon);
            } else {
                out.extend(intersection(&[polygon], std::slice::from_ref(&window.polygon))?);
            }
        }
        Ok(out)
    }

    /// The pieces of a line inside the window.
    pub fn clip_line(&self, line: Vec<DVec2>) -> Vec<Vec<DVec2>> {
        match &self.window {
            None => vec![line],
            Some(w) if w.convex && line.iter().all(|p| ring_contains(&w.polygon.outer, *p)) => vec![line],
            Some(w) => clip_line(&line, &w.polygon.outer),
        }
    }
}

/// Centre of gravity of a polygon's surface; the first point if it has none.
pub fn centroid(polygon: &Polygon) -> DVec2 {
    // About the first corner, so that a far origin costs no digits; geo's rings close themselves.
    let Some(&origin) = polygon.outer.first() else { return DVec2::ZERO };
    let ring = |r: &Ring| r.iter().map(|p| (*p - origin).to_array()).map(|[x, y]| geo::coord! { x: x, y: y }).collect();
    let shape = geo::Polygon::new(ring(&polygon.outer), polygon.holes.iter().map(ring).collect());
    shape.centroid().map_or(origin, |c| origin + DVec2::new(c.x(), c.y()))
}
