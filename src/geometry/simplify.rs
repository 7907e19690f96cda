//! Fewer vertices for much the same surface. In: a mesh and how many vertices to take out. Out: triangles over the
//! vertices that stay.
//!
//! Edges are collapsed onto one of their ends, cheapest first; the cost is the squared distance from the planes that met
//! at both ends (Garland, Heckbert 1997, "Surface simplification using quadric error metrics"). Borders count as planes
//! square to the surface. A collapse that would fold a triangle over or pinch the surface is not done.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use glam::{DVec2, DVec3};

use super::triangulate::triangulate_face;
use super::{Face, Mesh};

/// A mesh of triangles; `sources[i]` is the face of the input that triangle `i` is of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Simplified {
    pub mesh: Mesh,
    pub sources: Vec<u32>,
    /// Vertices taken out.
    pub removed: usize,
}

/// Takes out up to `count` of the vertices that faces use. Texture coordinates stay with the corners, normals are
/// dropped. Vertices that belong together must be one.
pub fn simplify(mesh: &Mesh, count: usize) -> Simplified {
    let mut work = Work::of(mesh);
    let mut queue = BinaryHeap::new();
    for (a, b) in work.edges() {
        queue.extend([work.entry(a, b), work.entry(b, a)]);
    }
    let mut removed = 0;
    while removed < count
        && let Some(Reverse(entry)) = queue.pop()
    {
        let (from, onto) = (entry.from, entry.onto);
        let current = entry.versions == [work.versions[from as usize], work.versions[onto as usize]];
        if !current || !work.allows(from, onto) {
            continue;
        }
        work.collapse(from, onto);
        removed += 1;
        // What was not allowed before may be now.
        for near in work.neighbours(onto) {
            for other in work.neighbours(near) {
                queue.extend([work.entry(near, other), work.entry(other, near)]);
            }
        }
    }
    work.finish(mesh, removed)
}

/// Sum of squared distances from planes, by weight: a symmetric 4 x 4 matrix.
#[derive(Clone, Copy, Default)]
struct Quadric {
    /// nn^T by rows of the upper triangle, n d, d d.
    terms: [f64; 10],
}

impl Quadric {
    /// The plane through a point; `normal` has length 1.
    fn plane(point: DVec3, normal: DVec3, weight: f64) -> Quadric {
        let d = -normal.dot(point);
        let DVec3 { x, y, z } = normal;
        let terms = [x * x, x * y, x * z, y * y, y * z, z * z, x * d, y * d, z * d, d * d];
        Quadric { terms: terms.map(|t| t * weight) }
    }

    fn plus(self, other: Quadric) -> Quadric {
        Quadric { terms: std::array::from_fn(|i| self.terms[i] + other.terms[i]) }
    }

    fn at(&self, p: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz, xd, yd, zd, dd] = self.terms;
        let DVec3 { x, y, z } = p;
        let square = xx * x * x + yy * y * y + zz * z * z + dd;
        (square + 2.0 * (xy * x * y + xz * x * z + yz * y * z + xd * x + yd * y + zd * z)).max(0.0)
    }
}

/// A collapse that could be done.
#[derive(PartialEq)]
struct Entry {
    cost: f64,
    from: u32,
    onto: u32,
    versions: [u32; 2],
}

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let key = |e: &Entry| (e.from, e.onto, e.versions);
        self.cost.total_cmp(&other.cost).then_with(|| key(self).cmp(&key(other)))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

struct Triangle {
    corners: [u32; 3],
    face: u32,
    uvs: Vec<(u8, [DVec2; 3])>,
    alive: bool,
}

struct Work {
    /// About the middle of the mesh, so that far origins cost no digits.
    positions: Vec<DVec3>,
    triangles: Vec<Triangle>,
    /// Triangles at every vertex, some of them gone.
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    /// Raised when something about a vertex changes.
    versions: Vec<u32>,
}

/// Planes along the border weigh this much more than the surface.
const BORDER: f64 = 100.0;
/// Cosine of the greatest turn of a triangle in one collapse.
const TURN: f64 = 0.2;

impl Work {
    fn of(mesh: &Mesh) -> Work {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let positions: Vec<DVec3> = mesh.positions.iter().map(|p| p - (low + high) / 2.0).collect();
        let count = positions.len();
        let mut work = Work {
            positions,
            triangles: Vec::new(),
            around: vec![Vec::new(); count],
            quadrics: vec![Quadric::default(); count],
            versions: vec![0; count],
        };
        for (number, face) in mesh.faces.iter().enumerate() {
            let corners: Vec<u32> = face.corners().collect();
            for triangle in triangulate_face(mesh, face) {
                let uvs = face.uvs.iter().map(|(set, uv)| (*set, triangle.map(|c| uv[c as usize])));
                let corners = triangle.map(|c| corners[c as usize]);
                corners.iter().for_each(|&v| work.around[v as usize].push(work.triangles.len() as u32));
                work.triangles.push(Triangle { corners, face: number as u32, uvs: uvs.collect(), alive: true });
            }
        }
        work.weigh();
        work
    }

