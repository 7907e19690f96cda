//! The bodies that loose faces make up. In: a mesh whose faces may have corners of their own, be split differently from
//! their neighbours, and continue beyond a body as sheets (overhangs). Out: bodies, closed or not, with their defects.
//!
//! Corners within a rounding of each other are one; corners on an edge of another face divide it. An edge is open if it
//! is not run as often forth as back. Open edges that lie on another face are attached to it: the body is closed there.
//! A face that others are attached to continues beyond the body; its free edges are those of a sheet, not of a hole.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::defects::{Defect, ROUNDING, defects};
use super::{self_intersections, volume};
use crate::geometry::Mesh;
use crate::geometry::body::nearest_point;
use crate::geometry::box_tree::{Bounds, BoxTree};
use crate::geometry::triangulate::triangles;

/// What is found on the faces of one feature.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bodies {
    pub closed: usize,
    /// Surfaces without an inside: they have no wall, no face that looks down, or none that looks up.
    pub surfaces: usize,
    pub defects: BTreeMap<Defect, usize>,
}

impl Bodies {
    pub fn add(&mut self, other: Bodies) {
        self.closed += other.closed;
        self.surfaces += other.surfaces;
        for (defect, count) in other.defects {
            *self.defects.entry(defect).or_default() += count;
        }
    }

    fn found(&mut self, defect: Defect, count: usize) {
        if count > 0 {
            *self.defects.entry(defect).or_default() += count;
        }
    }
}

/// Checks of single faces are made on all faces, those of closedness, direction and intersection body by body.
pub fn bodies(mesh: &Mesh) -> Bodies {
    use Defect as D;
    let mut out = Bodies::default();
    let between = [D::OpenEdge, D::EdgeUsedMoreThanTwice, D::FlippedFace, D::SelfIntersection, D::NegativeVolume];
    defects(mesh, &between).into_iter().for_each(|(d, n)| out.found(d, n));
    let extent = mesh.bounds().map_or(0.0, |(low, high)| (high - low).max_element());
    if !(extent.is_finite() && extent > 0.0) || out.defects.contains_key(&D::MissingVertex) {
        return out;
    }
    let seams = Seams::new(mesh, ROUNDING * extent);
    let groups = seams.groups();
    for faces in groups {
        let part =
            Mesh { positions: mesh.positions.clone(), faces: faces.iter().map(|&f| mesh.faces[f].clone()).collect() };
        let edges = seams.edges.iter().filter(|(_, e)| faces.binary_search(&e.faces[0]).is_ok());
        let (mut open, mut flipped, mut crowded) = (0, 0, 0);
        for (_, edge) in edges.filter(|(_, e)| e.forth != e.back && !e.is_attached) {
            match edge.forth + edge.back {
                1 => open += usize::from(!seams.is_sheet[edge.faces[0]]),
                2 => flipped += 1,
                _ => crowded += 1,
            }
        }
        out.found(D::FlippedFace, flipped);
        out.found(D::EdgeUsedMoreThanTwice, crowded);
        let meant_closed = has_inside(&part);
        if meant_closed {
            out.found(D::OpenEdge, open);
        }
        if open + flipped + crowded == 0 && meant_closed {
            out.closed += 1;
            let no_sheet = faces.iter().all(|&f| !seams.is_sheet[f]);
            out.found(D::NegativeVolume, usize::from(no_sheet && volume(&part) < 0.0));
        } else {
            out.surfaces += 1;
        }
        let pairs = self_intersections(&part, seams.tolerance);
        let bodily = |&(f, g): &(usize, usize)| !seams.is_sheet[faces[f]] && !seams.is_sheet[faces[g]];
        out.found(D::SelfIntersection, pairs.iter().filter(|p| bodily(p)).count());
    }
    out
}

/// Whether some faces look up, some down, and some sideways: then they are meant to enclose something.
fn has_inside(part: &Mesh) -> bool {
    let ups: Vec<f64> = part.faces.iter().map(|f| part.normal(f).y).collect();
    ups.iter().any(|&y| y > 0.1) && ups.iter().any(|&y| y < -0.1) && ups.iter().any(|&y| y.abs() <= 0.1)
}

