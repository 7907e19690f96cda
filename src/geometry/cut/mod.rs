//! Cutting meshes by planes. In: a mesh and one or many parallel planes. Out: the pieces, closed again by caps.
//!
//! Closed components give closed pieces, a cap face per separate outline of the cut, with its holes. Open ones are just
//! cut. Concave faces may fall into several. A face in the plane goes to the side it bounds. A face keeps its first
//! edge if that survives, otherwise it starts with the first surviving one (cga-reference C.3). Cut points are computed
//! once per edge, so the pieces meet bitwise. Texture coordinates are interpolated; caps have none.

pub(super) mod cap;
mod face;
mod levels;
mod quad;
mod sheet;

use std::collections::BTreeMap;

use glam::DVec3;
use smallvec::SmallVec;

use super::{Face, Mesh, Plane};
use face::{CutFace, Side};
pub use levels::slice_by_value;
use quad::Quad;
use sheet::Sheet;

/// Where a face of a piece comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// All or part of this face of the input.
    Face(u32),
    /// Closes the cut.
    Cap,
}

/// One piece; `origins` runs parallel to `mesh.faces`. A cap comes first if the input's face 0 is in other pieces
/// only (cga-reference 4.3.1), last otherwise. Empty if nothing of the input lies here.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    pub mesh: Mesh,
    pub origins: Origins,
}

/// Origins of the faces of a piece, in place for a few.
pub type Origins = SmallVec<[Origin; 2]>;

impl Piece {
    pub fn is_empty(&self) -> bool {
        self.mesh.faces.is_empty()
    }
}

/// The two sides of a cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cut {
    pub behind: Piece,
    pub front: Piece,
}

/// Cuts a mesh by a plane. Vertices within 1.5e-8 of the mesh's extent lie on the plane.
pub fn cut(mesh: &Mesh, plane: &Plane) -> Cut {
    let origins = (0..mesh.faces.len() as u32).map(Origin::Face).collect();
    cut_piece(Piece { mesh: mesh.clone(), origins }, plane, thickness(mesh))
}

/// Cuts a mesh by the parallel planes `normal . p = boundary` (`normal` of length 1, `boundaries` rising) into
/// `boundaries.len() + 1` pieces: before the first, between each pair, after the last. Pieces may be empty.
pub fn slice(mesh: &Mesh, normal: DVec3, boundaries: &[f64]) -> Vec<Piece> {
    let Some(mut quad) = Quad::of(mesh) else { return slice_one_by_one(mesh, normal, boundaries) };
    let thickness = thickness(mesh);
    let mut pieces = Vec::with_capacity(boundaries.len() + 1);
    for &offset in boundaries {
        let Some(piece) = quad.cut(&Plane { normal, offset }, thickness) else { break };
        pieces.push(piece);
    }
    let left = &boundaries[pieces.len()..];
    slice_rest(quad.into_piece(), normal, left, thickness, &mut pieces);
    pieces
}

fn slice_one_by_one(mesh: &Mesh, normal: DVec3, boundaries: &[f64]) -> Vec<Piece> {
    let origins = (0..mesh.faces.len() as u32).map(Origin::Face).collect();
    let mut pieces = Vec::with_capacity(boundaries.len() + 1);
    slice_rest(Piece { mesh: mesh.clone(), origins }, normal, boundaries, thickness(mesh), &mut pieces);
    pieces
}

fn slice_rest(mut rest: Piece, normal: DVec3, boundaries: &[f64], thickness: f64, pieces: &mut Vec<Piece>) {
    for &offset in boundaries {
        let Cut { behind, front } = cut_piece(rest, &Plane { normal, offset }, thickness);
        pieces.push(behind);
        rest = front;
    }
    pieces.push(rest);
}

/// Half the thickness of a plane: 16 steps of the kernel's grid for this extent (numerics section 3), 1.5e-8 of it, so
/// that walls turned by rounding make no slivers; and never below what f64 resolves this far from the origin.
fn thickness(mesh: &Mesh) -> f64 {
    let Some((lo, hi)) = mesh.bounds() else { return 0.0 };
    let reach = lo.abs().max(hi.abs()).max_element();
    ((hi - lo).max_element() * THICKNESS).max(reach * RESOLUTION)
}

const THICKNESS: f64 = 16.0 / (1u64 << 30) as f64;
const RESOLUTION: f64 = 1.0 / (1u64 << 45) as f64;

fn cut_piece(piece: Piece, plane: &Plane, thickness: f64) -> Cut {
    match sheet::cut(&piece, plane, thickness) {
        Some(Sheet::Behind) => Cut { behind: piece, front: Piece::default() },
        Some(Sheet::Front) => Cut { behind: Piece::default(), front: piece },
        Some(Sheet::Both(cut)) => cut,
        None => cut_any(piece, plane, thickness),
    }
}

