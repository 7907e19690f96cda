//! Plan polygons. In: rings of points. Out: a [`Polygon`] with measured area, bounds and containment.

use glam::DVec2;

/// A closed ring without a repeated last point.
pub type Ring = Vec<DVec2>;

/// A polygon with holes in the plan, metres. Behind the repair door: the outer ring is counter-clockwise,
/// holes are clockwise, rings are simple and do not overlap (they may touch in single points).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    pub outer: Ring,
    pub holes: Vec<Ring>,
}

/// Twice the signed area of a ring would overflow nothing here; this is the signed area, positive if
/// counter-clockwise, computed about the first point so that far origins cost no digits.
pub fn signed_area(ring: &[DVec2]) -> f64 {
    let Some(&o) = ring.first() else { return 0.0 };
    let mut sum = 0.0;
    for w in ring.windows(2) {
        sum += (w[0] - o).perp_dot(w[1] - o);
    }
    sum / 2.0
}

/// The centre of mass of a ring (about the first point); the mean of its points if it has no area.
pub fn centroid(ring: &[DVec2]) -> DVec2 {
    let Some(&o) = ring.first() else { return DVec2::ZERO };
    let (mut sum, mut area) = (DVec2::ZERO, 0.0);
    for w in ring.windows(2) {
        let (p, q) = (w[0] - o, w[1] - o);
        let cross = p.perp_dot(q);
        area += cross;
        sum += (p + q) * cross;
    }
    let mean = || ring.iter().map(|p| p - o).sum::<DVec2>() / ring.len() as f64;
    o + if area == 0.0 { mean() } else { sum / (3.0 * area) }
}

impl Polygon {
    /// Area of the outer ring less the holes, square metres, whatever the directions.
    pub fn area(&self) -> f64 {
        signed_area(&self.outer).abs() - self.holes.iter().map(|h| signed_area(h).abs()).sum::<f64>()
    }

    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Least and greatest coordinates of the outer ring; `None` if it is empty.
    pub fn bounds(&self) -> Option<(DVec2, DVec2)> {
        let &first = self.outer.first()?;
        Some(self.outer.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
    }

    /// Whether a point lies inside (even-odd over all rings); points on the border may go either way.
    pub fn contains(&self, p: DVec2) -> bool {
        self.rings().filter(|ring| ring_contains(ring, p)).count() % 2 == 1
    }
}

/// Even-odd test of a point against one ring.
pub fn ring_contains(ring: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for i in 0..ring.len() {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}
