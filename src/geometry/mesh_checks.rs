//! Defects and measures of meshes. In: a mesh. Out: every case of one defect, by the function of its name.

mod bodies;
mod defects;
mod self_intersection;

pub use self::bodies::{Bodies, bodies};
pub use self::defects::{Defect, ROUNDING, defects};
pub use self::self_intersection::self_intersections;

use std::cmp::Ordering;
use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::orientation::orientation;
use super::triangulate::{dropped_axis, triangles, triangulate_face};
use super::{Face, Mesh};

/// A directed edge of a face: (from, to) vertex indices.
pub type Edge = (u32, u32);

/// Runs of every edge (lesser vertex first): (that way, the other way).
fn edge_runs(mesh: &Mesh) -> BTreeMap<Edge, (usize, usize)> {
    let mut runs: BTreeMap<Edge, (usize, usize)> = BTreeMap::new();
    for (a, b) in mesh.faces.iter().flat_map(|f| f.edges()) {
        let count = runs.entry((a.min(b), a.max(b))).or_default();
        if a < b { count.0 += 1 } else { count.1 += 1 }
    }
    runs
}

/// Edges of one face only, as that face runs them.
pub fn open_edges(mesh: &Mesh) -> Vec<Edge> {
    let directed = |((a, b), runs)| match runs {
        (1, 0) => Some((a, b)),
        (0, 1) => Some((b, a)),
        _ => None,
    };
    edge_runs(mesh).into_iter().filter_map(directed).collect()
}

/// Edges (lesser vertex first) of more than two faces, with how many.
pub fn edges_used_more_than_twice(mesh: &Mesh) -> Vec<(Edge, usize)> {
    edge_runs(mesh).into_iter().map(|(e, (f, b))| (e, f + b)).filter(|&(_, n)| n > 2).collect()
}

/// Edges (lesser vertex first) that two faces run the same way: one of the two is flipped.
pub fn edges_run_twice_the_same_way(mesh: &Mesh) -> Vec<Edge> {
    edge_runs(mesh).into_iter().filter(|(_, runs)| matches!(runs, (2, 0) | (0, 2))).map(|(e, _)| e).collect()
}

/// Faces whose outer loop encloses no area, or has fewer than three corners.
pub fn faces_without_area(mesh: &Mesh) -> Vec<usize> {
    (0..mesh.faces.len())
        .filter(|&i| mesh.faces[i].outer.len() < 3 || mesh.newell(&mesh.faces[i]) == DVec3::ZERO)
        .collect()
}

/// (face, corner) where a loop repeats the position of the corner before.
pub fn doubled_corners(mesh: &Mesh) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (index, face) in mesh.faces.iter().enumerate() {
        let mut start = 0;
        for ring in face.loops() {
            let at = |i: usize| mesh.positions[ring[i % ring.len()] as usize];
            found.extend((0..ring.len()).filter(|&i| at(i) == at(i + ring.len() - 1)).map(|i| (index, start + i)));
            start += ring.len();
        }
    }
    found
}

/// Faces without a plane that all corners are within `tolerance` metres of, with the least such distance that was
/// found. Beside the plane of the mean normal, which says nothing about slivers, that of the three corners farthest from
/// each other is tried.
pub fn non_planar_faces(mesh: &Mesh, tolerance: f64) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    for (index, face) in mesh.faces.iter().enumerate() {
        let corners: Vec<DVec3> = face.corners().map(|c| mesh.positions[c as usize]).collect();
        let mut off = off_plane(&corners, mesh.normal(face));
        if off > tolerance {
            off = off.min(off_plane(&corners, spanned_normal(&corners)));
        }
        if off > tolerance {
            found.push((index, off));
        }
    }
    found
}

/// Greatest distance of a corner from the mean plane with this normal.
fn off_plane(corners: &[DVec3], normal: DVec3) -> f64 {
    let Some(&first) = corners.first() else { return 0.0 };
    let heights = corners.iter().map(|&p| (p - first).dot(normal));
    let mean = heights.clone().sum::<f64>() / corners.len() as f64;
    heights.map(|h| (h - mean).abs()).fold(0.0, f64::max)
}

/// Normal of the plane through the corner farthest from the first, the farthest from that, and the farthest from both.
fn spanned_normal(corners: &[DVec3]) -> DVec3 {
    let farthest = |distance: &dyn Fn(DVec3) -> f64| {
        corners.iter().copied().max_by(|&p, &q| distance(p).total_cmp(&distance(q))).unwrap_or_default()
    };
    let first = corners.first().copied().unwrap_or_default();
    let a = farthest(&|p| p.distance_squared(first));
    let b = farthest(&|p| p.distance_squared(a));
    let c = farthest(&|p| (p - a).cross(b - a).length_squared());
    (b - a).cross(c - a).normalize_or_zero()
}

