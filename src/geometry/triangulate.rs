//! Triangulation. In: a polygon with holes or a mesh face. Out: counter-clockwise triangles over its corners.
//!
//! Corners are numbered over the loops in order: the outer loop first, then the holes.

mod rounded;

use std::cmp::Ordering;
use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use spade::handles::{FaceHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::orientation::orientation;
use super::polygon::signed_area;
use super::{Face, Mesh, Polygon};

/// Outlines up to this long are cut by ears (2 to 4 microseconds for 4 to 30 corners); longer ones and those with
/// holes go through the constrained Delaunay triangulation (numerics section 6).
const LONGEST_FOR_EARS: usize = 64;

/// Outlines that cross themselves by a rounding are cut up to this length, in cubic time.
const LONGEST_FOR_ROUNDED: usize = 300;

/// Triangles of a plan polygon: n + 2 h - 2 of them, counter-clockwise, covering it exactly.
/// Input that is no polygon (too few points, no area, crossing edges) gives fewer or none.
pub fn triangulate_polygon(polygon: &Polygon) -> Vec<[u32; 3]> {
    let rings: Vec<&[DVec2]> = polygon.rings().map(Vec::as_slice).collect();
    triangulate_rings(&rings)
}

/// Triangles of a face over its corners, counter-clockwise seen from the side its normal points to.
/// The face is projected once, along the greatest component of its Newell normal. A face without area gives none.
pub fn triangulate_face(mesh: &Mesh, face: &Face) -> Vec<[u32; 3]> {
    if let [_, _, _] = face.outer[..]
        && face.holes.is_empty()
    {
        return if mesh.newell(face) == DVec3::ZERO { Vec::new() } else { vec![[0, 1, 2]] };
    }
    let Some(drop) = dropped_axis(mesh.newell(face)) else { return Vec::new() };
    let rings: Vec<Vec<DVec2>> =
        face.loops().map(|l| l.iter().map(|&i| drop(mesh.positions[i as usize])).collect()).collect();
    let rings: Vec<&[DVec2]> = rings.iter().map(Vec::as_slice).collect();
    triangulate_rings(&rings)
}

/// All triangles of a mesh as (face index, corner positions), faces in order.
pub fn triangles(mesh: &Mesh) -> impl Iterator<Item = (usize, [DVec3; 3])> + '_ {
    mesh.faces.iter().enumerate().flat_map(move |(index, face)| {
        let corners: Vec<u32> = face.corners().collect();
        triangulate_face(mesh, face)
            .into_iter()
            .map(move |t| (index, t.map(|c| mesh.positions[corners[c as usize] as usize])))
    })
}

/// The projection that drops the greatest component of the normal and keeps the face counter-clockwise; no
/// coordinate is rounded. `None` without a direction.
pub(super) fn dropped_axis(normal: DVec3) -> Option<fn(DVec3) -> DVec2> {
    let a = normal.abs();
    if !(a.max_element() > 0.0 && a.max_element().is_finite()) {
        return None;
    }
    Some(if a.y >= a.x && a.y >= a.z {
        if normal.y > 0.0 { |p| DVec2::new(p.z, p.x) } else { |p| DVec2::new(p.x, p.z) }
    } else if a.x >= a.z {
        if normal.x > 0.0 { |p| DVec2::new(p.y, p.z) } else { |p| DVec2::new(p.z, p.y) }
    } else if normal.z > 0.0 {
        |p| DVec2::new(p.x, p.y)
    } else {
        |p| DVec2::new(p.y, p.x)
    })
}

pub(super) fn triangulate_rings(rings: &[&[DVec2]]) -> Vec<[u32; 3]> {
    let [outer, holes @ ..] = rings else { return Vec::new() };
    if outer.len() < 3 || rings.iter().any(|r| r.iter().any(|p| !p.is_finite())) {
        return Vec::new();
    }
    if holes.is_empty()
        && outer.len() <= LONGEST_FOR_EARS
        && let Some(triangles) = cut_ears(outer)
    {
        return triangles;
    }
    let triangles = delaunay(rings);
    if holes.is_empty() && outer.len() <= LONGEST_FOR_ROUNDED && !covers(&triangles, outer) {
        return rounded::cut(outer).unwrap_or(triangles);
    }
    triangles
}

/// Whether there are n - 2 triangles whose areas add up to that of the ring.
fn covers(triangles: &[[u32; 3]], ring: &[DVec2]) -> bool {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| ring[i as usize]);
        (b - a).perp_dot(c - a) / 2.0
    };
    let (covered, whole) = (triangles.iter().map(area).sum::<f64>(), signed_area(ring));
    triangles.len() + 2 == ring.len() && (covered - whole).abs() <= 1e-9 * whole.abs()
}