/// The general way.
fn cut_any(piece: Piece, plane: &Plane, thickness: f64) -> Cut {
    let distances: Vec<f64> = piece.mesh.positions.iter().map(|&p| plane.signed_distance(p)).collect();
    let sides: Vec<Side> = distances.iter().map(|&d| Side::of(d, thickness)).collect();
    let mut cutter = Cutter::new(&piece.mesh, plane, distances, sides);
    let homes: Vec<(bool, bool)> = piece.mesh.faces.iter().map(|f| cutter.homes(f)).collect();
    match (homes.iter().any(|h| h.0), homes.iter().any(|h| h.1)) {
        (_, false) => return Cut { behind: piece, front: Piece::default() },
        (false, true) => return Cut { behind: Piece::default(), front: piece },
        (true, true) => (),
    }
    let (mut behind, mut front) = (Vec::new(), Vec::new());
    for (index, source) in piece.mesh.faces.iter().enumerate() {
        match homes[index] {
            (true, false) => behind.push((index, source.clone())),
            (false, _) => front.push((index, source.clone())),
            (true, true) => {
                let cut = CutFace::new(&piece.mesh, source, plane, |a, b| cutter.crossing(a, b));
                let parts =
                    |side| cut.parts(side, &cutter.positions, &cutter.sides).into_iter().map(move |f| (index, f));
                behind.extend(parts(Side::Behind));
                front.extend(parts(Side::Front));
            }
        }
    }
    let closed = cap::faces_of_closed_components(&piece.mesh);
    let finish = |faces: Vec<(usize, Face)>, side: Side| {
        let caps = cap::caps(&cutter.positions, &faces, &closed, plane, side, |v| cutter.sides[v as usize] == Side::On);
        assemble(&cutter.positions, &piece.origins, faces, caps)
    };
    Cut { behind: finish(behind, Side::Behind), front: finish(front, Side::Front) }
}

/// The vertices of one cut: those of the mesh, then the cut points.
struct Cutter<'a> {
    mesh: &'a Mesh,
    plane: &'a Plane,
    distances: Vec<f64>,
    positions: Vec<DVec3>,
    sides: Vec<Side>,
    /// Cut point of an edge, lesser vertex first.
    cut_points: BTreeMap<(u32, u32), u32>,
}

impl<'a> Cutter<'a> {
    fn new(mesh: &'a Mesh, plane: &'a Plane, distances: Vec<f64>, sides: Vec<Side>) -> Self {
        Cutter { mesh, plane, distances, positions: mesh.positions.clone(), sides, cut_points: BTreeMap::new() }
    }

    /// Whether a face has a part behind the plane, and one in front. A face in the plane goes to the side it bounds.
    fn homes(&self, face: &Face) -> (bool, bool) {
        let has = |s: Side| face.corners().any(|c| self.sides[c as usize] == s);
        match (has(Side::Behind), has(Side::Front)) {
            (false, false) => {
                let behind = self.mesh.newell(face).dot(self.plane.normal) > 0.0;
                (behind, !behind)
            }
            homes => homes,
        }
    }

    /// The cut point of edge a-b and its place from a (0) to b (1), if a and b are on different sides. The point is
    /// the same bits whichever way the edge is run, and lies in the plane exactly if that is a coordinate plane.
    fn crossing(&mut self, a: u32, b: u32) -> Option<(u32, f64)> {
        if self.sides[a as usize] != self.sides[b as usize].opposite()? {
            return None;
        }
        let share =
            |i: u32, j: u32| self.distances[i as usize] / (self.distances[i as usize] - self.distances[j as usize]);
        let end = |i: u32| (self.positions[i as usize], self.distances[i as usize]);
        let point = cut_point(end(a), end(b), self.plane);
        let vertex = *self.cut_points.entry((a.min(b), a.max(b))).or_insert_with(|| {
            self.positions.push(point);
            self.sides.push(Side::On);
            self.positions.len() as u32 - 1
        });
        Some((vertex, share(a, b)))
    }
}

/// Where the edge between two points with their distances meets the plane, the same bits whichever way it is run.
fn cut_point(a: (DVec3, f64), b: (DVec3, f64), plane: &Plane) -> DVec3 {
    let in_order = (a.0.x, a.0.y, a.0.z) <= (b.0.x, b.0.y, b.0.z);
    let ((p, dp), (q, dq)) = if in_order { (a, b) } else { (b, a) };
    on_coordinate_plane(p + (q - p) * (dp / (dp - dq)), plane)
}

fn on_coordinate_plane(mut p: DVec3, plane: &Plane) -> DVec3 {
    for axis in 0..3 {
        if plane.normal[axis].abs() == 1.0 {
            p[axis] = plane.offset * plane.normal[axis];
        }
    }
    p
}

/// Puts faces and caps in order and keeps only the vertices they use, in their old order.
fn assemble(positions: &[DVec3], origins: &[Origin], faces: Vec<(usize, Face)>, caps: Vec<Face>) -> Piece {
    let caps_first = faces.first().is_some_and(|&(index, _)| index != 0);
    let capped = caps.into_iter().map(|f| (Origin::Cap, f));
    let own = faces.into_iter().map(|(index, f)| (origins[index], f));
    let ordered: Vec<(Origin, Face)> =
        if caps_first { capped.chain(own).collect() } else { own.chain(capped).collect() };
    let mut place = vec![u32::MAX; positions.len()];
    ordered.iter().flat_map(|(_, f)| f.corners()).for_each(|c| place[c as usize] = 0);
    let mut piece = Piece::default();
    for (slot, &position) in place.iter_mut().zip(positions).filter(|(slot, _)| **slot == 0) {
        *slot = piece.mesh.positions.len() as u32;
        piece.mesh.positions.push(position);
    }
    for (origin, mut face) in ordered {
        let loops = std::iter::once(&mut face.outer).chain(&mut face.holes);
        loops.flatten().for_each(|c| *c = place[*c as usize]);
        piece.origins.push(origin);
        piece.mesh.faces.push(face);
    }
    piece
}

#[cfg(test)]
mod tests;
