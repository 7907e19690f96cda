//! Obstacles: what plants keep clear of. In: polygons of the plan. Out: whether a disc is free of them.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geometry::Polygon;

/// Metres of a cell of the index.
const CELL: f64 = 32.0;

/// What is in the way of plants.
#[derive(Clone, Debug, Default)]
pub struct Sites {
    /// Buildings and water: nothing grows there.
    pub taken: Obstacles,
    /// Roads and squares: what is not mapped as a tree or a row of trees keeps clear of them.
    pub paved: Obstacles,
}

impl Sites {
    pub fn is_free(&self, at: DVec2, clearance: f64) -> bool {
        self.taken.is_free(at, clearance) && self.paved.is_free(at, clearance)
    }
}

/// Polygons in cells of the plan.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    polygons: Vec<Polygon>,
    cells: BTreeMap<(i64, i64), Vec<u32>>,
}

impl Obstacles {
    pub fn new(polygons: Vec<Polygon>) -> Obstacles {
        let mut cells: BTreeMap<(i64, i64), Vec<u32>> = BTreeMap::new();
        for (number, polygon) in polygons.iter().enumerate() {
            let Some((low, high)) = polygon.bounds() else { continue };
            for cell in cells_of(low, high) {
                cells.entry(cell).or_default().push(number as u32);
            }
        }
        Obstacles { polygons, cells }
    }

    /// Whether no obstacle comes nearer than `clearance` metres to a place.
    pub fn is_free(&self, at: DVec2, clearance: f64) -> bool {
        let near = cells_of(at - clearance, at + clearance).filter_map(|cell| self.cells.get(&cell)).flatten();
        near.map(|&number| &self.polygons[number as usize]).all(|polygon| !reaches(polygon, at, clearance))
    }
}

fn cells_of(low: DVec2, high: DVec2) -> impl Iterator<Item = (i64, i64)> {
    let ((x0, y0), (x1, y1)) = (cell(low), cell(high));
    (x0..=x1).flat_map(move |x| (y0..=y1).map(move |y| (x, y)))
}

fn cell(p: DVec2) -> (i64, i64) {
    ((p.x / CELL).floor() as i64, (p.y / CELL).floor() as i64)
}

fn reaches(polygon: &Polygon, at: DVec2, clearance: f64) -> bool {
    let near_edge = |(a, b): (DVec2, DVec2)| distance_to_segment(at, a, b) < clearance;
    let edges = |ring: &[DVec2]| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])).any(near_edge);
    polygon.contains(at) || polygon.rings().any(|ring| edges(ring))
}

fn distance_to_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let share = if along == DVec2::ZERO { 0.0 } else { ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    (p - a - along * share).length()
}
