//! Corner normals and the orientation of faces. In: a mesh whose neighbouring faces share vertices. Out: the same, shaded
//! smoothly across blunt edges, or with its faces turned to one side.

use std::collections::BTreeMap;

use glam::DVec3;

use super::transform::flip_face;
use super::{Face, Mesh};

/// Faces and corners (numbered through a face's loops) that run an edge, by its lesser and greater vertex.
type Edges = BTreeMap<(u32, u32), Vec<Run>>;

/// A face running an edge: from its lesser vertex to its greater one if `rising`.
#[derive(Clone, Copy)]
struct Run {
    face: usize,
    rising: bool,
    /// Corner at the lesser, and at the greater vertex.
    corners: [usize; 2],
}

fn edges(mesh: &Mesh) -> Edges {
    let mut out = Edges::new();
    for (face, source) in mesh.faces.iter().enumerate() {
        let mut start = 0;
        for ring in source.loops() {
            for i in 0..ring.len() {
                let j = (i + 1) % ring.len();
                let (a, b) = (ring[i], ring[j]);
                let rising = a < b;
                let corners = if rising { [start + i, start + j] } else { [start + j, start + i] };
                out.entry((a.min(b), a.max(b))).or_default().push(Run { face, rising, corners });
            }
            start += ring.len();
        }
    }
    out
}

/// Gives every corner the mean normal of the faces around its vertex that can be reached over edges whose faces differ
/// by less than `degrees`. A face none of whose edges is that blunt is shaded flat. 0 makes all flat, 180 none.
pub fn soften(mesh: &mut Mesh, degrees: f64) {
    mesh.faces.iter_mut().for_each(|face| face.normals.clear());
    if degrees.is_nan() || degrees <= 0.0 {
        return;
    }
    let normals: Vec<DVec3> = mesh.faces.iter().map(|face| mesh.normal(face)).collect();
    let least = if degrees >= 180.0 { f64::NEG_INFINITY } else { libm::cos(degrees.to_radians()) };
    let mut fans = Fans::of(mesh);
    for runs in edges(mesh).values() {
        for (i, a) in runs.iter().enumerate() {
            for b in runs[i + 1..].iter().filter(|b| b.face != a.face) {
                if normals[a.face].dot(normals[b.face]) > least {
                    (0..2).for_each(|end| fans.join((a.face, a.corners[end]), (b.face, b.corners[end])));
                }
            }
        }
    }
    let sums = fans.sums(&normals);
    for (f, face) in mesh.faces.iter_mut().enumerate() {
        let corners: Vec<usize> = (0..face.corners().count()).map(|c| fans.root(f, c)).collect();
        if corners.iter().any(|&root| fans.is_shared(root)) {
            face.normals = corners.iter().map(|&root| sums[root].try_normalize().unwrap_or(normals[f])).collect();
        }
    }
}

/// Corners that share a normal, as a forest over all corners of all faces.
struct Fans {
    starts: Vec<usize>,
    leader: Vec<usize>,
    count: Vec<u32>,
}

impl Fans {
    fn of(mesh: &Mesh) -> Self {
        let mut starts = Vec::with_capacity(mesh.faces.len());
        let mut total = 0;
        for face in &mesh.faces {
            starts.push(total);
            total += face.corners().count();
        }
        Fans { starts, leader: (0..total).collect(), count: vec![1; total] }
    }

    fn root(&self, face: usize, corner: usize) -> usize {
        let mut i = self.starts[face] + corner;
        while self.leader[i] != i {
            i = self.leader[i];
        }
        i
    }

    fn join(&mut self, a: (usize, usize), b: (usize, usize)) {
        let (a, b) = (self.root(a.0, a.1), self.root(b.0, b.1));
        if a != b {
            self.leader[a.max(b)] = a.min(b);
            self.count[a.min(b)] += self.count[a.max(b)];
        }
    }

    fn is_shared(&self, root: usize) -> bool {
        self.count[root] > 1
    }

    /// Sum of the faces' normals per root.
    fn sums(&self, normals: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.leader.len()];
        for (face, &normal) in normals.iter().enumerate() {
            let end = self.starts.get(face + 1).copied().unwrap_or(self.leader.len());
            (0..end - self.starts[face]).for_each(|corner| sums[self.root(face, corner)] += normal);
        }
        sums
    }
}

/// Turns faces so that neighbours agree, each connected part as a whole outwards if it is closed, else upwards
/// (world y); a part that is neither keeps the side of its first face. All faces are shaded flat.
pub fn conform(mesh: &mut Mesh) {
    mesh.faces.iter_mut().for_each(|face| face.normals.clear());
    let edges = edges(mesh);
    let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); mesh.faces.len()];
    for runs in edges.values() {
        if let [a, b] = runs[..] {
            let agree = a.rising != b.rising;
            neighbours[a.face].push((b.face, agree));
            neighbours[b.face].push((a.face, agree));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.faces.len()];
    for first in 0..mesh.faces.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut part = vec![first];
        let mut next = 0;
        while let Some(&face) = part.get(next) {
            next += 1;
            let own = turned[face] == Some(true);
            for &(other, agree) in &neighbours[face] {
                if turned[other].is_none() {
                    turned[other] = Some(own == agree);
                    part.push(other);
                }
            }
        }
        part.iter().filter(|&&f| turned[f] == Some(true)).for_each(|&f| flip_face(&mut mesh.faces[f]));
        if outwards_or_up(mesh, &part, &edges) < 0.0 {
            part.iter().for_each(|&f| flip_face(&mut mesh.faces[f]));
        }
        part.iter().for_each(|&f| mesh.faces[f].normals.clear());
    }
}

/// Volume of a closed part, or how far the faces of an open one look up; negative for the wrong side.
fn outwards_or_up(mesh: &Mesh, part: &[usize], edges: &Edges) -> f64 {
    let faces = || part.iter().map(|&f| &mesh.faces[f]);
    let closed = edges.values().filter(|runs| runs.iter().any(|r| part.contains(&r.face))).all(|runs| runs.len() == 2);
    let vector: DVec3 = faces().map(|face| mesh.area_vector(face)).sum();
    let area: f64 = faces().map(|face| mesh.area(face)).sum();
    if !closed {
        return if vector.y.abs() > 1e-9 * area { vector.y } else { 0.0 };
    }
    let origin = first_corner(mesh, &mesh.faces[part[0]]);
    faces().map(|face| mesh.area_vector(face).dot(first_corner(mesh, face) - origin)).sum()
}

fn first_corner(mesh: &Mesh, face: &Face) -> DVec3 {
    face.outer.first().map_or(DVec3::ZERO, |&v| mesh.positions[v as usize])
}

#[cfg(test)]
mod tests;