/// A piece of an edge between two corners, with none between them.
#[derive(Clone, Debug, Default)]
struct Seam {
    forth: usize,
    back: usize,
    faces: Vec<usize>,
    is_attached: bool,
}

/// How faces hang together.
struct Seams {
    tolerance: f64,
    edges: BTreeMap<(u32, u32), Seam>,
    /// By face: whether it continues beyond the body.
    is_sheet: Vec<bool>,
    /// By face: a face of lesser number that it hangs together with, or itself.
    leader: Vec<usize>,
}

impl Seams {
    fn new(mesh: &Mesh, tolerance: f64) -> Seams {
        let place = places(mesh, tolerance);
        let corners: BTreeSet<u32> = place.iter().copied().collect();
        let corners: Vec<u32> = corners.into_iter().collect();
        let at = |v: u32| mesh.positions[v as usize];
        let tree = BoxTree::new(corners.iter().map(|&v| Bounds { lo: at(v), hi: at(v) }).collect());
        let mut edges: BTreeMap<(u32, u32), Seam> = BTreeMap::new();
        for (number, face) in mesh.faces.iter().enumerate() {
            for (a, b) in face.edges().map(|(a, b)| (place[a as usize], place[b as usize])).filter(|(a, b)| a != b) {
                let stops = stops(at, &tree, &corners, (a, b), tolerance);
                for w in stops.windows(2) {
                    let seam = edges.entry((w[0].min(w[1]), w[0].max(w[1]))).or_default();
                    if w[0] < w[1] {
                        seam.forth += 1
                    } else {
                        seam.back += 1
                    }
                    seam.faces.push(number);
                }
            }
        }
        let leader = (0..mesh.faces.len()).collect();
        let mut seams = Seams { tolerance, edges, is_sheet: vec![false; mesh.faces.len()], leader };
        seams.attach(mesh);
        seams
    }

    /// Finds the open edges that lie on other faces, and joins what hangs together.
    fn attach(&mut self, mesh: &Mesh) {
        let all: Vec<(usize, [DVec3; 3])> = triangles(mesh).collect();
        let bounds = |t: &[DVec3; 3]| Bounds { lo: t[0].min(t[1]).min(t[2]), hi: t[0].max(t[1]).max(t[2]) };
        let tree = BoxTree::new(all.iter().map(|(_, t)| bounds(t)).collect());
        let mut joins = Vec::new();
        for (&(a, b), seam) in &mut self.edges {
            joins.extend(seam.faces.windows(2).map(|w| (w[0], w[1])));
            if seam.forth + seam.back != 1 {
                continue;
            }
            let middle = (mesh.positions[a as usize] + mesh.positions[b as usize]) / 2.0;
            let near = tree.touching(&Bounds { lo: middle, hi: middle }.grown(self.tolerance));
            let under = near.into_iter().map(|i| &all[i]).find(|(face, t)| {
                !seam.faces.contains(face) && nearest_point(t, middle).distance(middle) <= self.tolerance
            });
            if let Some((face, _)) = under {
                seam.is_attached = true;
                self.is_sheet[*face] = true;
                joins.push((seam.faces[0], *face));
            }
        }
        for (f, g) in joins {
            let (f, g) = (self.find(f), self.find(g));
            self.leader[f.max(g)] = f.min(g);
        }
    }

    fn find(&mut self, face: usize) -> usize {
        let mut at = face;
        while self.leader[at] != at {
            self.leader[at] = self.leader[self.leader[at]];
            at = self.leader[at];
        }
        at
    }

    /// Faces that hang together, in rising order.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for face in 0..self.leader.len() {
            let mut at = face;
            while self.leader[at] != at {
                at = self.leader[at];
            }
            groups.entry(at).or_default().push(face);
        }
        groups.into_values().collect()
    }
}

/// By vertex the first vertex within `tolerance` of it.
fn places(mesh: &Mesh, tolerance: f64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let at = |v: u32| mesh.positions[v as usize];
    order.sort_by(|&a, &b| at(a).x.total_cmp(&at(b).x).then(a.cmp(&b)));
    let mut place: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    for (i, &v) in order.iter().enumerate() {
        let before = order[..i].iter().rev().take_while(|&&u| at(v).x - at(u).x <= tolerance);
        let near = before.filter(|&&u| place[u as usize] == u && at(u).distance(at(v)) <= tolerance);
        if let Some(&first) = near.min() {
            place[v as usize] = first;
        }
    }
    place
}

