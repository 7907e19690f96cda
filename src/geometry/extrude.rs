//! Extrusion. In: a mesh of faces, a direction and a distance. Out: prisms, with the role and source of every face.
//!
//! Words: *bottom* is the source face turned over, *top* its moved copy, *sides* stand on the source's border edges.

mod prism;

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::mesh::UvSets;
use super::plane::unit;
use super::transform::flip_face;
use super::{Face, Mesh};

/// Where the vertices go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Every face along its own normal; coplanar neighbours together, others as prisms of their own.
    FaceNormal,
    /// Every vertex along the mean normal of its faces, `distance` metres.
    VertexNormal,
    /// All along one vector (world up); it is normalised.
    Along(DVec3),
    /// Along one vector to a flat top: `distance` above the lowest vertex, at least the shape's own extent;
    /// a negative distance is taken down from the highest vertex.
    AlongToFlatTop(DVec3),
}

/// What a result face is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    Bottom,
    Top,
    SideOuter,
    SideInner,
}

/// Origin of one result face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    pub role: Role,
    /// Index of the source face.
    pub face: u32,
    /// Edge of the source face (outer loop first, then holes, no edge skipped) a side stands on.
    pub edge: Option<u32>,
}

/// `origins` runs parallel to `mesh.faces`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extruded {
    pub mesh: Mesh,
    pub origins: Vec<Origin>,
}

/// Distances up to this leave a shape as it is (compatibility notes).
pub const LEAST_DISTANCE: f64 = 0.001;

/// Neighbours whose normals differ by less than this in cosine (4.5e-5 rad) go up as one.
const COPLANAR: f64 = 1e-9;

/// Extrudes every face. For one n-gon: vertices are the n source ones, then the n moved ones; faces are bottom
/// [1, 0, n-1, .. 2], top [n, .. 2n-1], then side [i, i+1, i+1+n, i+n] per edge (compatibility notes, "Shape and
/// faces"); several faces: the same per face. Holes get walls, edges shared by two faces that move together none.
/// If the body lies behind the source face (negative distance) every face is turned so that it points outwards.
/// Top and bottom keep the uvs, sides carry the uv of their edge at both ends.
///
/// `None`: nothing to do, because `distance` is at most [`LEAST_DISTANCE`], is not finite, or no face has area.
pub fn extrude(mesh: &Mesh, direction: Direction, distance: f64) -> Option<Extruded> {
    if !distance.is_finite() || distance.abs() <= LEAST_DISTANCE {
        return None;
    }
    let out = prism::prism(mesh, direction, distance).unwrap_or_else(|| extrude_groups(mesh, direction, distance));
    (!out.mesh.faces.is_empty()).then_some(out)
}

fn extrude_groups(mesh: &Mesh, direction: Direction, distance: f64) -> Extruded {
    let mut out = Extruded::default();
    for group in groups(mesh, direction) {
        extrude_group(mesh, &group, direction, distance, &mut out);
    }
    out
}

