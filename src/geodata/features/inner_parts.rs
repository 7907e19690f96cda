//! Building parts that stand inside others: door ways mapped in a tower, shafts in a hall. In: a building's parts. Out:
//! the parts that nobody sees, by the part that hides them.
//!
//! A part is hidden by another whose footprint holds it and whose walls reach from no higher to no lower. Drawn, its
//! walls would fight with walls that they share. Of equal parts the first is drawn.

use super::parts::{Footprint, area_of};
use crate::geodata::ledger::Ledger;
use crate::geodata::tags::{Defaults, TagValue, attributes};
use crate::geometry::Polygon;
use crate::geometry::boolean::difference;

/// Share of a footprint that may lie outside: maps are drawn to some centimetres.
const OUTSIDE: f64 = 0.01;

/// What the walls of a part are known to fill.
struct Walls<'a> {
    part: usize,
    polygon: &'a Polygon,
    area: f64,
    from: f64,
    eaves: f64,
    top: f64,
}

/// (hidden, hiding) of the parts of one building, in rising order.
pub fn hidden(footprints: &[Footprint], parts: &[usize]) -> Vec<(usize, usize)> {
    let mut walls: Vec<Walls> = parts.iter().filter_map(|&part| walls(footprints, part)).collect();
    // Whatever may hide another comes first.
    walls.sort_by(|a, b| b.area.total_cmp(&a.area).then(b.top.total_cmp(&a.top)).then(a.part.cmp(&b.part)));
    let mut found = Vec::new();
    for (i, inner) in walls.iter().enumerate() {
        if let Some(outer) = walls[..i].iter().find(|outer| outer.hides(inner)) {
            found.push((inner.part, outer.part));
        }
    }
    found.sort_unstable();
    found
}

fn walls(footprints: &[Footprint], part: usize) -> Option<Walls<'_>> {
    let footprint = &footprints[part];
    let polygon = area_of(footprint)?;
    let known = attributes(&footprint.feature, &Defaults::default(), &mut Ledger::default());
    let find = |name: &str| known.iter().find(|(n, _)| &**n == name).map(|(_, value)| value);
    let number = |name: &str| match find(name) {
        Some(TagValue::Number(x)) => Some(*x),
        _ => None,
    };
    let is_flat = match find("roofShape") {
        None => true,
        Some(TagValue::Text(shape)) => &**shape == "flat",
        Some(_) => false,
    };
    let top = number("height")?;
    let from = number("minHeight").unwrap_or(0.0);
    // Of a pitched roof of unknown height nothing is known but where its walls begin.
    let eaves = number("eaveHeight").unwrap_or(if is_flat { top } else { from });
    Some(Walls { part, polygon, area: polygon.area(), from, eaves, top })
}

impl Walls<'_> {
    fn hides(&self, inner: &Walls) -> bool {
        let same = self.from == inner.from && self.eaves == inner.eaves && self.top == inner.top;
        (same || self.from <= inner.from && inner.top <= self.eaves)
            && self.area >= inner.area * (1.0 - OUTSIDE)
            && meet(self.polygon, inner.polygon)
            && outside(inner.polygon, self.polygon) <= OUTSIDE * inner.area
    }
}

fn meet(a: &Polygon, b: &Polygon) -> bool {
    let (Some((low, high)), Some((least, most))) = (a.bounds(), b.bounds()) else { return false };
    low.cmple(most).all() && least.cmple(high).all()
}

/// Area of one polygon outside another; all of it where that cannot be told.
fn outside(inner: &Polygon, outer: &Polygon) -> f64 {
    let one = std::slice::from_ref;
    difference(one(inner), one(outer)).map_or(f64::INFINITY, |rest| rest.iter().map(Polygon::area).sum())
}
