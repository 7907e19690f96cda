//! In: a raster's placement and the scene's frame. Out: cell coordinates of plan points, fast.
//!
//! The exact way (inverse transverse Mercator, then the file's projection) is taken on a lattice of control points and
//! interpolated bilinearly between them. With a step of 128 m the greatest error is `128^2 / 8 * tan(latitude) / R`:
//! 0.3 mm in the plan at 45 degrees, 0.6 mm at 60.

use glam::DVec2;

use super::super::elevation::Placement;
use super::super::projection::LocalFrame;

const STEP_M: f64 = 128.0;
/// Sides of at most this many steps; larger areas get longer steps.
const MAX_STEPS: f64 = 512.0;

/// Control points over a rectangle of the plan.
#[derive(Debug)]
pub(super) struct CellMap {
    lo: DVec2,
    step: f64,
    columns: usize,
    rows: usize,
    /// Cell coordinates at the control points; NaN where the projection has none.
    cells: Vec<DVec2>,
}

impl CellMap {
    pub(super) fn new(placement: &Placement, frame: &LocalFrame, lo: DVec2, hi: DVec2) -> Self {
        let size = (hi - lo).max(DVec2::ZERO);
        let step = STEP_M.max(size.max_element() / MAX_STEPS);
        let (columns, rows) = ((size.x / step).ceil() as usize + 2, (size.y / step).ceil() as usize + 2);
        let mut cells = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let plan = lo + DVec2::new(column as f64, row as f64) * step;
                cells.push(exact(placement, frame, plan).unwrap_or(DVec2::NAN));
            }
        }
        CellMap { lo, step, columns, rows, cells }
    }

    /// Cell coordinates; `None` outside the rectangle or the projection's domain.
    pub(super) fn get(&self, plan: DVec2) -> Option<DVec2> {
        let at = (plan - self.lo) / self.step;
        let (last_x, last_y) = ((self.columns - 1) as f64, (self.rows - 1) as f64);
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < last_x && at.y < last_y) {
            return None;
        }
        let (base, f) = (at.floor(), at - at.floor());
        let i = base.y as usize * self.columns + base.x as usize;
        let south = self.cells[i].lerp(self.cells[i + 1], f.x);
        let north = self.cells[i + self.columns].lerp(self.cells[i + self.columns + 1], f.x);
        let cell = south.lerp(north, f.y);
        (!cell.is_nan()).then_some(cell)
    }
}

/// Cell coordinates of a plan point by the full projections.
pub(super) fn exact(placement: &Placement, frame: &LocalFrame, plan: DVec2) -> Option<DVec2> {
    let (lon, lat) = frame.inverse(plan);
    placement.near_cell_at(lon, lat)
}
