//! Buildings and their parts. In: built footprints. Out: footprints that do not stand in each other.
//!
//! A part belongs to the smallest outline that a point inside it lies in. An outline of which its parts cover at least
//! 90 % is not drawn (<https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings>: parts must cover it); of a less covered
//! one the ground that its parts stand on is taken out. An outline whose parts all hang above the ground stays. A part
//! that another hides is not drawn.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec2;

use super::inner_parts::hidden;
use crate::geodata::feature::{Feature, FeatureClass, Outline};
use crate::geodata::ledger::Outcome;
use crate::geodata::tags::{OUTLINE_KEY, length, number};
use crate::geometry::Polygon;
use crate::geometry::boolean::{difference, point_on_surface};

/// A footprint on its way to the scene.
pub struct Footprint {
    pub feature: Feature,
    pub outcome: Outcome,
    /// Where it stands: decides whether it belongs to the window. Parts stand where their outline does.
    pub home: DVec2,
    /// Not to be drawn, and why.
    pub dropped: Option<String>,
}

/// Share of an outline that its parts must cover to stand for it.
const COVERED: f64 = 0.9;

/// Pieces of an outline between its parts smaller than this are not drawn, square metres.
const LEAST_REST: f64 = 1.0;

/// Looks of an outline that its parts have too unless tagged otherwise.
const INHERITED: [&str; 6] =
    ["building", "building:colour", "building:material", "roof:colour", "roof:material", "name"];

/// Attaches parts to outlines and takes out of outlines what parts stand for. New pieces come at the end.
pub fn resolve(footprints: &mut Vec<Footprint>) {
    let families = families(footprints);
    let mut pieces = Vec::new();
    for (&outline, parts) in &families {
        for &part in parts {
            adopt(footprints, outline, part);
        }
        for (inner, outer) in hidden(footprints, parts) {
            footprints[inner].dropped = Some(format!("inside the building part {}", footprints[outer].feature.id));
        }
        pieces.extend(carve(footprints, outline, parts));
    }
    footprints.extend(pieces);
}

pub(super) fn area_of(footprint: &Footprint) -> Option<&Polygon> {
    match &footprint.feature.outline {
        Outline::Area(polygon) => Some(polygon),
        Outline::Line(_) => None,
    }
}

/// Parts by their outline.
fn families(footprints: &[Footprint]) -> BTreeMap<usize, Vec<usize>> {
    let is = |class| move |f: &(usize, &Footprint)| f.1.feature.class == class;
    let mut families: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    if !footprints.iter().any(|f| f.feature.class == FeatureClass::BuildingPart) {
        return families;
    }
    let index = Cells::new(footprints.iter().enumerate().filter(is(FeatureClass::Building)));
    for (part, footprint) in footprints.iter().enumerate().filter(is(FeatureClass::BuildingPart)) {
        let Some(point) = area_of(footprint).and_then(point_on_surface) else { continue };
        let holder = index
            .at(point)
            .iter()
            .filter_map(|&i| Some((i, area_of(&footprints[i])?)))
            .filter(|(_, polygon)| polygon.contains(point))
            .min_by(|a, b| a.1.area().total_cmp(&b.1.area()));
        if let Some((outline, _)) = holder {
            families.entry(outline).or_default().push(part);
        }
    }
    families
}

/// Outlines by square cells of the plan.
struct Cells(BTreeMap<(i64, i64), Vec<usize>>);

impl Cells {
    const SIZE: f64 = 64.0;

    fn new<'a>(outlines: impl Iterator<Item = (usize, &'a Footprint)>) -> Self {
        let mut cells: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (i, footprint) in outlines {
            let Some((low, high)) = area_of(footprint).and_then(Polygon::bounds) else { continue };
            let ((x0, y0), (x1, y1)) = (Self::cell(low), Self::cell(high));
            for (x, y) in (x0..=x1).flat_map(|x| (y0..=y1).map(move |y| (x, y))) {
                cells.entry((x, y)).or_default().push(i);
            }
        }
        Cells(cells)
    }

    fn cell(p: DVec2) -> (i64, i64) {
        ((p.x / Self::SIZE).floor() as i64, (p.y / Self::SIZE).floor() as i64)
    }

    fn at(&self, p: DVec2) -> &[usize] {
        self.0.get(&Self::cell(p)).map_or(&[], Vec::as_slice)
    }
}

/// Gives a part its outline's place, id and looks.
fn adopt(footprints: &mut [Footprint], outline: usize, part: usize) {
    let parent = &footprints[outline];
    let mut given: Vec<(Arc<str>, Arc<str>)> = INHERITED
        .iter()
        .filter_map(|key| parent.feature.tags.get_key_value(*key))
        .map(|(key, value)| (Arc::clone(key), Arc::clone(value)))
        .collect();
    given.push((OUTLINE_KEY.into(), parent.feature.id.to_string().into()));
    let home = parent.home;
    let part = &mut footprints[part];
    part.home = home;
    for (key, value) in given {
        part.feature.tags.entry(key).or_insert(value);
    }
}

fn stands_on_ground(feature: &Feature) -> bool {
    let tag = |key: &str| feature.tags.get(key);
    let raised = tag("min_height").and_then(|v| length(v)).is_some_and(|h| h > 0.0);
    let lifted = tag("building:min_level").and_then(|v| number(v)).is_some_and(|n| n > 0.0);
    !raised && !lifted
}

/// Drops or cuts an outline; gives its pieces beyond the first.
fn carve(footprints: &mut [Footprint], outline: usize, parts: &[usize]) -> Vec<Footprint> {
    let polygons = |on_ground: bool| -> Vec<Polygon> {
        let parts = parts.iter().map(|&p| &footprints[p]).filter(|p| !on_ground || stands_on_ground(&p.feature));
        parts.filter_map(area_of).cloned().collect()
    };
    let (standing, all) = (polygons(true), polygons(false));
    let Some(whole) = area_of(&footprints[outline]).cloned() else { return Vec::new() };
    if standing.is_empty() {
        return Vec::new();
    }
    let whole = std::slice::from_ref(&whole);
    let (Ok(uncovered), Ok(rest)) = (difference(whole, &all), difference(whole, &standing)) else { return Vec::new() };
    let area = |polygons: &[Polygon]| polygons.iter().map(Polygon::area).sum::<f64>();
    let rest: Vec<Polygon> = rest.into_iter().filter(|p| p.area() >= LEAST_REST).collect();
    let count = parts.len();
    let footprint = &mut footprints[outline];
    if area(&uncovered) <= (1.0 - COVERED) * area(whole) || rest.is_empty() {
        footprint.dropped = Some(format!("drawn as its {count} building parts"));
        return Vec::new();
    }
    if area(&rest) >= area(whole) - LEAST_REST {
        return Vec::new();
    }
    footprint.outcome = Outcome::Repaired(format!("the ground of {count} building parts was taken out"));
    let mut pieces = rest.into_iter().map(|polygon| Footprint {
        feature: Feature { outline: Outline::Area(polygon), ..footprint.feature.clone() },
        outcome: footprint.outcome.clone(),
        home: footprint.home,
        dropped: None,
    });
    let first = pieces.next().map(|piece| piece.feature);
    let others = pieces.collect();
    footprint.feature = first.expect("rest was checked not to be empty");
    others
}
