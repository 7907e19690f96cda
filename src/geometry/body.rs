//! Where a point lies against a mesh. In: triangles with outward normals. Out: winding numbers, distances, sides.

use glam::DVec3;

use super::Mesh;
use super::box_tree::{Bounds, BoxTree};
use super::triangulate::triangles;

/// Triangles in space, ready for many questions.
#[derive(Clone, Debug, Default)]
pub struct Body {
    triangles: Vec<[DVec3; 3]>,
    tree: BoxTree,
}

/// Rays that pass an edge closer than this, in barycentric coordinates, are asked again in another direction.
const NEAR_EDGE: f64 = 1e-9;

/// Directions along nothing that people build.
const DIRECTIONS: [DVec3; 6] = [
    DVec3::new(0.8017837, 0.2672612, 0.5345225),
    DVec3::new(-0.3713907, 0.9284767, 0.0123451),
    DVec3::new(0.1234567, -0.5012345, 0.8564532),
    DVec3::new(-0.6172839, -0.3456789, -0.7067123),
    DVec3::new(0.4501237, 0.1928374, -0.8719283),
    DVec3::new(-0.9012345, 0.4123987, 0.1332211),
];

impl Body {
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Body {
        let around = |t: &[DVec3; 3]| Bounds { lo: t[0].min(t[1]).min(t[2]), hi: t[0].max(t[1]).max(t[2]) };
        let tree = BoxTree::new(triangles.iter().map(around).collect());
        Body { triangles, tree }
    }

    pub fn of_mesh(mesh: &Mesh) -> Body {
        Body::new(triangles(mesh).map(|(_, t)| t).collect())
    }

    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// How often the triangles of a closed mesh wind around the point: 0 outside, 1 inside. On the surface it may be
    /// either.
    pub fn winding(&self, p: DVec3) -> i32 {
        let counts = DIRECTIONS.iter().map(|&d| self.crossings(p, d));
        let mut last = 0;
        for (count, is_clear) in counts {
            last = count;
            if is_clear {
                break;
            }
        }
        last
    }

    /// Signed crossings of the half line, and whether it kept away from all edges.
    fn crossings(&self, p: DVec3, direction: DVec3) -> (i32, bool) {
        let (mut count, mut is_clear) = (0, true);
        let test = |t: &[DVec3; 3]| -> Option<(f64, f64)> {
            let (ab, ac) = (t[1] - t[0], t[2] - t[0]);
            let across = direction.cross(ac);
            let det = ab.dot(across);
            if det == 0.0 {
                return None;
            }
            let from = p - t[0];
            let u = from.dot(across) / det;
            let v = direction.dot(from.cross(ab)) / det;
            let way = ac.dot(from.cross(ab)) / det;
            (way > 0.0).then_some((u.min(v).min(1.0 - u - v), det))
        };
        self.tree.visit(
            |b| b.meets_ray(p, direction),
            |i| {
                if let Some((room, det)) = test(&self.triangles[i]) {
                    is_clear &= room.abs() > NEAR_EDGE;
                    let way = if det < 0.0 { 1 } else { -1 };
                    count += if room < 0.0 { 0 } else { way };
                }
            },
        );
        (count, is_clear)
    }

    /// Metres to the nearest point of the surface; infinite without triangles.
    pub fn distance(&self, p: DVec3) -> f64 {
        let nearest = self.tree.nearest(p, |i| p.distance(nearest_point(&self.triangles[i], p)));
        nearest.map_or(f64::INFINITY, |(_, d)| d)
    }

    /// Whether the point lies behind the triangle nearest to it, that is, against its normal. Of triangles equally
    /// near the one that is most across decides. Points on the surface are not behind.
    pub fn is_behind(&self, p: DVec3) -> bool {
        let least = self.distance(p);
        if !least.is_finite() || least == 0.0 {
            return false;
        }
        let reach = Bounds { lo: p, hi: p }.grown(least * (1.0 + 1e-6));
        let mut decides: (f64, f64) = (0.0, 0.0);
        for i in self.tree.touching(&reach) {
            let t = &self.triangles[i];
            let away = p - nearest_point(t, p);
            let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize_or_zero();
            let across = away.dot(normal) / least;
            if away.length() <= least * (1.0 + 1e-6) && across.abs() > decides.0 {
                decides = (across.abs(), across);
            }
        }
        decides.1 < 0.0
    }
}

/// The point of a triangle nearest to `p` (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
pub fn nearest_point(t: &[DVec3; 3], p: DVec3) -> DVec3 {
    let [a, b, c] = *t;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let all = va + vb + vc;
    a + ab * (vb / all) + ac * (vc / all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Face;
    use proptest::prelude::*;

    /// The cube from -1 to 1.
    fn cube() -> Mesh {
        let at = |i: usize, bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let positions = (0..8).map(|i| DVec3::new(at(i, 0), at(i, 1), at(i, 2))).collect();
        let quads: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Mesh { positions, faces: quads.into_iter().map(|q| Face::new(q.to_vec())).collect() }
    }

    proptest! {
        #[test]
        fn a_cube_knows_its_inside_and_its_distance(p in prop::array::uniform3(-2.0..2.0f64)) {
            let p = DVec3::from(p);
            let body = Body::of_mesh(&cube());
            let depth = p.abs().max_element() - 1.0;
            prop_assume!(depth.abs() > 1e-6);
            prop_assert_eq!(body.winding(p), i32::from(depth < 0.0));
            prop_assert_eq!(body.is_behind(p), depth < 0.0);
            let expected = if depth < 0.0 { -depth } else { (p.abs() - DVec3::ONE).max(DVec3::ZERO).length() };
            prop_assert!((body.distance(p) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn the_middle_of_a_cube_is_inside_though_rays_meet_edges() {
        let body = Body::of_mesh(&cube());
        assert_eq!((body.winding(DVec3::ZERO), body.winding(DVec3::new(-3.0, -3.0, -3.0))), (1, 0));
        assert_eq!(Body::default().winding(DVec3::ZERO), 0);
    }
}
