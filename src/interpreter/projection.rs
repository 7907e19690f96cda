//! Texture projections. In: the frame and tile sizes of `setupProjection`. Out: texture coordinates of world points.

use glam::{DVec2, DVec3};

/// A projection frozen in the world (reference 4.14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    pub origin: DVec3,
    /// World directions of u, of v, and of u x v.
    pub axes: [DVec3; 3],
    /// Size of one tile, metres; negative mirrors, never 0.
    pub tile: DVec2,
    /// Shift, metres.
    pub offset: DVec2,
    /// Share of the third axis in u.
    pub uw_factor: f64,
}

impl Projection {
    pub fn uv(&self, world: DVec3) -> DVec2 {
        let d = world - self.origin;
        let [a, b, c] = self.axes.map(|axis| axis.dot(d));
        DVec2::new((a + self.offset.x + self.uw_factor * c) / self.tile.x, (b + self.offset.y) / self.tile.y)
    }
}

/// The tile size nearest to `wanted` of which a whole number (at least one) covers `extent`; keeps the sign.
pub fn fitting_tile(extent: f64, wanted: f64) -> f64 {
    if wanted == 0.0 || extent == 0.0 {
        return wanted;
    }
    let count = (extent / wanted.abs()).abs().round().max(1.0);
    (extent.abs() / count).copysign(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floating_tiles_divide_the_extent() {
        assert_eq!(fitting_tile(4.0, 1.5), 4.0 / 3.0);
        assert_eq!(fitting_tile(4.0, -1.5), -4.0 / 3.0);
        assert_eq!(fitting_tile(1.0, 5.0), 1.0);
    }
}