/// Cuts ears until a triangle is left (Meisters 1975). An ear turns left strictly and no other corner lies in it or on
/// its border, so every triangle has area; `None` if no ear is left, as where the outline touches itself.
fn cut_ears(ring: &[DVec2]) -> Option<Vec<[u32; 3]>> {
    let mut left: Vec<u32> = (0..ring.len() as u32).collect();
    let mut triangles = Vec::with_capacity(ring.len() - 2);
    let mut at = 0;
    while left.len() > 3 {
        let n = left.len();
        let tip = (0..n).map(|k| (at + k) % n).find(|&k| is_ear(ring, &left, k))?;
        triangles.push([left[(tip + n - 1) % n], left[tip], left[(tip + 1) % n]]);
        left.remove(tip);
        at = if tip == n - 1 { 0 } else { tip };
    }
    let last = [left[0], left[1], left[2]];
    let [a, b, c] = last.map(|i| ring[i as usize]);
    triangles.push(last);
    (orientation(a, b, c) == Ordering::Greater).then_some(triangles)
}

fn is_ear(ring: &[DVec2], left: &[u32], tip: usize) -> bool {
    let n = left.len();
    let (before, after) = ((tip + n - 1) % n, (tip + 1) % n);
    let [a, b, c] = [before, tip, after].map(|k| ring[left[k] as usize]);
    orientation(a, b, c) == Ordering::Greater
        && (0..n).filter(|k| ![before, tip, after].contains(k)).all(|k| {
            let p = ring[left[k] as usize];
            orientation(a, b, p) == Ordering::Less
                || orientation(b, c, p) == Ordering::Less
                || orientation(c, a, p) == Ordering::Less
        })
}

/// Constrained Delaunay triangulation of all rings; kept are the triangles inside by crossing an odd number of edges
/// from the outside. Rings may touch in points. Edges that cross others are left out.
fn delaunay(rings: &[&[DVec2]]) -> Vec<[u32; 3]> {
    let Some((points, edges, corner_of)) = distinct_points(rings) else { return Vec::new() };
    let Ok(cdt) = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, edges, |_| ()) else {
        return Vec::new();
    };
    let inside = faces_inside(&cdt);
    let corners = |f: FaceHandle<'_, InnerTag, _, _, _, _>| f.vertices().map(|v| corner_of[v.fix().index()]);
    cdt.inner_faces().filter(|f| inside[f.fix().index()]).map(corners).collect()
}

type DistinctPoints = (Vec<Point2<f64>>, Vec<[usize; 2]>, Vec<u32>);

/// The points of all rings without repetitions, the edges between them, and the first corner at each point.
/// Edges run an even number of times bound nothing and are left out. `None` without three points.
fn distinct_points(rings: &[&[DVec2]]) -> Option<DistinctPoints> {
    // Spade refuses magnitudes below 1.8e-43: those are zero for every building.
    let plain = |x: f64| if x.abs() < 1e-40 { 0.0 } else { x };
    let all: Vec<DVec2> = rings.iter().flat_map(|r| r.iter().map(|p| DVec2::new(plain(p.x), plain(p.y)))).collect();
    let mut order: Vec<u32> = (0..all.len() as u32).collect();
    let key = |i: u32| all[i as usize];
    order.sort_by(|&i, &j| key(i).x.total_cmp(&key(j).x).then(key(i).y.total_cmp(&key(j).y)).then(i.cmp(&j)));
    let mut first_at: Vec<u32> = (0..all.len() as u32).collect();
    for w in order.windows(2) {
        if key(w[0]) == key(w[1]) {
            first_at[w[1] as usize] = first_at[w[0] as usize];
        }
    }
    let corner_of: Vec<u32> = (0..all.len() as u32).filter(|&i| first_at[i as usize] == i).collect();
    if corner_of.len() < 3 {
        return None;
    }
    let point_of = |corner: usize| corner_of.binary_search(&first_at[corner]).expect("every point has a first corner");
    let mut uses: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let mut start = 0;
    for ring in rings {
        for i in 0..ring.len() {
            let (a, b) = (point_of(start + i), point_of(start + (i + 1) % ring.len()));
            *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        start += ring.len();
    }
    let edges = uses.into_iter().filter(|([a, b], n)| a != b && n % 2 == 1).map(|(e, _)| e).collect();
    let points = corner_of.iter().map(|&i| Point2::new(key(i).x, key(i).y)).collect();
    Some((points, edges, corner_of))
}

/// Per face of the triangulation: does every way to the outside cross an odd number of constraints?
fn faces_inside(cdt: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<bool> {
    let mut inside = vec![false; cdt.num_all_faces()];
    let mut seen = vec![false; cdt.num_all_faces()];
    let outer = cdt.outer_face().fix().index();
    seen[outer] = true;
    // The outer face is reached by every hull edge; all other faces by their three edges.
    let mut queue = Vec::new();
    for edge in cdt.directed_edges().filter(|e| e.is_outer_edge()) {
        let face = edge.rev().face().fix().index();
        if !seen[face] {
            seen[face] = true;
            inside[face] = edge.is_constraint_edge();
            queue.push(edge.rev());
        }
    }
    while let Some(edge) = queue.pop() {
        let from = edge.face().fix().index();
        for side in [edge, edge.next(), edge.prev()] {
            let face = side.rev().face().fix().index();
            if !seen[face] {
                seen[face] = true;
                inside[face] = inside[from] != side.is_constraint_edge();
                queue.push(side.rev());
            }
        }
    }
    inside
}

#[cfg(test)]
mod tests;
