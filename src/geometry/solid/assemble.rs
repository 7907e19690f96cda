//! Puts kept pieces together. In: cells per facet. Out: polygons with holes over common vertices, with texture
//! coordinates and normals taken from the faces they come from.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec2, DVec3};

use super::arrange::Arrangement;
use super::classify::Piece;
use super::facets::{Facets, edge};
use super::straighten::straighten;
use super::{Combined, Origin};
use crate::geometry::cut::cap::{CapEdge, loops, nest};
use crate::geometry::transform::flip_loop;
use crate::geometry::triangulate::triangulate_face;
use crate::geometry::{Face, Mesh};

/// A polygon of the result over pool vertices.
pub struct Outline {
    pub facet: usize,
    pub loops: Vec<Vec<u32>>,
    pub is_shared: bool,
    pub is_flipped: bool,
}

pub fn assemble(facets: &Facets, arrangement: &Arrangement, pieces: Vec<Piece>, meshes: [&Mesh; 2]) -> Combined {
    let mut outlines: Vec<Outline> = pieces.iter().flat_map(|p| outlines_of(facets, arrangement, p)).collect();
    straighten(facets, &mut outlines);
    let mut out = Combined::default();
    // Vertices in their old order, new ones last.
    let used: BTreeSet<u32> = outlines.iter().flat_map(|o| o.loops.iter().flatten().copied()).collect();
    let places: BTreeMap<u32, u32> = used.iter().enumerate().map(|(i, &v)| (v, i as u32)).collect();
    out.mesh.positions = used.iter().map(|&v| facets.position(v)).collect();
    for outline in outlines {
        let facet = &facets.list[outline.facet];
        let mut face = filled(facets, &outline, meshes[usize::from(facet.operand)]);
        face.loops_mut().flatten().for_each(|v| *v = places[v]);
        out.mesh.faces.push(face);
        out.origins.push(Origin { operand: facet.operand, face: facet.face, is_shared: outline.is_shared });
    }
    out.cuts = cuts(&out);
    out
}

/// Edges between faces of different operands.
fn cuts(combined: &Combined) -> Vec<[u32; 2]> {
    let mut operands: BTreeMap<[u32; 2], [bool; 2]> = BTreeMap::new();
    for (face, origin) in combined.mesh.faces.iter().zip(&combined.origins) {
        for (a, b) in face.edges() {
            operands.entry(edge(a, b)).or_default()[usize::from(origin.operand)] = true;
        }
    }
    operands.into_iter().filter(|(_, both)| both[0] && both[1]).map(|(e, _)| e).collect()
}

fn outlines_of(facets: &Facets, arrangement: &Arrangement, piece: &Piece) -> Vec<Outline> {
    let facet = &facets.list[piece.facet];
    let along = |ring: &Vec<u32>| -> Vec<u32> {
        (0..ring.len()).flat_map(|i| arrangement.along(ring[i], ring[(i + 1) % ring.len()])).collect()
    };
    let own: Vec<Vec<u32>> = facet.loops.iter().map(along).collect();
    let polygons = if piece.is_whole {
        vec![own]
    } else {
        // Places of the border's edges in the order of the face, to find the first edge again.
        let mut ranks: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for ring in &own {
            for i in 0..ring.len() {
                let next = ranks.len();
                ranks.entry((ring[i], ring[(i + 1) % ring.len()])).or_insert(next);
            }
        }
        polygons(facets, piece, &ranks)
    };
    let outline = |mut loops: Vec<Vec<u32>>| {
        if piece.is_flipped {
            loops.iter_mut().for_each(|l| flip_loop(l));
        }
        Outline { facet: piece.facet, loops, is_shared: piece.is_shared, is_flipped: piece.is_flipped }
    };
    polygons.into_iter().map(outline).collect()
}

