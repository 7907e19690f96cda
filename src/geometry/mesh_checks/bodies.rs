//! The bodies that loose faces make up. In: a mesh whose faces may have corners of their own, be split differently from
//! their neighbours, and continue beyond a body as sheets (overhangs). Out: bodies, closed or not, with their defects.
//!
//! Corners within a rounding of each other are one; corners on an edge of another face divide it. An edge is open if it
//! is not run as often forth as back. Open edges that lie on another face are attached to it: the body is closed there.
//! A face that others are attached to continues beyond the body, and so do those that hang on such faces alone: their
//! free edges are those of a sheet, not of a hole. What stands on a sheet (stumps on ash) may reach to the sheet's border.

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
        let own = seams.edges.values().filter(|e| faces.binary_search(&e.runs[0].0).is_ok());
        let (mut open, mut flipped, mut crowded) = (0, 0, 0);
        for seam in own.filter(|e| !seams.is_sound(e)) {
            match seam.runs[..] {
                [(face, _)] => open += usize::from(!seams.is_sheet[face]),
                [_, _] => flipped += 1,
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
    ups.iter().any(|&y| y > LEVEL) && ups.iter().any(|&y| y < -LEVEL) && ups.iter().any(|&y| y.abs() <= UPRIGHT)
}

/// A piece of an edge between two corners, with none between them.
#[derive(Clone, Debug, Default)]
struct Seam {
    /// The faces that run it, and whether from the lesser corner to the greater.
    runs: Vec<(usize, bool)>,
    is_attached: bool,
}

fn is_balanced(runs: impl Iterator<Item = bool>) -> bool {
    runs.map(|forth| if forth { 1 } else { -1 }).sum::<i32>() == 0
}

/// How faces hang together.
struct Seams {
    tolerance: f64,
    edges: BTreeMap<(u32, u32), Seam>,
    /// By face: whether it continues beyond the body.
    is_sheet: Vec<bool>,
    /// By face: whether something stands on it, on the side that it faces.
    is_ground: Vec<bool>,
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
                    seam.runs.push((number, w[0] < w[1]));
                }
            }
        }
        let none = vec![false; mesh.faces.len()];
        let leader = (0..mesh.faces.len()).collect();
        let mut seams = Seams { tolerance, edges, is_sheet: none.clone(), is_ground: none, leader };
        seams.attach(mesh);
        seams.spread();
        seams
    }

    /// Whether a seam is no defect: run as often forth as back, attached, or the foot of what stands on a sheet's border.
    fn is_sound(&self, seam: &Seam) -> bool {
        let bodily: Vec<bool> = seam.runs.iter().filter(|(face, _)| !self.is_ground[*face]).map(|r| r.1).collect();
        let is_foot = match bodily.len() {
            0 => false,
            1 => seam.runs.len() > 1,
            _ => is_balanced(bodily.iter().copied()),
        };
        seam.is_attached || is_foot || is_balanced(seam.runs.iter().map(|r| r.1))
    }

    /// Finds the open edges that lie on other faces, and joins what hangs together.
    fn attach(&mut self, mesh: &Mesh) {
        let all: Vec<(usize, [DVec3; 3])> = triangles(mesh).collect();
        let bounds = |t: &[DVec3; 3]| Bounds { lo: t[0].min(t[1]).min(t[2]), hi: t[0].max(t[1]).max(t[2]) };
        let tree = BoxTree::new(all.iter().map(|(_, t)| bounds(t)).collect());
        let mut joins = Vec::new();
        for (&(a, b), seam) in &mut self.edges {
            joins.extend(seam.runs.windows(2).map(|w| (w[0].0, w[1].0)));
            let [(own, forth)] = seam.runs[..] else { continue };
            let (p, q) = (mesh.positions[a as usize], mesh.positions[b as usize]);
            let middle = (p + q) / 2.0;
            let near = tree.touching(&Bounds { lo: middle, hi: middle }.grown(self.tolerance));
            let under = near
                .into_iter()
                .map(|i| &all[i])
                .find(|(face, t)| *face != own && nearest_point(t, middle).distance(middle) <= self.tolerance);
            if let Some(&(face, _)) = under {
                let along = if forth { q - p } else { p - q };
                let inwards = mesh.normal(&mesh.faces[own]).cross(along).normalize_or_zero();
                seam.is_attached = true;
                self.is_sheet[face] = true;
                self.is_ground[face] |= inwards.dot(mesh.normal(&mesh.faces[face])) > UPRIGHT;
                joins.push((own, face));
            }
        }
        for (f, g) in joins {
            let (f, g) = (self.find(f), self.find(g));
            self.leader[f.max(g)] = f.min(g);
        }
    }

    /// What hangs on sheets alone and has a free edge is a sheet too.
    fn spread(&mut self) {
        let mut hangs: Vec<(bool, BTreeSet<usize>)> = vec![(false, BTreeSet::new()); self.is_sheet.len()];
        for seam in self.edges.values() {
            for &(face, _) in &seam.runs {
                hangs[face].0 |= seam.runs.len() == 1 && !seam.is_attached;
                hangs[face].1.extend(seam.runs.iter().map(|r| r.0).filter(|&other| other != face));
            }
        }
        let hangs_on_sheets = |sheets: &[bool], face: usize| {
            let (is_free, others) = &hangs[face];
            *is_free && !others.is_empty() && others.iter().all(|&other| sheets[other])
        };
        loop {
            let more = |&face: &usize| !self.is_sheet[face] && hangs_on_sheets(&self.is_sheet, face);
            let more: Vec<usize> = (0..hangs.len()).filter(more).collect();
            if more.is_empty() {
                return;
            }
            more.into_iter().for_each(|face| self.is_sheet[face] = true);
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

/// Least cosine between a wall and the normal of the face that it stands on; greatest one of a wall and the vertical.
const UPRIGHT: f64 = 0.1;

/// Least cosine of a face that looks up and the vertical: spires are steep.
const LEVEL: f64 = 1e-3;

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
    fn a_piece_of_roof_that_lies_beyond_the_walls_is_no_hole() {
        let mut wide = block(&[[-0.5, 1.0, 0.5], [2.5, 1.0, 0.5], [2.5, 1.0, -1.5], [-0.5, 1.0, -1.5]]);
        let beyond = mesh(&[&[[2.5, 1.0, 0.5], [3.0, 1.0, 0.0], [3.0, 1.0, -1.0], [2.5, 1.0, -1.5]]]);
        wide.faces.push(Face::new((wide.positions.len() as u32..).take(4).collect::<Vec<u32>>()));
        wide.positions.extend(beyond.positions);
        assert_eq!(found(&wide), (1, 0, vec![]));
    }

    #[test]
    fn stumps_without_floors_stand_on_a_sheet_up_to_its_border() {
        let mut stump = block(TOP);
        stump.faces.remove(0);
        let sheet = |z: [f64; 2]| mesh(&[&[[0.0, 0.0, z[0]], [5.0, 0.0, z[0]], [5.0, 0.0, z[1]], [0.0, 0.0, z[1]]]]);
        let on = |below: Mesh| {
            let mut both = stump.clone();
            let first = both.positions.len() as u32;
            both.faces.push(Face::new((first..first + 4).collect::<Vec<u32>>()));
            both.positions.extend(below.positions);
            bodies(&both).defects
        };
        assert_eq!(on(sheet([0.0, -3.0])), BTreeMap::new());
        // The floor that is missing, but facing up.
        let up = mesh(&[&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, -1.0], [0.0, 0.0, -1.0]]]);
        assert_eq!(on(up), BTreeMap::from([(Defect::FlippedFace, 5)]));
    }

    #[test]
    fn a_needle_of_a_spire_encloses_something() {
        let tip = [1.0, 40.0, -0.5];
        let mut spire = block(TOP);
        spire.faces.pop();
        let slopes: Vec<Vec<[f64; 3]>> = (0..4).map(|i| vec![TOP[i], TOP[(i + 1) % 4], tip]).collect();
        let first = spire.positions.len() as u32;
        for (number, slope) in slopes.iter().enumerate() {
            spire.positions.extend(slope.iter().map(|&p| DVec3::from(p)));
            spire.faces.push(Face::new((first + 3 * number as u32..).take(3).collect::<Vec<u32>>()));
        }
        assert_eq!(found(&spire), (1, 0, vec![]));
        spire.faces.pop();
        assert!(bodies(&spire).defects.contains_key(&Defect::OpenEdge));
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
