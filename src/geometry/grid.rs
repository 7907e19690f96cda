//! The integer grid of a footprint (`../shared/numerics.md` §3).
//!
//! In: the bounds of a shape in metres. Out: a [`Grid`] that turns its points into integers of at most 2^29 and back.
//! The step is a power of two that follows the extent, so scaling a shape by a power of two changes no integer.

use glam::DVec2;

/// Largest coordinate on a grid, give or take one.
pub const GRID_LIMIT: i64 = 1 << 29;

/// A lattice of points `origin + step * (i, j)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Plan position of (0, 0), a multiple of `step` wherever f64 can tell.
    pub origin: DVec2,
    /// Metres; a power of two, 2^(ceil(log2 extent) - 30).
    pub step: f64,
}

/// Widest and narrowest shapes we work on, metres.
const EXTENTS: std::ops::RangeInclusive<f64> = 1e-100..=1e10;

impl Grid {
    /// The grid over a box; `None` if it is empty, not finite or out of all proportion.
    pub fn over(min: DVec2, max: DVec2) -> Option<Grid> {
        let extent = (max - min).max_element();
        if !(min.is_finite() && max.is_finite() && EXTENTS.contains(&extent)) {
            return None;
        }
        let (mantissa, exponent) = libm::frexp(extent);
        let log2_ceil = if mantissa == 0.5 { exponent - 1 } else { exponent };
        let step = libm::ldexp(1.0, log2_ceil - 30);
        let centre = min + (max - min) / 2.0;
        Some(Grid { origin: (centre / step).round() * step, step })
    }

    /// The nearest grid point.
    pub fn snap(&self, p: DVec2) -> [i64; 2] {
        let q = ((p - self.origin) / self.step).round();
        [q.x as i64, q.y as i64]
    }

    /// Plan position of a point given in grid steps.
    pub fn plan(&self, x: f64, y: f64) -> DVec2 {
        self.origin + DVec2::new(x, y) * self.step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stays_within_the_limit_and_follows_scale() {
        for extent in [1e-9, 0.5, 1.0, 30.0, 1024.0, 1025.0, 1e9] {
            let grid = Grid::over(DVec2::splat(7.0), DVec2::splat(7.0 + extent)).expect("a grid");
            let far = grid.snap(DVec2::splat(7.0 + extent));
            assert!(far[0].abs() <= GRID_LIMIT + 1, "{extent}: {far:?}");
            assert!(extent / grid.step > (1 << 29) as f64);
        }
        let grid = Grid::over(DVec2::new(1.0, 2.0), DVec2::new(4.0, 5.0)).expect("a grid");
        let twice = Grid::over(DVec2::new(2.0, 4.0), DVec2::new(8.0, 10.0)).expect("a grid");
        let p = DVec2::new(1.7, 3.3);
        assert_eq!(grid.snap(p), twice.snap(p * 2.0));
    }

    #[test]
    fn import_lattice_is_not_moved() {
        let lattice = libm::ldexp(1.0, -20);
        let p = DVec2::new(731.0 + 17.0 * lattice, 5.0 + lattice);
        let grid = Grid::over(DVec2::ZERO, DVec2::new(1000.0, 400.0)).expect("a grid");
        let [x, y] = grid.snap(p);
        assert_eq!(grid.plan(x as f64, y as f64), p);
    }

    #[test]
    fn refuses_what_has_no_extent() {
        assert_eq!(Grid::over(DVec2::ONE, DVec2::ONE), None);
        assert_eq!(Grid::over(DVec2::ZERO, DVec2::new(f64::NAN, 1.0)), None);
        assert_eq!(Grid::over(DVec2::ZERO, DVec2::new(f64::INFINITY, 1.0)), None);
    }
}