    fn weigh(&mut self) {
        let border: Vec<(u32, u32)> = self.edges().into_iter().filter(|&(a, b)| self.is_border(a, b)).collect();
        let mut add = |vertices: &[u32], quadric: Quadric| {
            vertices.iter().for_each(|&v| self.quadrics[v as usize] = self.quadrics[v as usize].plus(quadric));
        };
        for triangle in &self.triangles {
            let [a, b, c] = triangle.corners.map(|v| self.positions[v as usize]);
            let area = (b - a).cross(c - a);
            add(&triangle.corners, Quadric::plane(a, area.normalize_or_zero(), area.length() / 2.0));
            for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                let (v, w) = (triangle.corners[i], triangle.corners[j]);
                if border.contains(&(v.min(w), v.max(w))) {
                    let along = self.positions[w as usize] - self.positions[v as usize];
                    let square = along.cross(area).normalize_or_zero();
                    add(&[v, w], Quadric::plane(self.positions[v as usize], square, BORDER * along.length_squared()));
                }
            }
        }
    }

    /// Lesser vertex first.
    fn edges(&self) -> BTreeSet<(u32, u32)> {
        let ends = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)].map(|(v, w)| (v.min(w), v.max(w)));
        self.triangles.iter().flat_map(|t| ends(t.corners)).collect()
    }

    fn at(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.around[v as usize].iter().copied().filter(|&t| self.triangles[t as usize].alive)
    }

    fn neighbours(&self, v: u32) -> BTreeSet<u32> {
        self.at(v).flat_map(|t| self.triangles[t as usize].corners).filter(|&w| w != v).collect()
    }

    /// Triangles on an edge.
    fn wings(&self, a: u32, b: u32) -> Vec<u32> {
        self.at(a).filter(|&t| self.triangles[t as usize].corners.contains(&b)).collect()
    }

    fn is_border(&self, a: u32, b: u32) -> bool {
        self.wings(a, b).len() == 1
    }

    fn entry(&self, from: u32, onto: u32) -> Reverse<Entry> {
        let quadric = self.quadrics[from as usize].plus(self.quadrics[onto as usize]);
        let cost = quadric.at(self.positions[onto as usize]);
        Reverse(Entry { cost, from, onto, versions: [self.versions[from as usize], self.versions[onto as usize]] })
    }

    /// Whether the surface stays a surface and no triangle turns over.
    fn allows(&self, from: u32, onto: u32) -> bool {
        let wings = self.wings(from, onto);
        let opposite: BTreeSet<u32> = wings
            .iter()
            .flat_map(|&t| self.triangles[t as usize].corners)
            .filter(|&v| v != from && v != onto)
            .collect();
        let common: BTreeSet<u32> = self.neighbours(from).intersection(&self.neighbours(onto)).copied().collect();
        let on_border = self.neighbours(from).into_iter().any(|v| self.is_border(from, v));
        if !(1..=2).contains(&wings.len()) || common != opposite || (on_border && wings.len() != 1) {
            return false;
        }
        let survivors: Vec<u32> = self.at(from).filter(|t| !wings.contains(t)).collect();
        let area = |corners: [u32; 3]| {
            let [a, b, c] = corners.map(|v| self.positions[v as usize]);
            (b - a).cross(c - a)
        };
        !survivors.is_empty()
            && survivors.into_iter().all(|t| {
                let before = self.triangles[t as usize].corners;
                let (old, new) = (area(before), area(before.map(|v| if v == from { onto } else { v })));
                new.dot(old) > TURN * new.length() * old.length()
            })
    }

    fn collapse(&mut self, from: u32, onto: u32) {
        let wings = self.wings(from, onto);
        let survivors: Vec<u32> = self.at(from).filter(|t| !wings.contains(t)).collect();
        for &t in &survivors {
            let corner = self.corner(t, from);
            for k in 0..self.triangles[t as usize].uvs.len() {
                let (set, uv) = self.triangles[t as usize].uvs[k];
                let moved = self.texture_at(&wings, set, uv[corner], from, onto).unwrap_or(uv[corner]);
                self.triangles[t as usize].uvs[k].1[corner] = moved;
            }
            self.triangles[t as usize].corners[corner] = onto;
        }
        wings.iter().for_each(|&t| self.triangles[t as usize].alive = false);
        self.around[from as usize].clear();
        self.around[onto as usize].extend(survivors);
        self.quadrics[onto as usize] = self.quadrics[onto as usize].plus(self.quadrics[from as usize]);
        self.versions[from as usize] += 1;
        self.versions[onto as usize] += 1;
    }

    fn corner(&self, t: u32, v: u32) -> usize {
        self.triangles[t as usize].corners.iter().position(|&w| w == v).unwrap_or(0)
    }

    /// The coordinates of `onto` on the side of a seam where `from` has the given ones; any, if no wing is on that side.
    fn texture_at(&self, wings: &[u32], set: u8, given: DVec2, from: u32, onto: u32) -> Option<DVec2> {
        let of = |&t: &u32| {
            let (_, uv) = self.triangles[t as usize].uvs.iter().find(|(s, _)| *s == set)?;
            Some((uv[self.corner(t, from)], uv[self.corner(t, onto)]))
        };
        let found: Vec<(DVec2, DVec2)> = wings.iter().filter_map(of).collect();
        found.iter().find(|(a, _)| *a == given).or(found.first()).map(|(_, b)| *b)
    }

    fn finish(self, mesh: &Mesh, removed: usize) -> Simplified {
        let mut out = Simplified { removed, ..Simplified::default() };
        let mut place = vec![u32::MAX; mesh.positions.len()];
        for triangle in self.triangles.into_iter().filter(|t| t.alive) {
            let corners = triangle.corners.map(|v| {
                let number = &mut place[v as usize];
                if *number == u32::MAX {
                    *number = out.mesh.positions.len() as u32;
                    out.mesh.positions.push(mesh.positions[v as usize]);
                }
                *number
            });
            let mut face = Face::new(corners.to_vec());
            face.uvs = triangle.uvs.into_iter().map(|(set, uv)| (set, uv.into_iter().collect())).collect();
            out.mesh.faces.push(face);
            out.sources.push(triangle.face);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mesh_checks::{is_closed, surface_area, volume};

    /// A sheet of n x n squares, lifted by a function.
    fn sheet(n: u32, height: impl Fn(f64, f64) -> f64) -> Mesh {
        let mut mesh = Mesh::default();
        for j in 0..=n {
            for i in 0..=n {
                let (x, z) = (f64::from(i), -f64::from(j));
                mesh.positions.push(DVec3::new(x, height(x, z), z));
            }
        }
        let at = |i: u32, j: u32| j * (n + 1) + i;
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            mesh.faces.push(Face::new(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
        }
        mesh
    }

    #[test]
    fn a_flat_sheet_keeps_its_outline() {
        let found = simplify(&sheet(6, |_, _| 0.0), 40);
        assert_eq!((found.removed, found.mesh.positions.len()), (40, 9));
        assert!((surface_area(&found.mesh) - 36.0).abs() < 1e-9);
    }

    #[test]
    fn folds_are_kept_longest() {
        let folded = sheet(6, |x, _| (x - 3.0).abs());
        let found = simplify(&folded, 38);
        assert!((surface_area(&found.mesh) - surface_area(&folded)).abs() < 1e-9);
        assert_eq!(simplify(&folded, 0).mesh.positions.len(), 49);
    }

    #[test]
    fn closed_bodies_stay_closed() {
        // A sphere of 12 x 24.
        let (rings, steps) = (12u32, 24u32);
        let mut mesh = Mesh { positions: vec![DVec3::Y, DVec3::NEG_Y], faces: Vec::new() };
        let vertex = |i: u32, k: u32| {
            if i == 0 {
                0
            } else if i == rings {
                1
            } else {
                2 + (i - 1) * steps + k % steps
            }
        };
        for i in 1..rings {
            for k in 0..steps {
                let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(i) / f64::from(rings));
                let (s, c) = libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(steps));
                mesh.positions.push(DVec3::new(sin * c, cos, -sin * s));
            }
        }
        for i in 0..rings {
            for k in 0..steps {
                let mut ring = vec![vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1), vertex(i, k + 1)];
                ring.dedup();
                if ring.first() == ring.last() {
                    ring.pop();
                }
                mesh.faces.push(Face::new(ring));
            }
        }
        assert!(is_closed(&mesh));
        let count = mesh.positions.len() / 2;
        let found = simplify(&mesh, count);
        assert_eq!((found.removed, is_closed(&found.mesh)), (count, true));
        let (before, after) = (volume(&mesh), volume(&found.mesh));
        assert!((before - after).abs() < 0.06 * before, "{before} {after}");
        assert_eq!(found, simplify(&mesh, count));
    }
}