/// The borders of a piece's triangles as polygons, each beginning with its first edge that the face had.
fn polygons(facets: &Facets, piece: &Piece, ranks: &BTreeMap<(u32, u32), usize>) -> Vec<Vec<Vec<u32>>> {
    let facet = &facets.list[piece.facet];
    let mut border: BTreeSet<(u32, u32)> = BTreeSet::new();
    for &[a, b, c] in &piece.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if !border.remove(&(to, from)) {
                border.insert((from, to));
            }
        }
    }
    let rank = |from: u32, to: u32| ranks.get(&(from, to)).copied().unwrap_or(usize::MAX);
    let edges = border.into_iter().map(|(from, to)| CapEdge { from, to, face: rank(from, to) }).collect();
    let flat = |v: u32| (facet.flat)(facets.position(v));
    let from_first_edge = |ring: &[u32]| -> Vec<u32> {
        let mut ring = ring.to_vec();
        let first = (0..ring.len()).min_by_key(|&i| (rank(ring[i], ring[(i + 1) % ring.len()]), i));
        ring.rotate_left(first.unwrap_or(0));
        ring
    };
    let faces = nest(loops(edges, flat), flat);
    faces.iter().map(|f| f.loops().map(from_first_edge).collect()).collect()
}

/// The face with everything its source says of its corners.
fn filled(facets: &Facets, outline: &Outline, mesh: &Mesh) -> Face {
    let source = &mesh.faces[facets.list[outline.facet].face as usize];
    let mut loops = outline.loops.iter();
    let outer = loops.next().cloned().unwrap_or_default();
    let mut face = Face::with_holes(outer, loops.cloned());
    if source.uvs.is_empty() && source.normals.is_empty() {
        return face;
    }
    let values = Values::new(facets, outline, mesh, source);
    let weights: Vec<[(usize, f64); 3]> = face.corners().map(|v| values.at(facets.position(v))).collect();
    for (set, uv) in &source.uvs {
        let value = |w: &[(usize, f64); 3]| w.iter().map(|&(c, share)| uv[c] * share).sum::<DVec2>();
        face.uvs.push((*set, weights.iter().map(value).collect()));
    }
    if !source.normals.is_empty() {
        let turn = if outline.is_flipped { -1.0 } else { 1.0 };
        let value = |w: &[(usize, f64); 3]| {
            let sum = w.iter().map(|&(c, share)| source.normals[c] * share).sum::<DVec3>();
            sum.normalize_or_zero() * turn
        };
        face.normals = weights.iter().map(value).collect();
    }
    face
}

/// Interpolation over one face.
struct Values {
    flat: fn(DVec3) -> DVec2,
    tolerance: f64,
    corners: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Values {
    fn new(facets: &Facets, outline: &Outline, mesh: &Mesh, source: &Face) -> Values {
        let flat = facets.list[outline.facet].flat;
        let corners = source.corners().map(|v| mesh.positions[v as usize]).collect();
        Values { flat, tolerance: 2.0 * facets.pool.tolerance, corners, triangles: triangulate_face(mesh, source) }
    }

    /// Shares of the face's corners at a point: of one where they are the same, else of the triangle around it.
    fn at(&self, p: DVec3) -> [(usize, f64); 3] {
        if let Some(corner) = self.corners.iter().position(|c| c.distance(p) <= self.tolerance) {
            return [(corner, 1.0), (corner, 0.0), (corner, 0.0)];
        }
        let q = (self.flat)(p);
        let mut best = (f64::NEG_INFINITY, [(0, 1.0), (0, 0.0), (0, 0.0)]);
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| (self.flat)(self.corners[i as usize]));
            let all = (b - a).perp_dot(c - a);
            let (u, v) = ((q - a).perp_dot(c - a) / all, (b - a).perp_dot(q - a) / all);
            let room = u.min(v).min(1.0 - u - v);
            if room > best.0 {
                let [i, j, k] = t.map(|i| i as usize);
                best = (room, [(i, 1.0 - u - v), (j, u), (k, v)]);
            }
        }
        best.1
    }
}