/// The corners on an edge, from its start to its end.
fn stops(at: impl Fn(u32) -> DVec3, tree: &BoxTree, corners: &[u32], (a, b): (u32, u32), tolerance: f64) -> Vec<u32> {
    let (p, q) = (at(a), at(b));
    let length = p.distance(q);
    let along = (q - p) / length;
    let box_around = Bounds { lo: p.min(q), hi: p.max(q) }.grown(tolerance);
    let mut between: Vec<(f64, u32)> = (tree.touching(&box_around).into_iter())
        .map(|i| corners[i])
        .map(|v| (along.dot(at(v) - p), v))
        .filter(|&(t, v)| t > tolerance && t < length - tolerance && (at(v) - p).distance(along * t) <= tolerance)
        .collect();
    between.sort_by(|x, y| x.0.total_cmp(&y.0));
    std::iter::once(a).chain(between.into_iter().map(|(_, v)| v)).chain([b]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Face;

    fn mesh(faces: &[&[[f64; 3]]]) -> Mesh {
        let mut mesh = Mesh::default();
        for corners in faces {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners.iter().map(|&p| DVec3::from(p)));
            mesh.faces.push(Face::new((first..mesh.positions.len() as u32).collect::<Vec<u32>>()));
        }
        mesh
    }

    /// A box 2 x 1 x 1 (x, y, z from -1 to 0) of loose faces, its front in two halves, with the given top.
    fn block(top: &[[f64; 3]]) -> Mesh {
        mesh(&[
            &[[0.0, 0.0, -1.0], [2.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            &[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 0.0]],
            &[[2.0, 0.0, 0.0], [2.0, 0.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 0.0]],
            &[[2.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 1.0, -1.0], [2.0, 1.0, -1.0]],
            &[[0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, -1.0]],
            top,
        ])
    }

    const TOP: &[[f64; 3]] = &[[0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, -1.0], [0.0, 1.0, -1.0]];

    fn found(mesh: &Mesh) -> (usize, usize, Vec<(Defect, usize)>) {
        let bodies = bodies(mesh);
        (bodies.closed, bodies.surfaces, bodies.defects.into_iter().collect())
    }

    #[test]
    fn loose_faces_with_divided_edges_make_a_closed_body() {
        assert_eq!(found(&block(TOP)), (1, 0, vec![]));
    }

    #[test]
    fn a_roof_beyond_the_walls_closes_them() {
        let wide = [[-0.5, 1.0, 0.5], [2.5, 1.0, 0.5], [2.5, 1.0, -1.5], [-0.5, 1.0, -1.5]];
        assert_eq!(found(&block(&wide)), (1, 0, vec![]));
    }

    #[test]
    fn a_roof_that_is_too_small_leaves_open_edges() {
        let small = [[0.0, 1.0, 0.0], [1.9, 1.0, 0.0], [1.9, 1.0, -1.0], [0.0, 1.0, -1.0]];
        let (closed, _, defects) = found(&block(&small));
        assert_eq!(closed, 0);
        assert!(matches!(defects[..], [(Defect::OpenEdge, _)]), "{defects:?}");
        let mut gap = block(TOP);
        gap.faces.remove(3);
        assert_eq!(found(&gap), (0, 1, vec![(Defect::OpenEdge, 4)]));
    }

    #[test]
    fn walls_alone_and_floors_alone_are_surfaces() {
        let mut ruin = block(TOP);
        ruin.faces = ruin.faces[1..6].to_vec();
        assert_eq!(found(&ruin), (0, 1, vec![]));
        ruin.faces.truncate(1);
        assert_eq!(found(&ruin), (0, 1, vec![]));
    }

    #[test]
    fn a_flipped_face_and_a_body_inside_out_are_named() {
        let mut flipped = block(TOP);
        flipped.faces[6].outer.reverse();
        assert!(bodies(&flipped).defects.contains_key(&Defect::FlippedFace));
        let mut turned = block(TOP);
        turned.faces.iter_mut().for_each(|f| f.outer.reverse());
        assert_eq!(found(&turned), (1, 0, vec![(Defect::NegativeVolume, 1)]));
    }
}