/// Faces that move together, in order of their first face. Faces without area belong to none.
fn groups(mesh: &Mesh, direction: Direction) -> Vec<Vec<usize>> {
    let normals: Vec<DVec3> = mesh.faces.iter().map(|f| mesh.normal(f)).collect();
    let solid: Vec<usize> = (0..normals.len()).filter(|&i| normals[i] != DVec3::ZERO).collect();
    if direction != Direction::FaceNormal || solid.len() < 2 {
        return if solid.is_empty() { Vec::new() } else { vec![solid] };
    }
    let mut leader: Vec<usize> = (0..mesh.faces.len()).collect();
    let runs: BTreeMap<(u32, u32), usize> =
        solid.iter().flat_map(|&i| mesh.faces[i].edges().map(move |e| (e, i))).collect();
    for (&(a, b), &i) in &runs {
        let Some(&j) = runs.get(&(b, a)) else { continue };
        if normals[i].dot(normals[j]) > 1.0 - COPLANAR {
            let (i, j) = (find(&leader, i), find(&leader, j));
            leader[i.max(j)] = i.min(j);
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for i in solid {
        groups.entry(find(&leader, i)).or_default().push(i);
    }
    groups.into_values().collect()
}

fn find(leader: &[usize], mut i: usize) -> usize {
    while leader[i] != i {
        i = leader[i];
    }
    i
}

/// Each value once, in order.
fn sorted<T: Ord>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut list: Vec<T> = values.collect();
    list.sort_unstable();
    list.dedup();
    list
}

fn extrude_group(mesh: &Mesh, group: &[usize], direction: Direction, distance: f64, out: &mut Extruded) {
    let vertices = sorted(group.iter().flat_map(|&i| mesh.faces[i].corners()));
    let first = out.mesh.positions.len() as u32;
    let place = |v: u32| vertices.binary_search(&v).expect("a corner of the group");
    let bottom_of = |v: u32| first + place(v) as u32;
    let rise = vertices.len() as u32;
    out.mesh.positions.reserve(2 * vertices.len());
    out.mesh.positions.extend(vertices.iter().map(|&v| mesh.positions[v as usize]));
    let moves = moves(mesh, group, &vertices, direction, distance);
    out.mesh.positions.extend(vertices.iter().zip(&moves).map(|(&v, &m)| mesh.positions[v as usize] + m));

    let runs = sorted(group.iter().flat_map(|&i| mesh.faces[i].edges()));
    let most = runs.len() + 2 * group.len();
    out.mesh.faces.reserve(most);
    out.origins.reserve(most);
    for &index in group {
        let source = &mesh.faces[index];
        let mean_move: DVec3 = source.corners().map(|v| moves[place(v)]).sum();
        let body_behind = mean_move.dot(mesh.newell(source)) < 0.0;
        let mut push = |mut face: Face, role: Role, edge: Option<u32>, turned: bool| {
            if turned {
                flip_face(&mut face);
            }
            out.mesh.faces.push(face);
            out.origins.push(Origin { role, face: index as u32, edge });
        };
        let moved = |lift: u32| Face {
            outer: source.outer.iter().map(|&v| bottom_of(v) + lift).collect(),
            holes: source.holes.iter().map(|h| h.iter().map(|&v| bottom_of(v) + lift).collect()).collect(),
            uvs: source.uvs.clone(),
            normals: Vec::new(),
        };
        push(moved(0), Role::Bottom, None, !body_behind);
        push(moved(rise), Role::Top, None, body_behind);
        for (edge, (a, b)) in source.edges().enumerate() {
            if runs.binary_search(&(b, a)).is_ok() {
                continue;
            }
            let (i, j) = (bottom_of(a), bottom_of(b));
            let role = if edge < source.outer.len() { Role::SideOuter } else { Role::SideInner };
            let uvs = side_uvs(source, edge);
            let side = Face { uvs, ..Face::new([i, j, j + rise, i + rise]) };
            push(side, role, Some(edge as u32), body_behind);
        }
    }
}

/// The uv of both ends of a face-edge, at the bottom and again at the top.
fn side_uvs(source: &Face, edge: usize) -> UvSets {
    let next = next_corner(source, edge);
    let ends = |uv: &[DVec2]| Some((*uv.get(edge)?, *uv.get(next)?));
    source.uvs.iter().filter_map(|(set, uv)| ends(uv).map(|(a, b)| (*set, [a, b, b, a].into()))).collect()
}

/// The corner after this one in its own loop.
fn next_corner(face: &Face, corner: usize) -> usize {
    let mut start = 0;
    for ring in face.loops() {
        if corner < start + ring.len() {
            return if corner + 1 < start + ring.len() { corner + 1 } else { start };
        }
        start += ring.len();
    }
    corner
}

/// How far each vertex of the group goes, in the order of `vertices`.
fn moves(mesh: &Mesh, group: &[usize], vertices: &[u32], direction: Direction, distance: f64) -> Vec<DVec3> {
    let along = |v: DVec3| unit(v).unwrap_or(DVec3::ZERO) * distance;
    match direction {
        Direction::FaceNormal => {
            let normal: DVec3 = group.iter().map(|&i| mesh.newell(&mesh.faces[i])).sum();
            vec![along(normal); vertices.len()]
        }
        Direction::Along(vector) => vec![along(vector); vertices.len()],
        Direction::VertexNormal => {
            let mut sums: BTreeMap<u32, DVec3> = vertices.iter().map(|&v| (v, DVec3::ZERO)).collect();
            for &i in group {
                let normal = mesh.normal(&mesh.faces[i]);
                mesh.faces[i].corners().for_each(|v| *sums.entry(v).or_default() += normal);
            }
            sums.into_values().map(along).collect()
        }
        Direction::AlongToFlatTop(vector) => {
            let up = unit(vector).unwrap_or(DVec3::ZERO);
            let heights: Vec<f64> = vertices.iter().map(|&v| mesh.positions[v as usize].dot(up)).collect();
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let height = distance.abs().max(highest - lowest);
            let top = if distance > 0.0 { lowest + height } else { highest - height };
            heights.iter().map(|h| up * (top - h)).collect()
        }
    }
}

#[cfg(test)]
mod tests;
