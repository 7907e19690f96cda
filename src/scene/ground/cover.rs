//! In: the area, the layers, and triangles between their borders. Out: which polygon owns each triangle.
//!
//! Borders are edges of the triangulation that cannot be crossed, so triangles connected without crossing one have
//! the same owner. It is decided once per region, at the centre of its largest triangle.

use glam::DVec2;
use spade::Triangulation as _;

use super::triangulation::{Triangulation, faces, vertex};
use super::{GroundLayer, Surface};
use crate::geodata::terrain::Terrain;
use crate::geometry::Polygon;

/// Side of the squares by which polygons are found, metres.
const CELL_M: f64 = 64.0;
/// Fewer squares than this along each side.
const MAX_CELLS: f64 = 2048.0;

/// Who owns a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    Outside,
    Bare,
    /// Number of a polygon of the [`Cover`].
    Layer(usize),
}

/// The area and all polygons, uppermost first, found by place.
pub(super) struct Cover<'a> {
    area: &'a Polygon,
    polygons: Vec<Piece<'a>>,
    lo: DVec2,
    cell: f64,
    columns: usize,
    /// Polygons by square, in order.
    squares: Vec<Vec<u32>>,
}

struct Piece<'a> {
    polygon: &'a Polygon,
    lo: DVec2,
    hi: DVec2,
    layer: &'a GroundLayer,
}

impl Piece<'_> {
    fn contains(&self, plan: DVec2) -> bool {
        plan.cmpge(self.lo).all() && plan.cmple(self.hi).all() && self.polygon.contains(plan)
    }
}

impl<'a> Cover<'a> {
    pub(super) fn new(area: &'a Polygon, layers: &'a [GroundLayer]) -> Self {
        let mut polygons = Vec::new();
        for layer in layers {
            let piece = |polygon: &'a Polygon| polygon.bounds().map(|(lo, hi)| Piece { polygon, lo, hi, layer });
            polygons.extend(layer.polygons.iter().filter_map(piece));
        }
        polygons.sort_by_key(|piece| std::cmp::Reverse(piece.layer.priority));
        let (lo, hi) = area.bounds().unwrap_or_default();
        let cell = CELL_M.max((hi - lo).max_element() / MAX_CELLS);
        let columns = ((hi.x - lo.x) / cell) as usize + 1;
        let rows = ((hi.y - lo.y) / cell) as usize + 1;
        let mut squares = vec![Vec::new(); columns * rows];
        for (index, piece) in polygons.iter().enumerate() {
            if piece.lo.cmpgt(hi).any() || piece.hi.cmplt(lo).any() {
                continue;
            }
            let (a, b) = (((piece.lo - lo) / cell).max(DVec2::ZERO), ((piece.hi - lo) / cell).max(DVec2::ZERO));
            for row in a.y as usize..=(b.y as usize).min(rows - 1) {
                for column in a.x as usize..=(b.x as usize).min(columns - 1) {
                    squares[row * columns + column].push(index as u32);
                }
            }
        }
        Cover { area, polygons, lo, cell, columns, squares }
    }

    pub(super) fn payload(&self, polygon: usize) -> u32 {
        self.polygons[polygon].layer.payload
    }

    /// The uppermost polygon at a place.
    pub(super) fn owner(&self, plan: DVec2) -> Owner {
        self.owner_or_bare(plan, true)
    }

    /// As [`Cover::owner`], but without `layers` only inside and outside are told apart.
    pub(super) fn owner_or_bare(&self, plan: DVec2, layers: bool) -> Owner {
        if !self.area.contains(plan) {
            return Owner::Outside;
        } else if !layers {
            return Owner::Bare;
        }
        let at = ((plan - self.lo) / self.cell).max(DVec2::ZERO);
        let square = self.squares.get(at.y as usize * self.columns + (at.x as usize).min(self.columns - 1));
        let mut here = square.into_iter().flatten().map(|&i| i as usize);
        here.find(|&i| self.polygons[i].contains(plan)).map_or(Owner::Bare, Owner::Layer)
    }
}

/// Owner of every inner face, in the order of [`faces`].
pub(super) fn owners(triangulation: &Triangulation, cover: &Cover) -> Vec<Owner> {
    // Inner faces are numbered from 1 by spade; 0 is the outside.
    let mut region = vec![usize::MAX; triangulation.num_all_faces()];
    let mut largest: Vec<(f64, DVec2)> = Vec::new();
    let mut open = Vec::new();
    for start in triangulation.inner_faces() {
        if region[start.index()] != usize::MAX {
            continue;
        }
        let id = largest.len();
        largest.push((-1.0, DVec2::ZERO));
        region[start.index()] = id;
        open.push(start);
        while let Some(face) = open.pop() {
            let [a, b, c] = face.vertices().map(|v| v.data().plan());
            let area = (b - a).perp_dot(c - a);
            if area > largest[id].0 {
                largest[id] = (area, (a + b + c) / 3.0);
            }
            for edge in face.adjacent_edges() {
                let Some(next) = edge.rev().face().as_inner().filter(|_| !edge.is_constraint_edge()) else { continue };
                if region[next.index()] == usize::MAX {
                    region[next.index()] = id;
                    open.push(next);
                }
            }
        }
    }
    let by_region: Vec<Owner> = largest.into_iter().map(|(_, centre)| cover.owner(centre)).collect();
    triangulation.inner_faces().map(|f| by_region[region[f.index()]]).collect()
}

/// Sets the vertices of level polygons to the least terrain height along their visible shore; gives which polygons
/// are level.
pub(super) fn level_water(triangulation: &mut Triangulation, cover: &Cover, terrain: &Terrain) -> Vec<bool> {
    let level: Vec<bool> = cover.polygons.iter().map(|p| p.layer.surface == Surface::Level).collect();
    if !level.contains(&true) || terrain.is_flat() {
        return level;
    }
    let mut least = vec![f64::INFINITY; level.len()];
    let mut water: Vec<(usize, usize)> = Vec::new();
    for (corners, owner) in faces(triangulation).zip(owners(triangulation, cover)) {
        let Owner::Layer(polygon) = owner else { continue };
        if level[polygon] {
            water.extend(corners.map(|c| (c, polygon)));
        }
    }
    for &(corner, polygon) in &water {
        // NaN loses against any number.
        least[polygon] = least[polygon].min(vertex(triangulation, corner).height);
    }
    for (corner, polygon) in water {
        let handle = spade::handles::FixedVertexHandle::from_index(corner);
        let data = triangulation.vertex_data_mut(handle);
        if least[polygon].is_finite() {
            data.height = if data.height.is_nan() { least[polygon] } else { data.height.min(least[polygon]) };
        }
    }
    level
}
