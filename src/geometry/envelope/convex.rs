//! Bodies over strictly convex polygons. In: the polygon, its limits and a height. Out: the prism over it, cut by the
//! plane of every slope in turn.
//!
//! The body is the intersection of half spaces (reference 4.8). So a slope counts even where other slopes have passed
//! the top of its own wall below: its plane comes back further up.

use glam::{DVec2, DVec3};

use super::super::cut::{self, Origin};
use super::super::polygon::Polygon;
use super::super::{Mesh, Plane};
use super::{Body, Envelope, Limit, Part, SAME, outline_of};

/// Turns of less than this (sine) count as straight on.
const STRAIGHT: f64 = 1e-6;

/// No holes, and a turn to the left at every corner.
pub fn is_strictly_convex(polygon: &Polygon) -> bool {
    let ring = &polygon.outer;
    let side = |i: usize| ring[(i + 1) % ring.len()] - ring[i % ring.len()];
    let turns = (0..ring.len()).map(|i| {
        let (a, b) = (side(i), side(i + 1));
        let sine = a.perp_dot(b) / (a.length() * b.length());
        (sine, libm::atan2(sine, a.dot(b) / (a.length() * b.length())))
    });
    let (least, sum) = turns.fold((f64::INFINITY, 0.0), |(least, sum), (sine, turn)| (sine.min(least), sum + turn));
    // A ring that winds twice also turns left everywhere.
    polygon.holes.is_empty() && least > STRAIGHT && sum < 1.5 * std::f64::consts::TAU
}

/// The body over a strictly convex polygon; nothing if the slopes leave none.
pub fn over(polygon: &Polygon, limits: &[Limit], height: f64) -> Option<Envelope> {
    let slopes = || (0..polygon.outer.len()).zip(limits).filter(|(_, limit)| limit.angle < 90.0);
    let height = slopes().map(|(edge, limit)| reach(polygon, edge, limit)).fold(height, f64::min);
    let mut body = Body::default();
    let outline = outline_of(polygon);
    body.bottom(polygon);
    body.upright(&outline, 0.0, height);
    body.top(&outline, height);
    let Envelope { mut mesh, mut parts } = body.finish();
    for (edge, limit) in slopes() {
        let piece = cut::cut(&mesh, &slope(polygon, edge, limit)?).behind;
        let part = |origin: &Origin| match origin {
            Origin::Face(i) => parts[*i as usize],
            Origin::Cap => Part::Side { edge, slope: true },
        };
        parts = piece.origins.iter().map(part).collect();
        mesh = piece.mesh;
        for (face, _) in mesh.faces.iter_mut().zip(&piece.origins).filter(|(_, origin)| **origin == Origin::Cap) {
            let heights: Vec<f64> = face.outer.iter().map(|&v| mesh.positions[v as usize].y).collect();
            let first = lowest_edge(&heights);
            face.outer.rotate_left(first);
        }
    }
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by_key(|&i| parts[i]);
    let faces = order.iter().map(|&i| mesh.faces[i].clone()).collect();
    let parts: Vec<Part> = order.iter().map(|&i| parts[i]).collect();
    (!parts.is_empty()).then(|| Envelope { mesh: Mesh { faces, ..mesh }, parts })
}

/// The edge of an outline, its start, and the direction to the left of it.
fn frame(polygon: &Polygon, edge: usize) -> (DVec2, DVec2) {
    let (a, b) = (polygon.outer[edge], polygon.outer[(edge + 1) % polygon.outer.len()]);
    (a, (b - a).normalize_or_zero().perp())
}

/// No point of the body lies above this: where the slope has come to the corner across. Prisms not much higher than
/// the body are cut most precisely.
fn reach(polygon: &Polygon, edge: usize, limit: &Limit) -> f64 {
    let (start, inward) = frame(polygon, edge);
    let across = polygon.outer.iter().map(|&p| (p - start).dot(inward)).fold(0.0, f64::max);
    limit.base + across * (libm::tan(limit.angle.to_radians()) * 1.01 + SAME)
}

/// The plane over an edge; the body is behind it.
fn slope(polygon: &Polygon, edge: usize, limit: &Limit) -> Option<Plane> {
    let (start, inward) = frame(polygon, edge);
    let (sin, cos) = libm::sincos(limit.angle.to_radians());
    Plane::through(DVec3::new(start.x, limit.base, -start.y), DVec3::new(-inward.x * sin, cos, inward.y * sin))
}

/// The edge of a loop with the lowest middle.
fn lowest_edge(heights: &[f64]) -> usize {
    let middle = |i: usize| heights[i] + heights[(i + 1) % heights.len()];
    (0..heights.len()).min_by(|&i, &j| middle(i).total_cmp(&middle(j))).unwrap_or(0)
}