/// (face, corner) whose index has no vertex. All other checks need this one to find nothing.
pub fn missing_vertices(mesh: &Mesh) -> Vec<(usize, usize)> {
    let beyond = |c: u32| c as usize >= mesh.positions.len();
    let faces = mesh.faces.iter().enumerate();
    faces
        .flat_map(|(i, f)| f.corners().enumerate().filter(move |&(_, c)| beyond(c)).map(move |(k, _)| (i, k)))
        .collect()
}

/// Vertices with a coordinate that is not finite.
pub fn non_finite_vertices(mesh: &Mesh) -> Vec<usize> {
    (0..mesh.positions.len()).filter(|&i| !mesh.positions[i].is_finite()).collect()
}

/// (face, number of triangles) where the triangulation of a face has triangles without area, seen along its normal.
pub fn degenerate_triangles(mesh: &Mesh) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (index, face) in mesh.faces.iter().enumerate() {
        let Some(drop) = dropped_axis(mesh.newell(face)) else { continue };
        let corners: Vec<DVec2> = face.corners().map(|c| drop(mesh.positions[c as usize])).collect();
        let flat = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|i| corners[i as usize]);
            orientation(a, b, c) != Ordering::Greater
        };
        let count = triangulate_face(mesh, face).iter().filter(flat).count();
        if count > 0 {
            found.push((index, count));
        }
    }
    found
}

/// Faces whose triangles do not add up to their area, to 1e-9 of their girth squared, or that have none: their loops
/// cross. Loops that touch are filled.
pub fn faces_not_triangulated(mesh: &Mesh) -> Vec<usize> {
    let unfilled = |&i: &usize| {
        let face = &mesh.faces[i];
        let normal = mesh.normal(face);
        let corners: Vec<DVec3> = face.corners().map(|c| mesh.positions[c as usize]).collect();
        let part = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| corners[k as usize]);
            (b - a).cross(c - a).dot(normal) / 2.0
        };
        let parts: Vec<f64> = triangulate_face(mesh, face).iter().map(part).collect();
        let length = |(a, b): Edge| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
        let girth: f64 = face.edges().map(length).sum();
        parts.is_empty() || (pairwise_sum(&parts) - mesh.area(face)).abs() > 1e-9 * girth * girth
    };
    (0..mesh.faces.len()).filter(unfilled).collect()
}

/// Whether every edge is run equally often each way and at least one is; vertices count as the same by index.
pub fn is_closed(mesh: &Mesh) -> bool {
    !mesh.faces.is_empty() && edge_runs(mesh).values().all(|(forth, back)| forth == back)
}

/// Volume by the divergence theorem, cubic metres: right for closed meshes, positive if faces point outwards.
/// Triangles are summed in pairs about the middle of the bounds, so far origins cost no digits.
pub fn volume(mesh: &Mesh) -> f64 {
    let Some((lo, hi)) = mesh.bounds() else { return 0.0 };
    let o = (lo + hi) / 2.0;
    let parts: Vec<f64> = triangles(mesh).map(|(_, [a, b, c])| (a - o).cross(b - o).dot(c - o)).collect();
    pairwise_sum(&parts) / 6.0
}

/// Volume between the faces and the middle of the bounds by the faces' planes, cubic metres: a third of area times distance
/// each, without triangles. [`volume`] is the same where triangles fill their faces and faces are planar.
pub fn volume_by_planes(mesh: &Mesh) -> f64 {
    let Some((lo, hi)) = mesh.bounds() else { return 0.0 };
    let o = (lo + hi) / 2.0;
    let cone = |face: &Face| {
        let count = face.outer.len().max(1) as f64;
        let mean = face.outer.iter().map(|&c| mesh.positions[c as usize] - o).sum::<DVec3>() / count;
        mean.dot(mesh.area_vector(face)) / 6.0
    };
    pairwise_sum(&mesh.faces.iter().map(cone).collect::<Vec<f64>>())
}

/// Sum of the face areas less holes, square metres.
pub fn surface_area(mesh: &Mesh) -> f64 {
    pairwise_sum(&mesh.faces.iter().map(|f| mesh.area(f)).collect::<Vec<f64>>())
}

/// Sum in a fixed order with an error that grows only with the logarithm of the length.
pub fn pairwise_sum(terms: &[f64]) -> f64 {
    if terms.len() <= 8 {
        return terms.iter().sum();
    }
    let (low, high) = terms.split_at(terms.len() / 2);
    pairwise_sum(low) + pairwise_sum(high)
}

#[cfg(test)]
mod tests;
