//! In: a raster's coordinate reference system and its affine transform. Out: cell coordinates of places, and back.
//!
//! Cell coordinates: cell (column, row) covers the unit square whose corner nearest to the first cell is
//! (column, row); its centre, which carries the height, is half a cell further in both directions.

use glam::{DAffine2, DVec2};

use super::crs::Crs;

/// A box in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LonLatBox {
    pub west: f64,
    pub south: f64,
    pub east: f64,
    pub north: f64,
}

/// Where a grid of cells lies.
#[derive(Debug)]
pub struct Placement {
    pub(super) crs: Crs,
    /// The file's coordinates from cell coordinates.
    pub(super) crs_from_cell: DAffine2,
    /// The inverse.
    cell_from_crs: DAffine2,
    pub(super) width: usize,
    pub(super) height: usize,
}

/// A range of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub column: usize,
    pub row: usize,
    pub width: usize,
    pub height: usize,
}

impl Placement {
    /// `None` if the transform is not invertible.
    pub(super) fn new(crs: Crs, crs_from_cell: DAffine2, width: usize, height: usize) -> Option<Self> {
        let cell_from_crs = crs_from_cell.inverse();
        let usable = crs_from_cell.is_finite() && cell_from_crs.is_finite();
        usable.then_some(Placement { crs, crs_from_cell, cell_from_crs, width, height })
    }

    /// Cell coordinates of a place, if a cell covers it.
    pub(super) fn cell_at(&self, lon: f64, lat: f64) -> Option<DVec2> {
        let (w, h) = (self.width as f64, self.height as f64);
        self.near_cell_at(lon, lat).filter(|c| (0.0..=w).contains(&c.x) && (0.0..=h).contains(&c.y) && w * h > 0.0)
    }

    /// Cell coordinates of a place, also outside the cells; of the longitudes that repeat every 360 degrees the one
    /// nearest to the middle of the raster is taken.
    pub(crate) fn near_cell_at(&self, lon: f64, lat: f64) -> Option<DVec2> {
        let c = self.cell_from_crs.transform_point2(self.crs.project(lon, lat)?);
        if !self.crs.is_geographic() {
            return Some(c);
        }
        let turn = self.cell_from_crs.transform_vector2(DVec2::new(360.0, 0.0));
        let middle = DVec2::new(self.width as f64, self.height as f64) / 2.0;
        let turns = ((middle - c).dot(turn) / turn.length_squared() + 0.5).floor();
        Some(if turns == 0.0 { c } else { c + turn * turns })
    }

    /// Longitude and latitude of cell coordinates.
    pub(crate) fn place_of(&self, cell: DVec2) -> Option<(f64, f64)> {
        self.crs.unproject(self.crs_from_cell.transform_point2(cell))
    }

    /// The cells that a box needs, with a margin, or all without a box. Of zero size if the box lies outside.
    pub(super) fn window(&self, area: Option<LonLatBox>) -> Window {
        const STEPS: usize = 8;
        let Some(area) = area else {
            return Window { column: 0, row: 0, width: self.width, height: self.height };
        };
        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for i in 0..(STEPS + 1) * (STEPS + 1) {
            let (u, v) = ((i % (STEPS + 1)) as f64 / STEPS as f64, (i / (STEPS + 1)) as f64 / STEPS as f64);
            let place = (area.west + u * (area.east - area.west), area.south + v * (area.north - area.south));
            if let Some(c) = self.near_cell_at(place.0, place.1) {
                (lo, hi) = (lo.min(c), hi.max(c));
            }
        }
        // Sides that are curved in the file's projection bulge beyond the samples by far less than a fiftieth.
        let margin = 2.0 + (hi - lo).max_element().max(0.0) / 50.0;
        let clamp = |v: f64, n: usize| v.clamp(0.0, n as f64) as usize;
        let (c0, r0) = (clamp((lo.x - margin).floor(), self.width), clamp((lo.y - margin).floor(), self.height));
        let (c1, r1) = (clamp((hi.x + margin).ceil(), self.width), clamp((hi.y + margin).ceil(), self.height));
        if c1 <= c0 || r1 <= r0 {
            return Window { column: 0, row: 0, width: 0, height: 0 };
        }
        Window { column: c0, row: r0, width: c1 - c0, height: r1 - r0 }
    }

    /// The placement of a range of the cells.
    pub(super) fn cropped(self, window: Window) -> Self {
        let shift = DVec2::new(window.column as f64, window.row as f64);
        Placement {
            crs_from_cell: self.crs_from_cell * DAffine2::from_translation(shift),
            cell_from_crs: DAffine2::from_translation(-shift) * self.cell_from_crs,
            width: window.width,
            height: window.height,
            crs: self.crs,
        }
    }
}
