//! Points inside a closed mesh. In: triangles. Out: uniform points within, and whether a point is within.

use glam::DVec3;

use super::super::topology::Topology;
use super::scatter::Dice;
use crate::geometry::Mesh;
use crate::geometry::mesh_checks::volume;
use crate::geometry::triangulate::triangles;

/// A closed mesh cut into the columns over its triangles: a point of a column lies inside where the winding of the
/// triangles above it is not 0.
pub struct Solid {
    triangles: Vec<[DVec3; 3]>,
    low: DVec3,
    high: DVec3,
    /// Draws of the box after which the nearest hit is taken: enough for all but 1 in 10^9 points.
    tries: usize,
}

impl Solid {
    /// `None` for meshes that are open or hold no volume.
    pub fn of(mesh: &Mesh) -> Option<Solid> {
        let (low, high) = mesh.bounds().filter(|_| Topology::of(mesh).is_closed())?;
        let share = volume(mesh).abs() / (high - low).element_product();
        if !(share.is_finite() && share > 1e-9) {
            return None;
        }
        let tries = (20.0 / share.min(1.0)).ceil() as usize;
        Some(Solid { triangles: triangles(mesh).map(|(_, t)| t).collect(), low, high, tries: tries.min(100_000) })
    }

    pub fn uniform(&self, dice: &mut Dice) -> DVec3 {
        let draw = |dice: &mut Dice| self.low + (self.high - self.low) * dice.roll3();
        let mut p = draw(dice);
        for _ in 0..self.tries {
            if self.contains(p) {
                return p;
            }
            p = draw(dice);
        }
        // Very thin bodies: the middle of the stretch inside the column of a triangle's middle.
        self.inside_a_column(dice).unwrap_or(p)
    }

    /// Whether the surface winds around the point: crossings of the vertical ray, counted by direction.
    pub fn contains(&self, p: DVec3) -> bool {
        let above = self.triangles.iter().filter_map(|t| crossing(t, p)).filter(|(y, _)| *y > p.y);
        above.map(|(_, turn)| turn).sum::<i32>() != 0
    }

    fn inside_a_column(&self, dice: &mut Dice) -> Option<DVec3> {
        let number = (dice.roll() * self.triangles.len() as f64) as usize;
        let [a, b, c] = self.triangles.get(number)?;
        let through = (a + b + c) / 3.0;
        let mut heights: Vec<f64> =
            self.triangles.iter().filter_map(|t| crossing(t, through)).map(|(y, _)| y).collect();
        heights.sort_by(f64::total_cmp);
        let stretch = heights.chunks_exact(2).next()?;
        Some(DVec3::new(through.x, (stretch[0] + stretch[1]) / 2.0, through.z))
    }
}

/// Height at which the vertical line through a point passes a triangle, +1 if upwards through its front. Each edge
/// belongs to one of its two triangles (half-open test), so that no line slips through between them.
fn crossing(&[a, b, c]: &[DVec3; 3], p: DVec3) -> Option<(f64, i32)> {
    let mut winding = 0;
    for (s, e) in [(a, b), (b, c), (c, a)] {
        if (s.z > p.z) != (e.z > p.z) {
            // Computed from the same end whichever way the edge is run.
            let (u, v) = if s.z < e.z { (s, e) } else { (e, s) };
            let x = u.x + (p.z - u.z) / (v.z - u.z) * (v.x - u.x);
            if x > p.x {
                winding += if e.z > s.z { 1 } else { -1 };
            }
        }
    }
    if winding == 0 {
        return None;
    }
    let normal = (b - a).cross(c - a);
    if normal.y == 0.0 {
        return None;
    }
    let y = a.y - ((p.x - a.x) * normal.x + (p.z - a.z) * normal.z) / normal.y;
    Some((y, if normal.y > 0.0 { 1 } else { -1 }))
}
