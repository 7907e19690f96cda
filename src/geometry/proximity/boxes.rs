//! Oriented boxes. In: an origin, axes and sizes (0 for flat, negative for mirrored). Out: the distance of two of them.

use glam::{DMat3, DVec3};

/// A box from `origin` along the columns of `axes` (unit length, perpendicular).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    pub origin: DVec3,
    pub axes: DMat3,
    pub size: DVec3,
}

/// Corners by bits: x 1, y 2, z 4. An edge joins corners that differ in one bit.
const EDGES: [(usize, usize); 12] =
    [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)];

impl OrientedBox {
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let part = DVec3::from_array([1, 2, 4].map(|bit| if i & bit > 0 { 1.0 } else { 0.0 }));
            self.origin + self.axes * (self.size * part)
        })
    }

    /// Least distance of a point of one from a point of the other, metres; 0 where they meet.
    ///
    /// Convex bodies that do not meet are nearest at a corner and a face or at two edges; where they meet, an edge of
    /// one runs through the other or a corner lies in it.
    pub fn distance(&self, other: &OrientedBox) -> f64 {
        let (a, b) = (self.corners(), other.corners());
        let through = |body: &OrientedBox, corners: &[DVec3; 8]| {
            EDGES.iter().any(|&(i, j)| body.meets_line(corners[i], corners[j]))
        };
        if through(self, &b) || through(other, &a) {
            return 0.0;
        }
        let to_corners = a.iter().map(|&p| other.distance_to(p)).chain(b.iter().map(|&p| self.distance_to(p)));
        let between = EDGES.iter().flat_map(|&(i, j)| EDGES.iter().map(move |&(k, l)| (i, j, k, l)));
        let to_edges = between.map(|(i, j, k, l)| line_distance([a[i], a[j]], [b[k], b[l]]));
        to_corners.chain(to_edges).fold(f64::INFINITY, f64::min)
    }

    /// Position in the box's own axes, in a box from 0 to the sizes made positive.
    fn local(&self, p: DVec3) -> DVec3 {
        self.axes.transpose() * (p - self.origin) - self.size.min(DVec3::ZERO)
    }

    pub fn distance_to(&self, p: DVec3) -> f64 {
        let q = self.local(p);
        q.distance(q.clamp(DVec3::ZERO, self.size.abs()))
    }

    /// Whether the line from p to q runs through the box (slabs).
    fn meets_line(&self, p: DVec3, q: DVec3) -> bool {
        let (from, to, size) = (self.local(p), self.local(q), self.size.abs());
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for axis in 0..3 {
            let along = to[axis] - from[axis];
            if along == 0.0 {
                if from[axis] < 0.0 || from[axis] > size[axis] {
                    return false;
                }
                continue;
            }
            let (s, t) = (-from[axis] / along, (size[axis] - from[axis]) / along);
            enter = enter.max(s.min(t));
            leave = leave.min(s.max(t));
        }
        enter <= leave
    }
}

/// The point of the line from `a` to `b` nearest to `p`.
pub fn nearest_on_line(p: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let along = b - a;
    let squared = along.length_squared();
    if squared == 0.0 { a } else { a + along * ((p - a).dot(along) / squared).clamp(0.0, 1.0) }
}

/// Distance of two lines with ends: in their middle where they pass each other there, else at an end of one.
fn line_distance([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let determinant = uu * vv - uv * uv;
    let ends = [
        a.distance(nearest_on_line(a, c, d)),
        b.distance(nearest_on_line(b, c, d)),
        c.distance(nearest_on_line(c, a, b)),
        d.distance(nearest_on_line(d, a, b)),
    ];
    let least = ends.into_iter().fold(f64::INFINITY, f64::min);
    if determinant <= 1e-12 * uu * vv {
        return least;
    }
    let s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
    let t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
    let inside = |x: f64| (0.0..=1.0).contains(&x);
    if inside(s) && inside(t) { least.min((w + u * s - v * t).length()) } else { least }
}
